//! Pictures of a pose at release and at rest, side by side, and of the way to a pose.

use crate::judge::replay::between;
use crate::solid::Solid;
use hangpose::geometry::{Point, Pose};
use hangpose::parry::pose_to_parry;
use image::{Rgb, RgbImage};
use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{self, Vector};
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;
use std::path::Path;

/// Side length of each of the two pictures of a pose, pixels.
const SIDE: u32 = 320;
/// Direction from the supporter to the camera: in front of the wall, to the side and above.
const EYE: [f32; 3] = [0.75, -0.55, 0.37];
/// Width of the picture of a way, pixels.
const WIDTH: u32 = 720;
/// Direction to the camera in the picture of a way: more from the side, so that a way to the wall does not hide its
/// end.
const ASIDE: [f32; 3] = [0.50, -0.78, 0.32];
/// Margin around what is seen of a way, as a share of its larger side.
const MARGIN: f32 = 0.04;
/// Rays for each pixel of the picture of a way along each of its sides.
const FINE: u32 = 2;
/// Number of poses on the way that are drawn, the start among them and the end not.
const ON_THE_WAY: usize = 6;
/// How much the first and the last of them hide of what is behind them.
const OPACITY: [f32; 2] = [0.30, 0.40];
/// Share of that by which they hide the supporter and the hanging object, so that these keep their colours.
const OVER_OPAQUE: f32 = 0.3;
/// Half the width of the line of the centre of mass, and the radius of the dots on it at the drawn poses, pixels.
const LINE: [f32; 2] = [1.2, 4.0];
/// Distance of the camera, m; larger than any scene.
const FAR: f32 = 10.0;
const BACKGROUND: [f32; 3] = [1.0; 3];
const OBJECT: [f32; 3] = [0.85, 0.45, 0.20];
const SUPPORTER: [f32; 3] = [0.45, 0.50, 0.60];
const CENTRE: [f32; 3] = [0.15, 0.25, 0.45];

/// The way of an object to the pose in which it hangs.
#[derive(Clone, Copy, Debug)]
pub struct Way<'a> {
    /// Its poses from the start to the end, at least one.
    pub poses: &'a [Pose],
    /// Its centre of mass, in its own coordinates.
    pub centre: [f32; 3],
}

/// Writes a PNG with the object at `release` on the left and at `rest` on the right, from the same viewpoint.
pub fn write(
    path: &Path,
    object: &Solid,
    supporter: &Solid,
    release: &Pose,
    rest: &Pose,
) -> image::ImageResult<()> {
    let [object, supporter] = [object, supporter].map(mesh_of);
    let seen = supporter.local_aabb().merged(&object.aabb(&pose_to_parry(release)));
    let mut picture = RgbImage::new(2 * SIDE, SIDE);
    let pixel = seen.extents().length() / SIDE as f32;
    let camera = Camera { centre: seen.center(), ..Camera::towards(EYE) };
    for (x, y, colour) in picture.enumerate_pixels_mut() {
        let pose = if x < SIDE { release } else { rest };
        let bodies = [
            Body::opaque(&supporter, math::Pose::IDENTITY, SUPPORTER),
            Body::opaque(&object, pose_to_parry(pose), OBJECT),
        ];
        let [u, v] = [x % SIDE, y].map(|k| (k as f32 + 0.5 - 0.5 * SIDE as f32) * pixel);
        *colour = rgb(camera.colour(&bodies, u, -v));
    }
    picture.save(path)
}

/// Writes a PNG with the object at `rest`, paler at poses that are evenly spread on the way, and with the line of its
/// centre of mass, which goes on to where that rests.
pub fn write_way(
    path: &Path,
    object: &Solid,
    supporter: &Solid,
    way: &Way,
    rest: &Pose,
) -> image::ImageResult<()> {
    let [object, supporter] = [object, supporter].map(mesh_of);
    let drawn = spread(way, &object);
    let mut bodies = vec![
        Body::opaque(&supporter, math::Pose::IDENTITY, SUPPORTER),
        Body::opaque(&object, pose_to_parry(rest), OBJECT),
    ];
    let [first, last] = OPACITY;
    for (index, pose) in drawn.iter().enumerate() {
        let opacity = first + (last - first) * index as f32 / (ON_THE_WAY - 1) as f32;
        bodies.push(Body { opacity, ..Body::opaque(&object, pose_to_parry(pose), OBJECT) });
    }

    // All corners in the view.
    let camera = Camera::towards(ASIDE);
    let corners = bodies.iter().flat_map(|body| {
        body.mesh.vertices().iter().map(|&vertex| camera.seen_at(body.pose.transform_point(vertex)))
    });
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for at in corners {
        low = [0, 1].map(|i| low[i].min(at[i]));
        high = [0, 1].map(|i| high[i].max(at[i]));
    }
    let margin = MARGIN * (high[0] - low[0]).max(high[1] - low[1]);
    let pixel = (high[0] - low[0] + 2.0 * margin) / WIDTH as f32;
    let height = ((high[1] - low[1] + 2.0 * margin) / pixel).ceil() as u32;
    let corner = [low[0] - margin, high[1] + margin];
    let on_picture = |pose: &Pose| {
        let at: [f32; 3] = (pose * Point::from(way.centre)).into();
        let [u, v] = camera.seen_at(at.into());
        [(u - corner[0]) / pixel, (corner[1] - v) / pixel]
    };
    let line: Vec<_> = way.poses.iter().chain([rest]).map(on_picture).collect();
    let dots: Vec<_> = drawn.iter().chain([rest]).map(on_picture).collect();

    let mut picture = RgbImage::new(WIDTH, height);
    for (x, y, colour) in picture.enumerate_pixels_mut() {
        let mut sum = [0.0; 3];
        for k in 0..FINE * FINE {
            let at = [(x, k % FINE), (y, k / FINE)]
                .map(|(whole, part)| whole as f32 + (part as f32 + 0.5) / FINE as f32);
            let on_line = line.windows(2).any(|pair| distance(at, [pair[0], pair[1]]) <= LINE[0]);
            let seen = if on_line || dots.iter().any(|&dot| distance(at, [dot, dot]) <= LINE[1]) {
                CENTRE
            } else {
                camera.colour(&bodies, corner[0] + at[0] * pixel, corner[1] - at[1] * pixel)
            };
            sum = [0, 1, 2].map(|i| sum[i] + seen[i]);
        }
        *colour = rgb(sum.map(|c| c / (FINE * FINE) as f32));
    }
    picture.save(path)
}

