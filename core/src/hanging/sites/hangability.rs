//! Where an object can be hung: section II-B.

use super::clusters::Clusters;
use crate::best::Best;
use crate::geometry::{Point, PointTree, Pose, Vector, any_perpendicular, rotate_about, unit_or};
use crate::hanging::samples::ObjectSamples;
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::params::{MAX_DIRECTIONS, Params};
use bytemuck::{Pod, Zeroable};

/// A place on an object into which a supporter can reach, in object coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct HangingSite {
    /// `c_h`: centre of the free space, metres.
    pub position: Point,
    /// `v_h`: unit vector along which the supporter passes through; its sign means nothing.
    pub hanging_direction: Vector,
    /// `p_h`: the contact point that the free space was found from, metres.
    pub contact_point: Point,
    /// `r_h`: radius of the free space, metres.
    pub free_space_radius: f32,
    /// `m`: share of the rays around the hanging direction that hit the object, eq. (5).
    pub encircled: f32,
    /// `m_1`: the same among the rays above the hanging position.
    pub encircled_above: f32,
    /// `m_2`: the same among the rays below it.
    pub encircled_below: f32,
    /// `|P_h|`: samples in the cluster of contact points.
    pub contact_points: u32,
}

impl HangingSite {
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

/// How much was left on the object after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ObjectCounts {
    /// Samples whose normal leans towards the centre of mass, eq. (3).
    pub contact_points: usize,
    /// Clusters of them, eq. (4).
    pub clusters: usize,
    /// Clusters with a free space outside the object.
    pub with_free_space: usize,
    /// Free spaces that the object encircles, eq. (6).
    pub encircled: usize,
    /// Different ones among them, eq. (7).
    pub sites: usize,
}

/// Sites kept at most: those that are encircled best. No shape in the tests has as many different ones.
pub(super) const MAX_SITES: usize = 128;

/// Rays start this far off the surface, metres, so that they do not hit where they come from.
const LIFT_OFF: f32 = 1e-4;

/// Bytes of working memory.
pub(super) const fn scratch_bytes(samples: usize) -> usize {
    array_bytes::<Point>(samples)
        .saturating_add(Clusters::scratch_bytes(samples))
        .saturating_add(array_bytes::<[f32; 2]>(MAX_DIRECTIONS))
        .saturating_add(array_bytes::<Hits>(MAX_DIRECTIONS))
}

/// The input of the search.
pub(super) struct Hangability<'a> {
    pub(super) samples: &'a ObjectSamples<'a>,
    /// The same samples for neighbour queries.
    pub(super) tree: &'a PointTree<'a>,
}

/// Rays that hit the object.
#[derive(Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct Hits {
    all: u32,
    above: u32,
}

