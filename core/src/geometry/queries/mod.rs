//! Rays, closest points, winding numbers, neighbours and hull exits, with trees in the caller's memory.

mod bvh;
pub mod hull;
mod nearest;
mod point_tree;
mod ray;
mod surface;

pub(crate) use bvh::Node;
pub(crate) use point_tree::{Nearest, PointTreeSlots};
pub use point_tree::{Neighbour, PointTree};
pub use surface::Surface;
