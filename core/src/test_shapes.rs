//! Shapes with known answers, for tests.

use crate::geometry::{Mesh, Point, Vector};

/// A mesh that owns its data.
#[derive(Clone, Default)]
pub(crate) struct Shape {
    pub(crate) vertices: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    pub(crate) fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles).unwrap()
    }

    pub(crate) fn map(&self, f: impl Fn(Point) -> Point) -> Self {
        let vertices = self.vertices.iter().map(|v| f((*v).into()).into()).collect();
        Self { vertices, triangles: self.triangles.clone() }
    }

    pub(crate) fn inside_out(&self) -> Self {
        let triangles = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        Self { vertices: self.vertices.clone(), triangles }
    }

    pub(crate) fn append(&mut self, other: &Self, offset: Vector) {
        let base = self.vertices.len() as u32;
        self.vertices.extend(other.map(|p| p + offset).vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + base)));
    }
}

/// A closed band of quads between `rows` rings of `columns` vertices; rings close on themselves, and the band on
/// its first ring if `wrap`.
fn band(rows: u32, columns: u32, wrap: bool, vertex: impl Fn(u32, u32) -> [f32; 3]) -> Shape {
    let vertices =
        (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))).map(|(i, j)| vertex(i, j)).collect();
    let triangles = (0..if wrap { rows } else { rows - 1 })
        .flat_map(|i| (0..columns).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let at = |i: u32, j: u32| i % rows * columns + j % columns;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    Shape { vertices, triangles }
}

fn turn(step: u32, steps: u32) -> (f32, f32) {
    (core::f32::consts::TAU * step as f32 / steps as f32).sin_cos()
}

/// A torus around the z axis.
pub(crate) fn torus(ring: f32, tube: f32, rows: u32, columns: u32) -> Shape {
    band(rows, columns, true, |i, j| {
        let ((sin_i, cos_i), (sin_j, cos_j)) = (turn(i, rows), turn(j, columns));
        let radius = ring + tube * cos_j;
        [radius * cos_i, radius * sin_i, tube * sin_j]
    })
}

/// A ball around the origin.
pub(crate) fn ball(radius: f32, rows: u32, columns: u32) -> Shape {
    // The poles are rings of coinciding vertices; their triangles without area are part of the test.
    band(rows + 1, columns, false, |i, j| {
        let (sin_i, cos_i) = turn(i, 2 * rows);
        let (sin_j, cos_j) = turn(j, columns);
        [radius * sin_i * cos_j, radius * sin_i * sin_j, radius * cos_i]
    })
}

/// A solid of revolution around the z axis: `profile` is its outline, distance from the axis and height, from the top down the
/// outside.
pub(crate) fn revolved(profile: &[[f32; 2]], columns: u32) -> Shape {
    band(profile.len() as u32, columns, false, |i, j| {
        let [radius, z] = profile[i as usize];
        let (sin, cos) = turn(j, columns);
        [radius * cos, radius * sin, z]
    })
}

/// A tube around the z axis.
pub(crate) fn tube(inner: f32, outer: f32, length: f32) -> Shape {
    let half = 0.5 * length;
    let section = [[inner, half], [inner, -half], [outer, -half], [outer, half]];
    band(4, 48, true, |i, j| {
        let [radius, z] = section[i as usize];
        let (sin, cos) = turn(j, 48);
        [radius * cos, radius * sin, z]
    })
}

/// A straight rod along the x axis around the origin.
pub(crate) fn rod(length: f32, radius: f32) -> Shape {
    let half = 0.5 * length;
    let upright = revolved(&[[0.0, half], [radius, half], [radius, -half], [0.0, -half]], 48);
    upright.map(|p| Point::new(p.z, p.x, p.y))
}

/// A prism along the x axis over a polygon in the y-z plane, counter-clockwise seen from the front, where x is positive, and
/// convex.
pub(crate) fn prism(length: f32, polygon: &[[f32; 2]]) -> Shape {
    let n = polygon.len() as u32;
    let end = |x: f32| polygon.iter().map(move |&[y, z]| [x, y, z]);
    let vertices = end(0.5 * length).chain(end(-0.5 * length)).collect();
    let caps = (1..n - 1).flat_map(|i| [[0, i, i + 1], [n, n + i + 1, n + i]]);
    let sides = (0..n).flat_map(|i| {
        let next = (i + 1) % n;
        [[i, n + i, n + next], [i, n + next, next]]
    });
    Shape { vertices, triangles: caps.chain(sides).collect() }
}

/// A flat square in the x-y plane, from the origin, `n` by `n` quads.
pub(crate) fn grid(edge: f32, n: u32) -> Shape {
    let at = |i: u32| edge * i as f32 / n as f32;
    let vertices = (0..=n).flat_map(|i| (0..=n).map(move |j| [at(i), at(j), 0.0])).collect();
    let triangles = (0..n)
        .flat_map(|i| (0..n).map(move |j| (i * (n + 1) + j, (i + 1) * (n + 1) + j)))
        .flat_map(|(a, b)| [[a, b, b + 1], [a, b + 1, a + 1]])
        .collect();
    Shape { vertices, triangles }
}

/// Points on a cylinder between `from` and `to` and on its two caps, with normals, about `spacing` apart. They
/// wind around it by the golden angle, so that no two distances are the same.
pub(crate) fn peg(from: Point, to: Point, radius: f32, spacing: f32) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let golden_angle = core::f32::consts::PI * (3.0 - 5_f32.sqrt());
    let axis = (to - from).normalize();
    let side = crate::geometry::any_perpendicular(axis);
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    let mut add = |point: Point, normal: Vector| {
        points.push(point.into());
        normals.push(normal.into());
    };
    let area = core::f32::consts::TAU * radius * (to - from).norm();
    let count = (area / spacing.powi(2)) as u32;
    for i in 0..count {
        let normal = crate::geometry::rotate_about(axis, golden_angle * i as f32, side);
        add(from + (to - from) * ((i as f32 + 0.5) / count as f32) + normal * radius, normal);
    }
    let count = (core::f32::consts::PI * (radius / spacing).powi(2)) as u32;
    for i in 0..count {
        let out = crate::geometry::rotate_about(axis, golden_angle * i as f32, side);
        let offset = out * (radius * ((i as f32 + 0.5) / count as f32).sqrt());
        add(from + offset, -axis);
        add(to + offset, axis);
    }
    (points, normals)
}
