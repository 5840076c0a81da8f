//! Queries on one triangle.

use crate::geometry::{Point, Vector};

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

/// The point of the triangle that is closest to `p`.
///
/// By the region that `p` is in, as Ericson does it ("Real-Time Collision Detection", 5.1.5). But his differences of
/// products cancel where a triangle is thin, with errors up to the length of the triangle. So every edge is tested
/// separately, components along `ab` are subtracted before measuring across it, and a point that is not above the
/// face is projected onto the closest edge.
pub(crate) fn closest_point([a, b, c]: &[Point; 3], p: &Point) -> Point {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let (ap, bp, cp) = (p - a, p - b, p - c);
    let (ab_ap, ac_ap, bc_bp) = (ab.dot(&ap), ac.dot(&ap), bc.dot(&bp));
    if ab_ap <= 0.0 && ac_ap <= 0.0 {
        return *a;
    }
    if ab.dot(&bp) >= 0.0 && bc_bp <= 0.0 {
        return *b;
    }
    if ac.dot(&cp) >= 0.0 && bc.dot(&cp) >= 0.0 {
        return *c;
    }
    // What is left of `ac` and `ap` across `ab`: the height of the triangle, and of `p`.
    let ab_squared = ab.norm_squared();
    let (along_c, along_p) = (ab.dot(&ac) / ab_squared, ab_ap / ab_squared);
    let (height, across) = (ac - ab * along_c, ap - ab * along_p);
    let w = across.dot(&height) / height.norm_squared();
    let v = along_p - w * along_c;
    if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
        return a + ab * v + ac * w;
    }
    let on_edge = |from: &Point, edge: Vector, along: f32| {
        let point = from + edge * (along / edge.norm_squared()).clamp(0.0, 1.0);
        ((point - p).norm_squared(), point)
    };
    let nearer = |x: (f32, Point), y: (f32, Point)| if y.0 < x.0 { y } else { x };
    nearer(nearer(on_edge(a, ab, ab_ap), on_edge(a, ac, ac_ap)), on_edge(b, bc, bc_bp)).1
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

/// Whether the triangle may come closer to `p` than a distance, given by its square: told by its plane, which costs less than the closest
/// point, and is farther away in most cases.
pub(crate) fn may_be_within([a, b, c]: &[Point; 3], p: &Point, squared: f32) -> bool {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(&ac);
    let (height, normal_squared) = (normal.dot(&(p - a)), normal.norm_squared());
    let has_plane = normal_squared > LEAST_SINE * LEAST_SINE * ab.norm_squared() * ac.norm_squared();
    !has_plane || height * height <= PLANE_ERROR * squared * normal_squared
}

/// Sine of the angle at a corner below which a triangle is too thin to tell its plane: it is off by some 1e-5 rad there.
const LEAST_SINE: f32 = 0.01;
/// By how much the square of the distance from the plane must be greater than that of the distance that is asked for: the plane is off by
/// as much at five thousand times that distance.
const PLANE_ERROR: f32 = 1.1;

/// A point of a triangle, the longest side of which is between the first two corners, and the radius of the ball about it that holds the
/// triangle: the centroid, or the middle of the longest side where that ball is smaller, as it is for thin triangles.
pub(crate) fn ball_on([a, b, c]: &[Point; 3]) -> (Point, f32) {
    let centroid = Point::from((a.coords + b.coords + c.coords) / 3.0);
    let ball = |centre: Point| {
        let squared = |corner: &Point| (corner - centre).norm_squared();
        (centre, squared(a).max(squared(b)).max(squared(c)))
    };
    let (around, beside) = (ball(centroid), ball(nalgebra::center(a, b)));
    let (centre, squared) = if beside.1 < around.1 { beside } else { around };
    (centre, libm::sqrtf(squared))
}

/// The two halves of a triangle, cut across the side between the first two corners.
pub(crate) fn halves([a, b, c]: [Point; 3]) -> [[Point; 3]; 2] {
    let middle = nalgebra::center(&a, &b);
    [[a, middle, c], [middle, b, c]]
}

