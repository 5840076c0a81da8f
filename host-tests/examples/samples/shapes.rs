//! Closed triangle meshes by revolution, sweep, prism and chamfered box.
//!
//! The vertex order and the sweep's tangents differ from those of the library's builder, and the published bytes of
//! `samples/` depend on both.

use host_tests::shapes::vector::{
    V, add, cos_sin, cross, dot, face_outwards, frames, scale, sub, turn, unit,
};
use host_tests::winding::Winding;
use std::f64::consts::TAU;

/// One closed surface with triangles that are counter-clockwise seen from outside.
#[derive(Clone, Default)]
pub(crate) struct Body {
    pub(crate) vertices: Vec<V>,
    pub(crate) triangles: Vec<[usize; 3]>,
}

impl Body {
    fn outward(mut self) -> Self {
        face_outwards(&self.vertices, &mut self.triangles);
        self
    }

    fn ring(&mut self, ring: impl Iterator<Item = V>) -> usize {
        let first = self.vertices.len();
        self.vertices.extend(ring);
        first
    }

    fn bridge(&mut self, a: usize, b: usize, count: usize) {
        for i in 0..count {
            let j = (i + 1) % count;
            self.triangles.push([a + i, a + j, b + j]);
            self.triangles.push([a + i, b + j, b + i]);
        }
    }

    fn cap(&mut self, ring: usize, apex: V, count: usize) {
        let tip = self.vertices.len();
        self.vertices.push(apex);
        for i in 0..count {
            self.triangles.push([ring + i, ring + (i + 1) % count, tip]);
        }
    }

    /// The solid of revolution of an outline of (radius, z) about the z axis. The outline begins and ends on the axis.
    pub(crate) fn revolve(outline: &[(f64, f64)], count: usize) -> Self {
        let mut body = Self::default();
        let rings: Vec<usize> = (outline[1..outline.len() - 1].iter())
            .map(|&(r, z)| {
                body.ring((0..count).map(|i| {
                    let [cos, sin] = cos_sin(TAU * i as f64 / count as f64);
                    [r * cos, r * sin, z]
                }))
            })
            .collect();
        for pair in rings.windows(2) {
            body.bridge(pair[0], pair[1], count);
        }
        // Caps at the two poles. The first faces the opposite way.
        let start = body.triangles.len();
        body.cap(rings[0], [0.0, 0.0, outline[0].1], count);
        for t in &mut body.triangles[start..] {
            t.swap(0, 1);
        }
        body.cap(rings[rings.len() - 1], [0.0, 0.0, outline[outline.len() - 1].1], count);
        body.outward()
    }

    /// An ellipse swept along a path without twist, with half axes `a`, initially along `side`, and `b`. A path that
    /// ends at its first point gives a closed sweep. Otherwise `round` states for each end whether it is round or flat.
    pub(crate) fn sweep(path: &[V], side: V, [a, b]: [f64; 2], count: usize, round: [bool; 2]) -> Self {
        let closed = path[0] == path[path.len() - 1];
        let n = if closed { path.len() - 1 } else { path.len() };
        let tangent = |i: usize| {
            let (before, after) = if closed {
                ((i + n - 1) % n, (i + 1) % n)
            } else {
                (i.saturating_sub(1), (i + 1).min(n - 1))
            };
            unit(sub(path[after], path[before]))
        };
        let tangents: Vec<V> = (0..n).map(tangent).collect();
        let mut body = Self::default();
        let mut rings = Vec::new();
        let ellipse = |centre: V, [u, v]: [V; 2], size: f64| {
            (0..count).map(move |k| {
                let [cos, sin] = cos_sin(TAU * k as f64 / count as f64);
                add(centre, add(scale(u, a * size * cos), scale(v, b * size * sin)))
            })
        };
        // Steps of the quarter circle in the profile of a round end.
        let steps = 4;
        let rounding = |k: usize| turn(90.0 * k as f64 / steps as f64);
        for (i, (&centre, frame)) in path.iter().zip(frames(&tangents, side)).enumerate() {
            let t = tangents[i];
            if !closed && i == 0 && round[0] {
                for k in (1..steps).rev() {
                    let [size, back] = rounding(k);
                    rings.push(body.ring(ellipse(add(centre, scale(t, -b * back)), frame, size)));
                }
            }
            rings.push(body.ring(ellipse(centre, frame, 1.0)));
            if !closed && i == n - 1 && round[1] {
                for k in 1..steps {
                    let [size, forth] = rounding(k);
                    rings.push(body.ring(ellipse(add(centre, scale(t, b * forth)), frame, size)));
                }
            }
        }
        for pair in rings.windows(2) {
            body.bridge(pair[0], pair[1], count);
        }
        let last = rings[rings.len() - 1];
        if closed {
            body.bridge(last, rings[0], count);
        } else {
            let reach = round.map(|round| if round { b } else { 0.0 });
            body.cap(last, add(path[n - 1], scale(tangents[n - 1], reach[1])), count);
            let start = body.triangles.len();
            body.cap(rings[0], add(path[0], scale(tangents[0], -reach[0])), count);
            for t in &mut body.triangles[start..] {
                t.swap(0, 1);
            }
        }
        body.outward()
    }

