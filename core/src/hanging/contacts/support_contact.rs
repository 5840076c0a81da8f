//! Where the supporter can carry something: points that look up.

use super::SupporterCounts;
use crate::geometry::{Point, PointTree, Vector};
use crate::monitor::{Meter, Stop};
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

/// Contacts kept at most.
pub(super) const MAX_CONTACTS: usize = 96;

/// They are this far apart, metres, or farther where there would be too many.
const APART: f32 = 0.012;
/// By so much farther then.
const FARTHER: f32 = 1.4;
/// Least cosine between the normal and up: `alpha_s` of section II-C. The ridges of bars come first, so that contacts are on them and
/// not on their flanks; at last less is asked than in the paper, for steep pegs.
const LEAST_COSINES: [f32; 4] = [0.95, 0.8, 0.6, 0.3];

/// What the search looks at.
pub(super) struct Search<'a> {
    pub(super) tree: &'a PointTree<'a>,
    /// In tree order.
    pub(super) normals: &'a [Vector],
    pub(super) up: Vector,
}

impl Search<'_> {
    /// Fills `slots` with contacts that are apart. `Some` says that the work limit ended the search early, with none.
    pub(super) fn find(
        &self,
        slots: &mut [SupportContact],
        meter: &mut Meter,
    ) -> (SupporterCounts, Option<Stop>) {
        let [.., least] = LEAST_COSINES;
        let contact_points = self.normals.iter().filter(|normal| normal.dot(&self.up) >= least).count();
        let mut apart = APART;
        let contacts = loop {
            match self.spread(apart, slots) {
                Some(count) => break count,
                None => apart *= FARTHER,
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

    /// Contacts this far apart; `None` if they are more than `slots`.
    fn spread(&self, apart: f32, slots: &mut [SupportContact]) -> Option<usize> {
        let mut count = 0;
        for least in LEAST_COSINES {
            let points = self.tree.points().iter().zip(self.normals);
            for (point, normal) in points.filter(|(_, normal)| normal.dot(&self.up) >= least) {
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
    /// Metres: more than a bar is thick, less than it is long.
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
