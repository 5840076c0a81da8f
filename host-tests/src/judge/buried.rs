//! Penetration without contact between surfaces: one shape wholly inside another.

use super::Scene;
use crate::solid::{Part, Solid};
use crate::winding::Winding;
use nalgebra::{Isometry3, Point3, Vector3};

/// Spacing of the points of a capsule that are tested against the object, m.
const SPACING: f32 = 0.01;

/// Penetration of the supporter's interior points into the object.
pub(super) struct Buried {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    winding: Winding,
    low: Point3<f64>,
    high: Point3<f64>,
    /// Interior points of the supporter, each with the radius of a ball around it inside the part, m.
    cores: Vec<(Point3<f64>, f64)>,
}

impl Buried {
    pub(super) fn new(scene: &Scene) -> Self {
        let Solid { vertices, triangles, .. } = scene.object;
        let vertices: Vec<_> = vertices.iter().map(|&vertex| Point3::from(vertex).cast()).collect();
        let low = vertices.iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = vertices.iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        let cores = scene.supporter.parts.iter().flat_map(cores).collect();
        let corners = triangles.iter().map(|triangle| triangle.map(|index| vertices[index as usize]));
        let winding = Winding::new(corners);
        Self { vertices, triangles: triangles.clone(), winding, low, high, cores }
    }

    /// Largest penetration depth of the balls around the cores, m; 0 if no core is inside the object.
    pub(super) fn depth(&self, pose: &Isometry3<f64>) -> f64 {
        let into_object = pose.inverse();
        let mut deepest = 0.0_f64;
        for (core, radius) in &self.cores {
            let core = into_object * core;
            if core >= self.low && core <= self.high && self.contains(&core) {
                deepest = deepest.max(radius + self.distance(&core));
            }
        }
        deepest
    }

    fn corners(&self) -> impl Iterator<Item = [Point3<f64>; 3]> {
        self.triangles.iter().map(|triangle| triangle.map(|index| self.vertices[index as usize]))
    }

    fn contains(&self, point: &Point3<f64>) -> bool {
        self.winding.number(point) > 0.5
    }

    fn distance(&self, point: &Point3<f64>) -> f64 {
        self.corners().map(|corners| distance(point, corners)).fold(f64::INFINITY, f64::min)
    }
}

/// Distance from a point to a triangle: to its plane if the projection is inside, otherwise to the nearest edge.
fn distance(point: &Point3<f64>, [a, b, c]: [Point3<f64>; 3]) -> f64 {
    let normal = (b - a).cross(&(c - a));
    let inside = |p: &Point3<f64>, q: &Point3<f64>| normal.cross(&(q - p)).dot(&(point - p)) >= 0.0;
    if normal.norm_squared() > 0.0 && inside(&a, &b) && inside(&b, &c) && inside(&c, &a) {
        return normal.normalize().dot(&(point - a)).abs();
    }
    let edge = |p: &Point3<f64>, q: &Point3<f64>| {
        let along: Vector3<f64> = q - p;
        let t = (along.dot(&(point - p)) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (point - (p + along * t)).norm()
    };
    edge(&a, &b).min(edge(&b, &c)).min(edge(&c, &a))
}

fn cores(part: &Part) -> Vec<(Point3<f64>, f64)> {
    match part {
        Part::Capsule { from, to, radius } => {
            let (from, to) = (Point3::from(*from), Point3::from(*to));
            let count = ((to - from).norm() / SPACING).ceil().max(1.0);
            let at = |i: u16| from + (to - from) * (f32::from(i) / count);
            (0..=count as u16).map(|i| (at(i).cast(), f64::from(*radius))).collect()
        }
        Part::Cuboid { centre, half_extents, .. } => {
            let around = half_extents.iter().copied().fold(f32::INFINITY, f32::min);
            vec![(Point3::from(*centre).cast(), f64::from(around))]
        }
        Part::Hull(points) => {
            let sum =
                points.iter().fold(Vector3::zeros(), |sum, &point| sum + Vector3::from(point).cast::<f64>());
            vec![(Point3::from(sum / points.len().max(1) as f64), 0.0)]
        }
    }
}
