//! Queries on one triangle.

use super::{Point, Vector};

/// Whether a triangle has an area that `f32` can tell from zero.
pub(crate) fn has_area([a, b, c]: &[Point; 3]) -> bool {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = ab.norm_squared().max(ac.norm_squared()).max(bc.norm_squared());
    // Twice the area against the longest edge: a needle a millionth as wide as it is long has none.
    ab.cross(&ac).norm() > 1e-6 * longest && longest > f32::MIN_POSITIVE
}

/// The normal, of the length of twice the area.
pub(crate) fn scaled_normal([a, b, c]: &[Point; 3]) -> Vector {
    (b - a).cross(&(c - a))
}

/// The point of the triangle that is closest to `p`, by the region of `p` (Ericson, "Real-Time Collision
/// Detection", 5.1.5).
pub(crate) fn closest_point([a, b, c]: &[Point; 3], p: &Point) -> Point {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}

/// The solid angle of the triangle seen from `p`, in steradians, positive if `p` sees its inner side
/// (Van Oosterom and Strackee 1983).
pub(crate) fn solid_angle([a, b, c]: &[Point; 3], p: &Point) -> f32 {
    let (a, b, c) = (a - p, b - p, c - p);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let volume = a.dot(&b.cross(&c));
    let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    if volume.abs() < SERIES * denominator {
        // Most triangles look small; the next term of the series is below 1e-7 of the first.
        let t = volume / denominator;
        let t2 = t * t;
        2.0 * t * (1.0 - t2 * (1.0 / 3.0 - t2 * (1.0 / 5.0)))
    } else {
        2.0 * libm::atan2f(volume, denominator)
    }
}

/// Tangents up to this are small enough for three terms of the arc tangent's series.
const SERIES: f32 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere() {
        let corners = [Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0), Point::new(0.0, 0.0, 1.0)];
        let eighth = 4.0 * core::f32::consts::PI / 8.0;
        assert!((solid_angle(&corners, &Point::origin()) - eighth).abs() < 1e-6);
        let [a, b, c] = corners;
        assert!((solid_angle(&[a, c, b], &Point::origin()) + eighth).abs() < 1e-6);
    }

    #[test]
    fn small_and_large_angles_agree_with_double_precision() {
        let corners = [Point::new(0.0, 0.0, 0.0), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];
        for height in [0.01_f32, 0.3, 1.0, 1.2, 1.5, 2.0, 4.0, 9.0] {
            let p = Point::new(0.2, 0.3, -height);
            let [a, b, c] = corners.map(|corner| (corner - p).cast::<f64>());
            let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
            let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
            let exact = 2.0 * a.dot(&b.cross(&c)).atan2(denominator);
            let relative = (f64::from(solid_angle(&corners, &p)) - exact) / exact;
            assert!(relative.abs() < 2e-6, "{height}: {relative}");
        }
    }

    #[test]
    fn needles_have_no_area_at_any_scale() {
        for scale in [1e-6, 1.0, 1e5] {
            let at = |x: f32, y: f32| Point::new(x * scale, y * scale, 0.0);
            assert!(has_area(&[at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]), "{scale}");
            assert!(!has_area(&[at(0.0, 0.0), at(1.0, 0.0), at(0.5, 1e-8)]), "{scale}");
            assert!(!has_area(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.0)]), "{scale}");
        }
    }
}
