//! The point cloud of a supporter from depth images.

use super::frames;
use hangpose::perception::depth::DepthImage;
use hangpose::perception::depth_points::DepthPointsSettings;
use hangpose::{CLOUD_VOXEL, scan_cloud};

/// A cloud as a robot has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeenCloud {
    /// Points in world coordinates, m.
    pub points: Vec<[f32; 3]>,
    /// Normals that face the cameras which saw the points.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Positions of the cameras, m.
    pub viewpoints: Vec<[f32; 3]>,
}

/// The points of all images, as the command makes them; none if that is an error.
pub fn cloud(images: &[DepthImage]) -> SeenCloud {
    scan_cloud(&frames(images), CLOUD_VOXEL, &DepthPointsSettings::default())
        .map(|found| found.cloud)
        .map(|cloud| SeenCloud { points: cloud.points, normals: cloud.normals, viewpoints: cloud.viewpoints })
        .unwrap_or_default()
}
