//! A pose of C as the goal of a path.

use crate::border::input;
use crate::failure::{Failure, Place};
use crate::pose::{hangpose_pose, pose_of};
use hangpose_core::geometry::{MAX_COORDINATE, Pose};
use hangpose_core::hanging::{HangingPose, Rest};

/// Name of the argument in the header.
pub(crate) const GOAL: &str = "goal";

/// # Safety
///
/// The obligations of the caller, see `border`.
pub(crate) unsafe fn goal(pointer: *const hangpose_pose) -> Result<HangingPose, Failure> {
    // SAFETY: those of this function.
    let goal = unsafe { input(pointer) }.map_err(|failure| match failure {
        Failure::Null { .. } => Failure::Null { argument: GOAL },
        Failure::Misaligned { alignment, .. } => Failure::Misaligned { argument: GOAL, alignment },
        Failure::StructSize { given, expected, .. } => {
            Failure::StructSize { argument: GOAL, given, expected }
        }
        failure => failure,
    })?;
    if goal.has_pose != 1 {
        return Err(Failure::NoGoal { value: goal.has_pose });
    }
    let release = pose("goal.position", goal.position, "goal.quaternion", goal.quaternion)?;
    let rest = match goal.has_rest {
        0 => None,
        1 => Some(Rest::at(pose(
            "goal.rest_position",
            goal.rest_position,
            "goal.rest_quaternion",
            goal.rest_quaternion,
        )?)),
        value => return Err(Failure::Choice { field: "goal.has_rest", value, most: 1 }),
    };
    Ok(HangingPose { pose: release, rest, matched: None })
}

fn pose(
    position_field: &'static str,
    position: [f32; 3],
    quaternion_field: &'static str,
    quaternion: [f32; 4],
) -> Result<Pose, Failure> {
    let wrong = |place: Place| Failure::Goal { spot: place.into() };
    if !position.iter().all(|x| x.abs() <= MAX_COORDINATE) {
        return Err(wrong(Place::of(position_field).coordinate(None, position)));
    }
    pose_of(position, quaternion).ok_or_else(|| wrong(Place::of(quaternion_field)))
}
