//! Pictures of a pose at release and at rest, and of the way to a pose.

use crate::solid::Solid;
use hangpose::geometry::{Point, Pose, Vector};
use hangpose::view::picture::{OBJECT, Picture, SUPPORTER};
use parry3d::shape::TriMesh;
use std::io;
use std::path::Path;

/// Width of a picture, pixels.
const WIDTH: u32 = 720;
/// Direction from the supporter to the camera: in front of the wall, to the side and above.
const EYE: [f32; 3] = [0.75, -0.55, 0.37];
/// Direction to the camera in the picture of a way: more from the side, so that a way to the wall does not hide its
/// end.
pub(crate) const ASIDE: [f32; 3] = [0.50, -0.78, 0.32];
/// How much the object at release hides of what is behind it.
const RELEASED: f32 = 0.35;

/// The way of an object to the pose in which it hangs.
#[derive(Clone, Copy, Debug)]
pub struct Way<'a> {
    /// Its poses from the start to the end, at least one.
    pub poses: &'a [Pose],
    /// Its centre of mass, in its own coordinates.
    pub centre: [f32; 3],
}

/// Writes a PNG with the object at `rest`, and paler at `release`.
pub fn write(path: &Path, object: &Solid, supporter: &Solid, release: &Pose, rest: &Pose) -> io::Result<()> {
    let [object, supporter] = [object, supporter].map(mesh_of);
    let mut picture = Picture::new(EYE, &Vector::z());
    picture.add_mesh(&supporter, &Pose::identity(), SUPPORTER, 1.0);
    picture.add_mesh(&object, rest, OBJECT, 1.0);
    picture.add_mesh(&object, release, OBJECT, RELEASED);
    std::fs::write(path, picture.png(WIDTH))
}

/// Writes a PNG with the object at `rest`, paler at poses that are evenly spread on the way, and with the line of its
/// centre of mass, which goes on to where that rests.
pub fn write_way(path: &Path, object: &Solid, supporter: &Solid, way: &Way, rest: &Pose) -> io::Result<()> {
    let [object, supporter] = [object, supporter].map(mesh_of);
    let mut picture = Picture::new(ASIDE, &Vector::z());
    picture.add_mesh(&supporter, &Pose::identity(), SUPPORTER, 1.0);
    let poses: Vec<Pose> = way.poses.iter().chain([rest]).copied().collect();
    picture.add_way(&object, &poses, &Point::from(way.centre), OBJECT);
    std::fs::write(path, picture.png(WIDTH))
}

pub(crate) fn mesh_of(solid: &Solid) -> TriMesh {
    let vertices = solid.vertices.iter().map(|&v| v.into()).collect();
    TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles")
}
