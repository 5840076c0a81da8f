//! Why the best pose on a scan fails on the true shapes.

use super::loss::Loss;
use super::row::{Failure, Outcome};
use super::seen::Seen;
use crate::judge::Limits;
use crate::solid::Solid;
use crate::winding::Winding;
use hangpose::geometry::Pose;
use hangpose::sample_supporter;
use nalgebra::Point3;
use parry3d::bounding_volume::BoundingVolume;
use parry3d::math;
use parry3d::query::PointQuery;
use parry3d::shape::TriMesh;
use std::collections::HashMap;

/// Number of samples of each true surface: one for about 3 mm² of a mug.
const SAMPLES: usize = 20_000;
/// Distance from the other shape up to which a sample is where the two collide, m.
const COLLIDING: f32 = 0.001;
/// Distance from the scanned surface, m, beyond which a true sample was not seen.
const UNSEEN: f32 = 0.003;
/// Share of the colliding samples of either shape that must be unseen for the collision to be by unseen surface.
const SHARE: f32 = 0.5;

/// Cause of the failure of an outcome; `None` if it succeeds. `pose` is where the shapes collide.
pub(super) fn cause(
    outcome: &Outcome,
    pose: &Pose,
    object: &Solid,
    supporter: &Solid,
    seen: &Seen,
) -> Option<Loss> {
    match outcome.failure()? {
        Failure::Penetration | Failure::Wedged if is_unseen(pose, object, supporter, seen) => {
            Some(Loss::Unseen)
        }
        Failure::Penetration | Failure::Wedged => Some(Loss::Inexact),
        _ if f64::from(outcome.sank) < Limits::DEFINITION.sinking => Some(Loss::Moves),
        _ => Some(Loss::Falls),
    }
}

/// Whether the scan lacks most of the surface of the object, or of the supporter, where the two collide.
fn is_unseen(pose: &Pose, object: &Solid, supporter: &Solid, seen: &Seen) -> bool {
    let scanned = seen.surface.shown();
    if scanned.is_empty() {
        return true;
    }
    let scanned = surface(&seen.surface.vertices, &scanned);
    let is_scanned = |point: &Point3<f32>| {
        scanned.distance_to_local_point(math::Vector::from_array((*point).into()), false) < UNSEEN
    };
    let measured = Near::new(&seen.cloud.points);
    mostly_unlike(&colliding(object, supporter, pose), is_scanned)
        || mostly_unlike(&colliding(supporter, object, &pose.inverse()), |point| measured.has(point))
}

/// Whether most of the points do not have a property.
fn mostly_unlike(points: &[Point3<f32>], is_so: impl Fn(&Point3<f32>) -> bool) -> bool {
    points.iter().filter(|point| !is_so(point)).count() as f32 > SHARE * points.len() as f32
}

/// Samples of a shape's surface that are within the other shape or on it, in coordinates of the first shape, which
/// `pose` maps to those of the other.
fn colliding(shape: &Solid, other: &Solid, pose: &Pose) -> Vec<Point3<f32>> {
    let samples = sample_supporter(&shape.mesh(), SAMPLES, 0).points;
    let surface = surface(&other.vertices, &other.triangles);
    let corner = |index: u32| Point3::from(other.vertices[index as usize]).cast::<f64>();
    let winding = Winding::new(other.triangles.iter().map(|triangle| triangle.map(corner)));
    let near = surface.local_aabb().loosened(COLLIDING);
    let collides = |point: &Point3<f32>| {
        let placed = pose * point;
        let at = math::Vector::from_array(placed.into());
        near.contains_local_point(at)
            && (surface.distance_to_local_point(at, true) < COLLIDING
                || winding.number(&placed.cast()).abs() > 0.5)
    };
    samples.into_iter().map(Point3::from).filter(collides).collect()
}

fn surface(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> TriMesh {
    let vertices = vertices.iter().map(|&vertex| vertex.into()).collect();
    TriMesh::new(vertices, triangles.to_vec()).expect("a pose needs triangles")
}

/// Points in cells as wide as [`UNSEEN`].
struct Near(HashMap<[i32; 3], Vec<Point3<f32>>>);

impl Near {
    fn new(points: &[[f32; 3]]) -> Self {
        let mut cells: HashMap<_, Vec<_>> = HashMap::new();
        for point in points.iter().copied().map(Point3::from) {
            cells.entry(Self::cell(&point)).or_default().push(point);
        }
        Self(cells)
    }

    fn cell(point: &Point3<f32>) -> [i32; 3] {
        point.coords.map(|x| (x / UNSEEN).floor() as i32).into()
    }

    /// Whether one of the points is near.
    fn has(&self, point: &Point3<f32>) -> bool {
        let [x, y, z] = Self::cell(point);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        around.filter_map(|cell| self.0.get(&cell)).flatten().any(|other| (other - point).norm() < UNSEEN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::{SeenCloud, Surface};

    /// A cube of 10 cm about the origin; with or without its face towards -x.
    fn cube(has_back: bool) -> Solid {
        let vertices = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|bit| 0.1 * bit as f32 - 0.05));
        let faces = [[1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1], [0, 4, 6, 2]];
        let shown = if has_back { &faces[..] } else { &faces[..5] };
        let triangles = shown.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Solid { vertices: vertices.collect(), triangles, ..Solid::default() }
    }

    #[test]
    fn a_collision_on_a_face_that_was_not_scanned_is_unseen() {
        let shape = cube(true);
        let cloud = sample_supporter(&shape.mesh(), 5000, 1);
        let cloud = SeenCloud { points: cloud.points, normals: None, viewpoints: Vec::new() };
        let scan = |has_back| {
            let Solid { vertices, triangles, .. } = cube(has_back);
            Seen {
                surface: Surface {
                    seen: vec![1; vertices.len()],
                    vertices,
                    triangles,
                    viewpoints: Vec::new(),
                },
                cloud: cloud.clone(),
            }
        };
        let outcome = Outcome::unclear(0.001);
        // The object's face towards +x or -x is 1 mm within the supporter.
        for (side, has_back, loss) in [
            (-1.0, true, Loss::Inexact),
            (-1.0, false, Loss::Inexact),
            (1.0, true, Loss::Inexact),
            (1.0, false, Loss::Unseen),
        ] {
            let pose = Pose::translation(side * 0.099, 0.0, 0.0);
            assert_eq!(
                cause(&outcome, &pose, &shape, &shape, &scan(has_back)),
                Some(loss),
                "{side} {has_back}"
            );
        }
    }
}