impl Hangability<'_> {
    /// Fills `slots` with the sites, the best encircled first, and returns what was left after each step. When the
    /// work limit is reached, what was found until then is there, and `Some` says why it is not all.
    pub(super) fn find(
        &self,
        slots: &mut [HangingSite],
        meter: &mut Meter,
        mut scratch: Arena,
    ) -> Result<(ObjectCounts, Option<Stop>), Unfinished> {
        let mut counts = ObjectCounts::default();
        let contacts = scratch.slice::<Point>(self.samples.points.len())?;
        let selected =
            self.samples.points.iter().zip(self.samples.normals).filter(|(p, n)| self.is_contact(p, n));
        for (slot, (point, _)) in contacts.iter_mut().zip(selected) {
            *slot = *point;
            counts.contact_points += 1;
        }
        if counts.contact_points == 0 {
            return Ok((counts, None));
        }
        let rays = self.rays(&mut scratch)?;
        let hits = scratch.slice::<Hits>(self.samples.params.object_directions)?;
        let bandwidth = self.samples.params.cluster_bandwidth * self.tree.aabb().diagonal();
        let clusters = Clusters::find(&contacts[..counts.contact_points], bandwidth, scratch, meter)?;

        let mut sites = Best::new(slots);
        let mut stop = None;
        for (done, (size, contact_point)) in clusters.iter().enumerate() {
            meter.progress(done as f32 / clusters.count as f32);
            if size <= self.samples.params.min_cluster_points {
                continue;
            }
            counts.clusters += 1;
            match self.site_at(contact_point, size, rays, hits, &mut counts, meter) {
                Ok(Some(site)) => sites.offer(site, |a, b| a.encircled > b.encircled),
                Ok(None) => {}
                Err(reason) => {
                    stop = Some(reason);
                    break;
                }
            }
        }
        counts.sites = prune_similar(sites.into_slice(), self.samples.params);
        Ok((counts, stop))
    }

    /// Eq. (3): the normal leans towards the centre of mass.
    fn is_contact(&self, point: &Point, normal: &Vector) -> bool {
        let to_centre = self.samples.centre_of_mass - point;
        to_centre.dot(normal) > self.samples.params.object_contact_cosine * to_centre.norm()
    }

    /// Cosine and sine of the angle of each ray against "above".
    fn rays<'s>(&self, scratch: &mut Arena<'s>) -> Result<&'s [[f32; 2]], OutOfMemory> {
        let rays = scratch.slice::<[f32; 2]>(self.samples.params.rays_per_direction)?;
        let step = core::f32::consts::TAU / rays.len() as f32;
        for (index, ray) in rays.iter_mut().enumerate() {
            let (sin, cos) = libm::sincosf(index as f32 * step);
            *ray = [cos, sin];
        }
        Ok(rays)
    }

    /// The site under a contact point, if it has a free space that the object encircles.
    fn site_at(
        &self,
        contact_point: Point,
        contact_points: usize,
        rays: &[[f32; 2]],
        hits: &mut [Hits],
        counts: &mut ObjectCounts,
        meter: &mut Meter,
    ) -> Result<Option<HangingSite>, Stop> {
        // `n_i`: down, when the object hangs from this point.
        let down = unit_or(self.samples.centre_of_mass - contact_point, -Vector::z());
        let Some((position, free_space_radius)) = self.free_space(contact_point, down, meter)? else {
            return Ok(None);
        };
        counts.with_free_space += 1;
        let (hanging_direction, hits) = self.hanging_direction(position, down, rays, hits, meter)?;
        let rays_above = rays.iter().filter(|ray| is_above(ray)).count();
        let share = |hits: u32, rays: usize| hits as f32 / rays as f32;
        let site = HangingSite {
            position,
            hanging_direction,
            contact_point,
            free_space_radius,
            encircled: share(hits.all, rays.len()),
            encircled_above: share(hits.above, rays_above),
            encircled_below: share(hits.all - hits.above, rays.len() - rays_above),
            contact_points: contact_points as u32,
        };
        // Eq. (6), with each half normalised by its own rays and in the sense of the text around it.
        let is_encircled = site.encircled_above >= self.samples.params.min_encircled_above
            && site.encircled_below >= self.samples.params.min_encircled_below;
        counts.encircled += usize::from(is_encircled);
        Ok(is_encircled.then_some(site))
    }

    /// "Hanging Position Detection": centre and radius of the free space between the contact point and the
    /// surface opposite.
    fn free_space(
        &self,
        contact_point: Point,
        down: Vector,
        meter: &mut Meter,
    ) -> Result<Option<(Point, f32)>, Stop> {
        let steps = self.samples.params.free_space_steps;
        meter.rays(1)?;
        meter.distance_queries(steps + 1)?;
        let start = contact_point + down * LIFT_OFF;
        let opposite = match self.samples.surface.closest_hit(&start, &down) {
            Some(distance) => start + down * distance,
            None => self.samples.centre_of_mass,
        };
        let (mut centre, mut radius_squared) = (contact_point, 0.0);
        for step in 0..steps {
            let point = contact_point + (opposite - contact_point) * (step as f32 / (steps - 1) as f32);
            let nearest = self.tree.nearest(&point).distance_squared;
            if nearest > radius_squared {
                (centre, radius_squared) = (point, nearest);
            }
        }
        let radius = libm::sqrtf(radius_squared);
        let is_free =
            radius > self.samples.params.min_free_space_radius && !self.samples.surface.is_inside(&centre);
        Ok(is_free.then_some((centre, radius)))
    }

    /// "Hanging Direction Detection": the direction around which most rays hit the object, eq. (5). Often many
    /// neighbouring directions share the maximum; then the middle one is taken, which is the axis of a hole.
    fn hanging_direction(
        &self,
        position: Point,
        down: Vector,
        rays: &[[f32; 2]],
        hits: &mut [Hits],
        meter: &mut Meter,
    ) -> Result<(Vector, Hits), Stop> {
        let reference = any_perpendicular(down);
        let count = hits.len();
        let direction =
            |j: usize| rotate_about(down, core::f32::consts::PI * j as f32 / count as f32, reference);
        for (j, hits) in hits.iter_mut().enumerate() {
            meter.rays(rays.len())?;
            let side = direction(j).cross(&down);
            *hits = Hits { all: 0, above: 0 };
            for ray in rays {
                let hit = self.samples.surface.any_hit(&position, &(side * ray[1] - down * ray[0]));
                hits.all += u32::from(hit);
                hits.above += u32::from(hit && is_above(ray));
            }
        }
        let best = middle_of_longest_maximum(hits);
        Ok((direction(best), hits[best]))
    }
}

