//! Pictures of a pose at release and at rest, side by side.

use crate::solid::Solid;
use hangpose::geometry::Pose;
use hangpose::parry::pose_to_parry;
use image::{Rgb, RgbImage};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;
use std::path::Path;

/// Side length of each of the two pictures, pixels.
const SIDE: u32 = 320;
/// Direction from the supporter to the camera: in front of the wall, to the side and above.
const EYE: [f32; 3] = [0.75, -0.55, 0.37];
/// Distance of the camera, m; larger than any scene.
const FAR: f32 = 10.0;
const BACKGROUND: Rgb<u8> = Rgb([255, 255, 255]);
const OBJECT: [f32; 3] = [0.85, 0.45, 0.20];
const SUPPORTER: [f32; 3] = [0.45, 0.50, 0.60];

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
    let mut picture = RgbImage::from_pixel(2 * SIDE, SIDE, BACKGROUND);
    for (column, pose) in [(0, release), (SIDE, rest)] {
        draw(&mut picture, column, &seen, &object, &supporter, &pose_to_parry(pose));
    }
    picture.save(path)
}

fn mesh_of(solid: &Solid) -> TriMesh {
    let vertices = solid.vertices.iter().map(|&v| v.into()).collect();
    TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles")
}

/// Draws an orthographic view of the box `seen` into the square that begins at `column`.
fn draw(
    picture: &mut RgbImage,
    column: u32,
    seen: &Aabb,
    object: &TriMesh,
    supporter: &TriMesh,
    pose: &math::Pose,
) {
    let identity = math::Pose::IDENTITY;
    let back = math::Vector::from_array(EYE).normalize();
    let right = math::Vector::Z.cross(back).normalize();
    let up = back.cross(right);
    let (centre, reach) = (seen.center(), 0.5 * seen.extents().length());
    for y in 0..SIDE {
        for x in 0..SIDE {
            let [u, v] = [x, y].map(|k| (2.0 * (k as f32 + 0.5) / SIDE as f32 - 1.0) * reach);
            let ray = Ray::new(centre + right * u - up * v + back * FAR, -back);
            let hit = |mesh: &TriMesh, pose: &math::Pose, colour: [f32; 3]| {
                let hit = mesh.cast_ray_and_get_normal(pose, &ray, 2.0 * FAR, false)?;
                Some((hit.time_of_impact, hit.normal.dot(back).abs(), colour))
            };
            let hits = [hit(object, pose, OBJECT), hit(supporter, &identity, SUPPORTER)];
            let nearest = hits.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, light, colour)) = nearest {
                let shade = colour.map(|c| (255.0 * c * (0.35 + 0.65 * light)) as u8);
                picture.put_pixel(column + x, y, Rgb(shade));
            }
        }
    }
}
