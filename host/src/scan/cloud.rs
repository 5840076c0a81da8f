//! From depth images to the point cloud of a supporter.

use super::{FuseError, checked, extent};
use crate::files::CloudFile;
use crate::files::depth::ScanFrame;
use hangpose_core::geometry::Vector;
use hangpose_core::perception::depth_points::{
    DepthPoints, DepthPointsError, DepthPointsSettings, depth_points,
};
use hangpose_core::perception::volume::VolumeSettings;

/// A voxel size for [`scan_cloud`], metres: finer than a nail. It is the same near and far, since a larger one at a greater
/// distance leaves too few points on a hook.
pub const CLOUD_VOXEL: f32 = 0.002;

/// The points that depth images show.
#[derive(Clone, Debug)]
pub struct ScannedCloud {
    /// Points and normals in world coordinates, metres, and the positions of the cameras as viewpoints.
    pub cloud: CloudFile,
    /// What became of the pixels of all images, before those in the same voxel were merged.
    pub counts: DepthPoints,
    /// Part of the points of an image that reappear in the next; `None` for a single image.
    pub agreement: Option<f32>,
}

/// The points of all images with normals that face the cameras: the means of those that share a voxel of this size,
/// metres. Nothing is guessed. Each camera is a viewpoint of the cloud, so that the analysis of the supporter can tell what
/// none of them saw.
pub fn scan_cloud(
    frames: &[ScanFrame],
    voxel: f32,
    settings: &DepthPointsSettings,
) -> Result<ScannedCloud, FuseError> {
    let (max_depth, crop) = (settings.max_depth, settings.crop);
    VolumeSettings { crop, max_depth, ..VolumeSettings::new(voxel) }
        .validate()
        .map_err(|error| FuseError::Settings(error.into()))?;
    let (images, agreement) = checked(frames)?;
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    let mut all = DepthPoints::default();
    for (index, (image, frame)) in images.iter().zip(frames).enumerate() {
        let start = points.len();
        let most = start + image.depths().len();
        points.resize(most, [0.0; 3]);
        normals.resize(most, [0.0; 3]);
        let wrong = |error: DepthPointsError| FuseError::Points { index, error };
        let counts = depth_points(image, frame.mask(), settings, &mut points[start..], &mut normals[start..])
            .map_err(wrong)?;
        points.truncate(start + counts.points);
        normals.truncate(start + counts.points);
        all.points += counts.points;
        all.outside += counts.outside;
        all.flying += counts.flying;
        all.grazing += counts.grazing;
    }
    if points.is_empty() {
        return Err(FuseError::Outside { max_depth, seen: extent::of(frames) });
    }
    let (points, normals) = merged(&points, &normals, voxel);
    let viewpoints = images.iter().map(|image| image.viewpoint().into()).collect();
    let cloud = CloudFile { points, normals: Some(normals), viewpoints, ..CloudFile::default() };
    Ok(ScannedCloud { cloud, counts: all, agreement })
}

/// One point and normal for each voxel: the means of those in it. In the order of the voxels, so that the result depends on
/// nothing but the points.
fn merged(points: &[[f32; 3]], normals: &[[f32; 3]], voxel: f32) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let cell = |point: &[f32; 3]| point.map(|x| (x / voxel).floor() as i32);
    let mut order: Vec<([i32; 3], usize)> = points.iter().map(cell).zip(0..).collect();
    order.sort_unstable();
    let mean = |members: &[([i32; 3], usize)]| -> Option<([f32; 3], [f32; 3])> {
        let sum = |list: &[[f32; 3]]| members.iter().map(|(_, i)| Vector::from(list[*i])).sum::<Vector>();
        // Normals that cancel out are those of both sides of a sheet, which has no side.
        let normal = sum(normals).try_normalize(f32::EPSILON)?;
        Some(((sum(points) / members.len() as f32).into(), normal.into()))
    };
    order.chunk_by(|(a, _), (b, _)| a == b).filter_map(mean).unzip()
}