/// Whether a ray, given by the cosine and sine of its angle, counts for `m_1`.
fn is_above(ray: &[f32; 2]) -> bool {
    ray[0] > 0.0
}

/// The middle of the longest run of maximal `all`. The entries go round: behind the last stands the first.
fn middle_of_longest_maximum(hits: &[Hits]) -> usize {
    let count = hits.len();
    let most = hits.iter().map(|h| h.all).max().unwrap_or(0);
    let is_most = |index: usize| hits[index % count.max(1)].all == most;
    let run_from = |start: usize| (0..count).take_while(|offset| is_most(start + offset)).count();
    let (mut start, mut longest) = (0, 0);
    // A run begins behind an entry that is not in it; if there is none, all are equal.
    for index in (0..count).filter(|&index| is_most(index) && !is_most(index + count - 1)) {
        let length = run_from(index);
        if length > longest {
            (start, longest) = (index, length);
        }
    }
    (start + longest.saturating_sub(1) / 2) % count.max(1)
}

/// Eq. (7): of sites with similar free space and direction only the better encircled one stays. Returns how many
/// are left at the front of `sites`, which are sorted.
fn prune_similar(sites: &mut [HangingSite], params: &Params) -> usize {
    let is_similar = |a: &HangingSite, b: &HangingSite| {
        let (ra, rb) = (a.free_space_radius, b.free_space_radius);
        (ra - rb).abs() < params.similar_radius * ra.max(rb)
            && a.hanging_direction.dot(&b.hanging_direction).abs() > params.similar_direction
    };
    let mut kept = 0;
    for index in 0..sites.len() {
        if !sites[..kept].iter().any(|other| is_similar(other, &sites[index])) {
            sites[kept] = sites[index];
            kept += 1;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hits(all: &[u32]) -> Vec<Hits> {
        all.iter().map(|&all| Hits { all, above: 0 }).collect()
    }

    #[test]
    fn the_middle_of_the_longest_run_wins() {
        assert_eq!(middle_of_longest_maximum(&hits(&[1, 3, 3, 3, 2, 3])), 2);
        assert_eq!(middle_of_longest_maximum(&hits(&[3, 3, 1, 3, 1, 3])), 0);
        assert_eq!(middle_of_longest_maximum(&hits(&[3, 1, 1, 2, 3, 3])), 5);
        assert_eq!(middle_of_longest_maximum(&hits(&[2, 2, 2])), 0);
        assert_eq!(middle_of_longest_maximum(&hits(&[5])), 0);
    }

    #[test]
    fn similar_sites_are_merged_into_the_first() {
        let site = |radius: f32, direction: Vector| HangingSite {
            free_space_radius: radius,
            hanging_direction: direction,
            ..HangingSite::zeroed()
        };
        let mut sites = [
            site(0.010, Vector::x()),
            site(0.0105, -Vector::x()),
            site(0.0105, Vector::y()),
            site(0.012, Vector::x()),
        ];
        assert_eq!(prune_similar(&mut sites, &Params::paper()), 3);
        assert_eq!(sites.map(|s| s.free_space_radius)[..3], [0.010, 0.0105, 0.012]);
    }
}
