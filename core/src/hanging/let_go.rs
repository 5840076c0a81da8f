//! What becomes of an object that is let go at any pose, also one that was not predicted.

use super::{Object, PredictError, Supporter, predict_bytes};
use crate::geometry::Pose;
use crate::mechanics::{Fate, Sleep, Support, swing_out};
use crate::memory::{Arena, Limits};
use crate::monitor::{Meter, Monitor, Stop};
use crate::params::Params;

/// What becomes of an object that is let go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LetGo {
    /// How it ends.
    pub fate: Fate,
    /// Where it ends, or was when that was clear: maps object coordinates to supporter coordinates; metres.
    pub pose: Pose,
}

/// Lets the object go at `release`, object to supporter coordinates, and watches for four seconds at most; or says why the monitor
/// stopped that. `memory` is working memory of [`predict_bytes`](super::predict_bytes).
pub fn let_go(
    object: &Object,
    supporter: &Supporter,
    release: &Pose,
    params: &Params,
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Result<LetGo, Stop>, PredictError> {
    params.validate()?;
    let body = object.body().ok_or(PredictError::NoDistanceField)?;
    let support = supporter.support();
    let points = supporter.points().points().len();
    let limits = Limits { points, ..Limits::NONE };
    let mut arena = Arena::new(memory, predict_bytes(&limits))?;
    let sleeps = arena.slice::<Sleep>(Support::sleepers(points))?;
    let mut meter = Meter::new(monitor);
    let settled = swing_out((&body, support), release, &-params.up(), params, sleeps, &mut meter);
    Ok(settled.map(|settled| LetGo { fate: settled.fate, pose: settled.pose }))
}
