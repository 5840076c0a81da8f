//! How deep two surfaces are in each other, whatever they are made of.
//!
//! The depth is that of the literature: the shortest shift after which nothing overlaps any more. It is tried out. What
//! an engine says of a shell's prisms is no measure of it, since none is deeper than the shell is thick.

use super::Scene;
use crate::solid::Solid;
use crate::winding::Winding;
use hangpose::geometry::Pose;
use hangpose::parry::pose_to_parry;
use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use parry3d::query;
use parry3d::shape::TriMesh;

/// Shifts that are tried, metres. The last is not passed: what overlaps more deeply is said to be this deep.
const SHIFTS: [f64; 8] = [0.00025, 0.0005, 0.001, 0.0015, 0.002, 0.004, 0.008, 0.016];
/// Surfaces are held in millimetres: in metres, parry's tolerances make narrow triangles meet that are far apart.
const SCALE: f32 = 1000.0;
/// Vertices of each shape that are looked for inside the other. If no surfaces cross, one of each body would do.
const PROBES: usize = 8;

pub(crate) struct Overlap {
    object: Side,
    supporter: Side,
}

/// One of the two shapes.
struct Side {
    surface: TriMesh,
    probes: Vec<Point3<f64>>,
    /// Only what is closed can have something inside.
    inside: Option<Winding>,
}

impl Overlap {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self { object: Side::new(scene.object), supporter: Side::new(scene.supporter) }
    }

    /// The least of [`SHIFTS`] that frees the object; 0 if it is free.
    pub(super) fn depth(&self, pose: &Isometry3<f64>) -> f64 {
        if self.is_free(pose) {
            return 0.0;
        }
        let [.., deepest] = SHIFTS;
        let frees = |shift: &f64| {
            directions().any(|direction| self.is_free(&(Translation3::from(direction * *shift) * pose)))
        };
        SHIFTS.into_iter().find(frees).unwrap_or(deepest)
    }

    /// Whether nothing overlaps.
    pub(crate) fn is_free(&self, pose: &Isometry3<f64>) -> bool {
        let mut into_supporter: Pose = pose.cast();
        into_supporter.translation.vector *= SCALE;
        let crossing = query::intersection_test(
            &pose_to_parry(&Pose::identity()),
            &self.supporter.surface,
            &pose_to_parry(&into_supporter),
            &self.object.surface,
        );
        !crossing.expect("meshes can be tested").intersecting
            && !self.supporter.contains_any(&self.object.probes, pose)
            && !self.object.contains_any(&self.supporter.probes, &pose.inverse())
    }
}

impl Side {
    fn new(solid: &Solid) -> Self {
        let points = solid.vertices.iter().map(|vertex| vertex.map(|x| x * SCALE).into()).collect();
        let step = solid.vertices.len().div_ceil(PROBES).max(1);
        Self {
            surface: TriMesh::new(points, solid.triangles.clone()).expect("a shape has triangles"),
            probes: solid.vertices.iter().step_by(step).map(|&vertex| Point3::from(vertex).cast()).collect(),
            inside: solid.is_closed().then(|| Winding::new(corners(solid))),
        }
    }

    fn contains_any(&self, points: &[Point3<f64>], pose: &Isometry3<f64>) -> bool {
        let aabb = self.surface.local_aabb();
        self.inside.as_ref().is_some_and(|winding| {
            points.iter().map(|point| pose * point).any(|point| {
                let is_near = aabb.contains_local_point(<[f32; 3]>::from(point.cast::<f32>() * SCALE).into());
                is_near && winding.number(&point).abs() > 0.5
            })
        })
    }
}

fn corners(solid: &Solid) -> impl Iterator<Item = [Point3<f64>; 3]> {
    let at = |index: u32| Point3::from(solid.vertices[index as usize]).cast();
    solid.triangles.iter().map(move |triangle| triangle.map(at))
}

/// Towards the faces, edges and corners of a cube.
fn directions() -> impl Iterator<Item = Vector3<f64>> {
    (0..27).filter_map(|k| {
        Vector3::from([k % 3, k / 3 % 3, k / 9].map(|digit| f64::from(digit) - 1.0)).try_normalize(0.0)
    })
}
