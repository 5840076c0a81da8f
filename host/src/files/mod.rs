//! Reads meshes and point clouds from files.
//!
//! | kind  | extensions | notes |
//! | ----- | ---------- | ----- |
//! | mesh  | `obj`      | polygons of any shape, objects and groups merged |
//! | mesh  | `stl`      | text and binary |
//! | mesh  | `ply`      | text and binary of both byte orders |
//! | mesh  | `glb`, `gltf` | every node of every scene, transforms applied |
//! | cloud | `ply`, `obj` | without faces |
//! | cloud | `pcd`      | text, binary and compressed; missing (NaN) points left out |
//! | cloud | `xyz`, `txt`, `pts` | `x y z` or `x y z nx ny nz` a line |
//!
//! Coordinates are taken as they stand: no format but glTF has a unit, and none is turned or scaled here. glTF is y-up by
//! its specification; whoever hangs the object says which way is up.
//!
//! Vertices that stand at the same place, bit for bit, become one, so that a solid is closed whatever the format. What was
//! changed on the way is told in the `notes`; what could not be read is a [`FileError`] that names the place and the remedy.
//! No file makes a reader panic or reserve memory that the file's own length does not call for.

mod cloud;
mod error;
mod mesh;
mod ply;
mod source;
mod supporter;
mod text;

pub use cloud::{CloudFile, read_cloud};
pub use error::{FileError, Place};
pub use mesh::{MeshFile, read_mesh};
pub use supporter::{SupporterFile, read_supporter};
