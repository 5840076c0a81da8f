//! `scene_camera.json` of the BOP benchmark: intrinsics, depth scale and pose of each image, by the number in its name.

use std::collections::BTreeMap;
use std::path::Path;

use super::matrix::{NOT_RIGID, checked};
use super::rigid;
use crate::files::{FileError, Place};
use hangpose_core::geometry::Pose;
use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;

/// What the file says of one image.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BopCamera {
    /// fx, fy, cx, cy, pixels.
    pub(super) intrinsics: [f64; 4],
    /// Metres per unit of depth.
    pub(super) scale: f32,
    /// Camera to world.
    pub(super) pose: Option<Pose>,
}

#[derive(Deserialize)]
struct Entry {
    #[serde(rename = "cam_K")]
    intrinsics: [f64; 9],
    /// Millimetres per unit of depth.
    depth_scale: f64,
    #[serde(rename = "cam_R_w2c")]
    rotation: Option<[f64; 9]>,
    /// Millimetres.
    #[serde(rename = "cam_t_w2c")]
    translation: Option<[f64; 3]>,
}

/// The images of the file by their number.
pub(super) fn read(path: &Path, text: &str) -> Result<BTreeMap<u64, BopCamera>, FileError> {
    let malformed = |place, reason, remedy| FileError::Malformed { path: path.into(), place, reason, remedy };
    let remedy = "give a scene_camera.json with cam_K and depth_scale for each image";
    let entries: BTreeMap<u64, Entry> = serde_json::from_str(text)
        .map_err(|error| malformed(Place::Line(error.line()), error.to_string(), remedy))?;
    let camera = |(number, entry): (u64, Entry)| {
        let part = || Place::Part(format!("image {number}"));
        let pose = match (entry.rotation, entry.translation) {
            (Some(rotation), Some(translation)) => {
                let translation = Vector3::from(translation) / 1000.0;
                let pose = rigid::pose(&Matrix3::from_row_slice(&rotation), translation);
                Some(pose.map_err(|reason| malformed(part(), reason, NOT_RIGID))?.inverse())
            }
            _ => None,
        };
        let intrinsics = checked(entry.intrinsics).map_err(|reason| malformed(part(), reason, remedy))?;
        Ok((number, BopCamera { intrinsics, scale: (entry.depth_scale / 1000.0) as f32, pose }))
    };
    entries.into_iter().map(camera).collect()
}

/// The number in a file's name: 12 for `000012.png` and `000012_000003.png`.
pub(super) fn image_number(path: &Path) -> Option<u64> {
    let stem = path.file_stem()?.to_str()?;
    stem.split(|c: char| !c.is_ascii_digit()).find(|digits| !digits.is_empty())?.parse().ok()
}
