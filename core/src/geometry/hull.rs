//! Convex hulls, asked without being built.

use super::{Point, Vector};

/// Half the side of the square that every point is thickened by across the ray, of the extent. It makes flat and
/// collinear sets solid, and is some hundred times what rounding does to a coordinate.
const THICKNESS: f32 = 1e-5;
/// The ray is moved this far within that thickness, so that it meets no vertex and no edge exactly.
const NUDGE: [f32; 2] = [0.37 * THICKNESS, 0.23 * THICKNESS];
/// Bounds that are this close, of the extent, are one.
const AGREED: f64 = 1e-6;
/// What rounding does to a distance from a plane, of the extent.
const ROUNDING: f64 = 3e-7;
/// More rounds than any set of points has been seen to need (10 to 20 do, for ten thousand points).
const ROUNDS: usize = 128;

/// Distance in metres along the unit `direction` from `origin`, which lies within or on the convex hull of `points`,
/// to where the ray leaves that hull.
///
/// The points may be in any order, repeated, flat, collinear or fewer than four: a flat set has a flat hull, and a ray
/// within its plane leaves it at its outline. The answer is 0 where the ray leaves at once, where `origin` lies
/// outside, and where an argument is not finite. All three arguments share one frame.
///
/// With `e` the largest distance of a coordinate from `origin`, the answer is never below the true one by more than
/// rounding, and never above that of a hull which is 1.5e-5 `e` larger on all sides.
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
            if q[0] < 0.0 && turn(first.1, l) <= 0.0 && turn(first.1, r) >= 0.0 {
                // Right behind the ray, seen from the first point.
                return around([start, left_corner((p, q)), right_corner((p, q))]);
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
