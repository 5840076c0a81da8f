//! Where the object can lie on something: points of its surface that look down when it hangs from them.

use crate::best::Best;
use crate::geometry::{Point, Surface, Vector, any_perpendicular, rotate_about, unit_or};
use bytemuck::{Pod, Zeroable};

/// A point of the object that can lie on a support, in object coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct ObjectContact {
    /// On the surface, metres.
    pub position: Point,
    /// Out of the solid.
    pub normal: Vector,
    /// Unit vector along the bar that is caught best under it; its sign means nothing.
    pub bar_direction: Vector,
    /// How far a thin bar under the point must come down before it gets out sideways, metres.
    pub capture: f32,
    /// How far it is to the surface opposite, metres; infinite where there is none.
    pub room: f32,
}

pub(super) const MAX_CONTACTS: usize = 192;
const DIRECTIONS: usize = 6;
const LEVELS: [f32; 6] = [0.0015, 0.003, 0.006, 0.012, 0.024, 0.048];
const LIFT_OFF: f32 = 1e-4;

/// Fills `slots` with contacts, the best caught first.
pub(super) fn find<'s>(
    surface: &Surface,
    points: &[Point],
    normals: &[Vector],
    centre_of_mass: Point,
    least_cosine: f32,
    slots: &'s mut [ObjectContact],
) -> &'s [ObjectContact] {
    let apart = 0.02 * surface.aabb().diagonal();
    let mut count = 0;
    for (point, normal) in points.iter().zip(normals) {
        let to_centre = centre_of_mass - point;
        if to_centre.dot(normal) < least_cosine * to_centre.norm() || count == slots.len() {
            continue;
        }
        let is_known = |other: &ObjectContact| {
            (other.position - point).norm_squared() < apart * apart && other.normal.dot(normal) > 0.7
        };
        if slots[..count].iter().any(is_known) {
            continue;
        }
        slots[count] = examine(surface, *point, *normal, centre_of_mass);
        count += 1;
    }
    slots[..count].sort_unstable_by(|a, b| {
        b.capture.total_cmp(&a.capture).then(b.room.total_cmp(&a.room)).then(
            a.position.x.total_cmp(&b.position.x).then(a.position.y.total_cmp(&b.position.y)),
        )
    });
    &slots[..count]
}

fn examine(surface: &Surface, point: Point, normal: Vector, centre_of_mass: Point) -> ObjectContact {
    let down = unit_or(centre_of_mass - point, normal);
    let start = point + normal * LIFT_OFF;
    let room = surface.closest_hit(&start, &down).unwrap_or(f32::INFINITY);
    let reference = any_perpendicular(down);
    let mut best = (Vector::zeros(), -1.0);
    for k in 0..DIRECTIONS {
        let along = rotate_about(down, core::f32::consts::PI * k as f32 / DIRECTIONS as f32, reference);
        let side = along.cross(&down);
        let is_caught = |level: &&f32| {
            let from = start + down * **level;
            **level < room && surface.any_hit(&from, &side) && surface.any_hit(&from, &-side)
        };
        // A bar as thick as the first levels may be hidden in a crease: the levels need not be caught from the first on.
        let capture = LEVELS.iter().rev().find(is_caught).copied().unwrap_or(0.0);
        if capture > best.1 {
            best = (along, capture);
        }
    }
    ObjectContact { position: point, normal, bar_direction: best.0, capture: best.1, room }
}
