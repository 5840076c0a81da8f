//! Distances to one triangle, prepared for many points.

use crate::geometry::Vector;
use bytemuck::{Pod, Zeroable};

/// A triangle in a frame of its own: the first corner at the origin, the second on the x axis, all in the x-y plane.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Frame {
    origin: [f32; 3],
    /// The axes of the frame. The third is the normal.
    axes: [[f32; 3]; 3],
    /// Length of the first edge, along the x axis.
    length: f32,
    /// From the second corner to the third, and from the first to the third: unit direction and length.
    edges: [[f32; 3]; 2],
    unused: f32,
}

impl Frame {
    /// The frame of a triangle that has an area.
    pub(super) fn of(&[a, b, c]: &[Vector; 3]) -> Self {
        let (ab, ac) = (b - a, c - a);
        let unit = |v: Vector| crate::geometry::unit_or(v, Vector::zeros());
        let x = unit(ab);
        // What is left of the third corner across the first edge; the difference loses nothing that the corner has.
        let z = unit(x.cross(&ac));
        let y = z.cross(&x);
        let length = ab.norm();
        let (cx, cy) = (ac.dot(&x), ac.dot(&y));
        let edge = |x: f32, y: f32| {
            let length = libm::sqrtf(x * x + y * y);
            let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
            [x * scale, y * scale, length]
        };
        let edges = [edge(cx - length, cy), edge(cx, cy)];
        Self { origin: a.into(), axes: [x.into(), y.into(), z.into()], length, edges, unused: 0.0 }
    }

    /// How far `point` is in front of the triangle's plane.
    #[inline]
    pub(super) fn height(&self, point: &Vector) -> f32 {
        dot(&self.axes[2], &self.relative(point))
    }

    /// How much the height changes at most over steps along x and y.
    #[inline]
    pub(super) fn slope(&self, x: f32, y: f32) -> f32 {
        self.axes[2][0].abs() * x + self.axes[2][1].abs() * y
    }

    /// Square of the distance from `point` to the triangle.
    #[inline]
    pub(super) fn distance_squared(&self, point: &Vector) -> f32 {
        let p = self.relative(point);
        let [x, y, z] = [dot(&self.axes[0], &p), dot(&self.axes[1], &p), dot(&self.axes[2], &p)];
        let [[ux, uy, u_length], [vx, vy, v_length]] = self.edges;
        // Along each edge, how far beyond its ends; and how far inwards of it.
        let beyond = |along: f32, length: f32| along - greater(lesser(along, length), 0.0);
        let from_b = x - self.length;
        let (along_b, in_b) = (from_b * ux + y * uy, y * ux - from_b * uy);
        let (along_c, in_c) = (x * vx + y * vy, x * vy - y * vx);
        let end_a = beyond(x, self.length);
        let end_b = beyond(along_b, u_length);
        let end_c = beyond(along_c, v_length);
        let least =
            lesser(lesser(end_a * end_a + y * y, end_b * end_b + in_b * in_b), end_c * end_c + in_c * in_c);
        let across = if lesser(lesser(y, in_b), in_c) >= 0.0 { 0.0 } else { least };
        across + z * z
    }

    #[inline]
    fn relative(&self, point: &Vector) -> [f32; 3] {
        [point.x - self.origin[0], point.y - self.origin[1], point.z - self.origin[2]]
    }
}

/// As `min`, but one instruction: nothing here is not a number.
#[inline]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline]
fn dot(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::geometry::shapes::triangle;
    use crate::random::Random;

    #[test]
    fn distances_are_those_to_the_closest_point() {
        let mut random = Random::new(5);
        let mut vector = |scale: f32| Vector::from([(); 3].map(|()| (random.next_f32() - 0.5) * scale));
        for round in 0..2000 {
            let a = vector(50.0);
            let flat = if round % 3 == 0 { 0.02 } else { 1.0 };
            let b = a + vector(10.0);
            let corners = [a, b, a + (b - a) * 0.7 + vector(8.0 * flat)];
            let frame = Frame::of(&corners);
            for _ in 0..20 {
                let p = a + vector(20.0);
                let closest = triangle::closest_point(&corners.map(Point::from), &p.into());
                let exact = (closest.coords - p).norm();
                let found = frame.distance_squared(&p).sqrt();
                assert!((found - exact).abs() < 1e-4, "{corners:?} {p}: {found} {exact}");
                assert!(frame.height(&p).abs() < exact + 1e-4);
            }
        }
    }
}
