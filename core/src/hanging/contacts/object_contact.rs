//! Contact candidates of the object: points of its surface that face down when it hangs from them.

use super::constants::*;
use super::counts::ObjectCounts;
use crate::geometry::{Point, Pose, Vector, rotate_about, unit_or};
use crate::hanging::opening;
use crate::hanging::samples::ObjectSamples;
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};

/// A point of the object that may rest on a supporter, in object coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct ObjectContact {
    /// On the surface, metres.
    pub position: Point,
    /// Unit vector out of the solid.
    pub normal: Vector,
    /// Unit vector along the thin bar that the object catches best below the point; its sign has no meaning.
    pub bar_direction: Vector,
    /// Capture depth: how far such a bar, a line without thickness, must move from the point towards the centre of mass, which is
    /// down when the object hangs, before it can leave sideways, metres; 0 if it is not caught.
    pub capture: f32,
    /// Distance from the point towards the centre of mass to the surface opposite, metres; infinite if there is none.
    pub room: f32,
    /// Free length for such a bar along its direction, towards the freer side, metres; infinite where nothing stops it,
    /// as in a hole.
    pub passage: f32,
    /// 1 if the object is all around such a bar, as around a hole, else 0.
    pub encircled: u32,
}

impl ObjectContact {
    /// The same in other coordinates, to which `motion` leads.
    pub(in crate::hanging) fn moved(&self, motion: &Pose) -> Self {
        let Self { position, normal, bar_direction, .. } = *self;
        Self {
            position: motion * position,
            normal: motion * normal,
            bar_direction: motion * bar_direction,
            ..*self
        }
    }

    /// Whether the contact is in a loop, through which a bar of useful length passes.
    pub(super) fn is_in_loop(&self) -> bool {
        self.encircled > 0 && !self.is_enclosed()
    }

    /// Height of the opening in which the bar lies, metres: see [`opening::height`].
    pub(super) fn opening(&self) -> f32 {
        opening::height(self.capture, self.room)
    }

    /// Whether only a short bar reaches the contact, as inside a cup.
    pub(super) fn is_enclosed(&self) -> bool {
        self.passage < BAR_LENGTH
    }
}

/// The search on one object.
pub(super) struct Search<'a> {
    pub(super) samples: &'a ObjectSamples<'a>,
}

impl Search<'_> {
    /// Fills `slots` with contacts, the deepest capture first, and of equal ones the narrowest, which hold more firmly.
    /// `Some` says that the work limit ended the search early, with the contacts found until then.
    pub(super) fn find(
        &self,
        slots: &mut [ObjectContact],
        meter: &mut Meter,
    ) -> (ObjectCounts, Option<Stop>) {
        let mut counts =
            ObjectCounts { contact_points: self.facing_the_centre().count(), ..ObjectCounts::default() };
        let mut apart = OBJECT_SPACING * self.samples.surface.aabb().diagonal();
        let found = loop {
            match self.spread(apart, slots) {
                Some(count) => break count,
                None => apart *= SPACING_GROWTH,
            }
        };
        let mut stop = None;
        for slot in &mut slots[..found] {
            match self.examine(slot.position, slot.normal, meter) {
                Ok(contact) => *slot = contact,
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

    /// Samples whose normal leans towards the centre of mass, with their normals.
    fn facing_the_centre(&self) -> impl Iterator<Item = (&Point, &Vector)> {
        let ObjectSamples { points, normals, centre_of_mass, .. } = *self.samples;
        points.iter().zip(normals).filter(move |(point, normal)| {
            let to_centre = centre_of_mass - *point;
            to_centre.dot(normal) >= MIN_OBJECT_COSINE * to_centre.norm()
        })
    }

    /// Fills `slots` with samples at least this far apart or with other normals, and returns their number; `None` if there are
    /// more than `slots`.
    fn spread(&self, apart: f32, slots: &mut [ObjectContact]) -> Option<usize> {
        let mut count = 0;
        for (point, normal) in self.facing_the_centre() {
            let is_known = |other: &ObjectContact| {
                (other.position - point).norm_squared() < apart * apart
                    && other.normal.dot(normal) > SIMILAR_NORMALS
            };
            if slots[..count].iter().any(is_known) {
                continue;
            }
            let slot = slots.get_mut(count)?;
            *slot = ObjectContact { position: *point, normal: *normal, ..ObjectContact::zeroed() };
            count += 1;
        }
        Some(count)
    }

    fn examine(&self, point: Point, normal: Vector, meter: &mut Meter) -> Result<ObjectContact, Stop> {
        let surface = self.samples.surface;
        let down = unit_or(self.samples.centre_of_mass - point, normal);
        let start = point + normal * RAY_OFFSET;
        meter.rays(1)?;
        let room = surface.closest_hit(&start, &down).unwrap_or(f32::INFINITY);
        let (bar_direction, capture) = opening::deepest_bar(surface, &start, &down, room, meter)?;
        let from = start + down * PASSAGE_DEPTH.min(0.5 * room);
        meter.rays(2)?;
        let ways = [bar_direction, -bar_direction].map(|way| surface.closest_hit(&from, &way));
        let passage = ways.iter().map(|hit| hit.unwrap_or(f32::INFINITY)).fold(0.0, f32::max);
        let is_hit = |k: usize| {
            let angle = core::f32::consts::TAU * k as f32 / ENCIRCLING_RAYS as f32;
            surface.any_hit(&from, &rotate_about(bar_direction, angle, down))
        };
        meter.rays(ENCIRCLING_RAYS)?;
        let encircled = u32::from(capture > 0.0 && (0..ENCIRCLING_RAYS).all(is_hit));
        Ok(ObjectContact { position: point, normal, bar_direction, capture, room, passage, encircled })
    }
}
