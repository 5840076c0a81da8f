//! Where the object can lie on something: points of its surface that look down when it hangs from them.

use super::ObjectCounts;
use crate::geometry::{Point, Vector, any_perpendicular, rotate_about, unit_or};
use crate::hanging::object::ObjectSamples;
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};

/// A point of the object that can lie on a support, in object coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct ObjectContact {
    /// On the surface, metres.
    pub position: Point,
    /// Unit vector out of the solid.
    pub normal: Vector,
    /// Unit vector along the thin bar that the object catches best under the point; its sign means nothing.
    pub bar_direction: Vector,
    /// How far such a bar must come down before it gets out sideways, metres; 0 if it is not caught.
    pub capture: f32,
    /// How far it is to the surface opposite, metres; infinite where there is none.
    pub room: f32,
    /// How far such a bar gets along its direction, on the side where it gets farther, metres; infinite where nothing stops it, as
    /// in a hole.
    pub passage: f32,
}

/// Contacts kept at most. They are samples of the surface that are apart; those that come first stay.
pub(super) const MAX_CONTACTS: usize = 192;
/// Contacts that look the same way are apart by this share of the object's diagonal.
const APART: f32 = 0.02;
/// ... and look the same way if their normals have this cosine.
const SAME_WAY: f32 = 0.7;
/// Least cosine between the normal and the direction to the centre of mass: eq. (3), with less asked than in the paper, because
/// gravity has the last word.
const LEAST_COSINE: f32 = 0.3;
/// Directions of a bar that are tried.
const DIRECTIONS: usize = 6;
/// How far below the contact it is looked to the sides, metres.
const LEVELS: [f32; 6] = [0.0015, 0.003, 0.006, 0.012, 0.024, 0.048];
/// How far below the contact it is looked along the bar, metres: about where a bar's middle comes to be.
const PASSAGE_LEVEL: f32 = 0.004;
/// Rays start this far off the surface, metres, so that they do not hit where they come from.
const LIFT_OFF: f32 = 1e-4;

/// The search on one object.
pub(super) struct Search<'a> {
    pub(super) samples: &'a ObjectSamples<'a>,
}

impl Search<'_> {
    /// Fills `slots` with contacts, the deepest capture first, and of equal ones the narrowest, which hold more firmly. `Some`
    /// says that the work limit ended the search early, with the contacts found until then.
    pub(super) fn find(
        &self,
        slots: &mut [ObjectContact],
        meter: &mut Meter,
    ) -> (ObjectCounts, Option<Stop>) {
        let ObjectSamples { surface, points, normals, centre_of_mass, .. } = *self.samples;
        let apart = APART * surface.aabb().diagonal();
        let (mut counts, mut stop) = (ObjectCounts::default(), None);
        for (point, normal) in points.iter().zip(normals) {
            let to_centre = centre_of_mass - point;
            if to_centre.dot(normal) < LEAST_COSINE * to_centre.norm() {
                continue;
            }
            counts.contact_points += 1;
            let count = counts.contacts;
            let is_known = |other: &ObjectContact| {
                (other.position - point).norm_squared() < apart * apart && other.normal.dot(normal) > SAME_WAY
            };
            if count == slots.len() || slots[..count].iter().any(is_known) {
                continue;
            }
            match self.examine(*point, *normal, meter) {
                Ok(contact) => slots[count] = contact,
                Err(reason) => {
                    stop = Some(reason);
                    break;
                }
            }
            counts.contacts += 1;
        }
        // Ties are broken by position: a sort that needs no memory is not stable.
        let place = |c: &ObjectContact| [c.position.x, c.position.y, c.position.z];
        slots[..counts.contacts].sort_unstable_by(|a, b| {
            let by_place = || {
                let (a, b) = (place(a), place(b));
                a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
            };
            b.capture.total_cmp(&a.capture).then(a.room.total_cmp(&b.room)).then_with(by_place)
        });
        (counts, stop)
    }

    fn examine(&self, point: Point, normal: Vector, meter: &mut Meter) -> Result<ObjectContact, Stop> {
        let down = unit_or(self.samples.centre_of_mass - point, normal);
        let start = point + normal * LIFT_OFF;
        meter.rays(1)?;
        let room = self.samples.surface.closest_hit(&start, &down).unwrap_or(f32::INFINITY);
        let reference = any_perpendicular(down);
        let (mut bar_direction, mut capture) = (reference, -1.0);
        for k in 0..DIRECTIONS {
            let along = rotate_about(down, core::f32::consts::PI * k as f32 / DIRECTIONS as f32, reference);
            let side = along.cross(&down);
            meter.rays(2 * LEVELS.len())?;
            let is_caught = |level: &&f32| {
                let from = start + down * **level;
                **level < room
                    && self.samples.surface.any_hit(&from, &side)
                    && self.samples.surface.any_hit(&from, &-side)
            };
            // From below, because what is not caught in a crease right under the contact may be caught deeper.
            let caught = LEVELS.iter().rev().find(is_caught).copied().unwrap_or(0.0);
            if caught > capture {
                (bar_direction, capture) = (along, caught);
            }
        }
        let from = start + down * PASSAGE_LEVEL.min(0.5 * room);
        meter.rays(2)?;
        let ways = [bar_direction, -bar_direction].map(|way| self.samples.surface.closest_hit(&from, &way));
        let passage = ways.iter().map(|hit| hit.unwrap_or(f32::INFINITY)).fold(0.0, f32::max);
        Ok(ObjectContact { position: point, normal, bar_direction, capture, room, passage })
    }
}
