//! Meshes and point clouds, and what follows from their coordinates alone.

mod aabb;
mod cloud;
mod mass;
mod mesh;
pub(super) mod triangle;
mod viewpoints;

pub use aabb::Aabb;
pub use cloud::{Cloud, CloudError};
pub use mass::MassProperties;
pub use mesh::{MAX_COUNT, Mesh, MeshError};
pub(crate) use triangle::closest_point as closest_point_on_triangle;
pub(crate) use triangle::{ball_on, halves, longest_side_first, scaled_normal};
pub(crate) use viewpoints::Viewpoints;
