//! Releases candidates, the most promising first, until enough of them hang.

use super::Counts;
use super::candidates::CandidateSearch;
use super::constants::{ATTEMPT_DIVISOR, REST_SHARE};
use crate::best::Best;
use crate::hanging::method::Found;
use crate::hanging::settling::Settling;
use crate::hanging::{HangingPose, Object, PredictError, Supporter};
use crate::memory::Arena;
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// Writes the best poses to `poses`: with [`Params::settle`] those that stay when released, otherwise the candidates as they are
/// made.
pub(in crate::hanging) fn search(
    object: &Object,
    supporter: &Supporter,
    params: &Params,
    poses: &mut [HangingPose],
    arena: Arena,
    meter: &mut Meter,
) -> Result<Found<Counts>, PredictError> {
    let body = object.body().ok_or(PredictError::NoDistanceField)?;
    let scene = (&body, supporter.support());
    let mut arena = arena;
    let mut settling = Settling::new(scene, params, &mut arena)?;
    let mut candidates =
        CandidateSearch::new(scene, object.contacts(), supporter.contacts(), params.up(), &mut arena)?;
    let mut best = Best::new(poses);
    let searched = match params.settle {
        true => release(&mut candidates, &mut settling, &mut best, meter),
        false => list(&mut candidates, &mut best, meter),
    };
    let counts = Counts {
        object: object.contact_counts(),
        supporter: supporter.contact_counts(),
        candidates: candidates.counts,
    };
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
