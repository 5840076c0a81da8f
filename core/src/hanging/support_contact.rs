//! Where the supporter can carry something: points that look up.

use crate::geometry::{Point, PointTree, Vector};
use bytemuck::{Pod, Zeroable};

/// A point of the supporter that something can lie on, in supporter coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct SupportContact {
    /// Metres.
    pub position: Point,
    /// Out of the solid.
    pub normal: Vector,
    /// Unit vector along which the supporter stretches around the point; its sign means nothing.
    pub bar_direction: Vector,
}

pub(super) const MAX_CONTACTS: usize = 128;

/// Fills `slots`.
pub(super) fn find<'s>(
    tree: &PointTree,
    normals: &[Vector],
    up: Vector,
    least_cosine: f32,
    slots: &'s mut [SupportContact],
) -> &'s [SupportContact] {
    let points = tree.points();
    let mut apart = 0.012_f32;
    loop {
        let mut count = 0;
        let mut is_full = false;
        // A stride that visits all points in an order without structure.
        let stride = 7919 % points.len().max(1);
        let stride = if stride == 0 { 1 } else { stride };
        let _ = stride;
        for (point, normal) in points.iter().zip(normals) {
            if normal.dot(&up) < least_cosine {
                continue;
            }
            if slots[..count].iter().any(|o| (o.position - point).norm_squared() < apart * apart) {
                continue;
            }
            if count == slots.len() {
                is_full = true;
                break;
            }
            slots[count] = SupportContact { position: *point, normal: *normal, bar_direction: Vector::x() };
            count += 1;
        }
        if is_full {
            apart *= 1.4;
            continue;
        }
        for slot in &mut slots[..count] {
            slot.bar_direction = bar_direction(tree, slot.position);
        }
        return &slots[..count];
    }
}

/// The direction of greatest spread of the points around.
fn bar_direction(tree: &PointTree, position: Point) -> Vector {
    const RADIUS: f32 = 0.02;
    let (mut count, mut sum, mut squares) = (0.0, Vector::zeros(), nalgebra::Matrix3::<f32>::zeros());
    tree.for_each_within(&position, RADIUS, |n| {
        let offset = tree.points()[n.index as usize] - position;
        count += 1.0;
        sum += offset;
        squares += offset * offset.transpose();
    });
    let spread = squares / count - (sum / count) * (sum / count).transpose();
    // Power iteration: the direction is a hint, not a measurement.
    let mut direction = Vector::new(1.0, 0.83, 0.61).normalize();
    for _ in 0..20 {
        let next = spread * direction;
        let norm = next.norm();
        if norm <= 0.0 {
            break;
        }
        direction = next / norm;
    }
    direction
}
