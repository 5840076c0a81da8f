//! The box that the object stays in.

use crate::geometry::{Aabb, Point, Pose, Vector};

/// A box in the caller's supporter coordinates, and the corners of the object's own box, in the frame of the object.
#[derive(Clone, Copy)]
pub(in crate::motion) struct Workspace {
    aabb: Aabb,
    corners: [Point; 8],
}

impl Workspace {
    pub(in crate::motion) fn new(aabb: Aabb, object: Aabb) -> Self {
        let corner = |index: usize| {
            Point::from(Vector::from(
                [0, 1, 2].map(
                    |axis| {
                        if index >> axis & 1 == 1 { object.max[axis] } else { object.min[axis] }
                    },
                ),
            ))
        };
        Self { aabb, corners: core::array::from_fn(corner) }
    }

    /// How far the object is inside the box at a pose, from its frame to the caller's supporter coordinates, metres; negative if a part of it is outside.
    pub(super) fn room_at(&self, pose: &Pose) -> f32 {
        let room = |corner: &Point| {
            let at = pose * corner;
            (0..3)
                .map(|axis| (at[axis] - self.aabb.min[axis]).min(self.aabb.max[axis] - at[axis]))
                .fold(f32::INFINITY, f32::min)
        };
        self.corners.iter().map(room).fold(f32::INFINITY, f32::min)
    }
}
