use crate::border::Public;
use crate::detail::HANGPOSE_NO_INDEX;
use crate::status::{hangpose_status, stopped};
use core::ffi::{CStr, c_char};
use hangpose_core::motion::{Collision, Mover, Obstacle, PlanFailure};

/// Why there is no path, one of HANGPOSE_PLAN_*.
pub type hangpose_plan_reason = u32;

/// There is a path.
pub const HANGPOSE_PLAN_FOUND: hangpose_plan_reason = 0;
/// No path was planned, because there is no pose, or because a better pose has a path.
pub const HANGPOSE_PLAN_NOT_TRIED: hangpose_plan_reason = 1;
/// The release pose is in collision: hangpose_plan_failure.mover and the fields after it say where.
pub const HANGPOSE_PLAN_GOAL_IN_COLLISION: hangpose_plan_reason = 2;
/// The given start is in collision.
pub const HANGPOSE_PLAN_START_IN_COLLISION: hangpose_plan_reason = 3;
/// The release pose or the rest pose is outside of the workspace, or hangpose_motion.accepts refused it.
pub const HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE: hangpose_plan_reason = 4;
/// The given start is outside of the workspace, or hangpose_motion.accepts refused it; or no start was given and none was
/// found.
pub const HANGPOSE_PLAN_START_OUTSIDE_WORKSPACE: hangpose_plan_reason = 5;
/// There is no path, whatever the budget: the object and the supporter are linked like two rings of a chain, or the object
/// is in a cage. Gaps between points of the supporter that are narrower than hangpose_plan_failure.resolution are taken as
/// closed.
pub const HANGPOSE_PLAN_ENCLOSED: hangpose_plan_reason = 6;
/// No path was found within hangpose_motion.samples.
pub const HANGPOSE_PLAN_BUDGET_USED_UP: hangpose_plan_reason = 7;
/// No path was found before the trees were full: hangpose_motion.nodes.
pub const HANGPOSE_PLAN_TREES_FULL: hangpose_plan_reason = 8;
/// The object has a path, but when the gripper opens it collides.
pub const HANGPOSE_PLAN_GRIPPER_CANNOT_OPEN: hangpose_plan_reason = 9;
/// The object has a path, but the opened gripper has no way out.
pub const HANGPOSE_PLAN_GRIPPER_CANNOT_LEAVE: hangpose_plan_reason = 10;
/// The monitor stopped the search: hangpose_plan_failure.stopped.
pub const HANGPOSE_PLAN_STOPPED: hangpose_plan_reason = 11;

/// What moves into a collision, one of HANGPOSE_MOVER_*.
pub type hangpose_mover = u32;

/// Nothing: there is no collision.
pub const HANGPOSE_MOVER_NONE: hangpose_mover = 0;
/// The object.
pub const HANGPOSE_MOVER_OBJECT: hangpose_mover = 1;
/// A part of the gripper.
pub const HANGPOSE_MOVER_GRIPPER: hangpose_mover = 2;

/// What stands in the way, one of HANGPOSE_OBSTACLE_*.
pub type hangpose_obstacle = u32;

/// Nothing: there is no collision.
pub const HANGPOSE_OBSTACLE_NONE: hangpose_obstacle = 0;
/// The supporter.
pub const HANGPOSE_OBSTACLE_SUPPORTER: hangpose_obstacle = 1;
/// A point of hangpose_request.scene_points.
pub const HANGPOSE_OBSTACLE_SCENE: hangpose_obstacle = 2;
/// An object of hangpose_request.hung.
pub const HANGPOSE_OBSTACLE_HUNG: hangpose_obstacle = 3;
/// The object that has been hung.
pub const HANGPOSE_OBSTACLE_OBJECT: hangpose_obstacle = 4;

/// Why there is no path to a pose. Part of hangpose_plan, and written by hangpose_predict_reachable for each pose.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_plan_failure {
    /// sizeof(hangpose_plan_failure), set by the library.
    pub struct_size: u32,
    /// One of HANGPOSE_PLAN_*; hangpose_plan_reason_string gives a text.
    pub reason: hangpose_plan_reason,
    /// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with HANGPOSE_PLAN_STOPPED, else HANGPOSE_OK.
    pub stopped: hangpose_status,
    /// With HANGPOSE_PLAN_BUDGET_USED_UP the number of samples, with HANGPOSE_PLAN_TREES_FULL that of the nodes of a full
    /// tree; else 0.
    pub count: u32,
    /// With HANGPOSE_PLAN_ENCLOSED the width of the gaps that are taken as closed, metres; else NaN.
    pub resolution: f32,
    /// With a collision what moves, one of HANGPOSE_MOVER_*; else HANGPOSE_MOVER_NONE.
    pub mover: hangpose_mover,
    /// Index in hangpose_motion.parts, or HANGPOSE_NO_INDEX.
    pub part: u32,
    /// With a collision what stands in the way, one of HANGPOSE_OBSTACLE_*; else HANGPOSE_OBSTACLE_NONE.
    pub obstacle: hangpose_obstacle,
    /// Index in hangpose_request.scene_points or hangpose_request.hung, or HANGPOSE_NO_INDEX.
    pub obstacle_index: u32,
    /// With a collision x, y, z of its place, metres, in supporter coordinates; else NaN.
    pub position: [f32; 3],
    /// With a collision the distance of the two, metres: negative in penetration, or less than the clearance; else NaN.
    pub distance: f32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_plan_failure {
    const NAME: &'static str = "failures";
}

/// Returns the meaning of a reason in English; a static string, never null.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_plan_reason_string(reason: hangpose_plan_reason) -> *const c_char {
    reason_text(reason).as_ptr()
}

