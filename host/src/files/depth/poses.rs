//! Poses of the cameras: a 4 x 4 matrix in each of several files, or all in one file.

use std::path::Path;

use super::ScanError;
use super::bop;
use super::list::matching;
use super::matrix::{self, read_lines};
use super::tum;
use crate::files::{FileError, source};
use hangpose_core::geometry::Pose;

/// What the pose files say. Poses are as in the file, not yet inverted, but for BOP.
pub(super) enum Poses {
    /// One for each image, in order.
    InOrder(Vec<Pose>),
    /// By time, seconds.
    ByTime(Vec<(f64, Pose)>),
    /// By the number of the image, camera to world.
    ByNumber(Vec<(u64, Pose)>),
}

/// Reads the poses. The format of a file is told by its first line.
pub(super) fn read(pattern: &str) -> Result<Poses, ScanError> {
    let files = matching(pattern, "pose files")?;
    if let [file] = &files[..] {
        return Ok(read_one(file)?);
    }
    let mut poses = Vec::new();
    for path in &files {
        let lines = read_lines(path, REMEDY)?;
        match matrix::poses(path, &lines)?[..] {
            [pose] => poses.push(pose),
            _ => {
                return Err(
                    matrix::malformed(path, lines[0].0, "holds more than one pose".into(), REMEDY).into()
                );
            }
        }
    }
    Ok(Poses::InOrder(poses))
}

const REMEDY: &str = "give 4 x 4 matrices (one in each file or all in one), an Open3D .log, a TUM trajectory (time tx ty tz qx qy qz qw) or a BOP scene_camera.json";

fn read_one(path: &Path) -> Result<Poses, FileError> {
    let bytes = source::read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    if text.trim_start().starts_with('{') {
        let cameras = bop::read(path, &text)?;
        let poses = cameras.into_iter().filter_map(|(number, camera)| Some((number, camera.pose?)));
        return Ok(Poses::ByNumber(poses.collect()));
    }
    let lines = read_lines(path, REMEDY)?;
    match lines[0].1.len() {
        3 => matrix::log(path, &lines).map(Poses::InOrder),
        4 => matrix::poses(path, &lines).map(Poses::InOrder),
        8 => tum::poses(path, &lines).map(Poses::ByTime),
        count => Err(matrix::malformed(path, lines[0].0, format!("{count} numbers are no pose"), REMEDY)),
    }
}
