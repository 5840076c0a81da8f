//! What planning returns.

use super::failure::PlanFailure;
use crate::geometry::Pose;
use crate::monitor::{Stop, Work};

/// A pose at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint {
    /// Time since the start, seconds.
    pub seconds: f32,
    /// Pose of the object, or of the gripper after it has let go: maps object coordinates, in which the gripper is given,
    /// to supporter coordinates; metres.
    pub pose: Pose,
}

impl Default for Waypoint {
    fn default() -> Self {
        Self { seconds: 0.0, pose: Pose::identity() }
    }
}

/// A collision-free path. Between two waypoints the centre of mass moves in a straight line at constant speed while the
/// object turns about a fixed axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path<'w> {
    /// Poses of the object. To hang it: from the start to the release pose, and on towards the rest pose, to where the object is 0.3 mm
    /// from the supporter. To take it off: the other way.
    pub object: &'w [Waypoint],
    /// Index in `object` of the release pose; the waypoints after it lower the object until it nearly touches.
    pub release: usize,
    /// Poses of the opened gripper relative to the supporter: after the object rests, away from it; to take the object off,
    /// towards it and before the object moves. Empty without a gripper.
    pub gripper: &'w [Waypoint],
    /// Least distance of the object, or of the gripper that holds it, from everything else between start and release pose,
    /// metres, capped at [`MAX_CLEARANCE`]. It is tested at steps in which no point moves farther than a millimetre, or than a
    /// quarter of the distance where that is more.
    pub clearance: f32,
}

/// Largest [`Path::clearance`] that is told apart, metres: what is farther away does not matter.
pub const MAX_CLEARANCE: f32 = 0.02;

/// How much a plan took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlanCounts {
    /// Poses sampled.
    pub samples: usize,
    /// Nodes of the trees.
    pub nodes: usize,
    /// Poses tested for collision.
    pub poses: usize,
    /// Poses that the caller was asked about.
    pub asked: usize,
}

/// The answer to [`plan`](super::plan).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan<'w> {
    /// The path, or why there is none. [`PlanFailure::Stopped`] if the monitor stopped the search.
    pub path: Result<Path<'w>, PlanFailure>,
    /// How much it took.
    pub counts: PlanCounts,
    /// Distance queries spent.
    pub work: Work,
}

impl Plan<'_> {
    /// Why the search ended early, if it did.
    pub fn stopped(&self) -> Option<Stop> {
        match self.path {
            Err(PlanFailure::Stopped(stop)) => Some(stop),
            _ => None,
        }
    }
}

/// A plan without its waypoints, which stand one after another in the caller's memory: those of the object, then those of the
/// gripper.
#[derive(Clone, Copy)]
pub(super) struct Outline {
    /// How many waypoints the path has, or why there is none.
    pub(super) path: Result<Shape, PlanFailure>,
    pub(super) counts: PlanCounts,
    pub(super) work: Work,
}

/// A path without its waypoints.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    /// Waypoints of the object.
    pub(super) object: usize,
    /// Index of the release pose.
    pub(super) release: usize,
    /// Waypoints of the gripper.
    pub(super) gripper: usize,
    pub(super) clearance: f32,
}

impl Outline {
    pub(super) fn failure(&self) -> Option<PlanFailure> {
        self.path.as_ref().err().copied()
    }

    /// The plan with its waypoints.
    pub(super) fn on(self, waypoints: &[Waypoint]) -> Plan<'_> {
        let path = self.path.map(|Shape { object, release, gripper, clearance }| {
            let (object, rest) = waypoints.split_at_checked(object).unwrap_or_default();
            Path { object, release, gripper: rest.get(..gripper).unwrap_or_default(), clearance }
        });
        Plan { path, counts: self.counts, work: self.work }
    }
}
