//! Releases candidates, the most promising first, until enough of them hang.

use super::candidates::CandidateSearch;
use super::constants::{ATTEMPT_DIVISOR, REST_SHARE};
use super::counts::Counts;
use super::object_contact::ObjectContact;
use super::support_contact::SupportContact;
use crate::best::Best;
use crate::hanging::error::PredictError;
use crate::hanging::found::Found;
use crate::hanging::pose::HangingPose;
use crate::hanging::scene::Scene;
use crate::hanging::settling::Settling;
use crate::memory::Arena;
use crate::monitor::{Meter, Stop};

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
    let (bodies, up) = ((settling.body, settling.support), scene.params.up());
    let mut candidates = CandidateSearch::new(bodies, contacts, places, up, &mut arena)?;
    let mut best = Best::new(poses);
    let searched = match scene.params.settle {
        true => release(&mut candidates, &mut settling, &mut best, meter),
        false => list(&mut candidates, &mut best, meter),
    };
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

/// Releases candidates until enough of them hang firmly, or the attempts are used up.
fn release(
    candidates: &mut CandidateSearch,
    settling: &mut Settling,
    poses: &mut Best<HangingPose>,
    meter: &mut Meter,
) -> Result<(), Stop> {
    let (attempts, firm_enough) = (settling.params.settle_attempts, settling.params.firm_enough);
    for attempt in 0..attempts {
        meter.progress(attempt as f32 / attempts as f32);
        let Some(candidate) = candidates.next(meter)? else { break };
        let pose = HangingPose { pose: candidate.pose, ..HangingPose::default() };
        let stays = settling.release(&pose, poses, meter)?;
        candidates.discount(&candidate, if stays { REST_SHARE } else { 1.0 });
        let has_enough = settling.counts.firm >= firm_enough;
        if has_enough || settling.counts.probable > 0 && ATTEMPT_DIVISOR * (attempt + 1) >= attempts {
            break;
        }
    }
    Ok(())
}
