//! How an object hangs, judged by the motions that free it, on the true surfaces.
//!
//! The object is moved in small steps, without turning it, and stopped where the surfaces overlap. This knows nothing of
//! openings and bars and is an approximation.

use super::verdict::bounds;
use super::{Overlap, Scene};
use crate::solid::Solid;
use hangpose::mechanics::Kind;
use hangpose::sample_supporter;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Vector3};
use parry3d::query::{PointQuery, Ray, RayCast};
use parry3d::shape::TriMesh;
use std::collections::{BinaryHeap, HashSet};
use std::f64::consts::PI;

/// Largest displacement that separates the shapes before the object is moved, m.
const APART: f64 = 0.004;
/// Length of a step, m: less than two thin wires together.
const STEP: f64 = 0.002;
/// Number of level lines along which the object is moved.
const LINES: usize = 8;
/// Number of rays from a point.
const RAYS: usize = 100;
/// Largest angle between their mean and the rays that leave a cavity, rad.
const NARROW: f64 = 1.3;
/// Share of the object's largest extent within which something stops an object that is caught.
const CAUGHT: f64 = 0.5;
/// Number of samples of the supporter's surface.
const SAMPLES: usize = 30_000;
/// Distance from the object within which a sample of the supporter touches it, m.
const TOUCHING: f64 = 0.0015;
/// Least upward part of the normal of a sample that carries the object.
const CARRYING: f64 = 0.2;
/// Distance between places at which the supporter carries the object, m.
const PLACES_APART: f64 = 0.015;
/// Distance from a place up to which normals tell most of the direction of the bar, m.
const NEAR: f64 = 0.005;
/// Sine of the angle to the vertical below which a bar is upright.
const UPRIGHT: f64 = 0.2;
/// Radius of the piece of the supporter that is the bar at a place, m.
const PIECE: f64 = 0.02;

/// How the object hangs at `rest`; `None` if 4 mm do not separate the shapes there.
///
/// - Capped: a point of the supporter is in a cavity of the object: the rays from it that do not meet the object are all
///   within 75 degrees of one direction.
/// - Threaded: at some place where the supporter carries the object, the piece of the supporter around it alone keeps the
///   object from leaving in the upright plane across the bar. A hook leaves through its mouth.
/// - Hooked: the object is stopped in two opposite level directions within half of its largest extent.
/// - Balanced: anything else.
pub fn freedom(scene: &Scene, rest: &Isometry3<f64>) -> Option<Kind> {
    let whole = Overlap::new(scene);
    let (low, high) = bounds(&scene.object.vertices);
    let extent = (high - low).max();
    let start = whole.separated(rest, APART)?;
    let object = Surface::new(scene.object);
    let is_caught = |way: &Vector3<f64>| {
        [*way, -way].iter().all(|way| stopped(&whole, &start, way, CAUGHT * extent).is_some())
    };
    let to_object = rest.inverse();
    let mut points = scene.supporter.vertices.iter().map(|&vertex| to_object * Point3::from(vertex).cast());
    Some(if points.any(|point| object.has_in_cavity(&point)) {
        Kind::Capped
    } else if places(scene, &object, rest).iter().any(|place| is_linked(scene, &start, place, extent)) {
        Kind::Threaded
    } else if lines().iter().any(is_caught) {
        Kind::Hooked
    } else {
        Kind::Balanced
    })
}

