//! How large the things are that depth images show.

use crate::files::depth::ScanFrame;
use hangpose_core::geometry::{Aabb, Point};
use hangpose_core::perception::depth::DepthImage;

/// Every so many pixels in both directions are looked at.
const STRIDE: usize = 8;
/// Size of a voxel in largest extents of what the images show.
const VOXEL: f32 = 0.01;
/// Least and greatest suggested voxel, metres: the pitch of the pixels of most cameras at arm's length, and the thickness
/// of a wire.
const VOXELS: [f32; 2] = [0.0015, 0.003];

/// A voxel size for [`scan`](crate::scan()) and [`complete_scan`](crate::complete_scan), metres: a hundredth of the largest
/// extent of what the images show up to the depth `max_depth`, metres, in the box `crop`, but 1.5 to 3 mm.
pub fn suggested_voxel(frames: &[ScanFrame], max_depth: f32, crop: Option<Aabb>) -> f32 {
    (VOXEL * Aabb::of(&all(frames, max_depth, crop)).extents().max()).clamp(VOXELS[0], VOXELS[1])
}

/// The box around what the images show, of the mask's label where there is one.
pub(super) fn of(frames: &[ScanFrame]) -> Aabb {
    Aabb::of(&all(frames, f32::INFINITY, None))
}

/// Some of the points of all images up to a depth, metres, in a box, in world coordinates.
fn all(frames: &[ScanFrame], max_depth: f32, crop: Option<Aabb>) -> Vec<Point> {
    let images = frames.iter().filter_map(|frame| Some((frame, frame.image().ok()?)));
    images
        .flat_map(|(frame, image)| points(frame, &image, max_depth))
        .filter(|point| crop.is_none_or(|crop| crop.contains(point)))
        .collect()
}

/// Some of the points of an image up to a depth, metres, in world coordinates.
fn points(frame: &ScanFrame, image: &DepthImage, max_depth: f32) -> Vec<Point> {
    let [width, height] = image.camera().size();
    let pixels = (0..height).step_by(STRIDE).flat_map(|v| (0..width).step_by(STRIDE).map(move |u| (u, v)));
    let is_shown =
        |u, v| frame.mask().is_none_or(|mask| mask.labels.get((v * width + u) as usize) == Some(&mask.label));
    pixels
        .filter(|(u, v)| is_shown(*u, *v))
        .filter_map(|(u, v)| image.point(u, v).filter(|point| point.z <= max_depth))
        .map(|point| image.pose() * point)
        .collect()
}
