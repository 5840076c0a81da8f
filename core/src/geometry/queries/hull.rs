//! Exit distance from a convex hull, without building the hull.

use crate::geometry::{Point, Vector};

/// Half the side of the square that every point is thickened by across the ray, of the extent. It makes flat and
/// collinear sets solid, and is some hundred times what rounding does to a coordinate.
const THICKNESS: f32 = 1e-5;
/// The ray is moved this far within that thickness, so that it meets no vertex and no edge exactly.
const NUDGE: [f32; 2] = [0.37 * THICKNESS, 0.23 * THICKNESS];
/// Relative difference at which the lower and the upper bound count as equal, of the extent.
const AGREED: f64 = 1e-6;
/// Rounding error of a distance from a plane, of the extent.
const ROUNDING: f64 = 3e-7;
/// Iterations at most. Ten thousand points take 10 to 20.
const ROUNDS: usize = 128;

/// Distance in metres along the unit `direction` from `origin`, which lies within or on the convex hull of `points`,
/// to where the ray leaves that hull.
///
/// The points may be in any order, repeated, flat, collinear or fewer than four: a flat set has a flat hull, and a ray
/// within its plane leaves it at its outline. The answer is 0 where the ray leaves at once, where `origin` lies
/// outside, and where an argument is not finite. All three arguments share one frame.
///
/// With `e` the largest distance of a coordinate from `origin`, the answer is never below the true one by more than
/// rounding, and never above that of a hull which is 2e-5 `e` larger on all sides.
///
/// Time goes with the points, ten to twenty passes over them. No hull is built: a portal, three points whose triangle
/// the ray pierces, walks outwards until no point lies beyond its plane (Snethen, Xenocollide, 2008); seen along the
/// ray that is the simplex method on three variables. The portal bounds the distance from below, the plane from above.
pub fn exit_distance(points: &[Point], origin: Point, direction: Vector) -> f32 {
    let Some(view) = View::new(points, origin, direction) else {
        return 0.0;
    };
    let Some(portal) = view.portal(points) else {
        return 0.0;
    };
    // Behind the origin the hull must begin, or the origin lies before it.
    let behind = view.reversed();
    let (begins, _) = behind.walk(points, portal.map(|[x, y, z]| [x, y, -z]), -f64::from(THICKNESS));
    if begins < -f64::from(THICKNESS) {
        return 0.0;
    }
    let (_, leaves) = view.walk(points, portal, f64::INFINITY);
    if leaves > AGREED { leaves as f32 * view.extent } else { 0.0 }
}

/// A corner of a portal as the ray sees it: two coordinates across it, relative to the nudged ray, and one along it, in
/// extents. Portals get slim, and in f32 the products of their coordinates would cancel; these few are f64, all that is
/// done to every point is f32.
type Corner = [f64; 3];

/// The frame of the ray: `axes[2]` along it.
struct View {
    origin: Point,
    axes: [Vector; 3],
    extent: f32,
    scale: f32,
}

impl View {
    /// `None` where no point is apart from the origin, or something is not finite.
    fn new(points: &[Point], origin: Point, direction: Vector) -> Option<Self> {
        let mut extent = 0.0;
        for p in points {
            let d = p - origin;
            // `max` passes over a NaN; a sum does not.
            if !(d.x + d.y + d.z).is_finite() {
                return None;
            }
            extent = d.x.abs().max(d.y.abs()).max(d.z.abs()).max(extent);
        }
        let length = libm::sqrtf(direction.dot(&direction));
        let usable = extent > f32::MIN_POSITIVE / f32::EPSILON && extent < f32::MAX / 16.0;
        if !(usable && length > 0.5 && length < 2.0) {
            return None;
        }
        // Any axis across the ray will do to find the point farthest from it.
        let along = direction;
        let helper = if along.x.abs() < 0.6 * length { Vector::x() } else { Vector::y() };
        let across = unit(along.cross(&helper))?;
        let mut view =
            Self { origin, axes: [across, along.cross(&across), along], extent, scale: 1.0 / extent };
        let mut farthest = [0.0, 0.0];
        let mut most = 0.0;
        for &p in points {
            let [x, y] = view.across(p);
            let distance = x * x + y * y;
            if distance > most {
                (farthest, most) = ([x, y], distance);
            }
        }
        // With that point on the first axis, a set that is flat along the ray lies on that axis.
        if let Some(first) = unit(view.axes[0] * farthest[0] + view.axes[1] * farthest[1]) {
            view.axes = [first, along.cross(&first), along];
        }
        Some(view)
    }

