//! Cross-sections for sweeps.

use super::vector::turn;

/// Number of corners of the polygon for a circle. Up to a radius of 25 mm the error is about 0.2 mm.
pub(crate) fn corners_of(radius: f64) -> usize {
    match radius {
        r if r < 0.002 => 6,
        r if r < 0.008 => 12,
        r if r < 0.014 => 16,
        _ => 24,
    }
}

/// The polygon for a circle.
pub(crate) fn circle(radius: f64) -> Vec<[f64; 2]> {
    ellipse(radius, radius)
}

/// The polygon for an ellipse of half axes `a` and `b`.
pub(crate) fn ellipse(a: f64, b: f64) -> Vec<[f64; 2]> {
    let n = corners_of(a.max(b));
    let corner = |i| turn(360.0 * i as f64 / n as f64);
    (0..n).map(corner).map(|[cos, sin]| [a * cos, b * sin]).collect()
}

/// A rectangle of edge lengths `a` and `b` about the origin.
pub(crate) fn rectangle(a: f64, b: f64) -> Vec<[f64; 2]> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x * a / 2.0, y * b / 2.0]).to_vec()
}
