//! Vectors, curves and closed surfaces in double precision, with the same bits on every machine.

use std::f64::consts::PI;

/// A point or vector: x, y, z in metres.
pub type V = [f64; 3];

/// Unit vector along x.
pub const X: V = [1.0, 0.0, 0.0];
/// Unit vector along y.
pub const Y: V = [0.0, 1.0, 0.0];
/// Unit vector along z.
pub const Z: V = [0.0, 0.0, 1.0];

/// The sum `a` + `b`.
pub fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference `a` - `b`.
pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The product `s` · `a`.
pub fn scale(a: V, s: f64) -> V {
    a.map(|c| c * s)
}

/// The dot product.
pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product `a` × `b`.
pub fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The Euclidean norm.
pub fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`, which must not be zero.
pub fn unit(a: V) -> V {
    scale(a, 1.0 / length(a))
}

/// The sum `a` + `s` · `b`.
pub fn along(a: V, s: f64, b: V) -> V {
    add(a, scale(b, s))
}

/// The component of `a` perpendicular to the unit vector `n`.
pub fn across(a: V, n: V) -> V {
    along(a, -dot(a, n), n)
}

/// The vector rounded to single precision.
pub fn single(a: V) -> [f32; 3] {
    a.map(|c| c as f32)
}

/// The vector in double precision.
pub fn double(a: [f32; 3]) -> V {
    a.map(f64::from)
}

/// The cosine and the sine of an angle in radians.
pub fn cos_sin(radians: f64) -> [f64; 2] {
    [libm::cos(radians), libm::sin(radians)]
}

/// The cosine and the sine of an angle in degrees.
pub fn turn(degrees: f64) -> [f64; 2] {
    cos_sin(degrees * PI / 180.0)
}

/// `steps` + 1 points on an arc about `centre`, from `from` to `to` degrees. 0 is along `x` and 90 along `y`; the
/// lengths of the two vectors are the arc's radii.
pub fn arc(centre: V, x: V, y: V, [from, to]: [f64; 2], steps: usize) -> Vec<V> {
    (0..=steps)
        .map(|i| {
            let [cos, sin] = turn(from + (to - from) * i as f64 / steps as f64);
            along(along(centre, cos, x), sin, y)
        })
        .collect()
}

/// `steps` + 1 points on a cubic Bézier curve.
pub fn bezier(controls: [V; 4], steps: usize) -> Vec<V> {
    (0..=steps)
        .map(|i| {
            let t = i as f64 / steps as f64;
            let s = 1.0 - t;
            let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
            controls.iter().zip(weights).fold([0.0; 3], |sum, (&p, w)| along(sum, w, p))
        })
        .collect()
}

/// A polygon whose corners are rounded by curves that begin `round` metres before each corner. The path of a closed
/// polygon ends at its first point.
pub fn rounded(corners: &[V], round: f64, is_closed: bool) -> Vec<V> {
    let n = corners.len();
    let mut path = Vec::new();
    for (i, &corner) in corners.iter().enumerate() {
        if !is_closed && (i == 0 || i == n - 1) {
            path.push(corner);
            continue;
        }
        let before = along(corner, round, unit(sub(corners[(i + n - 1) % n], corner)));
        let after = along(corner, round, unit(sub(corners[(i + 1) % n], corner)));
        path.extend(bezier(
            [
                before,
                along(scale(before, 0.45), 0.55, corner),
                along(scale(after, 0.45), 0.55, corner),
                after,
            ],
            12,
        ));
    }
    if is_closed {
        path.push(path[0]);
    }
    path
}

/// Rotation-minimising frames of a path, one for each of its unit tangents: two unit vectors perpendicular to the
/// tangent, the first and then the tangent × the first. The first frame is the one closest to `side`.
pub fn frames(tangents: &[V], side: V) -> Vec<[V; 2]> {
    let carried = |u: &mut V, &t: &V| {
        *u = unit(across(*u, t));
        Some([*u, cross(t, *u)])
    };
    tangents.iter().scan(side, carried).collect()
}

/// Reverses the triangles of a closed surface if it is inside out, so that they are counter-clockwise seen from
/// outside.
pub fn face_outwards(vertices: &[V], triangles: &mut [[usize; 3]]) {
    let volume: f64 = triangles
        .iter()
        .map(|t| t.map(|i| sub(vertices[i], vertices[0])))
        .map(|[a, b, c]| dot(a, cross(b, c)))
        .sum();
    if volume < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}