pub(crate) fn reason_text(reason: hangpose_plan_reason) -> &'static CStr {
    match reason {
        HANGPOSE_PLAN_FOUND => c"there is a path",
        HANGPOSE_PLAN_NOT_TRIED => c"no path was planned",
        HANGPOSE_PLAN_GOAL_IN_COLLISION => c"the release pose is in collision",
        HANGPOSE_PLAN_START_IN_COLLISION => c"the start is in collision",
        HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE => c"the hanging pose is outside of the workspace",
        HANGPOSE_PLAN_START_OUTSIDE_WORKSPACE => {
            c"the start is outside of the workspace, or no start outside of the supporter is in it"
        }
        HANGPOSE_PLAN_ENCLOSED => c"there is no way out: object and supporter enclose each other",
        HANGPOSE_PLAN_BUDGET_USED_UP => {
            c"no path was found with this number of samples: allow more, or there is none"
        }
        HANGPOSE_PLAN_TREES_FULL => {
            c"no path was found with this number of nodes in a tree: allow more, or there is none"
        }
        HANGPOSE_PLAN_GRIPPER_CANNOT_OPEN => c"the object has a path, but the gripper cannot open",
        HANGPOSE_PLAN_GRIPPER_CANNOT_LEAVE => c"the object has a path, but the opened gripper has no way out",
        HANGPOSE_PLAN_STOPPED => c"the search was cancelled, or the work limit was reached",
        _ => c"unknown reason",
    }
}

impl hangpose_plan_failure {
    /// A reason without further numbers.
    pub(crate) const fn of(reason: hangpose_plan_reason) -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            reason,
            stopped: 0,
            count: 0,
            resolution: f32::NAN,
            mover: HANGPOSE_MOVER_NONE,
            part: HANGPOSE_NO_INDEX,
            obstacle: HANGPOSE_OBSTACLE_NONE,
            obstacle_index: HANGPOSE_NO_INDEX,
            position: [f32::NAN; 3],
            distance: f32::NAN,
        }
    }

    fn collision(reason: hangpose_plan_reason, collision: Collision) -> Self {
        let Collision { mover, obstacle, at, distance } = collision;
        let (mover, part) = match mover {
            Mover::Object => (HANGPOSE_MOVER_OBJECT, HANGPOSE_NO_INDEX),
            Mover::Gripper(part) => (HANGPOSE_MOVER_GRIPPER, part as u32),
        };
        let (obstacle, obstacle_index) = match obstacle {
            Obstacle::Supporter => (HANGPOSE_OBSTACLE_SUPPORTER, HANGPOSE_NO_INDEX),
            Obstacle::Scene(index) => (HANGPOSE_OBSTACLE_SCENE, index as u32),
            Obstacle::Hung(index) => (HANGPOSE_OBSTACLE_HUNG, index as u32),
            Obstacle::Object => (HANGPOSE_OBSTACLE_OBJECT, HANGPOSE_NO_INDEX),
        };
        Self { mover, part, obstacle, obstacle_index, position: at, distance, ..Self::of(reason) }
    }
}

impl From<&PlanFailure> for hangpose_plan_failure {
    fn from(failure: &PlanFailure) -> Self {
        match *failure {
            PlanFailure::GoalInCollision(collision) => {
                Self::collision(HANGPOSE_PLAN_GOAL_IN_COLLISION, collision)
            }
            PlanFailure::StartInCollision(collision) => {
                Self::collision(HANGPOSE_PLAN_START_IN_COLLISION, collision)
            }
            PlanFailure::GoalOutsideWorkspace => Self::of(HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE),
            PlanFailure::StartOutsideWorkspace => Self::of(HANGPOSE_PLAN_START_OUTSIDE_WORKSPACE),
            PlanFailure::Enclosed { resolution } => Self { resolution, ..Self::of(HANGPOSE_PLAN_ENCLOSED) },
            PlanFailure::BudgetUsedUp { samples } => {
                Self { count: samples as u32, ..Self::of(HANGPOSE_PLAN_BUDGET_USED_UP) }
            }
            PlanFailure::TreesFull { nodes } => {
                Self { count: nodes as u32, ..Self::of(HANGPOSE_PLAN_TREES_FULL) }
            }
            PlanFailure::GripperCannotOpen(collision) => {
                Self::collision(HANGPOSE_PLAN_GRIPPER_CANNOT_OPEN, collision)
            }
            PlanFailure::GripperCannotLeave => Self::of(HANGPOSE_PLAN_GRIPPER_CANNOT_LEAVE),
            PlanFailure::Stopped(stop) => {
                Self { stopped: stopped(Some(stop)), ..Self::of(HANGPOSE_PLAN_STOPPED) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn reasons_begin_as_those_of_the_core() {
        let collision =
            Collision { mover: Mover::Object, obstacle: Obstacle::Supporter, at: [0.0; 3], distance: 0.0 };
        for core in [
            PlanFailure::GoalInCollision(collision),
            PlanFailure::StartInCollision(collision),
            PlanFailure::GoalOutsideWorkspace,
            PlanFailure::StartOutsideWorkspace,
            PlanFailure::Enclosed { resolution: 0.01 },
            PlanFailure::GripperCannotOpen(collision),
            PlanFailure::GripperCannotLeave,
        ] {
            let text = reason_text(hangpose_plan_failure::from(&core).reason).to_str().unwrap();
            assert!(core.to_string().starts_with(text), "{text}: {core}");
        }
    }

    #[test]
    fn every_reason_has_words() {
        for reason in HANGPOSE_PLAN_FOUND..=HANGPOSE_PLAN_STOPPED {
            assert_ne!(reason_text(reason), c"unknown reason", "{reason}");
        }
        assert_eq!(reason_text(HANGPOSE_PLAN_STOPPED + 1), c"unknown reason");
    }
}
