//! The options that say how the object moves to the pose, or away from it.

use super::gripper::Hand;
use super::{parse_numbers, pose_file};
use anyhow::{Context, Result};
use clap::Args;
use clap::error::ErrorKind;
use hangpose::geometry::{Aabb, Pose};
use hangpose::motion::{Motion, MotionError};
use std::path::{Path, PathBuf};

/// How the object moves.
#[derive(Args)]
pub(super) struct MotionArguments {
    /// Pose in which the object is grasped: JSON with "position" and "quaternion_xyzw" in the supporter frame. The default is
    /// any pose outside of the supporter's bounds.
    #[arg(long, value_name = "FILE")]
    start: Option<PathBuf>,
    /// Plan the way back: from the rest pose to the start.
    #[arg(long)]
    take_off: bool,
    /// The gripper that holds the object: a TOML file with retreat = [x, y, z] and [[part]] with from, to, radius and
    /// opening, in object coordinates, metres. Without it the path is for the object alone.
    #[arg(long, value_name = "FILE")]
    gripper: Option<PathBuf>,
    /// Box that the object stays in, by its lower and its upper corner in metres in the supporter frame.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_workspace, allow_hyphen_values = true)]
    workspace: Option<[f64; 6]>,
    /// Distance from obstacles that the path keeps where there is room for it, metres [default: 0.005].
    #[arg(long, value_name = "METRES", value_parser = parse_clearance, allow_hyphen_values = true)]
    plan_clearance: Option<f32>,
    /// Poses that are sampled at most [default: 400].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MAX_SAMPLES))]
    plan_samples: Option<u32>,
    /// File for the path as CSV: seconds,x,y,z,qx,qy,qz,qw of each waypoint of the object; - for standard output.
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
}

/// Greatest number of samples: either tree has room for one and a half nodes a sample, and for a million at most.
const MAX_SAMPLES: i64 = 500_000;

fn parse_workspace(text: &str) -> Result<[f64; 6], String> {
    match parse_numbers::<6>(text)? {
        [ax, ay, az, bx, by, bz] if !(ax < bx && ay < by && az < bz) => {
            Err("give the lower corner of the box first, as in -1,-1,0,1,1,1".into())
        }
        corners => Ok(corners),
    }
}

fn parse_clearance(text: &str) -> Result<f32, String> {
    match text.trim().parse() {
        Ok(metres) if 0.0 < metres && metres <= 0.1 => Ok(metres),
        _ => Err("use more than 0 and at most 0.1 metres".into()),
    }
}

/// What the options ask for, with the memory that a [`Motion`] borrows.
pub(super) struct Way {
    start: Option<Pose>,
    take_off: bool,
    hand: Option<Hand>,
    workspace: Option<Aabb>,
    clearance: f32,
    samples: usize,
    nodes: usize,
    /// Name of the gripper's file, for messages.
    gripper: PathBuf,
}

impl MotionArguments {
    /// Fails if an option is given that has no effect without `--plan`.
    pub(super) fn check_unused(&self) -> Result<()> {
        let given = [
            ("--start", self.start.is_some()),
            ("--take-off", self.take_off),
            ("--gripper", self.gripper.is_some()),
            ("--workspace", self.workspace.is_some()),
            ("--plan-clearance", self.plan_clearance.is_some()),
            ("--plan-samples", self.plan_samples.is_some()),
            ("--path", self.path.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(clap::Error::raw(
                ErrorKind::MissingRequiredArgument,
                format!("{option} has no effect without --plan: pass --plan, too\n"),
            )
            .into()),
            None => Ok(()),
        }
    }

    /// The files that are read.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        self.start.iter().chain(&self.gripper).map(PathBuf::as_path)
    }

    /// The file for the path.
    pub(super) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Reads the files, and moves what is in the supporter frame to the coordinates of its cloud.
    pub(super) fn read(&self, origin: [f64; 3]) -> Result<Way> {
        let in_cloud = |corner: [f64; 3]| [0, 1, 2].map(|i| (corner[i] - origin[i]) as f32).into();
        let samples = self.plan_samples.map_or(Motion::DEFAULT.samples, |samples| samples as usize);
        Ok(Way {
            start: self.start.as_deref().map(|path| pose_file::pose(path, origin)).transpose()?,
            take_off: self.take_off,
            hand: self.gripper.as_deref().map(Hand::read).transpose()?,
            workspace: self.workspace.map(|[ax, ay, az, bx, by, bz]| Aabb {
                min: in_cloud([ax, ay, az]),
                max: in_cloud([bx, by, bz]),
            }),
            clearance: self.plan_clearance.unwrap_or(Motion::DEFAULT.clearance),
            samples,
            nodes: Motion::DEFAULT.nodes.max(2 * samples),
            gripper: self.gripper.clone().unwrap_or_default(),
        })
    }
}

impl Way {
    /// The motion, checked.
    pub(super) fn motion(&self) -> Result<Motion<'_>> {
        let motion = Motion {
            start: self.start,
            take_off: self.take_off,
            gripper: self.hand.as_ref().map(Hand::gripper),
            workspace: self.workspace,
            clearance: self.clearance,
            samples: self.samples,
            nodes: self.nodes,
            ..Motion::DEFAULT
        };
        match motion.validate() {
            Ok(()) => Ok(motion),
            Err(error) => Err(error).with_context(|| self.option(&error)),
        }
    }

    /// What gave the value that is wrong.
    fn option(&self, error: &MotionError) -> String {
        match error {
            MotionError::Part { .. } | MotionError::NoParts | MotionError::Retreat => {
                self.gripper.display().to_string()
            }
            MotionError::Start => "--start".into(),
            MotionError::Workspace => "--workspace".into(),
            MotionError::Value { .. } => "--plan-clearance".into(),
            MotionError::Count { .. } => "--plan-samples".into(),
        }
    }
}