fn mesh_of(solid: &Solid) -> TriMesh {
    let vertices = solid.vertices.iter().map(|&v| v.into()).collect();
    TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles")
}

/// Poses at even distances on the way. The distance of two poses is the most that a point of the object can move.
fn spread(way: &Way, object: &TriMesh) -> Vec<Pose> {
    let centre = Point::from(way.centre);
    let reach = object.vertices().iter().map(|vertex| (Point::from(vertex.to_array()) - centre).norm());
    let reach = reach.fold(0.0, f32::max);
    let moved = |from: &Pose, to: &Pose| {
        (to * centre - from * centre).norm() + reach * from.rotation.angle_to(&to.rotation)
    };
    let moves: Vec<f32> = way.poses.windows(2).map(|pair| moved(&pair[0], &pair[1])).collect();
    let all: f32 = moves.iter().sum();
    let at = |index: usize| {
        let mut left = all * index as f32 / ON_THE_WAY as f32;
        for (pair, &moves) in way.poses.windows(2).zip(&moves) {
            if left < moves {
                let [from, to] = [&pair[0], &pair[1]].map(|pose| pose.cast::<f64>());
                return between(&from, &to, &centre.cast(), f64::from(left / moves)).cast();
            }
            left -= moves;
        }
        way.poses[way.poses.len() - 1]
    };
    (0..ON_THE_WAY).map(at).collect()
}

/// A mesh at a pose, with a colour.
struct Body<'a> {
    mesh: &'a TriMesh,
    pose: math::Pose,
    colour: [f32; 3],
    /// How much it hides of what is behind it.
    opacity: f32,
}

impl<'a> Body<'a> {
    fn opaque(mesh: &'a TriMesh, pose: math::Pose, colour: [f32; 3]) -> Self {
        Self { mesh, pose, colour, opacity: 1.0 }
    }
}

/// An orthographic view.
struct Camera {
    /// What is in the middle.
    centre: Vector,
    right: Vector,
    up: Vector,
    back: Vector,
}

impl Camera {
    /// The camera in this direction from the origin, which is in the middle.
    fn towards(eye: [f32; 3]) -> Self {
        let back = Vector::from_array(eye).normalize();
        let right = Vector::Z.cross(back).normalize();
        Self { centre: Vector::ZERO, right, up: back.cross(right), back }
    }

    /// Where a point is in the view, right and up from the middle, m.
    fn seen_at(&self, point: Vector) -> [f32; 2] {
        [self.right, self.up].map(|axis| axis.dot(point - self.centre))
    }

    /// The colour at a place in the view.
    fn colour(&self, bodies: &[Body], u: f32, v: f32) -> [f32; 3] {
        let ray = Ray::new(self.centre + self.right * u + self.up * v + self.back * FAR, -self.back);
        let hit = |body: &Body| {
            let hit = body.mesh.cast_ray_and_get_normal(&body.pose, &ray, 2.0 * FAR, false)?;
            let shade = 0.35 + 0.65 * hit.normal.dot(self.back).abs();
            Some((hit.time_of_impact, body.colour.map(|c| c * shade), body.opacity))
        };
        let mut hits: Vec<_> = bodies.iter().filter_map(hit).collect();
        hits.sort_by(|a, b| b.0.total_cmp(&a.0));
        let nothing = (BACKGROUND, 1.0);
        let (colour, _) = hits.into_iter().fold(nothing, |(behind, share), (_, colour, opacity)| {
            if opacity == 1.0 {
                return (colour, OVER_OPAQUE);
            }
            ([0, 1, 2].map(|i| behind[i] + (colour[i] - behind[i]) * opacity * share), share)
        });
        colour
    }
}

/// Distance of a point from a segment in the plane.
fn distance(point: [f32; 2], [from, to]: [[f32; 2]; 2]) -> f32 {
    let [point, from, to] = [point, from, to].map(nalgebra::Vector2::from);
    let (along, away) = (to - from, point - from);
    let share = (away.dot(&along) / along.norm_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    (away - along * share).norm()
}

fn rgb(colour: [f32; 3]) -> Rgb<u8> {
    Rgb(colour.map(|c| (255.0 * c) as u8))
}
