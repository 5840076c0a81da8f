//! Vectors and curves in double precision, the same on every machine.

use std::f64::consts::PI;

/// x, y, z in metres.
pub(crate) type V = [f64; 3];

pub(crate) const X: V = [1.0, 0.0, 0.0];
pub(crate) const Y: V = [0.0, 1.0, 0.0];
pub(crate) const Z: V = [0.0, 0.0, 1.0];

pub(crate) fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: V, s: f64) -> V {
    a.map(|c| c * s)
}

pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn unit(a: V) -> V {
    scale(a, 1.0 / length(a))
}

/// `a` + `s` · `b`.
pub(crate) fn along(a: V, s: f64, b: V) -> V {
    add(a, scale(b, s))
}

/// `a` without its part along the unit vector `n`.
pub(crate) fn across(a: V, n: V) -> V {
    along(a, -dot(a, n), n)
}

pub(crate) fn single(a: V) -> [f32; 3] {
    a.map(|c| c as f32)
}

pub(crate) fn double(a: [f32; 3]) -> V {
    a.map(f64::from)
}

/// The cosine and the sine of an angle in degrees.
pub(crate) fn turn(degrees: f64) -> [f64; 2] {
    let radians = degrees * PI / 180.0;
    [libm::cos(radians), libm::sin(radians)]
}

/// Points on an arc about `centre`, from `from` to `to` degrees, where 0 is along `x` and 90 along `y`; both
/// carry their radius.
pub(crate) fn arc(centre: V, x: V, y: V, [from, to]: [f64; 2], steps: usize) -> Vec<V> {
    (0..=steps)
        .map(|i| {
            let [cos, sin] = turn(from + (to - from) * i as f64 / steps as f64);
            along(along(centre, cos, x), sin, y)
        })
        .collect()
}

/// Points on a cubic Bézier curve.
pub(crate) fn bezier(controls: [V; 4], steps: usize) -> Vec<V> {
    (0..=steps)
        .map(|i| {
            let t = i as f64 / steps as f64;
            let s = 1.0 - t;
            let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
            controls.iter().zip(weights).fold([0.0; 3], |sum, (&p, w)| along(sum, w, p))
        })
        .collect()
}

/// A polygon with its corners rounded by arcs that begin `round` before each corner. A closed one ends where it
/// began.
pub(crate) fn rounded(corners: &[V], round: f64, is_closed: bool) -> Vec<V> {
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
