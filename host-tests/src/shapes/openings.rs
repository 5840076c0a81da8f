//! Openings, with widths measured on the generated surface.

use super::builder::Builder;
use super::vector::{V, X, Y, across, add, along, cross, dot, double, length, scale, single, sub, unit};
use super::{HangObject, Opening, OpeningKind};
use crate::solid::Solid;

/// Half the length of the bar that measures a hole, unless a length is given, m.
const HALF_LENGTH: f64 = 0.005;

impl HangObject {
    /// An object without openings.
    pub(crate) fn new(builder: &Builder) -> Self {
        Self { solid: builder.finish(), openings: Vec::new() }
    }

    /// Adds a hole that contains the point `inside`. Its centre is that of the widest bar along `axis`.
    pub(crate) fn hole(self, inside: V, axis: V) -> Self {
        self.hole_through(inside, axis, HALF_LENGTH)
    }

    /// Adds a hole that is measured by a bar of half length `half_length`, such as the hole of a bail above a rim.
    pub(crate) fn hole_through(mut self, inside: V, axis: V, half_length: f64) -> Self {
        let axis = unit(axis);
        let near = Near::new(&self.solid, inside, axis, half_length);
        let u = unit(across(if axis[0].abs() < 0.7 { X } else { Y }, axis));
        let v = cross(axis, u);
        let (mut centre, mut widest) = (inside, near.clearance(inside));
        let mut step = widest / 2.0;
        while step > 1e-4 {
            let moved = (0..8).map(|i| super::vector::turn(45.0 * f64::from(i)));
            let best = moved
                .map(|[cos, sin]| along(along(centre, step * cos, u), step * sin, v))
                .filter(|&p| length(sub(p, inside)) < near.reach)
                .map(|p| (near.clearance(p), p))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((clear, p)) if clear > widest => (widest, centre) = (clear, p),
                _ => step /= 2.0,
            }
        }
        self.push(OpeningKind::Hole, centre, axis, widest);
        self
    }

    /// Adds a hook about `centre` with a mouth of width `mouth`.
    pub(crate) fn hook(mut self, centre: V, axis: V, mouth: f64) -> Self {
        let axis = unit(axis);
        let clear = Near::new(&self.solid, centre, axis, HALF_LENGTH).clearance(centre).min(mouth / 2.0);
        self.push(OpeningKind::Hook, centre, axis, clear);
        self
    }

    /// Adds an opening of any kind.
    pub(crate) fn push(&mut self, kind: OpeningKind, centre: V, axis: V, clear_radius: f64) {
        self.openings.push(opening(kind, true, centre, axis, clear_radius));
    }

    /// Adds an opening by which the object may come to hang although no person hangs it so.
    pub(crate) fn also(mut self, kind: OpeningKind, centre: V, axis: V, clear_radius: f64) -> Self {
        self.openings.push(opening(kind, false, centre, axis, clear_radius));
        self
    }
}

fn opening(kind: OpeningKind, is_meant: bool, centre: V, axis: V, clear_radius: f64) -> Opening {
    let (centre, axis) = (single(centre), single(axis));
    Opening { kind, is_meant, centre, axis, clear_radius: clear_radius as f32 }
}

/// The triangles that a bar near a point may touch.
struct Near {
    axis: V,
    half_length: f64,
    /// Distance from the centre up to which the triangles are complete.
    reach: f64,
    /// Each triangle with the centre and the radius of a bounding ball.
    triangles: Vec<([V; 3], V, f64)>,
}

impl Near {
    fn new(solid: &Solid, centre: V, axis: V, half_length: f64) -> Self {
        let with_ball = |t: [V; 3]| {
            let middle = scale(add(add(t[0], t[1]), t[2]), 1.0 / 3.0);
            (t, middle, t.iter().map(|&p| length(sub(p, middle))).fold(0.0, f64::max))
        };
        let corners = solid.triangles.iter().map(|t| t.map(|v| double(solid.vertices[v as usize])));
        let mut near = Self { axis, half_length, reach: 0.0, triangles: corners.map(with_ball).collect() };
        // The clearance grows by at most the distance from the centre.
        near.reach = 3.0 * near.clearance(centre);
        let far = half_length + 2.4 * near.reach;
        near.triangles.retain(|(t, ..)| length(sub(centre, nearest(centre, t))) < far);
        near
    }

    /// Radius of the widest bar about `centre`.
    fn clearance(&self, centre: V) -> f64 {
        let steps = if self.half_length > HALF_LENGTH { 8 } else { 2 };
        let at = |i: i32| along(centre, self.half_length * f64::from(i) / f64::from(steps), self.axis);
        let mut least = f64::INFINITY;
        for p in (-steps..=steps).map(at) {
            for (t, middle, radius) in &self.triangles {
                if length(sub(p, *middle)) < least + radius {
                    least = least.min(length(sub(p, nearest(p, t))));
                }
            }
        }
        least
    }
}

/// The point of a triangle nearest to `p` (Ericson, "Real-Time Collision Detection", 2005, 5.1.5).
fn nearest(p: V, &[a, b, c]: &[V; 3]) -> V {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let [d1, d2] = [ab, ac].map(|e| dot(e, sub(p, a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let [d3, d4] = [ab, ac].map(|e| dot(e, sub(p, b)));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return along(a, d1 / (d1 - d3), ab);
    }
    let [d5, d6] = [ab, ac].map(|e| dot(e, sub(p, c)));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return along(a, d2 / (d2 - d6), ac);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return along(b, (d4 - d3) / ((d4 - d3) + (d5 - d6)), sub(c, b));
    }
    add(a, scale(add(scale(ab, vb), scale(ac, vc)), 1.0 / (va + vb + vc)))
}

#[cfg(test)]
mod tests {
    use super::super::vector::Z;
    use super::*;

    #[test]
    fn a_hole_is_as_wide_as_it_was_made() {
        let mut builder = Builder::default();
        builder.eye([0.1, 0.0], [0.01, 0.01], [0.015, 0.015], [0.0, 0.003]);
        let ring = HangObject::new(&builder).hole([0.104, 0.002, 0.001], Z);
        let hole = ring.openings[0];
        assert!((hole.clear_radius - 0.01).abs() < 2e-4, "{hole:?}");
        assert!((hole.centre[0] - 0.1).abs() < 2e-4 && hole.centre[1].abs() < 2e-4, "{hole:?}");
    }
}
