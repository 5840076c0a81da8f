//! The file readers against files written by hand, whose content is known.

mod clouds;
mod errors;
mod garbage;
mod meshes;
mod polygons;
#[path = "../random/mod.rs"]
mod random;
mod samples;
