//! Shapes and queries on them. Nothing here knows of hanging.

/// A position, in metres.
pub type Point = nalgebra::Point3<f32>;
/// A direction or a displacement, in metres.
pub type Vector = nalgebra::Vector3<f32>;
/// A rigid motion: rotation, then translation in metres.
pub type Pose = nalgebra::Isometry3<f32>;

pub mod hull;
