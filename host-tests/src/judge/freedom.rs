//! How an object hangs, judged by the motions that free it, on the true surfaces.
//!
//! The object is moved along straight lines in small steps and stopped where the surfaces overlap. This knows nothing of
//! openings and bars and is an approximation.

use super::verdict::bounds;
use super::{Overlap, Scene};
use crate::solid::Solid;
use hangpose::mechanics::Kind;
use hangpose::sample_supporter;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, Vector3};
use parry3d::query::{PointQuery, Ray, RayCast};
use parry3d::shape::TriMesh;
use std::f64::consts::TAU;

/// Largest displacement that separates the shapes before the object is moved, m.
const APART: f64 = 0.004;
/// Length of a step, m: less than two thin wires together.
const STEP: f64 = 0.002;
/// Number of level directions.
const DIRECTIONS: usize = 16;
/// Share of the object's largest extent within which something stops an object that is caught.
const CAUGHT: f64 = 0.5;
/// Number of samples of the supporter's surface.
const SAMPLES: usize = 30_000;
/// Distance from the object within which a sample of the supporter touches it, m.
const TOUCHING: f64 = 0.0015;
/// Least upward part of the normal of a sample that carries the object.
const CARRYING: f32 = 0.2;
/// Distance between places at which the supporter carries the object, m.
const PLACES_APART: f64 = 0.015;
/// Radius of the piece of the supporter that is the bar at a place, m.
const PIECE: f64 = 0.025;
/// Shares of the height at which a bar stops the object from below at which level ways across the bar are tried.
const HEIGHTS: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
/// Angles of these ways to the perpendicular of the bar, rad.
const ASKEW: [f64; 3] = [0.0, -0.25, 0.25];

/// How the object hangs at `rest`; `None` if 4 mm do not separate the shapes there.
///
/// - Threaded: at some place where the supporter carries the object, the piece of the supporter around it alone stops the
///   object on its way up, and at no height below that can the object leave sideways across the piece.
/// - Capped: the object is free upwards and stopped in all level directions, and a point of the supporter is in a cavity
///   of the object: level rays in all directions and the ray upwards meet the object.
/// - Hooked: it is stopped in two opposite level directions.
/// - Balanced: anything else.
///
/// A vessel that lies with its hollow over a level bar counts as threaded, and an object that lies between two walls as
/// hooked.
pub fn freedom(scene: &Scene, rest: &Isometry3<f64>) -> Option<Kind> {
    let whole = Overlap::new(scene);
    let (low, high) = bounds(&scene.object.vertices);
    let extent = (high - low).max();
    let start = whole.separated(rest, APART)?;
    let object = Surface::new(scene.object);
    if places(scene, &object, rest).iter().any(|place| is_linked(scene, &start, place, extent)) {
        return Some(Kind::Threaded);
    }
    let caught: Vec<bool> =
        level_ways().iter().map(|way| stopped(&whole, &start, way, CAUGHT * extent).is_some()).collect();
    let is_held = |k: usize| caught[k] && caught[(k + DIRECTIONS / 2) % DIRECTIONS];
    let is_over_a_tip = || {
        caught.iter().all(|&caught| caught)
            && stopped(&whole, &start, &Vector3::z(), extent).is_none()
            && scene
                .supporter
                .vertices
                .iter()
                .any(|&vertex| object.encloses(rest, Point3::from(vertex).cast()))
    };
    Some(if is_over_a_tip() {
        Kind::Capped
    } else if (0..DIRECTIONS / 2).any(is_held) {
        Kind::Hooked
    } else {
        Kind::Balanced
    })
}

