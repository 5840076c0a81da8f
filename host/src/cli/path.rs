//! A path, or why there is none: for people, as JSON and as CSV.

use hangpose::geometry::Point;
use hangpose::motion::{self, Collision, Mover, Obstacle, PlanFailure};
use serde::Serialize;
use std::fmt::Write;

/// Room for the waypoints of a path: 1 km of the shortest steps.
pub(super) const MAX_WAYPOINTS: usize = 100_000;

/// A path in the JSON, its poses in the supporter frame.
#[derive(Clone, Serialize)]
pub(super) struct Path {
    /// Poses of the object, from the start to just before the rest pose, or the other way.
    waypoints: Vec<Waypoint>,
    /// Index of the release pose.
    release: usize,
    /// Poses of the opened gripper, away from the object or towards it.
    gripper: Vec<Waypoint>,
    /// Metres.
    clearance: f32,
}

#[derive(Clone, Serialize)]
struct Waypoint {
    seconds: f32,
    position: [f32; 3],
    quaternion_xyzw: [f32; 4],
}

/// Why there is no path, in the JSON.
#[derive(Serialize)]
pub(super) struct Failure {
    reason: &'static str,
    message: String,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    collision: Option<Hit>,
}

/// What collides with what.
#[derive(Serialize)]
struct Hit {
    /// "object" or "gripper".
    mover: &'static str,
    /// Index of the part of the gripper.
    part: Option<usize>,
    /// "supporter", "scene", "hung" or "object".
    obstacle: &'static str,
    /// Index of the point of the scene.
    index: Option<usize>,
    at: [f32; 3],
    distance: f32,
}

impl From<&motion::Path<'_>> for Path {
    fn from(path: &motion::Path) -> Self {
        let waypoints = |list: &[motion::Waypoint]| list.iter().map(Waypoint::from).collect();
        Self {
            waypoints: waypoints(path.object),
            release: path.release,
            gripper: waypoints(path.gripper),
            clearance: path.clearance,
        }
    }
}

impl From<&motion::Waypoint> for Waypoint {
    fn from(&motion::Waypoint { seconds, pose }: &motion::Waypoint) -> Self {
        let (position, quaternion_xyzw) = (pose.translation.vector.into(), pose.rotation.coords.into());
        Self { seconds, position, quaternion_xyzw }
    }
}

impl Failure {
    /// The failure in a cloud at `origin`.
    pub(super) fn new(failure: &PlanFailure, origin: [f64; 3]) -> Self {
        Self {
            reason: failure.name(),
            message: message(failure, origin),
            collision: failure.collision().map(Hit::from),
        }
    }
}

impl From<&Collision> for Hit {
    fn from(&Collision { mover, obstacle, at, distance }: &Collision) -> Self {
        let (mover, part) = match mover {
            Mover::Object => ("object", None),
            Mover::Gripper(part) => ("gripper", Some(part)),
        };
        let (obstacle, index) = match obstacle {
            Obstacle::Supporter => ("supporter", None),
            Obstacle::Scene(index) => ("scene", Some(index)),
            Obstacle::Hung(index) => ("hung", Some(index)),
            Obstacle::Object => ("object", None),
        };
        Self { mover, part, obstacle, index, at, distance }
    }
}

/// Why there is no path, with the place of a collision in the supporter frame.
pub(super) fn message(failure: &PlanFailure, origin: [f64; 3]) -> String {
    let text = match failure {
        PlanFailure::BudgetUsedUp { .. } | PlanFailure::TreesFull { .. } => {
            format!("{failure} (--plan-samples)")
        }
        failure => failure.to_string(),
    };
    let Some(collision) = failure.collision() else { return text };
    // The core says where in the coordinates of the cloud.
    let written = |[x, y, z]: [f64; 3]| format!("({x:.3}, {y:.3}, {z:.3})");
    let at = collision.at.map(f64::from);
    text.replace(&written(at), &written([0, 1, 2].map(|i| at[i] + origin[i])))
}

/// A path in words: its length is that of the way of the centre of mass.
pub(super) fn in_words(path: &motion::Path, centre_of_mass: &Point) -> String {
    let length: f32 = path
        .object
        .windows(2)
        .map(|pair| (pair[1].pose * centre_of_mass - pair[0].pose * centre_of_mass).norm())
        .sum();
    let seconds = path.object.iter().chain(path.gripper).map(|at| at.seconds).fold(0.0, f32::max);
    let gripper = if path.gripper.is_empty() { "" } else { " with the gripper" };
    format!(
        "a path of {length:.2} m takes {seconds:.1} s{gripper}, clearance {:.1} mm",
        1000.0 * path.clearance
    )
}

/// The waypoints of the object as CSV, moved by `origin`.
pub(super) fn csv(path: &motion::Path, origin: [f64; 3]) -> String {
    let mut text = String::from("seconds,x,y,z,qx,qy,qz,qw\n");
    for motion::Waypoint { seconds, pose } in path.object {
        let position: [f32; 3] = pose.translation.vector.into();
        let [x, y, z] = [0, 1, 2].map(|i| match origin[i] {
            0.0 => position[i].to_string(),
            offset => (f64::from(position[i]) + offset).to_string(),
        });
        let [qx, qy, qz, qw]: [f32; 4] = pose.rotation.coords.into();
        writeln!(text, "{seconds},{x},{y},{z},{qx},{qy},{qz},{qw}").expect("a string takes any text");
    }
    text
}
