//! Intrinsics: a 3 x 3 matrix as text, JSON of Open3D, or `scene_camera.json` of BOP.

use std::collections::BTreeMap;
use std::path::Path;

use super::bop::{self, BopCamera};
use super::matrix::{self, NOT_RIGID, checked};
use super::rigid;
use crate::files::{FileError, Place, source};
use hangpose_core::geometry::Pose;
use nalgebra::Matrix4;
use serde::Deserialize;
use serde_json::Value;

/// What a camera file says.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum CameraFile {
    /// The same for all images.
    One(Pinhole),
    /// By the number of the image.
    Bop(BTreeMap<u64, BopCamera>),
}

/// One camera.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pinhole {
    /// Width and height, pixels, where the file says them.
    pub(super) size: Option<[u32; 2]>,
    /// fx, fy, cx, cy, pixels.
    pub(super) intrinsics: [f64; 4],
    /// Camera to world, where the file says it.
    pub(super) pose: Option<Pose>,
}

/// `PinholeCameraIntrinsic` of Open3D.
#[derive(Deserialize)]
struct Intrinsic {
    width: u32,
    height: u32,
    /// Column by column.
    intrinsic_matrix: [f64; 9],
}

/// `PinholeCameraParameters` of Open3D.
#[derive(Deserialize)]
struct Parameters {
    /// World to camera, column by column.
    extrinsic: [f64; 16],
    intrinsic: Intrinsic,
}

/// Reads a camera file. JSON is told by its first character.
pub(super) fn read(path: &Path) -> Result<CameraFile, FileError> {
    let bytes = source::read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    if !text.trim_start().starts_with('{') {
        let intrinsics = matrix::intrinsics(path)?;
        return Ok(CameraFile::One(Pinhole { size: None, intrinsics, pose: None }));
    }
    let remedy =
        "give JSON of Open3D (PinholeCameraIntrinsic or PinholeCameraParameters) or BOP (scene_camera.json)";
    let malformed = |place, reason, remedy| FileError::Malformed { path: path.into(), place, reason, remedy };
    let broken = |error: serde_json::Error| malformed(Place::Line(error.line()), error.to_string(), remedy);
    let value: Value = serde_json::from_str(&text).map_err(broken)?;
    let (intrinsic, extrinsic) = if value.get("intrinsic_matrix").is_some() {
        (serde_json::from_str::<Intrinsic>(&text).map_err(broken)?, None)
    } else if value.get("intrinsic").is_some() {
        let Parameters { extrinsic, intrinsic } = serde_json::from_str(&text).map_err(broken)?;
        (intrinsic, Some(extrinsic))
    } else {
        return bop::read(path, &text).map(CameraFile::Bop);
    };
    let k = intrinsic.intrinsic_matrix;
    let rows = [k[0], k[3], k[6], k[1], k[4], k[7], k[2], k[5], k[8]];
    let intrinsics =
        checked(rows).map_err(|reason| malformed(Place::Part("intrinsic_matrix".into()), reason, remedy))?;
    let pose = extrinsic.map(|columns| {
        let rows = Matrix4::from_column_slice(&columns).transpose();
        rigid::of_rows(rows.as_slice())
            .map(|pose| pose.inverse())
            .map_err(|reason| malformed(Place::Part("extrinsic".into()), reason, NOT_RIGID))
    });
    let size = Some([intrinsic.width, intrinsic.height]);
    Ok(CameraFile::One(Pinhole { size, intrinsics, pose: pose.transpose()? }))
}
