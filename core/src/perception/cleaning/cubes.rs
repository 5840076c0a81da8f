//! The cubes of a grid: in which one a point is, and its hash.

use crate::geometry::Point;

/// The cube with an edge of `edge` metres that a point is in.
pub(super) fn cube(point: &Point, edge: f32) -> [u32; 3] {
    [point.x, point.y, point.z].map(|x| libm::floorf(x / edge) as i32 as u32)
}

/// A hash of a cube, mixed in all bits.
pub(super) fn hash([x, y, z]: [u32; 3]) -> u32 {
    let mixed = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ z.wrapping_mul(0xC2B2_AE3D);
    (mixed ^ mixed >> 15).wrapping_mul(0x2C1B_3C6D) ^ mixed >> 13
}
