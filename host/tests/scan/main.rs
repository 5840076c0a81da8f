//! Depth images from files to a mesh: formats, errors and the command `hangpose scan`.

mod cloud;
mod command;
mod completion;
mod errors;
mod formats;
mod garbage;
mod scene;

#[path = "../images/mod.rs"]
mod images;
#[path = "../random/mod.rs"]
mod random;
