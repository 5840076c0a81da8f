//! Poses of the caller's own: JSON with a position and a quaternion, or a prediction.

use anyhow::{Context, Result, anyhow, ensure};
use hangpose::geometry::{Pose, Vector};
use hangpose::hanging::{HangingPose, Rest};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion};
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;

/// A pose as its file gives it, in the supporter frame; an entry of `poses` of a prediction is one, too.
#[derive(Deserialize)]
struct Entry {
    position: [f64; 3],
    quaternion_xyzw: [f64; 4],
    /// Row-major.
    rest_pose: Option<[f64; 16]>,
}

/// Largest difference from a rotation, for the rounding of what is printed.
const ROUNDING: f64 = 1e-3;

/// The pose in a file, as an offset from `origin`.
pub(super) fn pose(path: &Path, origin: [f64; 3]) -> Result<Pose> {
    let entry = entry(path, read(path)?)?;
    released(&entry, origin).with_context(|| path.display().to_string())
}

/// The hanging pose in a file, or the one with this rank of a prediction, as an offset from `origin`.
pub(super) fn hanging_pose(path: &Path, rank: u32, origin: [f64; 3]) -> Result<HangingPose> {
    let at = || path.display().to_string();
    let mut document = read(path)?;
    let chosen = match document.get_mut("poses").and_then(Value::as_array_mut) {
        Some(poses) => {
            let count = poses.len();
            ensure!(count > 0, "{}: the prediction has no pose; give one that has", at());
            ensure!(rank as usize <= count, "{}: there is no pose {rank}: pass --rank 1 to {count}", at());
            poses.swap_remove(rank as usize - 1)
        }
        None => {
            ensure!(rank == 1, "{}: is a single pose: leave out --rank", at());
            document
        }
    };
    hanging_pose_of(path, chosen, origin)
}

/// The hanging pose that a value of the file at `path` gives, as an offset from `origin`.
pub(super) fn hanging_pose_of(path: &Path, value: Value, origin: [f64; 3]) -> Result<HangingPose> {
    let at = || path.display().to_string();
    let entry = entry(path, value)?;
    let pose = released(&entry, origin).with_context(at)?;
    let rest = entry.rest_pose.map(|rows| rested(&rows, origin)).transpose().with_context(at)?;
    Ok(HangingPose { pose, rest: rest.map(Rest::at), matched: None })
}

/// The JSON in a file.
pub(super) fn read(path: &Path) -> Result<Value> {
    let at = || path.display().to_string();
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{}: cannot be read; give a readable JSON file of a pose", at()))?;
    serde_json::from_str(&text).with_context(|| format!("{}: is no JSON", at()))
}

fn entry(path: &Path, value: Value) -> Result<Entry> {
    serde_json::from_value(value).map_err(|error| {
        anyhow!(
            "{}: {error}; give {{\"position\": [x, y, z], \"quaternion_xyzw\": [x, y, z, w]}} in the supporter frame, metres",
            path.display()
        )
    })
}

fn released(entry: &Entry, origin: [f64; 3]) -> Result<Pose> {
    let [x, y, z, w] = entry.quaternion_xyzw;
    let quaternion = Quaternion::new(w, x, y, z);
    ensure!(
        (quaternion.norm() - 1.0).abs() < ROUNDING,
        "the quaternion ({x}, {y}, {z}, {w}) is not of unit length; give x, y, z, w of a rotation"
    );
    Ok(moved(entry.position, UnitQuaternion::from_quaternion(quaternion), origin))
}

fn rested(rows: &[f64; 16], origin: [f64; 3]) -> Result<Pose> {
    let matrix = Matrix3::from_fn(|row, column| rows[4 * row + column]);
    let error = (matrix * matrix.transpose() - Matrix3::identity()).norm();
    ensure!(
        error < ROUNDING && matrix.determinant() > 0.0,
        "rest_pose is no row-major 4 x 4 matrix of a rotation and a position; leave it out if it is not known"
    );
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
    Ok(moved([rows[3], rows[7], rows[11]], rotation, origin))
}

fn moved(position: [f64; 3], rotation: UnitQuaternion<f64>, origin: [f64; 3]) -> Pose {
    let position = Vector::from([0, 1, 2].map(|i| (position[i] - origin[i]) as f32));
    Pose::from_parts(position.into(), rotation.cast())
}
