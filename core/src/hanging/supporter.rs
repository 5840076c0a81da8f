//! The thing that is hung on.

use super::AnalysisError;
use super::supportability::{self, SupportSite, Supportability, SupportabilityCounts};
use crate::geometry::{Cloud, Neighbour, PointTree, Vector};
use crate::mechanics::Support;
use crate::memory::{Arena, Limits, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::Params;
use crate::perception::normals;

/// Normals shorter than this are taken as not given.
const NO_DIRECTION: f32 = 1e-6;
/// Normals whose length is within this of one are taken as of unit length.
const UNIT_LENGTH: f32 = 1e-3;

/// A supporter, analysed: points and support sites, in supporter coordinates. Immutable; any number of threads
/// may match it at once.
#[derive(Clone, Copy)]
pub struct Supporter<'m> {
    tree: PointTree<'m>,
    point_normals: &'m [Vector],
    disc: f32,
    is_chosen: &'m [u8],
    sites: &'m [SupportSite],
    normals: NormalCounts,
    counts: SupportabilityCounts,
    work: Work,
    stopped: Option<Stop>,
}

/// What had to be done to the normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NormalCounts {
    /// Normals that were missing or zero, and were estimated from the neighbouring points.
    pub estimated: usize,
    /// Normals that were not of unit length, and were scaled to it.
    pub renormalised: usize,
}

impl<'m> Supporter<'m> {
    /// Bytes of memory for any supporter within `limits`.
    pub const fn bytes(limits: &Limits) -> usize {
        let points = limits.points;
        let model =
            PointTree::bytes(points).saturating_add(array_bytes::<SupportSite>(supportability::MAX_SITES)).saturating_add(array_bytes::<Vector>(points)).saturating_add(array_bytes::<u8>(points));
        let scratch = larger(
            PointTree::scratch_bytes(points),
            array_bytes::<Vector>(points).saturating_mul(2).saturating_add(larger(
                normals::scratch_bytes(points),
                supportability::scratch_bytes(points),
            )),
        );
        model_bytes(model.saturating_add(scratch))
    }

    /// Analyses `cloud` in `memory`, which must hold [`Supporter::bytes`] for its size. The cloud need not stay.
    pub fn analyze(
        cloud: &Cloud,
        params: &Params,
        memory: &'m mut [u8],
        monitor: &Monitor,
    ) -> Result<Self, AnalysisError> {
        params.validate()?;
        let points = cloud.points();
        let limits = Limits { vertices: 0, triangles: 0, samples: 0, points: points.len() };
        let mut arena = Arena::new(memory, Self::bytes(&limits))?;
        let mut meter = Meter::new(monitor);

        let tree = PointTree::build(points, &mut arena)?;
        let sites = arena.slice::<SupportSite>(supportability::MAX_SITES)?;

        let in_tree_order = arena.slice::<Vector>(points.len())?;
        let is_chosen = arena.slice::<u8>(points.len())?;
        let mut scratch = arena.scratch();
        let mut normals = NormalCounts::default();
        if let Some(given) = cloud.normals() {
            for (normal, &index) in in_tree_order.iter_mut().zip(tree.order()) {
                let given = Vector::from(given[index as usize]);
                let length = given.norm();
                if length > NO_DIRECTION {
                    *normal = given / length;
                    normals.renormalised += usize::from((length - 1.0).abs() > UNIT_LENGTH);
                }
            }
        }
        let viewpoint = cloud.viewpoint();
        normals.estimated =
            normals::complete(&tree, in_tree_order, viewpoint, params.up(), scratch.scratch())?;
        meter.check().map_err(|_| AnalysisError::Cancelled)?;

        let in_cloud_order = scratch.slice::<Vector>(points.len())?;
        for (normal, &index) in in_tree_order.iter().zip(tree.order()) {
            in_cloud_order[index as usize] = *normal;
        }
        let search = Supportability { tree: &tree, points, normals: in_cloud_order, params };
        let (counts, stopped) = search.find(sites, &mut meter, scratch.scratch())?;
        if stopped == Some(Stop::Cancelled) {
            return Err(AnalysisError::Cancelled);
        }
        let spacing = spacing(&tree);
        let thin = knob(0);
        let disc = knob(1) * spacing.max(thin);
        choose(&tree, in_tree_order, thin, is_chosen, scratch.slice::<u8>(points.len())?);
        Ok(Self { tree, point_normals: in_tree_order, disc, is_chosen, sites: &sites[..counts.sites], normals, counts, work: meter.work, stopped })
    }

    /// For mechanics.
    pub fn support(&self) -> Support<'_> {
        Support { tree: &self.tree, normals: self.point_normals, disc: self.disc, is_chosen: self.is_chosen }
    }

    /// The points, for neighbour queries.
    pub fn points(&self) -> &PointTree<'m> {
        &self.tree
    }

    /// Where something can be hung, the thinnest site first.
    pub fn sites(&self) -> &'m [SupportSite] {
        self.sites
    }

    /// What had to be done to the normals that were given.
    pub fn normals(&self) -> NormalCounts {
        self.normals
    }

    /// What was left after each step of the search for sites.
    pub fn counts(&self) -> SupportabilityCounts {
        self.counts
    }

    /// Rays and distance queries spent.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Why the search for sites ended early, if it did; then there may be more than [`sites`](Self::sites).
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }
}

/// The distance at which points have their fourth neighbour, in the median of some.
fn spacing(tree: &PointTree) -> f32 {
    const PROBES: usize = 64;
    let mut distances = [0.0; PROBES];
    let points = tree.points();
    for (k, distance) in distances.iter_mut().enumerate() {
        let mut found = [Neighbour::default(); 5];
        let found = tree.k_nearest(&points[k * points.len() / PROBES], &mut found);
        *distance = found.last().map_or(0.0, |n| libm::sqrtf(n.distance_squared));
    }
    distances.sort_unstable_by(f32::total_cmp);
    distances[PROBES / 2]
}

/// Marks points so that every other has one of similar normal within `apart`.
fn choose(tree: &PointTree, normals: &[Vector], apart: f32, is_chosen: &mut [u8], is_covered: &mut [u8]) {
    for index in 0..is_chosen.len() {
        if is_covered[index] > 0 {
            continue;
        }
        is_chosen[index] = 1;
        tree.for_each_within(&tree.points()[index], apart, |n| {
            let other = n.index as usize;
            if normals[other].dot(&normals[index]) > knob(2) {
                is_covered[other] = 1;
            }
        });
    }
}
/// dbg
pub static KNOBS: [core::sync::atomic::AtomicU32; 4] = [const { core::sync::atomic::AtomicU32::new(0) }; 4];
fn knob(k: usize) -> f32 { f32::from_bits(KNOBS[k].load(core::sync::atomic::Ordering::Relaxed)) }
