//! The crop box that leaves room for what is behind the surfaces that images show.

use super::CompletionSettings;
use crate::geometry::{Aabb, MAX_COORDINATE, Point, Pose, Vector};
use crate::perception::depth::{DepthImage, Mask};

/// Every so many pixels in both directions are looked at for how far back other images show something.
const STRIDE: usize = 8;

/// Box in world coordinates around what the images show and around the room behind it that a completion may fill; `None`
/// if they show nothing up to the depth `max_depth`, metres, or the room is not finite. Behind the surface in an image there is room for an object as
/// deep as it appears narrow. `margin`, metres, is added on all sides; the truncation and two voxels suit a volume.
///
/// Each image may have a mask that says which pixels count. Of a mask that is too short the other pixels do not count;
/// [`Volume::integrate`](crate::perception::volume::Volume::integrate) says that it is.
pub fn room<'a>(
    images: impl Iterator<Item = (DepthImage<'a>, Option<Mask<'a>>)> + Clone,
    settings: &CompletionSettings,
    max_depth: f32,
    margin: f32,
) -> Option<Aabb> {
    let bounds = |to_frame: Pose, image, mask| {
        let points = points(image, mask, max_depth, 1).map(|point| to_frame * point);
        points.fold(None, |bounds: Option<Aabb>, point| {
            Some(bounds.map_or(Aabb { min: point, max: point }, |bounds| bounds.grow(&point)))
        })
    };
    let mut room: Option<Aabb> = None;
    for (image, mask) in images.clone() {
        let Some(world) = bounds(*image.pose(), image, mask) else { continue };
        let Some(camera) = bounds(Pose::identity(), image, mask) else { continue };
        let extents = camera.extents();
        let needed = extents.x.min(extents.y).min(2.0 * settings.radius).max(settings.thickness);
        let forward = image.pose().rotation * Vector::z();
        let depth = |point: &Point| (point - image.viewpoint()).dot(&forward);
        let others = images.clone().flat_map(|(image, mask)| {
            points(image, mask, max_depth, STRIDE).map(move |point| image.pose() * point)
        });
        let farthest = others.map(|point| depth(&point)).fold(camera.max.z, f32::max);
        let shift = forward * (camera.min.z + needed - farthest).max(0.0);
        let both = world.union(&Aabb { min: world.min + shift, max: world.max + shift });
        room = Some(room.map_or(both, |room| room.union(&both)));
    }
    let margin = Vector::repeat(margin);
    let room = room.map(|room| Aabb { min: room.min - margin, max: room.max + margin });
    // Lengths of the settings may be larger than any room.
    room.filter(|room| room.min.iter().chain(room.max.iter()).all(|x| x.is_finite()))
}

/// The points that an image shows, in camera coordinates, metres: those of every `stride`th pixel in both directions.
fn points<'a>(
    image: DepthImage<'a>,
    mask: Option<Mask<'a>>,
    max_depth: f32,
    stride: usize,
) -> impl Iterator<Item = Point> + 'a {
    let [width, height] = image.camera().size();
    let pixels =
        (0..height).step_by(stride).flat_map(move |v| (0..width).step_by(stride).map(move |u| [u, v]));
    pixels.filter_map(move |[u, v]| {
        let is_shown = mask.is_none_or(|mask| mask.holds(v as usize * width as usize + u as usize));
        // A lens may be said to distort so much that a pixel looks nowhere.
        let is_somewhere = |point: &Point| point.iter().all(|x| x.abs() <= MAX_COORDINATE);
        image.point(u, v).filter(|point| is_shown && point.z <= max_depth && is_somewhere(point))
    })
}
