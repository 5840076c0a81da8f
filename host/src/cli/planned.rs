//! Which of the poses of a prediction can be reached, and by which path.

use super::json::Pose;
use super::path;
use hangpose::geometry::Point;
use hangpose::motion::{self, PlanFailure, Reachable, Waypoint};

/// What planning found for the poses of a prediction.
pub(super) struct Planned {
    /// Why the poses that were tried have none.
    failures: Vec<Option<PlanFailure>>,
    /// The path of one of the poses.
    found: Option<FoundPath>,
}

/// A path and its memory.
struct FoundPath {
    /// Index of the pose.
    pose: usize,
    object: Vec<Waypoint>,
    release: usize,
    gripper: Vec<Waypoint>,
    clearance: f32,
}

impl Planned {
    /// `failures` are those of the poses, and the path is that of the last pose of which the plan is.
    pub(super) fn new(failures: Vec<Option<PlanFailure>>, found: &Reachable) -> Self {
        let path = found.plan.as_ref().and_then(|plan| plan.path.as_ref().ok());
        let found = path.map(|path| FoundPath {
            pose: found.planned - 1,
            object: path.object.to_vec(),
            release: path.release,
            gripper: path.gripper.to_vec(),
            clearance: path.clearance,
        });
        Self { failures, found }
    }

    /// The path to the pose that has one.
    pub(super) fn path(&self) -> Option<motion::Path<'_>> {
        self.found.as_ref().map(|found| motion::Path {
            object: &found.object,
            release: found.release,
            gripper: &found.gripper,
            clearance: found.clearance,
        })
    }

    /// Lines of the table: which pose can be reached, and why better ones cannot.
    pub(super) fn table(&self, centre_of_mass: &Point, origin: [f64; 3]) -> String {
        let mut text = String::new();
        for (rank, failure) in (1..).zip(&self.failures) {
            if let Some(failure) = failure {
                text += &format!("{rank:4}  has no path: {}\n", path::message(failure, origin));
            }
        }
        if let (Some(found), Some(path)) = (&self.found, self.path()) {
            let words = path::in_words(&path, centre_of_mass);
            text += &format!("{:4}  can be reached: {words}\n", found.pose + 1);
        }
        text
    }

    /// The pose with its path, or the reason why it has none, if one was planned.
    pub(super) fn add_to<'a>(&self, pose: Pose<'a>, index: usize, origin: [f64; 3]) -> Pose<'a> {
        let failure = self.failures[index].as_ref().map(|failure| path::Failure::new(failure, origin));
        let path = self.path().filter(|_| self.found.as_ref().is_some_and(|found| found.pose == index));
        match (path, failure) {
            (None, None) => pose,
            (path, failure) => pose.with_path(path.as_ref().map(Into::into), failure),
        }
    }
}
