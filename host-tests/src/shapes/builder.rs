//! Construction of bodies. Every operation adds mesh and convex parts together, so that they agree.

use super::sections::{circle, corners_of};
use super::vector::{V, X, Y, Z, add, along, face_outwards, frames, length, scale, single, sub, turn, unit};
use crate::solid::{Part, Solid};

/// A shape under construction. Every method adds one closed body and the convex parts that fill it.
#[derive(Clone, Default)]
pub struct Builder {
    vertices: Vec<V>,
    triangles: Vec<[usize; 3]>,
    parts: Vec<Convex>,
}

#[derive(Clone)]
enum Convex {
    Hull(Vec<V>),
    Capsule(V, V, f64),
    Cuboid(V, [V; 3], V),
}

/// Unit tangents at the distinct points of a path, and whether it is closed. A path is closed if it ends at its first
/// point.
fn tangents(path: &[V]) -> (Vec<V>, bool) {
    let is_closed = length(sub(path[0], path[path.len() - 1])) < 1e-9;
    let n = path.len() - usize::from(is_closed);
    let step = |i: usize, j: usize| unit(sub(path[j], path[i]));
    let tangent = |i: usize| match i {
        0 if !is_closed => step(0, 1),
        _ if !is_closed && i == n - 1 => step(n - 2, n - 1),
        _ => unit(add(step((i + n - 1) % n, i), step(i, (i + 1) % n))),
    };
    ((0..n).map(tangent).collect(), is_closed)
}

impl Builder {
    /// The shape in single precision.
    pub fn finish(&self) -> Solid {
        let part = |part: &Convex| match part {
            Convex::Hull(points) => Part::Hull(points.iter().copied().map(single).collect()),
            &Convex::Capsule(from, to, radius) => {
                Part::Capsule { from: single(from), to: single(to), radius: radius as f32 }
            }
            &Convex::Cuboid(centre, axes, half) => {
                Part::Cuboid { centre: single(centre), axes: axes.map(single), half_extents: single(half) }
            }
        };
        Solid {
            vertices: self.vertices.iter().copied().map(single).collect(),
            triangles: self.triangles.iter().map(|t| t.map(|v| v as u32)).collect(),
            parts: self.parts.iter().map(part).collect(),
            is_shell: false,
        }
    }

    /// Adds `other` with its x, y and z along the right-handed unit vectors `axes` and its origin at `origin`.
    pub fn place(&mut self, other: &Self, axes: [V; 3], origin: V) {
        let to = |v: V| along(along(along(origin, v[0], axes[0]), v[1], axes[1]), v[2], axes[2]);
        let turned = |v: V| sub(to(v), origin);
        let first = self.vertices.len();
        self.vertices.extend(other.vertices.iter().map(|&v| to(v)));
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
        self.parts.extend(other.parts.iter().map(|part| match part {
            Convex::Hull(points) => Convex::Hull(points.iter().map(|&v| to(v)).collect()),
            &Convex::Capsule(a, b, radius) => Convex::Capsule(to(a), to(b), radius),
            &Convex::Cuboid(centre, edges, half) => Convex::Cuboid(to(centre), edges.map(turned), half),
        }));
    }

    /// Adds a closed surface and makes it face outwards.
    fn body(&mut self, vertices: Vec<V>, mut triangles: Vec<[usize; 3]>) {
        face_outwards(&vertices, &mut triangles);
        let first = self.vertices.len();
        self.vertices.extend(vertices);
        self.triangles.extend(triangles.into_iter().map(|t| t.map(|i| i + first)));
    }

    /// Adds the body between consecutive convex polygons with equal numbers of corners. If closed, the first polygon
    /// also follows the last. A first or last polygon of one point is a tip. Each pair gives one hull.
    pub fn loft(&mut self, rings: &[Vec<V>], is_closed: bool) {
        self.skin(rings, is_closed);
        for i in 1..rings.len() + usize::from(is_closed) {
            let (a, b) = (&rings[i - 1], &rings[i % rings.len()]);
            self.parts.push(Convex::Hull(a.iter().chain(b).copied().collect()));
        }
    }

