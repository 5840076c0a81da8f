//! Watertight intersection of rays with boxes and triangles.

use crate::geometry::{Aabb, Point, Vector};

/// A ray, prepared to be tested against many boxes and triangles (Woop, Benthin and Wald 2013, "Watertight
/// Ray/Triangle Intersection").
///
/// Space is sheared so that the ray runs along its largest component, through the origin of the plane of the
/// other two. A vertex goes to the same rounded place in that plane whichever triangle asks, and which side of an
/// edge the ray passes is decided exactly there. So triangles that share an edge agree, and a closed mesh has no
/// hole for a ray. The triangle that is hit has corners that are off by a few rounding errors.
pub(crate) struct Ray {
    origin: Point,
    /// The axes of the plane, then that of the largest component.
    axes: [usize; 3],
    /// What a step along the last of `axes` shifts along the other two, and how much of the ray it is.
    shear: [f32; 3],
    /// One over each component, large but finite for a zero, so that a ray in the plane of a face gives no NaN.
    inverse: Vector,
    /// Amount by which each pair of a box's sides is widened, as a multiple of the direction: more than the rounding
    /// errors of the shear, so that no box hides a triangle that the ray hits.
    slack: Vector,
}

impl Ray {
    /// A ray from `origin` along `direction` through things inside `bounds`.
    pub(crate) fn new(origin: &Point, direction: &Vector, bounds: &Aabb) -> Self {
        let along = direction.iamax();
        let axes = [(along + 1) % 3, (along + 2) % 3, along];
        let [x, y, z] = axes.map(|axis| direction[axis]);
        let inverse = direction.map(|d| if d.abs() < 1e-30 { 1e30 } else { 1.0 / d });
        // The shear and the test of a box round a coordinate four times each.
        let margin = 8.0 * f32::EPSILON * libm::sqrtf(bounds.farthest_squared(origin));
        let shear = [x / z, y / z, 1.0 / z];
        Self { origin: *origin, axes, shear, inverse, slack: inverse.abs() * margin }
    }

    /// Where the ray enters a box, as a multiple of its direction; `None` if it misses or enters after `limit`.
    pub(crate) fn enter(&self, aabb: &Aabb, limit: f32) -> Option<f32> {
        let (mut enter, mut leave) = (0.0_f32, limit);
        for i in 0..3 {
            let low = (aabb.min[i] - self.origin[i]) * self.inverse[i];
            let high = (aabb.max[i] - self.origin[i]) * self.inverse[i];
            enter = enter.max(low.min(high) - self.slack[i]);
            leave = leave.min(low.max(high) + self.slack[i]);
        }
        (enter <= leave).then_some(enter)
    }

    /// Where the ray meets a triangle, from either side, as a multiple of its direction in [0, limit].
    pub(crate) fn hit(&self, corners: &[Point; 3], limit: f32) -> Option<f32> {
        let [x_axis, y_axis, z_axis] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let offset = corner - self.origin;
            let z = offset[z_axis];
            [offset[x_axis] - self.shear[0] * z, offset[y_axis] - self.shear[1] * z, self.shear[2] * z]
        });
        // Most triangles lie to one side.
        for i in 0..2 {
            if a[i].min(b[i]).min(c[i]) > 0.0 || a[i].max(b[i]).max(c[i]) < 0.0 {
                return None;
            }
        }
        // Twice the area that the ray spans with an edge: exact, but for the last bit of the difference.
        let [a, b, c] = [a, b, c].map(|corner| corner.map(f64::from));
        let span = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (span(b, c), span(c, a), span(a, b));
        let area = u + v + w;
        let same_side = u >= 0.0 && v >= 0.0 && w >= 0.0 || u <= 0.0 && v <= 0.0 && w <= 0.0;
        if !same_side || area == 0.0 {
            return None;
        }
        let t = ((u * a[2] + v * b[2] + w * c[2]) / area) as f32;
        (0.0..=limit).contains(&t).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::test_shapes;

    /// Rays from inside to every vertex and to the middle of every edge of a ball, where triangles meet.
    #[test]
    fn no_ray_slips_out_between_triangles() {
        let ball = test_shapes::ball(0.1, 24, 48).map(|p| p + Vector::new(0.3, -0.2, 0.7));
        let mesh = ball.mesh();
        let mut random = Random::new(8);
        for triangle in mesh.solid_triangles() {
            let [a, b, _] = mesh.corners(triangle as usize);
            let off = Vector::from_fn(|_, _| 0.08 * (random.next_f32() - 0.5));
            let origin = Point::new(0.3, -0.2, 0.7) + off;
            for target in [a, nalgebra::center(&a, &b)] {
                let direction = (target - origin).normalize();
                let ray = Ray::new(&origin, &direction, &mesh.aabb());
                let hit = |t| {
                    let corners = mesh.corners(t as usize);
                    ray.enter(&Aabb::of(&corners), f32::MAX)?;
                    ray.hit(&corners, f32::MAX)
                };
                let at = mesh.solid_triangles().find_map(hit).expect("the ball is closed");
                assert!((origin + direction * at - target).norm() < 1e-6, "{at}");
            }
        }
    }

    #[test]
    fn a_ray_in_the_plane_of_a_triangle_and_one_without_direction_miss() {
        let corners = [Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];
        let bounds = Aabb::of(&corners);
        for direction in [Vector::x(), Vector::zeros()] {
            let ray = Ray::new(&Point::new(-1.0, 0.2, 0.0), &direction, &bounds);
            assert_eq!(ray.hit(&corners, f32::MAX), None, "{direction}");
        }
    }
}
