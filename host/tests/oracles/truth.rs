//! Reference results for a mesh, by parry in double precision.

use crate::shapes::Shape;
use nalgebra::{Point3, Vector3};
use parry3d_f64::math;
use parry3d_f64::query::{PointQuery, Ray, RayCast};
use parry3d_f64::shape::{TriMesh, TriMeshFlags};

pub(crate) struct Truth {
    mesh: TriMesh,
    bodies: Vec<TriMesh>,
    /// Corners of the triangles that have an area.
    pub(crate) corners: Vec<[Point3<f64>; 3]>,
    /// Lower corner of the bounding box.
    pub(crate) low: Point3<f64>,
    /// Upper corner of the bounding box.
    pub(crate) high: Point3<f64>,
}

/// Intersection of a ray and a mesh.
pub(crate) struct Hit {
    /// Ray parameter, in multiples of the direction.
    pub(crate) at: f64,
    /// Absolute cosine of the angle between the ray and the normal.
    pub(crate) cosine: f64,
    /// Distance from the border of the triangle, perpendicular to the ray.
    pub(crate) from_border: f64,
}

pub(crate) fn double(p: [f32; 3]) -> Point3<f64> {
    Point3::from(p).cast()
}

fn to_parry(p: Point3<f64>) -> math::Vector {
    math::Vector::new(p.x, p.y, p.z)
}

/// Aspect ratio by the core's definition: twice the area over the square of the longest edge.
fn aspect([a, b, c]: [Point3<f64>; 3]) -> f64 {
    let longest = (b - a).norm_squared().max((c - a).norm_squared()).max((c - b).norm_squared());
    if longest > 0.0 { (b - a).cross(&(c - a)).norm() / longest } else { 0.0 }
}

/// Distance between the line through `point` along `direction` and the closest edge.
fn border_distance([a, b, c]: [Point3<f64>; 3], point: &Point3<f64>, direction: &Vector3<f64>) -> f64 {
    let across = |v: Vector3<f64>| v - direction * (v.dot(direction) / direction.norm_squared());
    let edges = [[a, b], [b, c], [c, a]].map(|[p, q]| {
        let (edge, offset) = (across(q - p), across(point - p));
        (offset - edge * (offset.dot(&edge) / edge.norm_squared()).clamp(0.0, 1.0)).norm()
    });
    edges.into_iter().fold(f64::INFINITY, f64::min)
}

impl Truth {
    pub(crate) fn of(shape: &Shape) -> Self {
        let vertices: Vec<Point3<f64>> = shape.vertices.iter().map(|&v| double(v)).collect();
        let parrys: Vec<math::Vector> = vertices.iter().map(|&v| to_parry(v)).collect();
        // The core ignores triangles without area, so they are dropped here too.
        let solid: Vec<(usize, [u32; 3])> = shape
            .triangles
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, t)| aspect(t.map(|v| vertices[v as usize])) > 1e-6)
            .collect();
        let triangles: Vec<[u32; 3]> = solid.iter().map(|&(_, t)| t).collect();
        let mut from = 0;
        let mut bodies = Vec::new();
        for &end in shape.bodies.iter().filter(|_| shape.is_closed) {
            let body = solid.iter().filter(|(i, _)| (from..end).contains(i)).map(|&(_, t)| t).collect();
            let flags = TriMeshFlags::ORIENTED | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
            bodies.push(TriMesh::with_flags(parrys.clone(), body, flags).unwrap());
            from = end;
        }
        let corners: Vec<[Point3<f64>; 3]> =
            triangles.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
        let all = || corners.iter().flatten();
        Self {
            low: all().fold(corners[0][0], |low, v| low.inf(v)),
            high: all().fold(corners[0][0], |high, v| high.sup(v)),
            mesh: TriMesh::new(parrys, triangles).unwrap(),
            bodies,
            corners,
        }
    }

    /// Length of the diagonal of the bounding box.
    pub(crate) fn size(&self) -> f64 {
        (self.high - self.low).norm()
    }

    /// One rounding of the distances between `point` and the mesh, as defined in `main.rs`.
    pub(crate) fn rounding_of_distances(&self, point: &Point3<f64>) -> f64 {
        f64::from(f32::EPSILON) * (self.high - point).amax().max((self.low - point).amax())
    }

    /// One rounding of these distances or of the coordinates, whichever is larger.
    pub(crate) fn rounding(&self, point: &Point3<f64>) -> f64 {
        let largest = self.low.coords.amax().max(self.high.coords.amax()).max(point.coords.amax());
        self.rounding_of_distances(point).max(f64::from(f32::EPSILON) * largest)
    }

    pub(crate) fn is_in_box(&self, point: &Point3<f64>) -> bool {
        (0..3).all(|i| (self.low[i]..=self.high[i]).contains(&point[i]))
    }

    pub(crate) fn distance(&self, point: &Point3<f64>) -> f64 {
        self.mesh.distance_to_local_point(to_parry(*point), false)
    }

    /// First hit of a ray beyond `skip`.
    pub(crate) fn first_hit(&self, origin: &Point3<f64>, direction: &Vector3<f64>, skip: f64) -> Option<Hit> {
        let d = to_parry(Point3::from(*direction));
        let ray = Ray::new(to_parry(origin + direction * skip), d);
        let hit = self.mesh.cast_local_ray_and_get_normal(&ray, f64::MAX, false)?;
        let at = origin + direction * (skip + hit.time_of_impact);
        Some(Hit {
            at: skip + hit.time_of_impact,
            cosine: hit.normal.dot(d).abs(),
            from_border: border_distance(self.corners[hit.subshape as usize], &at, direction),
        })
    }

    /// Whether a point is in any body; `None` if the shape is open.
    pub(crate) fn is_inside(&self, point: &Point3<f64>) -> Option<bool> {
        let inside = |body: &TriMesh| body.contains_local_point(to_parry(*point));
        (!self.bodies.is_empty()).then(|| self.bodies.iter().any(inside))
    }

    /// Winding number: the sum of all solid angles (Van Oosterom and Strackee 1983) over 4π.
    pub(crate) fn winding_number(&self, point: &Point3<f64>) -> f64 {
        let angle = |corners: &[Point3<f64>; 3]| {
            let [a, b, c] = corners.map(|corner| corner - point);
            let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
            let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
            2.0 * a.dot(&b.cross(&c)).atan2(denominator)
        };
        self.corners.iter().map(angle).sum::<f64>() / (2.0 * std::f64::consts::TAU)
    }
}
