//! A picture of one pose without a browser.

use super::display::{MAX_POINTS, ShownMesh, shown_points, thinned};
use super::picture::{FORCE, GUESSED, OBJECT, Picture, SUPPORTER};
use super::{Scene, ShownPose};
use crate::geometry::{Point, Pose};
use parry3d::math;
use parry3d::shape::TriMesh;

/// Width of the picture, pixels.
const WIDTH: u32 = 900;
/// Direction to the camera: in front, to the side and above. With a way more from the side, which shows it better.
const EYE: [f32; 3] = [0.75, -0.55, 0.37];
const ASIDE: [f32; 3] = [0.50, -0.78, 0.32];
/// Length of the arrow of a force as large as the weight, as a share of the extent of the object.
const ARROW: f32 = 0.25;

/// A PNG of the pose of this index: the supporter as seen, the object where it hangs and, paler, on its way there, the line of
/// its centre of mass, and contact forces. Without any pose it shows the supporter alone.
pub fn snapshot(scene: &Scene, index: usize) -> Vec<u8> {
    let mesh = ShownMesh::of(scene.mesh);
    let corners = mesh.vertices.iter().map(|&vertex| math::Vector::from_array(vertex)).collect();
    let object = TriMesh::new(corners, mesh.triangles).ok();
    let pose = scene.poses.get(index);
    let way = pose.map(ShownPose::path).unwrap_or_default();
    let mut picture = Picture::new(if way.is_empty() { EYE } else { ASIDE }, &scene.params.up());

    let (points, normals) = shown_points(scene.cloud);
    picture.add_cloud(&points, &normals, SUPPORTER);
    let guessed: Vec<[f32; 3]> = scene.supporter.guessed_points().map(Into::into).collect();
    let obstacles: Vec<[f32; 3]> =
        thinned(scene.request.scene.len(), MAX_POINTS).map(|index| scene.request.scene[index]).collect();
    for others in [guessed, obstacles] {
        if !others.is_empty() {
            picture.add_cloud(&others, &[], GUESSED);
        }
    }
    if let (Some(pose), Some(object)) = (pose, &object) {
        let rest = pose.rest().unwrap_or(pose.release());
        let way: Vec<Pose> = way.into_iter().chain([*rest]).collect();
        picture.add_way(object, &way, &scene.object.centre_of_mass(), OBJECT);
        let extent = scene.object.surface().aabb().diagonal();
        for (position, force) in pose.contacts() {
            picture.add_line(vec![position, Point::from(position.coords + force * (ARROW * extent))], FORCE);
            picture.add_dot(position, FORCE);
        }
    }
    picture.png(WIDTH)
}
