//! Contact candidates of the supporter: points that face up.

use super::constants::*;
use super::counts::SupporterCounts;
use crate::geometry::{Point, PointTree, Pose, Vector, principal_direction};
use crate::mechanics::Support;
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};

/// A point of the supporter on which an object may rest, in supporter coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct SupportContact {
    /// A point of the cloud, metres.
    pub position: Point,
    /// Unit vector out of the solid.
    pub normal: Vector,
    /// Unit vector along the direction of greatest extent of the supporter around the point; its sign has no meaning.
    pub bar_direction: Vector,
}

impl SupportContact {
    /// The same in other coordinates, to which `motion` leads.
    pub(in crate::hanging) fn moved(&self, motion: &Pose) -> Self {
        let Self { position, normal, bar_direction } = *self;
        Self { position: motion * position, normal: motion * normal, bar_direction: motion * bar_direction }
    }
}

/// The search on one supporter.
pub(super) struct Search<'a> {
    pub(super) tree: &'a PointTree<'a>,
    /// In tree order.
    pub(super) normals: &'a [Vector],
    /// 1 for points on which nothing hangs, in tree order.
    pub(super) is_excluded: &'a [u8],
    pub(super) up: Vector,
}

impl Search<'_> {
    /// Fills `slots` with contacts that are apart. `Some` says that the work limit ended the search early, with none.
    pub(super) fn find(
        &self,
        slots: &mut [SupportContact],
        meter: &mut Meter,
    ) -> (SupporterCounts, Option<Stop>) {
        let [.., least] = MIN_SUPPORT_COSINES;
        let contact_points = self.facing_up(least).count();
        match spread(self.tree, |least| self.facing_up(least), slots, meter) {
            Ok(contacts) => (SupporterCounts { contact_points, contacts }, None),
            Err(stop) => (SupporterCounts { contact_points, contacts: 0 }, Some(stop)),
        }
    }

    /// Points that are not excluded, with their normals, whose normal has at least this cosine with up.
    fn facing_up(&self, least: f32) -> impl Iterator<Item = (&Point, &Vector)> {
        let points = self.tree.points().iter().zip(self.normals).zip(self.is_excluded);
        let faces_up = move |normal: &Vector| normal.dot(&self.up) >= least;
        points
            .filter(move |((_, normal), excluded)| **excluded == 0 && faces_up(normal))
            .map(|(point, _)| point)
    }
}

/// Fills `slots` with contacts of a supporter at points that are in a region, closer together than those of the whole supporter, and returns their
/// number.
pub(super) fn find_within(
    support: &Support,
    is_in: impl Fn(&Point) -> bool + Copy,
    up: &Vector,
    slots: &mut [SupportContact],
    meter: &mut Meter,
) -> Result<usize, Stop> {
    let facing_up = |least| {
        let surface = support.hangable_surface();
        surface.filter(move |(point, normal): &(&Point, &Vector)| normal.dot(up) >= least && is_in(point))
    };
    spread(&support.tree, facing_up, slots, meter)
}

/// Fills `slots` with contacts as close together as they have room for, and returns their number. `facing_up` gives the points
/// with their normals whose normal has at least a cosine with up.
fn spread<'a, P: Iterator<Item = (&'a Point, &'a Vector)>>(
    tree: &PointTree,
    facing_up: impl Fn(f32) -> P,
    slots: &mut [SupportContact],
    meter: &mut Meter,
) -> Result<usize, Stop> {
    let mut apart = SUPPORT_SPACING;
    let count = loop {
        match spread_apart(apart, &facing_up, slots) {
            Some(count) => break count,
            None => apart *= SPACING_GROWTH,
        }
    };
    meter.distance_queries(count)?;
    for slot in &mut slots[..count] {
        slot.bar_direction = principal_direction(tree, &slot.position, BAR_RADIUS);
    }
    Ok(count)
}

/// Fills `slots` with contacts at least this far apart, and returns their number; `None` if there are more than `slots`.
fn spread_apart<'a, P: Iterator<Item = (&'a Point, &'a Vector)>>(
    apart: f32,
    facing_up: &impl Fn(f32) -> P,
    slots: &mut [SupportContact],
) -> Option<usize> {
    let mut count = 0;
    for least in MIN_SUPPORT_COSINES {
        for (point, normal) in facing_up(least) {
            let is_near = |other: &SupportContact| (other.position - point).norm_squared() < apart * apart;
            if slots[..count].iter().any(is_near) {
                continue;
            }
            let slot = slots.get_mut(count)?;
            *slot = SupportContact { position: *point, normal: *normal, bar_direction: Vector::zeros() };
            count += 1;
        }
    }
    Some(count)
}
