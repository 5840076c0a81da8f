//! Contact candidates of the supporter: points that face up.

use super::constants::*;
use super::counts::SupporterCounts;
use crate::geometry::{Point, PointTree, Vector};
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
        let mut apart = SUPPORT_SPACING;
        let contacts = loop {
            match self.spread(apart, slots) {
                Some(count) => break count,
                None => apart *= SPACING_GROWTH,
            }
        };
        if let Err(stop) = meter.distance_queries(contacts) {
            return (SupporterCounts { contact_points, contacts: 0 }, Some(stop));
        }
        for slot in &mut slots[..contacts] {
            slot.bar_direction = bar_direction(self.tree, slot.position);
        }
        (SupporterCounts { contact_points, contacts }, None)
    }

    /// Points that are not excluded, with their normals, whose normal has at least this cosine with up.
    fn facing_up(&self, least: f32) -> impl Iterator<Item = (&Point, &Vector)> {
        let points = self.tree.points().iter().zip(self.normals).zip(self.is_excluded);
        let faces_up = move |normal: &Vector| normal.dot(&self.up) >= least;
        points
            .filter(move |((_, normal), excluded)| **excluded == 0 && faces_up(normal))
            .map(|(point, _)| point)
    }

    /// Fills `slots` with contacts at least this far apart, and returns their number; `None` if there are more than
    /// `slots`.
    fn spread(&self, apart: f32, slots: &mut [SupportContact]) -> Option<usize> {
        let mut count = 0;
        for least in MIN_SUPPORT_COSINES {
            for (point, normal) in self.facing_up(least) {
                let is_near =
                    |other: &SupportContact| (other.position - point).norm_squared() < apart * apart;
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
}

/// The direction of greatest spread of the points around.
fn bar_direction(tree: &PointTree, position: Point) -> Vector {
    let (mut count, mut sum, mut squares) = (0.0, Vector::zeros(), nalgebra::Matrix3::<f32>::zeros());
    tree.for_each_within(&position, BAR_RADIUS, |n| {
        let offset = tree.points()[n.index as usize] - position;
        count += 1.0;
        sum += offset;
        squares += offset * offset.transpose();
    });
    let spread = squares / count - (sum / count) * (sum / count).transpose();
    // Power iteration. Twenty rounds suffice for a direction that only orders candidates.
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
