//! Releases candidates, the most promising first, until enough of them hang.

use super::candidates::CandidateSearch;
use super::constants::{ATTEMPT_DIVISOR, ENOUGH_QUERIES, MAX_SUPPORT_CONTACTS, REST_SHARE};
use super::counts::Counts;
use super::object_contact::ObjectContact;
use super::support_contact::{self, SupportContact};
use crate::best::Best;
use crate::geometry::Point;
use crate::hanging::error::PredictError;
use crate::hanging::found::Found;
use crate::hanging::pose::HangingPose;
use crate::hanging::scene::Scene;
use crate::hanging::settling::Settling;
use crate::mechanics::{Frames, Kind};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop};

/// Bytes of working memory for [`search`], beside that for settling.
pub(in crate::hanging) const fn search_bytes() -> usize {
    CandidateSearch::bytes().saturating_add(array_bytes::<SupportContact>(MAX_SUPPORT_CONTACTS))
}

/// Writes the best poses to `poses`: with [`Params::settle`](crate::Params::settle) those that stay when released,
/// otherwise the candidates as they are made.
pub(in crate::hanging) fn search(
    scene: &Scene,
    (contacts, places): (&[ObjectContact], &[SupportContact]),
    counts: Counts,
    poses: &mut [HangingPose],
    arena: Arena,
    meter: &mut Meter,
) -> Result<Found<Counts>, PredictError> {
    // Moved, so that its memory is borrowed for no longer than the scene.
    let mut arena = arena;
    let mut settling = Settling::new(scene, &mut arena)?;
    let (bodies, up, request) = ((settling.body, settling.support), scene.params.up(), scene.request);
    let frames = Frames::of(bodies);
    let stopped = |stop| Found { poses: 0, counts, settling: Default::default(), stop: Some(stop) };
    let places = match request.on.is_limited() {
        false => places,
        true => {
            let slots = arena.slice::<SupportContact>(MAX_SUPPORT_CONTACTS)?;
            let is_in = |point: &Point| request.on.contains(&frames.on_supporter(point));
            match support_contact::find_within(bodies.1, is_in, &up, slots, meter) {
                Ok(count) => &slots[..count],
                Err(stop) => return Ok(stopped(stop)),
            }
        }
    };
    let is_on = !request.on.is_limited() || !places.is_empty();
    let is_by = |contact: &ObjectContact| request.by.contains(&frames.on_object(&contact.position));
    let is_by = !request.by.is_limited() || contacts.iter().any(is_by);
    settling.counts.outside += usize::from(!is_on || !is_by);
    let mut candidates = CandidateSearch::new(bodies, contacts, request, places, up, &mut arena)?;
    let mut best = Best::new(poses);
    let searched = match scene.params.settle {
        true => release(&mut candidates, &mut settling, &mut best, meter),
        false => list(&mut candidates, &mut best, meter),
    };
    settling.counts.in_scene += candidates.in_scene;
    let counts = Counts { candidates: candidates.counts, ..counts };
    Ok(Found { poses: best.len(), counts, settling: settling.counts, stop: searched.err() })
}

/// Offers the candidates in the order in which they come.
fn list(
    candidates: &mut CandidateSearch,
    poses: &mut Best<HangingPose>,
    meter: &mut Meter,
) -> Result<(), Stop> {
    while let Some(candidate) = candidates.next(meter)? {
        poses.offer(HangingPose { pose: candidate.pose, ..HangingPose::default() }, |_, _| false);
        if poses.is_full() {
            break;
        }
        candidates.discount(&candidate, 1.0);
    }
    Ok(())
}

/// Releases candidates until enough of them hang firmly in the way that is asked for, or the attempts are used up.
fn release(
    candidates: &mut CandidateSearch,
    settling: &mut Settling,
    poses: &mut Best<HangingPose>,
    meter: &mut Meter,
) -> Result<(), Stop> {
    let (attempts, firm_enough) = (settling.params.settle_attempts, settling.params.firm_enough);
    let queries_before = meter.work.distance_queries;
    // A candidate that cannot be brought off the supporter is not released, which costs less. As many of these are allowed as
    // releases.
    for tried in 0.. {
        let released = settling.counts.released;
        let spent = released.max(tried - released);
        meter.progress(spent as f32 / attempts as f32);
        let has_tried_enough = ATTEMPT_DIVISOR * released >= attempts;
        if spent >= attempts || settling.counts.probable > 0 && has_tried_enough {
            break;
        }
        let Some(candidate) = candidates.next(meter)? else { break };
        let pose = HangingPose { pose: candidate.pose, ..HangingPose::default() };
        let stays = settling.release(&pose, poses, meter)?;
        candidates.discount(&candidate, if stays { REST_SHARE } else { 1.0 });
        let counts = &settling.counts;
        let has_enough = counts.firm_as_preferred >= firm_enough || settling.is_saturated();
        let queries = meter.work.distance_queries - queries_before;
        let enough_queries = if settling.has_reliable { ENOUGH_QUERIES } else { 2 * ENOUGH_QUERIES };
        if has_enough || settling.counts.probable > 0 && queries > enough_queries {
            break;
        }
        // Caps alone are no reason to stop, but to look elsewhere.
        if settling.has_enough_of_others() && !settling.request.prefer.contains(Kind::Capped) {
            candidates.drop_enclosed();
        }
    }
    Ok(())
}
