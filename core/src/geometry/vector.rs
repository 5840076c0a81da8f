//! Points, vectors and poses, and the vector functions that nalgebra leaves out.

use nalgebra::{Quaternion, UnitQuaternion};

/// A position, in metres.
pub type Point = nalgebra::Point3<f32>;
/// A direction or a displacement, in metres.
pub type Vector = nalgebra::Vector3<f32>;
/// A rigid motion: rotation, then translation in metres.
pub type Pose = nalgebra::Isometry3<f32>;

/// The largest absolute coordinate, in metres, that a mesh or a cloud may have. Above it, the spacing of `f32` exceeds the
/// details of hand-held objects, and squared distances may overflow.
pub const MAX_COORDINATE: f32 = 1e6;

/// Whether a pose is a rigid motion to a place within the greatest coordinates.
pub(crate) fn is_rigid(pose: &Pose) -> bool {
    let length = pose.rotation.coords.norm();
    pose.translation.vector.iter().all(|x| x.abs() <= MAX_COORDINATE) && (length - 1.0).abs() < 1e-3
}

/// `vector` scaled to unit length, or `otherwise` if its length is zero.
pub(crate) fn unit_or(vector: Vector, otherwise: Vector) -> Vector {
    let length = vector.norm();
    if length > 0.0 { vector / length } else { otherwise }
}

/// A unit vector perpendicular to the unit vector `v`. The choice is a fixed rule, so that runs repeat.
pub(crate) fn any_perpendicular(v: Vector) -> Vector {
    let axis = if v.x.abs() < 0.9 { Vector::x() } else { Vector::y() };
    v.cross(&axis).normalize()
}

/// `v` rotated by `angle` radians about the unit vector `axis`, to which it is perpendicular.
pub(crate) fn rotate_about(axis: Vector, angle: f32, v: Vector) -> Vector {
    let (sin, cos) = libm::sincosf(angle);
    v * cos + axis.cross(&v) * sin
}

/// Point `index` of a Fibonacci lattice of `count` points, which are evenly spread on the unit sphere.
pub(crate) fn fibonacci_direction(index: usize, count: usize) -> Vector {
    let golden_angle = core::f32::consts::PI * (3.0 - libm::sqrtf(5.0));
    let z = 1.0 - (2.0 * index as f32 + 1.0) / count as f32;
    let (across, angle) = (libm::sqrtf(1.0 - z * z), golden_angle * index as f32);
    Vector::new(across * libm::cosf(angle), across * libm::sinf(angle), z)
}

/// Rotation about the axis `turn` by its length in radians.
pub(crate) fn rotation_by(turn: &Vector) -> UnitQuaternion<f32> {
    let half = 0.5 * turn.norm();
    // sin(x) / x without a division by zero.
    let scale = if half > 1e-3 { libm::sinf(half) / half } else { 1.0 - half * half / 6.0 };
    UnitQuaternion::new_normalize(Quaternion::from_parts(libm::cosf(half), turn * (0.5 * scale)))
}