    fn reversed(&self) -> Self {
        let [a, b, c] = self.axes;
        Self { axes: [a, b, -c], ..*self }
    }

    /// Where a point lies across the ray, in extents.
    fn across(&self, p: Point) -> [f32; 2] {
        // Scale first: the products of small distances would vanish.
        let d = (p - self.origin) * self.scale;
        [self.axes[0].dot(&d), self.axes[1].dot(&d)]
    }

    /// A point moved across the ray by `x`, `y`.
    fn corner(&self, p: Point, [x, y]: [f32; 2]) -> Corner {
        let d = ((p - self.origin) * self.scale).map(f64::from);
        let [a, b, c] = self.axes.map(|axis| axis.map(f64::from).dot(&d));
        [a + f64::from(x - NUDGE[0]), b + f64::from(y - NUDGE[1]), c]
    }

    /// Three corners of thickened points, anticlockwise, that have the ray between them, or `None` where it misses the
    /// thickened hull.
    fn portal(&self, points: &[Point]) -> Option<[Corner; 3]> {
        let nudged = |p: Point| {
            let [x, y] = self.across(p);
            [x - NUDGE[0], y - NUDGE[1]]
        };
        // Seen along the ray, a point and the corners of its square that lie farthest to the left and to the right.
        let mut first = (self.origin, [0.0, 0.0]);
        for &p in points {
            let q = nudged(p);
            if q[0].abs() <= THICKNESS && q[1].abs() <= THICKNESS {
                // The ray goes through this point: half of its square will do.
                let aside = if q[0] <= q[1] { THICKNESS } else { -THICKNESS };
                return around(
                    [[-THICKNESS, -THICKNESS], [aside, -aside], [THICKNESS, THICKNESS]]
                        .map(|by| self.corner(p, by)),
                );
            }
            if q[0] > first.1[0] {
                first = (p, q);
            }
        }
        let leftwards = |q: [f32; 2]| [-THICKNESS.copysign(q[1]), THICKNESS.copysign(q[0])];
        let left_of = |q: [f32; 2]| [q[0] + leftwards(q)[0], q[1] + leftwards(q)[1]];
        let right_of = |q: [f32; 2]| [q[0] - leftwards(q)[0], q[1] - leftwards(q)[1]];
        let left_corner = |(p, q): (Point, [f32; 2])| self.corner(p, leftwards(q));
        let right_corner = |(p, q): (Point, [f32; 2])| self.corner(p, leftwards(q).map(|by| -by));
        let start = self.corner(first.0, [0.0, 0.0]);
        // Those that turn farthest away from the first point, each on its side.
        let (mut left, mut right) = (first, first);
        let (mut leftmost, mut rightmost) = (left_of(first.1), right_of(first.1));
        for &p in points {
            let q = nudged(p);
            let (l, r) = (left_of(q), right_of(q));
            let side = turn(first.1, q);
            // Right behind the ray, seen from the first point; where rounding decides that, the exact test does.
            if q[0] < 0.0
                && turn(first.1, l) <= 0.0
                && turn(first.1, r) >= 0.0
                && let Some(portal) = around([start, left_corner((p, q)), right_corner((p, q))])
            {
                return Some(portal);
            }
            if side >= 0.0 && turn(leftmost, l) > 0.0 {
                (left, leftmost) = ((p, q), l);
            }
            if side <= 0.0 && turn(rightmost, r) < 0.0 {
                (right, rightmost) = ((p, q), r);
            }
        }
        around([start, left_corner(left), right_corner(right)])
    }

