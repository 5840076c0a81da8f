//! A pose of C as the goal of a path.

use crate::border::input;
use crate::failure::Failure;
use crate::pose::{checked_pose, hangpose_pose};
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
    let pose = checked_pose(("goal.position", goal.position), ("goal.quaternion", goal.quaternion))?;
    let rest = match goal.has_rest {
        0 => None,
        1 => Some(Rest::at(checked_pose(
            ("goal.rest_position", goal.rest_position),
            ("goal.rest_quaternion", goal.rest_quaternion),
        )?)),
        value => return Err(Failure::Choice { field: "goal.has_rest", value, most: 1 }),
    };
    Ok(HangingPose { pose, rest, matched: None })
}
