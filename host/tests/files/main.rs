//! The file readers on hand-written files with known content.

mod clouds;
mod errors;
mod garbage;
mod meshes;
mod polygons;
#[path = "../random/mod.rs"]
mod random;
mod samples;
mod urdf;
