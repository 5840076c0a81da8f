//! The published method: hanging sites of the object, support sites of the supporter, and every pair of them that fits.
//!
//! | section of the paper | file |
//! |---|---|
//! | II-B, hangability of the object | `hangability.rs` |
//! | II-C, supportability of the supporter | `supportability.rs` |
//! | II-D, matching | `matching.rs` |
//! | II-D, cost, eqs. (8) to (11) | `cost.rs` |
//! | both searches: clusters of contact points | `clusters.rs` |

mod clusters;
mod cost;
mod hangability;
mod matching;
pub(super) mod site_match;
mod supportability;

pub use cost::Cost;
pub use hangability::{HangingSite, ObjectCounts};
pub use matching::MatchingCounts;
pub use site_match::SiteMatch;
pub use supportability::{SupportSite, SupporterCounts};

use super::error::PredictError;
use super::found::Found;
use super::pose::HangingPose;
use super::samples::{ObjectSamples, SupporterCloud};
use super::scene::Scene;
use super::settling::{Settling, SettlingCounts};
use super::stage::Stage;
use crate::best::Best;
use crate::geometry::{Mesh, Point, PointTree, Vector};
use crate::memory::{Arena, OutOfMemory, array_bytes, larger};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::perception::sampling;
use hangability::Hangability;
use supportability::Supportability;

/// How much was left after each step of the method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// On the object, section II-B.
    pub object: ObjectCounts,
    /// On the supporter, section II-C.
    pub supporter: SupporterCounts,
    /// Of their pairs, section II-D.
    pub matching: MatchingCounts,
}

impl Counts {
    /// The first step that left nothing.
    pub(super) fn empty_stage(&self) -> Option<Stage> {
        let steps = [
            (self.object.clusters, Stage::NoContactPoints),
            (self.object.with_free_space, Stage::NoFreeSpace),
            (self.object.encircled, Stage::NotEncircled),
            (self.supporter.sites, Stage::NoSupport),
            (self.matching.fitting, Stage::TooThick),
            (self.matching.clear, Stage::AllCollide),
        ];
        steps.iter().find(|(left, _)| *left == 0).map(|(_, stage)| *stage)
    }
}

/// Bytes of the sites of an object.
pub(super) const fn object_bytes() -> usize {
    array_bytes::<HangingSite>(hangability::MAX_SITES)
}

/// Bytes of working memory for drawing `samples` points of an object and finding its sites.
pub(super) const fn object_scratch_bytes(samples: usize) -> usize {
    let search = PointTree::bytes(samples).saturating_add(hangability::scratch_bytes(samples));
    larger(sampling::scratch_bytes(samples), search)
}

/// Memory for the sites of an object.
pub(super) fn object_slots<'m>(arena: &mut Arena<'m>) -> Result<&'m mut [HangingSite], OutOfMemory> {
    arena.slice(hangability::MAX_SITES)
}

/// Draws Poisson-disk samples, as the paper does.
pub(super) fn sample(
    mesh: &Mesh,
    seed: u64,
    points: &mut [Point],
    normals: &mut [Vector],
    scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    sampling::sample_into(mesh, seed, points, normals, scratch, meter)
}

/// Fills `slots` with the hanging sites, the best encircled first. `Some` says why the search ended early.
pub(super) fn find_on_object(
    samples: &ObjectSamples,
    slots: &mut [HangingSite],
    meter: &mut Meter,
    mut scratch: Arena,
) -> Result<(ObjectCounts, Option<Stop>), Unfinished> {
    let tree = PointTree::build(samples.points, &mut scratch, meter)?;
    Hangability { samples, tree: &tree }.find(slots, meter, scratch)
}

/// Bytes of the sites of a supporter.
pub(super) const fn supporter_bytes() -> usize {
    array_bytes::<SupportSite>(supportability::MAX_SITES)
}

/// Bytes of working memory for finding the sites of a supporter of `points`.
pub(super) const fn supporter_scratch_bytes(points: usize) -> usize {
    array_bytes::<Vector>(points).saturating_add(supportability::scratch_bytes(points))
}

/// Memory for the sites of a supporter.
pub(super) fn supporter_slots<'m>(arena: &mut Arena<'m>) -> Result<&'m mut [SupportSite], OutOfMemory> {
    arena.slice(supportability::MAX_SITES)
}

/// Fills `slots` with the support sites, the thinnest first. `Some` says why the search ended early.
pub(super) fn find_on_supporter(
    cloud: &SupporterCloud,
    slots: &mut [SupportSite],
    meter: &mut Meter,
    mut scratch: Arena,
) -> Result<(SupporterCounts, Option<Stop>), Unfinished> {
    let normals = scratch.slice::<Vector>(cloud.normals.len())?;
    // A point without a normal does not face up, and is no place to hang on.
    let given = cloud.normals.iter().zip(cloud.is_excluded);
    for (normal, (given, _)) in normals.iter_mut().zip(given).filter(|(_, (_, excluded))| **excluded == 0) {
        *normal = *given;
    }
    Supportability { tree: cloud.tree, normals, params: cloud.params }.find(slots, meter, scratch)
}

/// Matches every hanging site with every support site and writes the best poses to `poses`; with [`Params::settle`] those of
/// them that stay when released. `counts` are those of the places.
pub(super) fn search(
    scene: &Scene,
    places: (&[HangingSite], &[SupportSite]),
    counts: Counts,
    poses: &mut [HangingPose],
    arena: Arena,
    meter: &mut Meter,
) -> Result<Found<Counts>, PredictError> {
    // Moved, so that its memory is borrowed for no longer than the scene.
    let mut arena = arena;
    let mut settling = match scene.params.settle {
        true => Some(Settling::new(scene, &mut arena)?),
        false => None,
    };
    let mut best = Best::new(poses);
    let (matching, stop) = matching::match_sites(scene, places, &mut best, meter);
    let matched = best.into_slice();
    let (poses, settled) = match &mut settling {
        Some(settling) => settling.sieve(matched, meter),
        None => (matched.len(), Ok(())),
    };
    let settling = settling.map_or(SettlingCounts::default(), |settling| settling.counts);
    Ok(Found { poses, counts: Counts { matching, ..counts }, settling, stop: stop.or(settled.err()) })
}
