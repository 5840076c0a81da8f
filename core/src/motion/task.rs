//! What moves, among what, and how.

use super::gripper::{Capsule, Gripper};
use crate::geometry::{Aabb, MAX_COORDINATE, Pose, Vector, is_rigid};
use crate::hanging::{Distance, Object, Request, Supporter};
use crate::params::Params;
use core::fmt;

/// Finest [`Motion::step`]: finer than what robots repeat. A path of 100 m has a million such steps, and the caller is asked about
/// each of them.
const FINEST_STEP: Distance = Distance { position: 1e-4, rotation: 1e-3 };

/// An object that moves, the things that it must not touch, and how it moves.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The object; analysed with [`voxels`](Params::voxels).
    pub object: &'a Object<'a>,
    /// The supporter.
    pub supporter: &'a Supporter<'a>,
    /// Its [`scene`](Request::scene) and [`hung`](Request::hung) are obstacles. The rest matters for
    /// [`predict_reachable`](super::predict_reachable) alone.
    pub request: &'a Request<'a>,
    /// Those of the analyses.
    pub params: &'a Params,
    /// How it moves.
    pub motion: Motion<'a>,
}

/// How an object moves to the pose in which it hangs, or away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<'a> {
    /// Pose in which the object is grasped, object to supporter coordinates; to take it off, where it is brought. `None` for
    /// any pose outside of the supporter's bounds.
    pub start: Option<Pose>,
    /// Whether the object is taken off instead of hung: the path begins at the rest pose and leads to the start.
    pub take_off: bool,
    /// The hand that holds it, if that is to be planned.
    pub gripper: Option<Gripper<'a>>,
    /// Box in supporter coordinates, metres, that all of the object stays in; `None` for no limit. The gripper may leave
    /// it.
    pub workspace: Option<Aabb>,
    /// Distance from obstacles, metres, that the path keeps where there is room for it. At the release pose, and where the way
    /// is narrow, it is less, but never a collision.
    pub clearance: f32,
    /// Largest distance between two waypoints; at least 0.1 mm and 1 mrad.
    pub step: Distance,
    /// Limits for the times of the waypoints.
    pub speed: Speed,
    /// Poses that are sampled at most: the budget of the search.
    pub samples: usize,
    /// Capacity of either of the two trees.
    pub nodes: usize,
    /// Seed of the samples: the same seed gives the same path.
    pub seed: u64,
}

/// Limits on speed and acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// Of the centre of mass, m/s.
    pub linear: f32,
    /// Of rotation, rad/s.
    pub angular: f32,
    /// Of the centre of mass, m/s².
    pub linear_acceleration: f32,
    /// Of rotation, rad/s².
    pub angular_acceleration: f32,
}

impl Motion<'_> {
    /// From outside of the supporter's bounds, without a gripper and a workspace.
    pub const DEFAULT: Self = Self {
        start: None,
        take_off: false,
        gripper: None,
        workspace: None,
        clearance: 0.005,
        step: Distance { position: 0.01, rotation: 0.1 },
        speed: Speed { linear: 0.25, angular: 1.0, linear_acceleration: 0.5, angular_acceleration: 2.0 },
        samples: 400,
        nodes: 4096,
        seed: 1,
    };

    /// Checks every value.
    pub fn validate(&self) -> Result<(), MotionError> {
        let is_usable = |vector: &[f32; 3]| vector.iter().all(|x| x.abs() <= MAX_COORDINATE);
        if self.start.is_some_and(|start| !is_rigid(&start)) {
            return Err(MotionError::Start);
        }
        if let Some(gripper) = self.gripper {
            let is_valid = |part: &Capsule| {
                is_usable(&part.from)
                    && is_usable(&part.to)
                    && is_usable(&part.opening)
                    && (0.0..=10.0).contains(&part.radius)
            };
            if let Some(part) = gripper.parts.iter().position(|part| !is_valid(part)) {
                return Err(MotionError::Part { part });
            }
            if gripper.parts.is_empty() {
                return Err(MotionError::NoParts);
            }
            if !(0.0..=10.0).contains(&Vector::from(gripper.retreat).norm()) {
                return Err(MotionError::Retreat);
            }
        }
        if let Some(Aabb { min, max }) = self.workspace
            && !(0..3).all(|axis| min[axis] < max[axis])
        {
            return Err(MotionError::Workspace);
        }
        let positive = [
            ("clearance", self.clearance, 0.0, 0.1),
            ("step.position", self.step.position, FINEST_STEP.position, 1.0),
            ("step.rotation", self.step.rotation, FINEST_STEP.rotation, core::f32::consts::PI),
            ("speed.linear", self.speed.linear, 0.0, 100.0),
            ("speed.angular", self.speed.angular, 0.0, 100.0),
            ("speed.linear_acceleration", self.speed.linear_acceleration, 0.0, 1000.0),
            ("speed.angular_acceleration", self.speed.angular_acceleration, 0.0, 1000.0),
        ];
        if let Some((name, value, min, max)) =
            positive.into_iter().find(|(_, value, min, max)| !(*value > 0.0 && value >= min && value <= max))
        {
            return Err(MotionError::Value { name, value, min, max });
        }
        let counts = [("samples", self.samples, 1, 10_000_000), ("nodes", self.nodes, 64, 1_000_000)];
        match counts.into_iter().find(|(_, value, min, max)| !(min..=max).contains(&value)) {
            Some((name, value, min, max)) => Err(MotionError::Count { name, value, min, max }),
            None => Ok(()),
        }
    }
}

impl Default for Motion<'_> {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Why a motion is invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionError {
    /// The start is too far away or not a number, or its rotation is not a unit quaternion.
    Start,
    /// A part of the gripper has a coordinate or a radius out of range.
    Part {
        /// Its index.
        part: usize,
    },
    /// The gripper has no parts.
    NoParts,
    /// The retreat is longer than 10 metres or not a number.
    Retreat,
    /// The workspace is empty or not a number.
    Workspace,
    /// A value is not above zero, or not in the range from `min` to `max`.
    Value {
        /// Its field.
        name: &'static str,
        /// The value.
        value: f32,
        /// The smallest one.
        min: f32,
        /// The largest one.
        max: f32,
    },
    /// A count is out of range.
    Count {
        /// Its field.
        name: &'static str,
        /// The count.
        value: usize,
        /// The smallest one.
        min: usize,
        /// The largest one.
        max: usize,
    },
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start => {
                write!(f, "the start needs a position within ±{MAX_COORDINATE} metres and a unit quaternion")
            }
            Self::Part { part } => write!(
                f,
                "part {part} of the gripper needs coordinates within ±{MAX_COORDINATE} metres and a radius of 0 to 10 metres"
            ),
            Self::NoParts => {
                f.write_str("the gripper has no parts: give at least one capsule, or no gripper")
            }
            Self::Retreat => f.write_str("the retreat of the gripper must be 0 to 10 metres long"),
            Self::Workspace => f.write_str(
                "the workspace needs a lower corner that is less than the upper one on every axis",
            ),
            Self::Value { name, value, min: 0.0, max } => {
                write!(f, "{name} of the motion is {value}: it must be above 0 and at most {max}")
            }
            Self::Value { name, value, min, max } => {
                write!(f, "{name} of the motion is {value}: it must be {min} to {max}")
            }
            Self::Count { name, value, min, max } => {
                write!(f, "{name} of the motion is {value}: it must be {min} to {max}")
            }
        }
    }
}

impl core::error::Error for MotionError {}
