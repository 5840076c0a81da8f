//! Where a supporter can carry something: section II-C.

use super::clusters::Clusters;
use crate::best::Best;
use crate::geometry::{
    Point, PointTree, Pose, Vector, any_perpendicular, hull, linked_cluster, rotate_about,
};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::params::Params;
use bytemuck::{Pod, Zeroable};

/// A place on a supporter that something can hang on, in supporter coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct SupportSite {
    /// `c_s`: centre of the cross-section, metres.
    pub position: Point,
    /// `v_s`: unit vector along which the cross-section is smallest, horizontal; its sign means nothing.
    pub hanging_direction: Vector,
    /// `p_s`: the contact point that the supporter was sliced at, metres.
    pub contact_point: Point,
    /// `r_s`: radius of the sphere around the cross-section, metres.
    pub support_radius: f32,
    /// `d_1`, `d_2`: distances from the position to the convex hull of the supporter along the hanging direction
    /// and against it, metres.
    pub boundary_distances: [f32; 2],
}

impl SupportSite {
    /// The same in other coordinates, to which `motion` leads.
    pub(in crate::hanging) fn moved(&self, motion: &Pose) -> Self {
        let Self { position, hanging_direction, contact_point, .. } = *self;
        Self {
            position: motion * position,
            hanging_direction: motion * hanging_direction,
            contact_point: motion * contact_point,
            ..*self
        }
    }
}

/// How much was left on the supporter after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SupporterCounts {
    /// Points that face up, eq. (2).
    pub contact_points: usize,
    /// Clusters of them.
    pub clusters: usize,
    /// Clusters at which a slice through the supporter holds together.
    pub sites: usize,
}

/// Sites kept at most: those with the smallest radius, which most objects fit on.
pub(super) const MAX_SITES: usize = 256;

/// Bytes of working memory.
pub(super) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<Point>(points).saturating_add(Clusters::scratch_bytes(points))
}

/// The input of the search.
pub(super) struct Supportability<'a> {
    pub(super) tree: &'a PointTree<'a>,
    /// In tree order.
    pub(super) normals: &'a [Vector],
    pub(super) params: &'a Params,
}

impl Supportability<'_> {
    /// Fills `slots` with the sites, the thinnest first, and returns what was left after each step. When the work
    /// limit is reached, what was found until then is there, and `Some` says why it is not all.
    pub(super) fn find(
        &self,
        slots: &mut [SupportSite],
        meter: &mut Meter,
        mut scratch: Arena,
    ) -> Result<(SupporterCounts, Option<Stop>), Unfinished> {
        let up = self.params.up();
        let mut counts = SupporterCounts::default();
        let contacts = scratch.slice::<Point>(self.tree.points().len())?;
        let faces_up = |normal: &Vector| normal.dot(&up) > self.params.supporter_contact_cosine;
        let selected = self.tree.points().iter().zip(self.normals).filter(|(_, normal)| faces_up(normal));
        for (slot, (point, _)) in contacts.iter_mut().zip(selected) {
            *slot = *point;
            counts.contact_points += 1;
        }
        if counts.contact_points == 0 {
            return Ok((counts, None));
        }
        let bandwidth = self.params.cluster_bandwidth * self.tree.aabb().diagonal();
        let clusters = Clusters::find(&contacts[..counts.contact_points], bandwidth, scratch, meter)?;
        counts.clusters = clusters.count;
        // The clusters have copies of the contact points.
        let slice = contacts;

        let mut sites = Best::new(slots);
        let mut stop = None;
        for (done, (_, contact_point)) in clusters.iter().enumerate() {
            meter.progress(done as f32 / clusters.count as f32);
            match self.site_at(contact_point, up, slice, meter) {
                Ok(Some(site)) => sites.offer(site, |a, b| a.support_radius < b.support_radius),
                Ok(None) => {}
                Err(reason) => {
                    stop = Some(reason);
                    break;
                }
            }
        }
        counts.sites = sites.into_slice().len();
        Ok((counts, stop))
    }

    /// The slice through `contact_point` whose bounding sphere is smallest.
    fn site_at(
        &self,
        contact_point: Point,
        up: Vector,
        slice: &mut [Point],
        meter: &mut Meter,
    ) -> Result<Option<SupportSite>, Stop> {
        let reference = any_perpendicular(up);
        let directions = self.params.supporter_directions;
        let mut best: Option<SupportSite> = None;
        for j in 0..directions {
            meter.distance_queries(1)?;
            let direction = rotate_about(up, core::f32::consts::PI * j as f32 / directions as f32, reference);
            // A slice that reaches farther than the best sphere is wide cannot have a smaller sphere.
            let reach = best.map_or(f32::INFINITY, |site| 2.0 * site.support_radius);
            let Some((centre, radius)) = self.cross_section(contact_point, direction, slice, reach) else {
                continue;
            };
            if best.is_none_or(|site| radius < site.support_radius) {
                best = Some(SupportSite {
                    position: centre,
                    hanging_direction: direction,
                    contact_point,
                    support_radius: radius,
                    boundary_distances: [0.0; 2],
                });
            }
        }
        if let Some(site) = &mut best {
            meter.distance_queries(2)?;
            site.boundary_distances = [site.hanging_direction, -site.hanging_direction]
                .map(|direction| hull::exit_distance(self.tree.points(), site.position, direction));
        }
        Ok(best)
    }

    /// Centre and radius of what hangs together with `contact_point` in the slice across `direction`; `None` if
    /// it is one point, or reaches farther than `reach` from it.
    fn cross_section(
        &self,
        contact_point: Point,
        direction: Vector,
        slice: &mut [Point],
        reach: f32,
    ) -> Option<(Point, f32)> {
        let offset = |point: &Point| (point - contact_point).dot(&direction).abs();
        let mut count = 0;
        let mut look_at = |point: &Point| {
            if offset(point) < self.params.slice_half_thickness {
                slice[count] = *point;
                if *point == contact_point {
                    slice.swap(0, count);
                }
                count += 1;
            }
        };
        let link = self.params.slice_link_distance;
        if reach.is_finite() {
            // What hangs together and reaches farther has a point that is not a link farther.
            self.tree.for_each_within(&contact_point, reach + link, |neighbour| {
                look_at(&self.tree.points()[neighbour.index as usize]);
            });
        } else {
            self.tree.points().iter().for_each(look_at);
        }
        let members = linked_cluster(&mut slice[..count], link, reach)?;
        if members < 2 {
            return None;
        }
        let members = &slice[..members];
        let centre = Point::from(members.iter().map(|p| p.coords).sum::<Vector>() / members.len() as f32);
        let radius = members.iter().map(|p| (p - centre).norm_squared()).fold(0.0, f32::max);
        Some((centre, libm::sqrtf(radius)))
    }
}
