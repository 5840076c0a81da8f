//! Penetration depth of two arbitrary surfaces.
//!
//! The depth is the usual one: the length of the shortest translation that separates the shapes. It is found by trial.
//! An engine's depth for the prisms of a shell is not a measure of it, since it cannot exceed the thickness of the
//! shell.

use super::Scene;
use crate::solid::Solid;
use crate::winding::Winding;
use hangpose::geometry::Pose;
use hangpose::parry::pose_to_parry;
use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use parry3d::query;
use parry3d::shape::TriMesh;

/// Lengths of the translations that are tried, m. The last one is also the depth of anything deeper.
const SHIFTS: [f64; 8] = [0.00025, 0.0005, 0.001, 0.0015, 0.002, 0.004, 0.008, 0.016];
/// Scale of the surfaces, from metres to millimetres: in metres, parry's tolerances make narrow triangles intersect
/// that are far apart.
const SCALE: f32 = 1000.0;
/// Number of vertices of each shape that are tested for being inside the other. Without crossing surfaces one vertex
/// per body would suffice.
const PROBES: usize = 8;

/// An overlap test of an object and a supporter.
pub(crate) struct Overlap {
    object: Side,
    supporter: Side,
}

/// One of the two shapes.
struct Side {
    surface: TriMesh,
    probes: Vec<Point3<f64>>,
    /// Winding number, for closed surfaces only.
    inside: Option<Winding>,
}

impl Overlap {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self { object: Side::new(scene.object), supporter: Side::new(scene.supporter) }
    }

    /// The smallest of [`SHIFTS`] that separates the shapes, m; 0 if they do not overlap.
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

    /// The pose displaced by as little as separates the shapes, upwards if possible; `None` if `most` metres do not.
    pub(super) fn separated(&self, pose: &Isometry3<f64>, most: f64) -> Option<Isometry3<f64>> {
        let shifts = SHIFTS.into_iter().take_while(|shift| *shift <= most);
        let ways = || std::iter::once(Vector3::z()).chain(directions());
        let mut moved =
            shifts.flat_map(|shift| ways().map(move |way| Translation3::from(way * shift) * pose));
        moved.find(|moved| self.is_free(moved))
    }

    /// Whether the shapes do not overlap.
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

/// Unit vectors towards the faces, edges and corners of a cube.
fn directions() -> impl Iterator<Item = Vector3<f64>> {
    (0..27).filter_map(|k| {
        Vector3::from([k % 3, k / 3 % 3, k / 9].map(|digit| f64::from(digit) - 1.0)).try_normalize(0.0)
    })
}