    /// Adds the surface of a loft without parts.
    fn skin(&mut self, rings: &[Vec<V>], is_closed: bool) {
        let mut triangles = Vec::new();
        let firsts: Vec<usize> = rings
            .iter()
            .scan(0, |next, ring| {
                *next += ring.len();
                Some(*next - ring.len())
            })
            .collect();
        for i in 1..rings.len() + usize::from(is_closed) {
            let j = i % rings.len();
            let (a, b) = (firsts[i - 1], firsts[j]);
            let n = rings[i - 1].len().max(rings[j].len());
            for k in 0..n {
                let next = (k + 1) % n;
                match (rings[i - 1].len(), rings[j].len()) {
                    (1, _) => triangles.push([a, b + next, b + k]),
                    (_, 1) => triangles.push([a + k, a + next, b]),
                    _ => triangles.extend([[a + k, a + next, b + next], [a + k, b + next, b + k]]),
                }
            }
        }
        if !is_closed {
            let last = rings.len() - 1;
            for k in 1..rings[0].len().max(2) - 1 {
                triangles.push([firsts[0], firsts[0] + k + 1, firsts[0] + k]);
            }
            for k in 1..rings[last].len().max(2) - 1 {
                triangles.push([firsts[last], firsts[last] + k, firsts[last] + k + 1]);
            }
        }
        self.body(rings.iter().flatten().copied().collect(), triangles);
    }

    /// Cross-sections perpendicular to a path, in rotation-minimising frames. `side` is the initial direction of the
    /// section's x.
    fn rings(path: &[V], side: V, section: impl Fn(usize) -> Vec<[f64; 2]>) -> (Vec<Vec<V>>, bool) {
        let (tangents, is_closed) = tangents(path);
        let ring = |(i, [u, v]): (usize, [V; 2])| {
            section(i).iter().map(|&[x, y]| along(along(path[i], x, u), y, v)).collect()
        };
        (frames(&tangents, side).into_iter().enumerate().map(ring).collect(), is_closed)
    }

    /// Adds a convex polygon swept along a path, with flat ends. A path that ends at its first point gives a closed
    /// sweep.
    pub fn sweep(&mut self, path: &[V], side: V, section: &[[f64; 2]]) {
        let (rings, is_closed) = Self::rings(path, side, |_| section.to_vec());
        self.loft(&rings, is_closed);
    }

    /// Adds a sweep whose polygon is scaled by `size` of the position along the path, from 0 to 1.
    pub fn tapered(&mut self, path: &[V], side: V, section: &[[f64; 2]], size: impl Fn(f64) -> f64) {
        let last = (path.len() - 1) as f64;
        let scaled = |i| {
            let s = size(i as f64 / last);
            section.iter().map(|&[x, y]| [x * s, y * s]).collect()
        };
        let (rings, is_closed) = Self::rings(path, side, scaled);
        self.loft(&rings, is_closed);
    }

    /// Adds a round tube with round ends, or a closed tube if the path is closed. Its parts are capsules.
    pub fn tube(&mut self, path: &[V], radius: f64) {
        let start = sub(path[1], path[0]);
        let side = if start[2].abs() < 0.7 * length(start) { Z } else { X };
        let (mut rings, is_closed) = Self::rings(path, side, |_| circle(radius));
        if !is_closed {
            let steps = if radius < 0.01 { 4 } else { 8 };
            for end in 0..2 {
                let (tip, inner) =
                    if end == 0 { (path[0], path[1]) } else { (path[path.len() - 1], path[path.len() - 2]) };
                let out = unit(sub(tip, inner));
                let ring = if end == 0 { rings[0].clone() } else { rings[rings.len() - 1].clone() };
                let mut round: Vec<Vec<V>> = (1..steps)
                    .map(|k| {
                        let [cos, sin] = turn(90.0 * k as f64 / steps as f64);
                        ring.iter().map(|&v| along(along(tip, cos, sub(v, tip)), radius * sin, out)).collect()
                    })
                    .collect();
                round.push(vec![along(tip, radius, out)]);
                if end == 0 {
                    round.reverse();
                    round.append(&mut rings);
                    rings = round;
                } else {
                    rings.append(&mut round);
                }
            }
        }
        self.skin(&rings, is_closed);
        self.parts.extend(path.windows(2).map(|p| Convex::Capsule(p[0], p[1], radius)));
    }

    /// Adds the solid of revolution of an outline of (radius, z) about the z axis, with one hull per step of the
    /// outline. The outline may begin and end on the axis.
    pub fn lathe(&mut self, outline: &[[f64; 2]]) {
        let count = corners_of(outline.iter().fold(0.0, |most, p| p[0].max(most)));
        let ring = |&[r, z]: &[f64; 2]| match r {
            0.0 => vec![[0.0, 0.0, z]],
            _ => (0..count)
                .map(|i| turn(360.0 * i as f64 / count as f64))
                .map(|[cos, sin]| [r * cos, r * sin, z])
                .collect(),
        };
        self.loft(&outline.iter().map(ring).collect::<Vec<_>>(), false);
    }

