//! Reads meshes, point clouds and depth images from files.
//!
//! | kind  | extensions | notes |
//! | ----- | ---------- | ----- |
//! | mesh  | `obj`      | polygons of any shape; objects and groups are merged |
//! | mesh  | `stl`      | text and binary |
//! | mesh  | `ply`      | text and binary of both byte orders |
//! | mesh  | `glb`, `gltf` | every node of every scene, with its transform |
//! | mesh  | `urdf` | every link at zero joint positions, or `robot.urdf#link` in its own frame |
//! | cloud | `ply`, `obj` | without faces |
//! | cloud | `pcd`      | text, binary and compressed; missing (NaN) points are dropped |
//! | cloud | `xyz`, `txt`, `pts` | `x y z` or `x y z nx ny nz` per line |
//!
//! A URDF gives the visual meshes of its links, or the collision meshes of a link that has no others, and boxes,
//! cylinders, spheres and capsules. A path may begin with `package://`: the package is looked for in `AMENT_PREFIX_PATH` and
//! `ROS_PACKAGE_PATH`, and above the URDF that names it.
//!
//! Depth images and what belongs to them are in [`depth`].
//!
//! Coordinates are returned as in the file. Only glTF has a unit, and no format is rotated or scaled here. glTF is y-up
//! by its specification; the caller states the up axis.
//!
//! Vertices with bitwise equal coordinates are merged, so that a solid is closed in every format. The `notes` report
//! what a reader changed. A file that cannot be read is a [`FileError`] that names the place and the remedy. No file
//! makes a reader panic, or reserve memory out of proportion to the length of the file and of those it names.

mod cloud;
pub mod depth;
mod error;
mod locate;
mod mesh;
mod ply;
mod source;
mod supporter;
mod text;

pub use cloud::{CloudFile, cloud_ply_bytes, read_cloud};
pub use error::{FileError, Place};
pub use locate::is_located;
pub use mesh::{MeshFile, ply_bytes, read_mesh};
pub use supporter::{SupporterFile, read_supporter};
