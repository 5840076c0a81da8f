//! Simulates the release of an object at any pose, predicted or not.

use super::{Object, PredictError, Supporter, predict_bytes};
use crate::geometry::{Pose, is_rigid};
use crate::mechanics::{Fate, Frames, Sleep, Support, swing_out};
use crate::memory::Arena;
use crate::monitor::{Meter, Monitor, Stop};
use crate::params::Params;

/// The outcome of a release.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LetGo {
    /// Whether the object rests, falls or moves at the end.
    pub fate: Fate,
    /// The last pose of the simulation, which ends as soon as the fate is certain: maps object coordinates to supporter
    /// coordinates; metres.
    pub pose: Pose,
}

/// Releases the object at `release`, which maps object to supporter coordinates, and simulates up to four seconds. The
/// inner error says why the monitor stopped the simulation. `memory` is working memory,
/// [`predict_bytes`](super::predict_bytes) of it.
pub fn let_go(
    object: &Object,
    supporter: &Supporter,
    release: &Pose,
    params: &Params,
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Result<LetGo, Stop>, PredictError> {
    params.validate()?;
    if !is_rigid(release) {
        return Err(PredictError::Release);
    }
    let body = object.body().ok_or(PredictError::NoDistanceField)?;
    let support = supporter.support();
    let frames = Frames::of((&body, support));
    let mut arena = Arena::new(memory, predict_bytes(&supporter.limits()))?;
    let sleeps = arena.slice::<Sleep>(Support::sleepers(support.patches.len()))?;
    let mut meter = Meter::new(monitor);
    let settled =
        swing_out((&body, support), &frames.inwards(release), &-params.up(), params, sleeps, &mut meter);
    Ok(settled.map(|settled| LetGo { fate: settled.fate, pose: frames.outwards(&settled.pose) }))
}