    /// A prism over a convex outline in the x-y plane, from `low` to `high` in z.
    pub(crate) fn prism(outline: &[[f64; 2]], low: f64, high: f64) -> Self {
        let count = outline.len();
        let mut body = Self::default();
        let a = body.ring(outline.iter().map(|&[x, y]| [x, y, low]));
        let b = body.ring(outline.iter().map(|&[x, y]| [x, y, high]));
        body.bridge(a, b, count);
        for i in 1..count - 1 {
            body.triangles.push([a, a + i + 1, a + i]);
            body.triangles.push([b, b + i, b + i + 1]);
        }
        body.outward()
    }

    /// A box about `centre` with edges chamfered by `chamfer`: six rectangles, joined by strips along the edges and by
    /// triangles at the corners.
    pub(crate) fn cuboid(centre: V, size: V, chamfer: f64) -> Self {
        let mut body = Self::default();
        // Each corner has three vertices, one on each of the faces that meet there.
        let index = |corner: usize, axis: usize| corner * 3 + axis;
        for corner in 0..8usize {
            for axis in 0..3 {
                let at = |i: usize| {
                    let half = size[i] / 2.0 - if i == axis { 0.0 } else { chamfer };
                    centre[i] + if corner >> i & 1 == 1 { half } else { -half }
                };
                body.vertices.push([at(0), at(1), at(2)]);
            }
        }
        let mut faces: Vec<Vec<usize>> = Vec::new();
        for axis in 0..3 {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            for side in 0..2usize {
                let c = |a: usize, b: usize| (side << axis) | (a << j) | (b << k);
                // The rectangle of the face.
                faces.push([c(0, 0), c(1, 0), c(1, 1), c(0, 1)].map(|corner| index(corner, axis)).to_vec());
                for other in 0..2usize {
                    // The strip along k between the faces of `axis` and `j`.
                    let (p, q) = (c(other, 0), c(other, 1));
                    faces.push(vec![index(p, axis), index(q, axis), index(q, j), index(p, j)]);
                }
            }
        }
        for corner in 0..8 {
            faces.push((0..3).map(|axis| index(corner, axis)).collect());
        }
        for face in faces {
            for i in 1..face.len() - 1 {
                let mut t = [face[0], face[i], face[i + 1]];
                let [a, b, c] = t.map(|v| body.vertices[v]);
                // The box is convex, so outward is away from the centre.
                if dot(cross(sub(b, a), sub(c, a)), sub(a, centre)) < 0.0 {
                    t.swap(1, 2);
                }
                body.triangles.push(t);
            }
        }
        body
    }

    /// The winding number of the surface.
    pub(crate) fn winding(&self) -> Winding {
        Winding::new(self.triangles.iter().map(|t| t.map(|v| self.vertices[v].into())))
    }
}

/// `steps` + 1 points on a straight line, including both ends.
pub(crate) fn line(a: V, b: V, steps: usize) -> Vec<V> {
    (0..=steps).map(|i| add(a, scale(sub(b, a), i as f64 / steps as f64))).collect()
}
