//! Why there is no path.

use crate::mechanics::Frames;
use crate::monitor::Stop;
use core::fmt;

/// Why no path was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanFailure {
    /// The release pose is in collision.
    GoalInCollision(Collision),
    /// The given start is in collision.
    StartInCollision(Collision),
    /// The release pose or the rest pose is outside of the workspace, or the caller refused it.
    GoalOutsideWorkspace,
    /// The given start is outside of the workspace, or the caller refused it; or no start was given and none was found.
    StartOutsideWorkspace,
    /// There is no path, whatever the budget: the object and the supporter are linked like two rings of a chain, or
    /// the object is in a cage. Gaps between points of the supporter that are narrower than this are taken as closed, metres.
    Enclosed {
        /// The width, metres.
        resolution: f32,
    },
    /// No path was found within [`Motion::samples`](super::Motion::samples).
    BudgetUsedUp {
        /// Poses sampled.
        samples: usize,
    },
    /// No path was found before the trees were full: [`Motion::nodes`](super::Motion::nodes).
    TreesFull {
        /// Nodes of a full tree.
        nodes: usize,
    },
    /// The object has a path, but when the gripper opens it collides.
    GripperCannotOpen(Collision),
    /// The object has a path, but the opened gripper has no way out.
    GripperCannotLeave,
    /// The monitor stopped the search.
    Stopped(Stop),
}

/// What collides with what, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// What collides.
    pub mover: Mover,
    /// With what.
    pub obstacle: Obstacle,
    /// Where, in supporter coordinates, metres.
    pub at: [f32; 3],
    /// Distance between the two, metres: negative in a collision, or less than the clearance.
    pub distance: f32,
}

/// What moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mover {
    /// The object.
    #[default]
    Object,
    /// The part of the gripper with this index.
    Gripper(usize),
}

/// What stands still.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Obstacle {
    /// The supporter.
    #[default]
    Supporter,
    /// The point of the scene with this index.
    Scene(usize),
    /// The object with this index that hangs already.
    Hung(usize),
    /// The object that has been hung.
    Object,
}

impl PlanFailure {
    /// The name of the reason, in snake_case.
    pub fn name(&self) -> &'static str {
        match self {
            Self::GoalInCollision(_) => "goal_in_collision",
            Self::StartInCollision(_) => "start_in_collision",
            Self::GoalOutsideWorkspace => "goal_outside_workspace",
            Self::StartOutsideWorkspace => "start_outside_workspace",
            Self::Enclosed { .. } => "enclosed",
            Self::BudgetUsedUp { .. } => "budget_used_up",
            Self::TreesFull { .. } => "trees_full",
            Self::GripperCannotOpen(_) => "gripper_cannot_open",
            Self::GripperCannotLeave => "gripper_cannot_leave",
            Self::Stopped(_) => "stopped",
        }
    }

    /// The same in the caller's coordinates.
    pub(super) fn outwards(mut self, frames: &Frames) -> Self {
        if let Self::GoalInCollision(collision)
        | Self::StartInCollision(collision)
        | Self::GripperCannotOpen(collision) = &mut self
        {
            collision.at = frames.on_supporter(&collision.at.into()).into();
        }
        self
    }

    /// What collides with what, if that is the reason.
    pub fn collision(&self) -> Option<&Collision> {
        match self {
            Self::GoalInCollision(collision)
            | Self::StartInCollision(collision)
            | Self::GripperCannotOpen(collision) => Some(collision),
            _ => None,
        }
    }
}

impl fmt::Display for Mover {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Object => f.write_str("the object"),
            Self::Gripper(part) => write!(f, "part {part} of the gripper"),
        }
    }
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Supporter => f.write_str("the supporter"),
            Self::Scene(point) => write!(f, "point {point} of the scene"),
            Self::Hung(index) => write!(f, "object {index} that hangs already"),
            Self::Object => f.write_str("the object"),
        }
    }
}

impl fmt::Display for Collision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mover, obstacle, at: [x, y, z], distance } = self;
        write!(f, "{mover} is {:.1} mm from {obstacle} at ({x:.3}, {y:.3}, {z:.3})", distance * 1e3)
    }
}

impl fmt::Display for PlanFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GoalInCollision(collision) => {
                write!(f, "the release pose is in collision: {collision}")
            }
            Self::StartInCollision(collision) => write!(f, "the start is in collision: {collision}"),
            Self::GoalOutsideWorkspace => f.write_str("the hanging pose is outside of the workspace"),
            Self::StartOutsideWorkspace => f.write_str(
                "the start is outside of the workspace, or no start outside of the supporter is in it",
            ),
            Self::Enclosed { resolution } => write!(
                f,
                "there is no way out: object and supporter enclose each other, with gaps narrower than {:.1} mm taken as closed",
                resolution * 1e3
            ),
            Self::BudgetUsedUp { samples } => {
                write!(f, "no path was found with {samples} samples: allow more, or there is none")
            }
            Self::TreesFull { nodes } => {
                write!(f, "no path was found with {nodes} nodes in a tree: allow more, or there is none")
            }
            Self::GripperCannotOpen(collision) => {
                write!(f, "the object has a path, but the gripper cannot open: {collision}")
            }
            Self::GripperCannotLeave => {
                f.write_str("the object has a path, but the opened gripper has no way out")
            }
            Self::Stopped(Stop::Cancelled) => f.write_str("the search was cancelled"),
            Self::Stopped(Stop::WorkLimit) => f.write_str("the work limit was reached"),
        }
    }
}