/// The corners in the same order, so that the longest side is between the first two.
pub(crate) fn longest_side_first([a, b, c]: [Point; 3]) -> [Point; 3] {
    let sides = [(a - b).norm_squared(), (b - c).norm_squared(), (c - a).norm_squared()];
    match sides {
        [ab, bc, ca] if ab >= bc && ab >= ca => [a, b, c],
        [_, bc, ca] if bc >= ca => [b, c, a],
        _ => [c, a, b],
    }
}

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

    /// Above a point of the face the way down is as long as the height, and out beside an edge as long as the offset,
    /// however thin the triangle.
    #[test]
    fn thin_triangles_keep_their_closest_points() {
        let mut random = crate::random::Random::new(3);
        let mut unit = || f64::from(random.next_f32());
        for width in [1.0, 1e-2, 1e-3, 1e-4, 1e-5] {
            for _ in 0..2000 {
                let a = nalgebra::Vector3::new(unit(), unit(), unit());
                let along = nalgebra::Vector3::new(unit() - 0.5, unit() - 0.5, unit() + 0.1).normalize();
                let aside = along.cross(&nalgebra::Vector3::new(1.0, unit(), 0.0)).normalize();
                // With the short edge opposite to each of the corners in turn, or none where all are long.
                let turn = (3.0 * unit()) as usize;
                let mut corners = [a, a + along, a + along * 0.9 + aside * width];
                corners.rotate_left(turn);
                // What counts is the triangle after rounding.
                let corners = corners.map(|corner| Point::from(corner.cast::<f32>()));
                let [a, b, c] = corners.map(|corner| corner.coords.cast::<f64>());
                let normal = (b - a).cross(&(c - a)).normalize();
                let (s, t, height) = (unit().sqrt(), unit(), unit() - 0.5);
                let on_face = a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t);
                let p = Point::from((on_face + normal * height).cast::<f32>());
                let distance = f64::from((closest_point(&corners, &p) - p).norm());
                // Half a dozen roundings of coordinates around 1.
                assert!((distance - height.abs()).abs() < 1e-6, "{width} {turn}: {distance} {height}");
                let out = (b - a).cross(&normal).normalize() * height.abs();
                let p = Point::from((a + (b - a) * t + out).cast::<f32>());
                let distance = f64::from((closest_point(&corners, &p) - p).norm());
                assert!((distance - height.abs()).abs() < 1e-6, "{width} {turn}: {distance} {height}");
            }
        }
    }

    #[test]
    fn a_triangle_that_is_within_a_distance_may_be() {
        let mut random = crate::random::Random::new(5);
        let mut told = 0;
        for width in [1.0, 1e-2, 1e-4, 1e-6] {
            for _ in 0..2000 {
                let mut point = || Point::from([(); 3].map(|()| random.next_f32()));
                let (a, b, p) = (point(), point(), point());
                let corners = [a, b, a + (b - a) * 0.7 + (point() - b) * width];
                let distance = (closest_point(&corners, &p) - p).norm();
                let may_be =
                    |share: f32| may_be_within(&corners, &p, (share * distance) * (share * distance));
                assert!(may_be(1.001) && may_be(2.0), "{corners:?} {p}");
                told += u32::from(!may_be(0.3));
            }
        }
        // Above its face, the plane of a triangle tells.
        assert!(told > 500, "{told}");
    }

    #[test]
    fn the_ball_on_a_triangle_holds_it_and_is_small() {
        let mut random = crate::random::Random::new(6);
        for width in [1.0, 0.1, 1e-3] {
            for _ in 0..2000 {
                let mut point = || Point::from([(); 3].map(|()| random.next_f32()));
                let (a, b) = (point(), point());
                let corners = longest_side_first([a, b, a + (b - a) * 0.7 + (point() - b) * width]);
                let (centre, radius) = ball_on(&corners);
                let farthest = corners.map(|corner| (corner - centre).norm()).into_iter().fold(0.0, f32::max);
                assert!((farthest - radius).abs() < 1e-6, "{farthest} {radius}");
                assert!((closest_point(&corners, &centre) - centre).norm() < 1e-6);
                let [a, b, _] = corners;
                // No ball that holds the longest side is smaller than half of it.
                assert!(radius < 1.3 * 0.5 * (a - b).norm(), "{corners:?} {radius}");
            }
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
