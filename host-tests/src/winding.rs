//! Generalised winding numbers.

use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Number of grid cells along the longest side of the bounding box. The triangles of a cell form a cluster.
const CELLS: f64 = 20.0;
/// Distance in multiples of a cluster's radius from which the cluster is approximated by one dipole (Barill et al.
/// 2018).
const FAR: f64 = 3.0;

/// A surface with its generalised winding number (Jacobson et al. 2013): 1 inside a closed surface, 0 outside, and in
/// between near the openings of an open surface.
pub struct Winding {
    clusters: Vec<Cluster>,
}

/// Neighbouring triangles and their far-field approximation.
struct Cluster {
    triangles: Vec<[Point3<f64>; 3]>,
    centre: Point3<f64>,
    /// Distance of the farthest corner from the centre.
    reach: f64,
    /// Sum of the area-weighted normals.
    area_normal: Vector3<f64>,
}

impl Winding {
    /// Groups the triangles into clusters.
    pub fn new(triangles: impl Iterator<Item = [Point3<f64>; 3]>) -> Self {
        let triangles: Vec<_> = triangles.collect();
        let corners = || triangles.as_flattened().iter().copied();
        let low = corners().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = corners().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        let size = ((high - low).max() / CELLS).max(f64::MIN_POSITIVE);
        let mut cells: BTreeMap<[i64; 3], Vec<[Point3<f64>; 3]>> = BTreeMap::new();
        for triangle in &triangles {
            let cell = (middle(triangle) - low).map(|x| (x / size) as i64);
            cells.entry(cell.into()).or_default().push(*triangle);
        }
        Self { clusters: cells.into_values().map(Cluster::new).collect() }
    }

    /// The winding number of the surface around a point.
    pub fn number(&self, point: &Point3<f64>) -> f64 {
        self.clusters.iter().map(|cluster| cluster.angle(point)).sum::<f64>() / (4.0 * PI)
    }
}

impl Cluster {
    fn new(triangles: Vec<[Point3<f64>; 3]>) -> Self {
        let sum: Vector3<f64> = triangles.iter().map(|triangle| middle(triangle).coords).sum();
        let centre = Point3::from(sum / triangles.len() as f64);
        let corners = triangles.as_flattened().iter();
        Self {
            reach: corners.map(|corner| (corner - centre).norm()).fold(0.0, f64::max),
            area_normal: triangles.iter().map(|[a, b, c]| (b - a).cross(&(c - a)) / 2.0).sum(),
            centre,
            triangles,
        }
    }

    /// Solid angle of the triangles as seen from the point.
    fn angle(&self, point: &Point3<f64>) -> f64 {
        let away = self.centre - point;
        let distance = away.norm();
        if distance > FAR * self.reach {
            return away.dot(&self.area_normal) / distance.powi(3);
        }
        self.triangles.iter().map(|triangle| solid_angle(triangle, point)).sum()
    }
}

/// Solid angle of a triangle (Van Oosterom and Strackee 1983).
fn solid_angle(triangle: &[Point3<f64>; 3], point: &Point3<f64>) -> f64 {
    let [a, b, c] = triangle.map(|corner| corner - point);
    let [la, lb, lc] = [a.norm(), b.norm(), c.norm()];
    let under = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * a.dot(&b.cross(&c)).atan2(under)
}

fn middle([a, b, c]: &[Point3<f64>; 3]) -> Point3<f64> {
    ((a.coords + b.coords + c.coords) / 3.0).into()
}
