//! Which pose belongs to which image.

use std::path::{Path, PathBuf};

use super::camera::CameraFile;
use super::list::Listed;
use super::poses::{self, Poses};
use super::{ScanError, ScanSources, bop, tum};
use hangpose_core::geometry::Pose;

/// An image with its pose, camera to world, and its place among all that were found.
pub(super) struct Posed {
    pub(super) index: usize,
    pub(super) path: PathBuf,
    pub(super) pose: Pose,
}

/// The images that have a pose.
pub(super) struct Paired {
    pub(super) images: Vec<Posed>,
    /// What was left out, as sentences for the user.
    pub(super) notes: Vec<String>,
}

/// Finds the pose of each image.
pub(super) fn pair(
    images: Vec<Listed>,
    camera: &CameraFile,
    sources: &ScanSources,
) -> Result<Paired, ScanError> {
    let count = images.len();
    let upright = |pose: Pose| if sources.world_to_camera { pose.inverse() } else { pose };
    let in_order = |poses: Vec<Pose>| {
        let posed = |(index, (image, pose)): (usize, (&Listed, Pose))| Posed {
            index,
            path: image.path.clone(),
            pose,
        };
        let images = images.iter().zip(poses).enumerate().map(posed).collect();
        Ok(Paired { images, notes: Vec::new() })
    };
    let Some(pattern) = &sources.poses else {
        return match camera {
            CameraFile::Bop(cameras) if cameras.values().any(|camera| camera.pose.is_some()) => {
                let of = |number| cameras.get(&number).and_then(|camera| camera.pose);
                in_order(by_number(&images, &sources.camera, of)?)
            }
            CameraFile::One(pinhole) if count == 1 => in_order(vec![pinhole.pose.unwrap_or_default()]),
            CameraFile::Bop(_) if count == 1 => in_order(vec![Pose::identity()]),
            _ => Err(ScanError::NoPoses { images: count }),
        };
    };
    match poses::read(pattern)? {
        Poses::InOrder(poses) if poses.len() == count => in_order(poses.into_iter().map(upright).collect()),
        Poses::InOrder(poses) => {
            let pattern = pattern.clone();
            Err(ScanError::Count { pattern, what: "poses", count: poses.len(), images: count })
        }
        Poses::ByNumber(poses) => {
            let of = |number| poses.iter().find(|(n, _)| *n == number).map(|(_, pose)| *pose);
            in_order(by_number(&images, Path::new(pattern), of)?)
        }
        Poses::ByTime(mut trajectory) => {
            trajectory.iter_mut().for_each(|(_, pose)| *pose = upright(*pose));
            by_time(images, &trajectory, pattern)
        }
    }
}

/// The pose of each image by the number in its name.
fn by_number(
    images: &[Listed],
    path: &Path,
    of: impl Fn(u64) -> Option<Pose>,
) -> Result<Vec<Pose>, ScanError> {
    let pose = |image: &Listed| {
        bop::image_number(&image.path).and_then(&of).ok_or_else(|| no_entry(path, &image.path))
    };
    images.iter().map(pose).collect()
}

/// The images that have a pose near in time.
fn by_time(images: Vec<Listed>, trajectory: &[(f64, Pose)], pattern: &str) -> Result<Paired, ScanError> {
    let count = images.len();
    let (mut kept, mut least) = (Vec::new(), f64::INFINITY);
    for (index, image) in images.into_iter().enumerate() {
        let Some(time) = image.time else {
            return Err(ScanError::NoTime { image: image.path, pattern: pattern.into() });
        };
        let Some((gap, pose)) = tum::nearest(trajectory, time) else { continue };
        least = least.min(gap);
        if gap <= tum::MAX_GAP {
            kept.push(Posed { index, path: image.path, pose });
        }
    }
    if kept.is_empty() {
        return Err(ScanError::Times { pattern: pattern.into(), limit: tum::MAX_GAP, nearest: least });
    }
    let mut notes = Vec::new();
    if kept.len() < count {
        let (dropped, limit) = (count - kept.len(), tum::MAX_GAP);
        notes.push(format!(
            "{pattern}: {dropped} of {count} images have no pose within {limit} s and are left out"
        ));
    }
    Ok(Paired { images: kept, notes })
}

pub(super) fn no_entry(path: &Path, image: &Path) -> ScanError {
    ScanError::NoEntry { path: path.into(), image: image.into() }
}