    /// Walks the portal outwards until the bounds agree, or the lower one is `enough`. Returns where the ray leaves the
    /// thickened hull at the least, and the hull at the most, in extents.
    fn walk(&self, points: &[Point], mut portal: [Corner; 3], enough: f64) -> (f64, f64) {
        let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
        for _ in 0..ROUNDS {
            let [a, b, c] = portal;
            let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
            let area = cross(u, v);
            // The upward normal of the portal's plane, its third coordinate 1.
            let slope = [(u[1] * v[2] - u[2] * v[1]) / area, (u[2] * v[0] - u[0] * v[2]) / area];
            let height = a[2] + slope[0] * a[0] + slope[1] * a[1];
            if !(area > 0.0 && height.is_finite()) {
                break;
            }
            least = height.max(least);
            if least >= enough {
                break;
            }
            let p = self.farthest(points, slope);
            let s = self.corner(p, slope.map(|c| THICKNESS.copysign(c as f32)));
            let beyond = s[2] + slope[0] * s[0] + slope[1] * s[1] - height;
            // The plane through that point with the portal's slope has all points below it.
            let steepness = slope[0].abs() + slope[1].abs();
            let doubt = ROUNDING * steepness;
            let nudge = slope[0] * f64::from(NUDGE[0]) + slope[1] * f64::from(NUDGE[1]);
            most = (height + beyond + nudge - f64::from(THICKNESS) * steepness + doubt).min(most);
            if beyond <= doubt.max(AGREED) {
                break;
            }
            // The ray passes through one of the three triangles that the new corner makes with the portal's sides.
            let [sa, sb, sc] = portal.map(|q| cross(s, q));
            portal = if sa >= 0.0 && sb <= 0.0 {
                [s, a, b]
            } else if sb >= 0.0 && sc <= 0.0 {
                [s, b, c]
            } else {
                [s, c, a]
            };
        }
        (least, most)
    }

    /// The point farthest along the normal of a plane with that slope; the first of equals.
    fn farthest(&self, points: &[Point], slope: [f64; 2]) -> Point {
        let size = 1.0 + slope[0].abs() + slope[1].abs();
        let [x, y, z] = [slope[0] / size, slope[1] / size, 1.0 / size].map(|c| c as f32);
        let normal = self.axes[0] * x + self.axes[1] * y + self.axes[2] * z;
        let mut best = self.origin;
        let mut most = f32::NEG_INFINITY;
        for &p in points {
            let distance = normal.dot(&(p - self.origin));
            if distance > most {
                (best, most) = (p, distance);
            }
        }
        best
    }
}

/// The triangle, anticlockwise, if the ray passes through it.
fn around([a, b, c]: [Corner; 3]) -> Option<[Corner; 3]> {
    let [ab, bc, ca] = [cross(a, b), cross(b, c), cross(c, a)];
    if ab >= 0.0 && bc >= 0.0 && ca >= 0.0 {
        Some([a, b, c])
    } else if ab <= 0.0 && bc <= 0.0 && ca <= 0.0 {
        Some([a, c, b])
    } else {
        None
    }
}

