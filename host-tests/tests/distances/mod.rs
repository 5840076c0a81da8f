//! Textbook distances, independent of the code under test.

use host_tests::solid::Part;

type V = [f64; 3];

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

/// A part as half-spaces, or as a capsule.
pub(crate) enum Hull {
    /// Unit normals and offsets of the faces.
    Faces(Vec<(V, f64)>),
    /// Ends of the segment and radius of a capsule.
    Capsule(V, V, f64),
}

impl Hull {
    /// Converts a part. The faces of a hull are the planes through three points that have all others on one side.
    pub(crate) fn of(part: &Part) -> Self {
        match part {
            &Part::Capsule { from, to, radius } => {
                Self::Capsule(from.map(f64::from), to.map(f64::from), f64::from(radius))
            }
            Part::Cuboid { centre, axes, half_extents } => Self::Faces(
                (0..6)
                    .map(|i| {
                        let sign = if i < 3 { 1.0 } else { -1.0 };
                        let n = axes[i % 3].map(|c| sign * f64::from(c));
                        (n, dot(n, centre.map(f64::from)) + f64::from(half_extents[i % 3]))
                    })
                    .collect(),
            ),
            Part::Hull(points) => {
                let points: Vec<V> = points.iter().map(|p| p.map(f64::from)).collect();
                let mut faces: Vec<(V, f64)> = Vec::new();
                for (i, &a) in points.iter().enumerate() {
                    for (j, &b) in points.iter().enumerate().skip(i + 1) {
                        for &c in &points[j + 1..] {
                            let n = cross(sub(b, a), sub(c, a));
                            let size = length(n);
                            if size < 1e-12 {
                                continue;
                            }
                            for n in [n.map(|x| x / size), n.map(|x| -x / size)] {
                                let offset = dot(n, a);
                                if points.iter().all(|&p| dot(n, p) < offset + 1e-6) {
                                    faces.push((n, offset));
                                }
                            }
                        }
                    }
                }
                assert!(faces.len() >= 4, "a flat part: {points:?}");
                Self::Faces(faces)
            }
        }
    }
}

/// Signed distance, negative inside. Outside near an edge it may be too small.
pub(crate) fn distance_to_part(hull: &Hull, p: V) -> f64 {
    match hull {
        Hull::Faces(faces) => faces.iter().map(|&(n, d)| dot(n, p) - d).fold(f64::NEG_INFINITY, f64::max),
        &Hull::Capsule(a, b, radius) => distance_to_segment(p, a, b) - radius,
    }
}

fn distance_to_segment(p: V, a: V, b: V) -> f64 {
    let (ab, ap) = (sub(b, a), sub(p, a));
    let t = (dot(ap, ab) / dot(ab, ab)).clamp(0.0, 1.0);
    length([0, 1, 2].map(|i| ap[i] - t * ab[i]))
}

/// Distance from a point to a triangle.
pub(crate) fn distance_to_triangle(p: V, &[a, b, c]: &[V; 3]) -> f64 {
    let n = cross(sub(b, a), sub(c, a));
    let size = length(n);
    let is_above = |a: V, b: V| dot(cross(n, sub(b, a)), sub(p, a)) >= 0.0;
    if size > 1e-14 && is_above(a, b) && is_above(b, c) && is_above(c, a) {
        return dot(n, sub(p, a)).abs() / size;
    }
    [(a, b), (b, c), (c, a)].iter().map(|&(a, b)| distance_to_segment(p, a, b)).fold(f64::INFINITY, f64::min)
}

/// Winding number of the surface around a point, by the solid angles of Van Oosterom and Strackee.
pub(crate) fn winding_number(triangles: &[[V; 3]], p: V) -> f64 {
    let angle = |t: &[V; 3]| {
        let [a, b, c] = t.map(|v| sub(v, p));
        let [la, lb, lc] = [a, b, c].map(length);
        let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        dot(a, cross(b, c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / std::f64::consts::TAU
}
