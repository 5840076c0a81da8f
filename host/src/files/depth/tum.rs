//! Trajectories of the TUM RGB-D benchmark: `time tx ty tz qx qy qz qw` on each line.

use std::path::Path;

use super::matrix::{Line, NOT_RIGID, malformed};
use crate::files::FileError;
use hangpose_core::geometry::Pose;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Greatest deviation of a quaternion's length from one.
const TOLERANCE: f64 = 0.01;
/// Greatest time between an image and its pose, seconds: less than one image at 30 Hz.
pub(super) const MAX_GAP: f64 = 0.02;

/// The times, seconds, and poses of a trajectory, by time.
pub(super) fn poses(path: &Path, lines: &[Line]) -> Result<Vec<(f64, Pose)>, FileError> {
    let remedy = "write time, tx ty tz and qx qy qz qw on each line";
    let pose = |(number, values): &Line| {
        let [time, x, y, z, i, j, k, w] = values[..] else {
            let reason = format!("expected eight numbers, found {}", values.len());
            return Err(malformed(path, *number, reason, remedy));
        };
        let quaternion = Quaternion::new(w, i, j, k);
        if !((quaternion.norm() - 1.0).abs() <= TOLERANCE && [time, x, y, z].iter().all(|x| x.is_finite())) {
            let reason =
                format!("the pose is not rigid: its quaternion has the length {}", quaternion.norm());
            return Err(malformed(path, *number, reason, NOT_RIGID));
        }
        let rotation = UnitQuaternion::from_quaternion(quaternion).cast();
        Ok((time, Pose::from_parts(Vector3::new(x, y, z).cast::<f32>().into(), rotation)))
    };
    let mut poses: Vec<_> = lines.iter().map(pose).collect::<Result<_, _>>()?;
    poses.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(poses)
}

/// The pose nearest in time, and the time between, seconds.
pub(super) fn nearest(poses: &[(f64, Pose)], time: f64) -> Option<(f64, Pose)> {
    let after = poses.partition_point(|(t, _)| *t < time);
    let candidates = poses[after.saturating_sub(1)..].iter().take(2);
    candidates.map(|(t, pose)| ((t - time).abs(), *pose)).min_by(|a, b| a.0.total_cmp(&b.0))
}
