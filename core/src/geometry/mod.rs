//! Shapes and queries on them. Nothing here knows of hanging.

mod aabb;
mod bvh;
mod cloud;
// Until an object has one.
#[allow(dead_code)]
mod distance_field;
mod eigen;
pub mod hull;
mod linkage;
mod mass;
pub(crate) mod mean_shift;
mod mesh;
mod point_tree;
mod ray;
mod surface;
mod triangle;

pub use aabb::Aabb;
pub use cloud::{Cloud, CloudError};
pub use distance_field::DistanceField;
pub(crate) use eigen::least_eigenvector;
pub(crate) use linkage::linked_cluster;
pub use mass::MassProperties;
pub use mesh::{MAX_COUNT, Mesh, MeshError};
pub use point_tree::{Neighbour, PointTree};
pub use surface::Surface;
pub(crate) use triangle::scaled_normal;

/// A position, in metres.
pub type Point = nalgebra::Point3<f32>;
/// A direction or a displacement, in metres.
pub type Vector = nalgebra::Vector3<f32>;
/// A rigid motion: rotation, then translation in metres.
pub type Pose = nalgebra::Isometry3<f32>;

/// The largest coordinate, in metres, that a mesh or a cloud may have. Beyond it an `f32` could not tell the
/// parts of anything that a robot holds apart, and squares would overflow.
pub const MAX_COORDINATE: f32 = 1e6;

/// `vector` at unit length, or `otherwise` where it has no direction.
pub(crate) fn unit_or(vector: Vector, otherwise: Vector) -> Vector {
    let length = vector.norm();
    if length > 0.0 { vector / length } else { otherwise }
}

/// A unit vector perpendicular to the unit vector `v`, by a fixed rule so that runs repeat.
pub(crate) fn any_perpendicular(v: Vector) -> Vector {
    let axis = if v.x.abs() < 0.9 { Vector::x() } else { Vector::y() };
    v.cross(&axis).normalize()
}

/// `v` turned by `angle` radians around the unit vector `axis`, to which it is perpendicular.
pub(crate) fn rotate_about(axis: Vector, angle: f32, v: Vector) -> Vector {
    let (sin, cos) = libm::sincosf(angle);
    v * cos + axis.cross(&v) * sin
}
