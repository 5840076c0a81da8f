//! How an object hangs, judged by the motions that free it, on the true surfaces.
//!
//! The object is moved along straight lines in small steps and stopped where the surfaces overlap. This knows nothing of
//! openings and bars and is an approximation: a wall or a second hook near the object stops it as well.

use super::verdict::bounds;
use super::{Overlap, Scene};
use hangpose::mechanics::Kind;
use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;
use std::f64::consts::TAU;

/// Heights by which the object is lifted before it is moved, m: the first at which the shapes do not overlap counts.
const LIFTS: [f64; 5] = [0.0005, 0.001, 0.0015, 0.002, 0.003];
/// Length of a step, m: less than two thin wires together.
const STEP: f64 = 0.002;
/// Number of level directions.
const DIRECTIONS: usize = 16;
/// Heights at which level ways out are looked for below an obstacle, as shares of the height at which it is met.
const HEIGHTS: [f64; 4] = [0.0, 0.35, 0.7, 1.0];
/// Share of the object's largest extent within which something stops an object that is caught.
const CAUGHT: f64 = 0.5;
/// Largest angle between a level direction and the mean of the free ones for both to be along the bar, rad.
const ALONG: f64 = 0.8;

/// How the object hangs at `rest`; `None` if the shapes overlap there even when the object is lifted a little.
///
/// - Threaded: something stops the object on its way up, and at all heights up to there it can leave in one level
///   direction at most, give or take 45 degrees, as along the bar.
/// - Capped: it is free upwards and stopped in all level directions, and a point of the supporter is in a cavity of the
///   object: level rays in all directions and the ray upwards meet the object.
/// - Hooked: it is not threaded and is stopped in two opposite level directions.
/// - Balanced: anything else.
pub fn freedom(scene: &Scene, rest: &Isometry3<f64>) -> Option<Kind> {
    let overlap = Overlap::new(scene);
    let (low, high) = bounds(&scene.object.vertices);
    let extent = (high - low).max();
    let lift = |height: f64| Translation3::new(0.0, 0.0, height) * rest;
    let start = LIFTS.into_iter().map(lift).find(|pose| overlap.is_free(pose))?;
    // Distance at which the object is stopped; `None` if it is not.
    let stopped = |from: &Isometry3<f64>, way: Vector3<f64>, most: f64| {
        (1..=(most / STEP).ceil() as u32)
            .map(|k| STEP * f64::from(k))
            .find(|distance| !overlap.is_free(&(Translation3::from(way * *distance) * from)))
    };
    let ways = level_ways();
    let above = stopped(&start, Vector3::z(), extent);
    if let Some(above) = above {
        let is_linked = HEIGHTS.into_iter().all(|share| {
            let from = Translation3::new(0.0, 0.0, share * (above - STEP)) * start;
            is_narrow(&ways.iter().filter(|way| stopped(&from, **way, extent).is_none()).collect::<Vec<_>>())
        });
        if is_linked {
            return Some(Kind::Threaded);
        }
    }
    let caught: Vec<bool> = ways.iter().map(|way| stopped(&start, *way, CAUGHT * extent).is_some()).collect();
    let is_held = |k: usize| caught[k] && caught[(k + DIRECTIONS / 2) % DIRECTIONS];
    Some(if above.is_none() && caught.iter().all(|&caught| caught) && is_over_a_tip(scene, rest) {
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

/// Whether level directions are all about the same.
fn is_narrow(ways: &[&Vector3<f64>]) -> bool {
    let mean: Vector3<f64> = ways.iter().copied().sum();
    ways.is_empty() || mean.norm() > 0.0 && ways.iter().all(|way| way.angle(&mean) < ALONG)
}

/// Whether a point of the supporter is in a cavity of the object.
fn is_over_a_tip(scene: &Scene, rest: &Isometry3<f64>) -> bool {
    // In millimetres, as in the overlap test.
    let scaled = |vertex: Point3<f64>| (vertex * 1000.0).cast::<f32>();
    let vertices = scene.object.vertices.iter().map(|&vertex| rest * Point3::from(vertex).cast());
    let vertices = vertices.map(|vertex| <[f32; 3]>::from(scaled(vertex)).into()).collect();
    let surface = TriMesh::new(vertices, scene.object.triangles.clone()).expect("a shape has triangles");
    let meets = |from: &Point3<f64>, way: Vector3<f64>| {
        let ray = Ray::new(<[f32; 3]>::from(scaled(*from)).into(), <[f32; 3]>::from(way.cast()).into());
        surface.intersects_local_ray(&ray, f32::MAX)
    };
    let ways = level_ways();
    let mut points = scene.supporter.vertices.iter().map(|&vertex| Point3::from(vertex).cast());
    points.any(|point| meets(&point, Vector3::z()) && ways.iter().all(|&way| meets(&point, way)))
}