/// Level unit vectors along lines in all directions.
fn lines() -> [Vector3<f64>; LINES] {
    std::array::from_fn(|k| {
        let (sin, cos) = (PI * k as f64 / LINES as f64).sin_cos();
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
    /// Level direction across the bar there.
    across: Vector3<f64>,
}

/// The places at which a bar of the supporter that is not upright carries the object at `rest`.
fn places(scene: &Scene, object: &Surface, rest: &Isometry3<f64>) -> Vec<Place> {
    let samples = sample_supporter(&scene.supporter.mesh(), SAMPLES, 1);
    let normals = samples.normals.unwrap_or_default();
    let samples: Vec<(Point3<f64>, Vector3<f64>)> = (samples.points.iter().zip(&normals))
        .map(|(&point, &normal)| (Point3::from(point).cast(), Vector3::from(normal).cast()))
        .collect();
    // The two sides of a surface that is not closed are alike.
    let is_closed = scene.supporter.is_closed();
    let to_object = rest.inverse();
    let mut at: Vec<Point3<f64>> = Vec::new();
    for (point, normal) in &samples {
        let rises = if is_closed { normal.z } else { normal.z.abs() };
        if rises > CARRYING
            && at.iter().all(|other| (other - point).norm() > PLACES_APART)
            && object.distance(&(to_object * point)) < TOUCHING
        {
            at.push(*point);
        }
    }
    let place =
        |at: &Point3<f64>| Some(Place { piece: piece(scene.supporter, at), across: across(&samples, at)? });
    at.iter().filter_map(place).collect()
}

/// The level direction across the bar at a place; `None` if the bar is upright. The bar is along the direction to which
/// the normals around the place are perpendicular, the nearest most.
fn across(samples: &[(Point3<f64>, Vector3<f64>)], at: &Point3<f64>) -> Option<Vector3<f64>> {
    let mut spread = Matrix3::zeros();
    for (point, normal) in samples {
        let squared = (point - at).norm_squared() / (NEAR * NEAR);
        if squared < 9.0 {
            spread += normal * normal.transpose() * (-squared).exp();
        }
    }
    let eigen = spread.symmetric_eigen();
    let bar: Vector3<f64> = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    bar.cross(&Vector3::z()).try_normalize(UPRIGHT)
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

/// Whether the piece of the supporter at a place alone keeps the object from leaving across the bar.
fn is_linked(scene: &Scene, start: &Isometry3<f64>, place: &Place, extent: f64) -> bool {
    let overlap = Overlap::new(&Scene { supporter: &place.piece, ..scene.clone() });
    is_enclosed(&overlap, start, &place.across, extent)
}

/// Whether no sequence of steps along a level way and up or down takes the object farther than its extent. The farthest
/// place is tried first.
fn is_enclosed(overlap: &Overlap, start: &Isometry3<f64>, way: &Vector3<f64>, extent: f64) -> bool {
    let (mut seen, mut open) = (HashSet::from([[0_i32; 2]]), BinaryHeap::from([(0, [0_i32; 2])]));
    while let Some((_, [aside, up])) = open.pop() {
        if STEP * f64::from(aside.abs().max(up.abs())) > extent {
            return false;
        }
        for [aside, up] in [[aside + 1, up], [aside - 1, up], [aside, up + 1], [aside, up - 1]] {
            let shift = (way * f64::from(aside) + Vector3::z() * f64::from(up)) * STEP;
            if seen.insert([aside, up]) && overlap.is_free(&(Translation3::from(shift) * start)) {
                open.push((aside * aside + up * up, [aside, up]));
            }
        }
    }
    true
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

    /// Whether all rays from a point that do not meet the surface are in about one direction.
    fn has_in_cavity(&self, point: &Point3<f64>) -> bool {
        let is_way_out = |way: &Vector3<f64>| {
            let way = <[f32; 3]>::from(way.cast::<f32>()).into();
            !self.0.intersects_local_ray(&Ray::new(millimetres(point), way), f32::MAX)
        };
        let out: Vec<Vector3<f64>> = sphere().filter(is_way_out).collect();
        let mean: Vector3<f64> = out.iter().sum();
        mean.norm() > 0.0 && out.iter().all(|way| way.angle(&mean) < NARROW)
    }
}

/// Unit vectors spread evenly over the sphere on a Fibonacci lattice.
fn sphere() -> impl Iterator<Item = Vector3<f64>> {
    (0..RAYS).map(|k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / RAYS as f64;
        let (sin, cos) = (PI * (3.0 - 5.0_f64.sqrt()) * k as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        Vector3::new(across * cos, across * sin, z)
    })
}

fn millimetres(point: &Point3<f64>) -> parry3d::math::Vector {
    <[f32; 3]>::from((point * 1000.0).cast::<f32>()).into()
}