/// Twice the area, seen along the ray, of the triangle that two corners make with it.
fn cross(a: Corner, b: Corner) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The same, for the many points that are only to be compared.
fn turn(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

fn unit(v: Vector) -> Option<Vector> {
    let length = libm::sqrtf(v.dot(&v));
    (length > 0.0).then(|| v / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Vec<Point> {
        (0..8).map(|i| Point::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32)).collect()
    }

    #[track_caller]
    fn same(a: f32, b: f32, tolerance: f32) {
        assert!((a - b).abs() <= tolerance, "{a}, should be {b}");
    }

    #[test]
    fn cube_from_within() {
        let centre = Point::new(0.5, 0.5, 0.5);
        same(exit_distance(&cube(), centre, Vector::x()), 0.5, 1e-6);
        same(exit_distance(&cube(), Point::new(0.5, 0.25, 0.5), -Vector::y()), 0.25, 1e-6);
        // Through a corner and through the middle of an edge, exactly.
        same(exit_distance(&cube(), centre, Vector::new(1.0, 1.0, 1.0).normalize()), 0.75f32.sqrt(), 1e-5);
        same(exit_distance(&cube(), centre, Vector::new(0.0, 1.0, -1.0).normalize()), 0.5f32.sqrt(), 1e-5);
    }

    #[test]
    fn cube_from_its_boundary_and_from_outside() {
        let face = Point::new(1.0, 0.3, 0.3);
        assert_eq!(exit_distance(&cube(), face, Vector::x()), 0.0);
        same(exit_distance(&cube(), face, -Vector::x()), 1.0, 1e-6);
        // Along the face, along an edge, from a corner.
        same(exit_distance(&cube(), face, Vector::y()), 0.7, 1e-5);
        same(exit_distance(&cube(), Point::new(0.0, 0.0, 0.3), Vector::z()), 0.7, 1e-5);
        same(exit_distance(&cube(), Point::origin(), Vector::repeat(1.0).normalize()), 3f32.sqrt(), 3e-5);
        assert_eq!(exit_distance(&cube(), Point::origin(), -Vector::z()), 0.0);
        // Before the cube, behind it, beside it.
        for x in [-0.5, 1.5] {
            for direction in [Vector::x(), -Vector::x(), Vector::y()] {
                assert_eq!(exit_distance(&cube(), Point::new(x, 0.5, 0.5), direction), 0.0);
            }
        }
    }

    #[test]
    fn tetrahedron() {
        let set = [
            Point::origin(),
            Point::new(1.0, 0.0, 0.0),
            Point::new(0.0, 1.0, 0.0),
            Point::new(0.0, 0.0, 1.0),
        ];
        let origin = Point::new(0.1, 0.1, 0.1);
        same(exit_distance(&set, origin, Vector::repeat(1.0).normalize()), 0.7 / 3f32.sqrt(), 1e-6);
        same(exit_distance(&set, origin, Vector::x()), 0.7, 1e-6);
        same(exit_distance(&set, origin, -Vector::z()), 0.1, 1e-6);
    }

    /// The hull of a sample lies within the sphere, and has in it the sphere that the sample's gaps leave.
    #[test]
    fn sphere() {
        let count = 10_000;
        let spiral = |i: usize| {
            let z = 1.0 - (2 * i + 1) as f32 / count as f32;
            let (sin, cos) = (i as f32 * 2.399_963_3).sin_cos();
            Point::from(Vector::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z) * 0.05)
        };
        let set: Vec<Point> = (0..count).map(spiral).collect();
        for i in 0..200 {
            let direction = spiral(i * 49 + 7).coords.normalize();
            let t = exit_distance(&set, Point::origin(), direction);
            // No point of the sphere is farther than 2.2 / sqrt(count) radii from a sample.
            assert!((0.05 * 0.9995..=0.05 * 1.000_02).contains(&t), "{t}");
        }
    }

    #[test]
    fn flat_and_fewer() {
        // A square in a slanting plane, with points within and again.
        let (u, v) = (Vector::new(0.6, 0.48, 0.64), Vector::new(-0.8, 0.36, 0.48));
        let at = |x: f32, y: f32| Point::new(0.3, -0.2, 0.1) + u * x + v * y;
        let mut set = Vec::new();
        for i in 0..11 {
            for j in 0..11 {
                set.push(at(0.1 * i as f32, 0.1 * j as f32));
            }
        }
        set.extend_from_within(..60);
        same(exit_distance(&set, at(0.3, 0.4), u), 0.7, 2e-5);
        same(exit_distance(&set, at(0.3, 0.4), -v), 0.4, 2e-5);
        same(exit_distance(&set, at(0.25, 0.25), (u + v).normalize()), 0.75 * 2f32.sqrt(), 3e-5);
        same(exit_distance(&set, at(0.3, 0.4), u.cross(&v)), 0.0, 2e-5);

        let segment = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.0)];
        same(exit_distance(&segment, at(0.25, 0.0), u), 0.75, 2e-5);
        same(exit_distance(&segment, at(0.25, 0.0), v), 0.0, 2e-5);
        assert_eq!(exit_distance(&segment, at(1.25, 0.0), u), 0.0);

        assert_eq!(exit_distance(&[at(0.0, 0.0)], at(0.0, 0.0), u), 0.0);
        assert_eq!(exit_distance(&[at(0.0, 0.0); 9], at(0.0, 0.0), u), 0.0);
        assert_eq!(exit_distance(&[at(0.5, 0.0)], at(0.0, 0.0), u), 0.0);
        assert_eq!(exit_distance(&[], at(0.0, 0.0), u), 0.0);
    }

    #[test]
    fn nonsense() {
        let inside = Point::new(0.5, 0.5, 0.5);
        for bad in [f32::NAN, f32::INFINITY, f32::MAX] {
            let mut set = cube();
            set[3].y = bad;
            assert!(exit_distance(&set, inside, Vector::x()).is_finite());
            assert_eq!(exit_distance(&cube(), Point::new(bad, 0.5, 0.5), Vector::x()), 0.0);
            assert_eq!(exit_distance(&cube(), inside, Vector::new(bad, 0.0, 0.0)), 0.0);
        }
        assert_eq!(exit_distance(&cube(), inside, Vector::zeros()), 0.0);
    }

    #[test]
    fn scale_and_order_do_not_matter() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (state >> 8) as f32 / (1 << 24) as f32 - 0.5
        };
        for _ in 0..100 {
            let set: Vec<Point> = (0..50).map(|_| Point::new(random(), random(), random())).collect();
            let origin = Point::from((set[0].coords + set[1].coords + set[2].coords + set[3].coords) / 4.0);
            let direction = Vector::new(random(), random(), random()).normalize();
            let t = exit_distance(&set, origin, direction);
            assert!(t > 0.0);
            for scale in [1e-12, 1e-3, 64.0, 1e12] {
                let large: Vec<Point> = set.iter().map(|p| p * scale).collect();
                same(exit_distance(&large, origin * scale, direction) / scale, t, 2e-5);
            }
            let reversed: Vec<Point> = set.iter().rev().copied().collect();
            same(exit_distance(&reversed, origin, direction), t, 2e-5);
        }
    }

    /// A needle seen from the side: the plane that bounds it is steep, and many points lie close to it.
    #[test]
    fn needle() {
        let set = [
            [-0.012094883, -0.0058180573, -0.009756541],
            [-0.17979766, -0.14180358, -0.18469691],
            [-0.12675688, -0.10357281, -0.13024385],
            [0.13254192, 0.10831921, 0.1485116],
            [-0.22354175, -0.17491922, -0.23396184],
            [-0.07448012, -0.06535697, -0.08424126],
            [0.23022519, 0.18168463, 0.24423814],
            [-0.5781727, -0.46420327, -0.6234132],
            [-0.20056193, -0.15931821, -0.21424796],
            [0.42304367, 0.3377809, 0.4554459],
            [0.25592288, 0.20754085, 0.27983296],
            [-0.3805349, -0.3024521, -0.41032195],
            [0.18847166, 0.1457212, 0.2014467],
            [-0.44930625, -0.3627483, -0.48403385],
            [0.5386101, 0.43129787, 0.5790766],
            [-0.031230632, -0.022020644, -0.028383825],
            [0.25827807, 0.20862186, 0.2776466],
            [0.06809281, 0.050785586, 0.07036706],
            [0.06555571, 0.058536943, 0.071149305],
            [0.16913784, 0.13717946, 0.1857496],
            [-0.3375567, -0.27215004, -0.36722198],
            [0.5046709, 0.4033112, 0.53828347],
        ]
        .map(Point::from);
        let origin = Point::new(-0.006683653, -0.0048891352, -0.0065251067);
        let direction = Vector::new(0.3227196, -0.7750151, -0.54332644);
        same(exit_distance(&set, origin, direction), 0.005426, 2e-5);
    }
}
