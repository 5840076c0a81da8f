//! The best pose that can be reached.

use super::error::PlanError;
use super::failure::PlanFailure;
use super::path::{Plan, Waypoint};
use super::plan::{outline, plan_bytes};
use super::task::Task;
use crate::geometry::Pose;
use crate::hanging::{HangingPose, Prediction, predict, predict_bytes};
use crate::memory::{Limits, larger};
use crate::monitor::Monitor;

/// What [`predict_reachable`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reachable<'p, 'w> {
    /// All poses, best first, or why there are none.
    pub prediction: Prediction<'p>,
    /// Number of poses for which a path was planned, from the best on. All but the last one have none, and `failures` says why.
    pub planned: usize,
    /// The plan of the last of them; `None` if there are no poses.
    pub plan: Option<Plan<'w>>,
}

/// Bytes of working memory for [`predict_reachable`]: a supporter within `limits`, `scene` points of a scene and trees of
/// `nodes`.
pub const fn reachable_bytes(limits: &Limits, scene: usize, nodes: usize) -> usize {
    larger(predict_bytes(limits), plan_bytes(limits, scene, nodes))
}

/// Predicts poses, best first, and plans for one after another until one has a path.
///
/// `poses` and `memory`, of [`reachable_bytes`], are as for [`predict`], `accepts` and `waypoints` as for
/// [`plan`](super::plan()). `failures` has one element for each of `poses`; those of the poses without a path are set.
pub fn predict_reachable<'p, 'w>(
    task: &Task,
    poses: &'p mut [HangingPose],
    failures: &mut [Option<PlanFailure>],
    waypoints: &'w mut [Waypoint],
    accepts: &mut dyn FnMut(&Pose) -> bool,
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Reachable<'p, 'w>, PlanError> {
    task.motion.validate()?;
    let Task { object, supporter, request, params, .. } = *task;
    let prediction = predict(object, supporter, request, params, poses, memory, monitor)?;
    failures.fill(None);
    let (mut planned, mut last) = (0, None);
    for (pose, index) in prediction.poses.iter().zip(0..) {
        let outline = outline(task, pose, waypoints, accepts, memory, monitor)?;
        planned = index + 1;
        last = Some(outline);
        let Some(failure) = outline.failure() else { break };
        if let Some(slot) = failures.get_mut(index) {
            *slot = Some(failure);
        }
        if let PlanFailure::Stopped(_) = failure {
            break;
        }
    }
    let plan = last.map(|outline| outline.on(waypoints));
    Ok(Reachable { prediction, planned, plan })
}