    /// Adds a ball, with hulls that are slices.
    pub fn ball(&mut self, centre: V, radius: f64) {
        let mut ball = Self::default();
        let mut outline: Vec<[f64; 2]> =
            (0..=12).map(|i| turn(15.0 * i as f64)).map(|[cos, sin]| [radius * sin, -radius * cos]).collect();
        (outline[0][0], outline[12][0]) = (0.0, 0.0);
        ball.lathe(&outline);
        self.place(&ball, [X, Y, Z], centre);
    }

    /// Adds a hollow body of revolution about the z axis: each two consecutive pairs of (radius, z) span a convex
    /// quadrilateral, which is revolved. The first pair may lie on the axis.
    pub fn revolve(&mut self, wall: &[[[f64; 2]; 2]]) {
        const COUNT: usize = 24;
        let at = |[r, z]: [f64; 2], i: usize| {
            let [cos, sin] = turn(360.0 * i as f64 / COUNT as f64);
            [r * cos, r * sin, z]
        };
        let ring = |p: [f64; 2]| match p[0] {
            0.0 => vec![[0.0, 0.0, p[1]]],
            _ => (0..COUNT).map(|i| at(p, i)).collect(),
        };
        let rings: Vec<Vec<V>> = (wall.iter().map(|pair| ring(pair[0])))
            .chain(wall.iter().rev().map(|pair| ring(pair[1])))
            .collect();
        self.skin(&rings, wall[0][0][0] > 0.0);
        for pair in wall.windows(2) {
            let corners = [pair[0][0], pair[0][1], pair[1][0], pair[1][1]];
            let [a, b] = if corners[0][1] > corners[1][1] { [0, 1] } else { [1, 0] };
            let is_disc = corners[0][0] == 0.0
                && corners[a][1] >= corners[a + 2][1]
                && corners[b][1] <= corners[b + 2][1];
            if is_disc {
                self.parts.push(Convex::Hull(corners.iter().flat_map(|&p| ring(p)).collect()));
                continue;
            }
            for i in 0..COUNT {
                let both = |p: [f64; 2]| {
                    let count = if p[0] == 0.0 { 1 } else { 2 };
                    (0..count).map(move |k| at(p, (i + k) % COUNT))
                };
                self.parts.push(Convex::Hull(corners.iter().flat_map(|&p| both(p)).collect()));
            }
        }
    }

    /// Adds a band in the x-y plane, from `low` to `high` in z: each two consecutive pairs of points span a convex
    /// quadrilateral.
    pub fn strip(&mut self, pairs: &[[[f64; 2]; 2]], [low, high]: [f64; 2], is_closed: bool) {
        let ring = |&[a, b]: &[[f64; 2]; 2]| {
            vec![[a[0], a[1], low], [b[0], b[1], low], [b[0], b[1], high], [a[0], a[1], high]]
        };
        self.loft(&pairs.iter().map(ring).collect::<Vec<_>>(), is_closed);
    }

    /// Adds a flat ring about (x, y) with elliptical edges of half axes `inner` and `outer`.
    pub fn eye(&mut self, [x, y]: [f64; 2], inner: [f64; 2], outer: [f64; 2], z: [f64; 2]) {
        let pairs: Vec<_> = (0..24)
            .map(|i| turn(15.0 * i as f64))
            .map(|[cos, sin]| [inner, outer].map(|[a, b]| [x + a * cos, y + b * sin]))
            .collect();
        self.strip(&pairs, z, true);
    }

    /// Adds a prism over a convex outline in the x-y plane, from `low` to `high` in z.
    pub fn prism(&mut self, outline: &[[f64; 2]], [low, high]: [f64; 2]) {
        let ring = |z: f64| outline.iter().map(|&[x, y]| [x, y, z]).collect::<Vec<V>>();
        self.loft(&[ring(low), ring(high)], false);
    }

    /// Adds an axis-aligned box.
    pub fn cuboid(&mut self, low: V, high: V) {
        let ring = |z: f64| {
            vec![[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]]
        };
        self.skin(&[ring(low[2]), ring(high[2])], false);
        let (centre, half) = (scale(add(low, high), 0.5), scale(sub(high, low), 0.5));
        self.parts.push(Convex::Cuboid(centre, [X, Y, Z], half));
    }
}