fn level_ways() -> [Vector3<f64>; DIRECTIONS] {
    std::array::from_fn(|k| {
        let (sin, cos) = (TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        Vector3::new(cos, sin, 0.0)
    })
}

/// Distance along a way at which the object is stopped, m; `None` if `most` metres are free.
fn stopped(overlap: &Overlap, from: &Isometry3<f64>, way: &Vector3<f64>, most: f64) -> Option<f64> {
    let distances = (1..=(most / STEP).ceil() as u32).map(|k| STEP * f64::from(k));
    distances.into_iter().find(|distance| !overlap.is_free(&(Translation3::from(way * *distance) * from)))
}

/// A place at which the supporter carries the object.
struct Place {
    /// The supporter's triangles near it.
    piece: Solid,
    /// Level direction across the supporter there.
    across: Vector3<f64>,
}

/// The places at which the supporter carries the object at `rest`.
fn places(scene: &Scene, object: &Surface, rest: &Isometry3<f64>) -> Vec<Place> {
    let samples = sample_supporter(&scene.supporter.mesh(), SAMPLES, 1);
    let points: Vec<Point3<f64>> = samples.points.iter().map(|&point| Point3::from(point).cast()).collect();
    let normals = samples.normals.unwrap_or_default();
    let mut at: Vec<Point3<f64>> = Vec::new();
    let to_object = rest.inverse();
    for (point, normal) in points.iter().zip(&normals) {
        let carries = normal[2] > CARRYING || scene.supporter.is_shell && normal[2] < -CARRYING;
        if carries
            && at.iter().all(|other| (other - point).norm() > PLACES_APART)
            && object.distance(&(to_object * point)) < TOUCHING
        {
            at.push(*point);
        }
    }
    at.iter().map(|at| Place { piece: piece(scene.supporter, at), across: across(&points, at) }).collect()
}

/// The triangles of a shape that reach into the ball of radius [`PIECE`] around a point.
fn piece(solid: &Solid, at: &Point3<f64>) -> Solid {
    let near = |triangle: &&[u32; 3]| {
        let corners = triangle.map(|index| Point3::from(solid.vertices[index as usize]).cast::<f64>());
        let [a, b, c] = corners.map(|corner| <[f32; 3]>::from(corner.cast::<f32>()).into());
        let at = <[f32; 3]>::from(at.cast::<f32>()).into();
        let distance = parry3d::shape::Triangle::new(a, b, c).distance_to_local_point(at, true);
        f64::from(distance) < PIECE
    };
    let triangles = solid.triangles.iter().filter(near).copied().collect();
    Solid { triangles, vertices: solid.vertices.clone(), ..Solid::default() }
}

/// The level direction across the points around `at`: perpendicular to the direction in which they extend most.
fn across(points: &[Point3<f64>], at: &Point3<f64>) -> Vector3<f64> {
    let near = || points.iter().filter(|point| (*point - at).norm() < PIECE);
    let mean = near().map(|point| point.coords).sum::<Vector3<f64>>() / near().count() as f64;
    let spread: Matrix3<f64> = near().map(|point| point.coords - mean).map(|v| v * v.transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let along = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
    along.cross(&Vector3::z()).try_normalize(1e-3).unwrap_or_else(Vector3::x)
}

/// Whether the piece of the supporter at a place alone keeps the object from leaving upwards and sideways.
fn is_linked(scene: &Scene, start: &Isometry3<f64>, place: &Place, extent: f64) -> bool {
    let overlap = Overlap::new(&Scene { supporter: &place.piece, ..scene.clone() });
    let Some(height) = stopped(&overlap, start, &Vector3::z(), extent) else { return false };
    HEIGHTS.into_iter().all(|share| {
        let from = Translation3::new(0.0, 0.0, share * (height - STEP)) * start;
        ASKEW.into_iter().flat_map(|askew| [askew, askew + 0.5 * TAU]).all(|angle| {
            let way = Rotation3::from_axis_angle(&Vector3::z_axis(), angle) * place.across;
            stopped(&overlap, &from, &way, extent).is_some()
        })
    })
}

/// The object's surface in its own coordinates, in millimetres as in the overlap test.
struct Surface(TriMesh);

impl Surface {
    fn new(solid: &Solid) -> Self {
        let vertices = solid.vertices.iter().map(|vertex| vertex.map(|x| 1000.0 * x).into()).collect();
        Self(TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles"))
    }

    /// Distance of a point from the surface, m.
    fn distance(&self, point: &Point3<f64>) -> f64 {
        f64::from(self.0.distance_to_local_point(millimetres(point), false)) / 1000.0
    }

    /// Whether level rays in all directions and the ray upwards from a point of the supporter meet the object at `rest`.
    fn encloses(&self, rest: &Isometry3<f64>, point: Point3<f64>) -> bool {
        let to_object = rest.inverse();
        std::iter::once(Vector3::z()).chain(level_ways()).all(|way| {
            let way = <[f32; 3]>::from((to_object * way).cast::<f32>()).into();
            self.0.intersects_local_ray(&Ray::new(millimetres(&(to_object * point)), way), f32::MAX)
        })
    }
}

fn millimetres(point: &Point3<f64>) -> parry3d::math::Vector {
    <[f32; 3]>::from((point * 1000.0).cast::<f32>()).into()
}
