//! What happens in a prediction, for those who look: which candidates were released, and how the object moved.

use super::{LetGo, Object, PredictError, Supporter, predict_bytes};
use crate::geometry::Pose;
use crate::mechanics::{Fate, Frames, Settings, Sleep, Support, settle_watched};
use crate::memory::Arena;
use crate::monitor::{Meter, Monitor, Stop};
use crate::params::Params;
use core::fmt;

/// A function that [`predict`](super::predict) calls for each candidate that it releases, with the pose, object to supporter
/// coordinates, and how the release ended.
#[derive(Clone, Copy)]
pub struct Watch<'a>(pub &'a (dyn Fn(&Pose, Fate) + Sync));

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Watch")
    }
}

/// Repeats a release that [`predict`](super::predict) simulated, and calls `watch` with the seconds since the release and the
/// pose of the object after each time step. From a release pose that was predicted it leads to the rest pose, and from a
/// candidate to the same fate. The damping is strong, unlike that of [`let_go`](super::let_go).
///
/// `release` maps object to supporter coordinates. The inner error says why the monitor stopped the simulation. `memory` is
/// working memory, [`predict_bytes`](super::predict_bytes) of it.
pub fn watch_release(
    (object, supporter): (&Object, &Supporter),
    release: &Pose,
    params: &Params,
    memory: &mut [u8],
    monitor: &Monitor,
    watch: &mut dyn FnMut(f32, &Pose),
) -> Result<Result<LetGo, Stop>, PredictError> {
    params.validate()?;
    let body = object.body().ok_or(PredictError::NoDistanceField)?;
    let support = supporter.support();
    let frames = Frames::of((&body, support));
    let mut arena = Arena::new(memory, predict_bytes(&supporter.limits()))?;
    let sleeps = arena.slice::<Sleep>(Support::sleepers(support.patches.len()))?;
    let (settings, down) = (Settings::damped(params), -params.up());
    let (release, mut step) = (frames.inwards(release), 0);
    let watch_state = |state: &_| {
        step += 1;
        watch(step as f32 * params.time_step, &frames.outwards(&body.pose(state)));
    };
    let mut meter = Meter::new(monitor);
    let settled =
        settle_watched((&body, support), &release, &down, settings, sleeps, &mut meter, watch_state);
    Ok(settled.map(|settled| LetGo { fate: settled.fate, pose: frames.outwards(&settled.pose) }))
}
