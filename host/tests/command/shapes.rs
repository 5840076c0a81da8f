//! Shapes with known sites and centres of mass, in metres with z up.

use super::{Value, distance, number, numbers};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

pub(crate) type Mesh = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// Radius of the ring's centre line, which lies in the xz plane around the origin.
pub(crate) const RING_RADIUS: f64 = 0.03;
/// Radius of the ring's wire.
pub(crate) const WIRE_RADIUS: f64 = 0.004;
/// Half extents of the weight below the ring.
pub(crate) const WEIGHT: [f64; 3] = [0.01, 0.004, 0.04];
/// Height of the centre of the weight.
pub(crate) const WEIGHT_Z: f64 = -0.08;
/// Radius of the peg, which lies along x with its centre at the origin.
pub(crate) const PEG_RADIUS: f64 = 0.004;
/// Length of the peg.
pub(crate) const PEG_LENGTH: f64 = 0.1;

/// The ring, of `2 rows columns` triangles.
pub(crate) fn torus(rows: usize, columns: usize) -> Mesh {
    grid(rows, columns, |u, v| {
        let (u, v) = (TAU * u, TAU * v);
        let r = RING_RADIUS + WIRE_RADIUS * v.cos();
        [r * u.cos(), WIRE_RADIUS * v.sin(), r * u.sin()]
    })
}

/// A ring and a box below it, as two closed bodies.
pub(crate) fn weighted_ring() -> Mesh {
    let (mut vertices, mut triangles) = torus(96, 24);
    let first = vertices.len();
    for i in 0..8 {
        let side = |axis: usize| if i >> axis & 1 == 1 { WEIGHT[axis] } else { -WEIGHT[axis] };
        vertices.push([side(0), side(1), WEIGHT_Z + side(2)]);
    }
    // Counter-clockwise seen from outside.
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        triangles.extend([[a, b, c], [a, c, d]].map(|t: [usize; 3]| t.map(|i| first + i)));
    }
    (vertices, triangles)
}

/// Asserts that the free space of a site of the weighted ring lies in the hole of the ring and touches the wire.
#[track_caller]
pub(crate) fn assert_is_in_the_ring(site: &Value) {
    let reach = distance(numbers(&site["position"]), [0.0; 3]) + number(&site["free_space_radius"]);
    assert!((reach - (RING_RADIUS - WIRE_RADIUS)).abs() < 0.001, "{site}");
    let [_, axis, _] = numbers(&site["hanging_direction"]);
    assert!(axis.abs() > 0.7, "through the hole: {site}");
}

/// Asserts that every contact at rest is between the ring and the top of the peg.
#[track_caller]
pub(crate) fn assert_hangs_by_the_ring(entry: &Value) {
    let rest = numbers::<16>(&entry["rest_pose"]);
    for contact in entry["contacts"].as_array().unwrap() {
        let p @ [x, y, z] = numbers::<3>(&contact["position"]);
        assert!(x.abs() < PEG_LENGTH / 2.0 + 0.001, "{contact}");
        assert!((y.hypot(z) - PEG_RADIUS).abs() < 0.001 && z > 0.0, "on top of the peg: {contact}");
        // The contact in the object frame.
        let [u, v, w] =
            core::array::from_fn(|i| (0..3).map(|j| rest[4 * j + i] * (p[j] - rest[4 * j + 3])).sum::<f64>());
        let from_wire = (f64::hypot(u, w) - RING_RADIUS).hypot(v);
        assert!((from_wire - WIRE_RADIUS).abs() < 0.001, "on the ring: {contact} {from_wire}");
    }
}

/// Height of the weighted ring's centre of mass, which lies on the z axis: the volume of the ring is by Pappus'
/// theorem.
pub(crate) fn weighted_ring_centre_z() -> f64 {
    let ring = PI * WIRE_RADIUS.powi(2) * TAU * RING_RADIUS;
    let weight = 8.0 * WEIGHT.iter().product::<f64>();
    WEIGHT_Z * weight / (ring + weight)
}

/// A ball: no part of its surface faces its centre.
pub(crate) fn ball() -> Mesh {
    let (mut vertices, mut triangles) = grid(24, 11, |u, v| {
        let (u, v) = (TAU * u, PI * (v * 11.0 + 1.0) / 12.0);
        [0.04 * v.sin() * u.cos(), 0.04 * v.sin() * u.sin(), 0.04 * v.cos()]
    });
    // The grid joins the last row to the first; a ball has poles there.
    triangles.retain(|t| t.iter().all(|i| i % 11 != 10) || t.iter().all(|i| i % 11 != 0));
    let (north, south) = (vertices.len(), vertices.len() + 1);
    vertices.extend([[0.0, 0.0, 0.04], [0.0, 0.0, -0.04]]);
    for u in 0..24 {
        let next = (u + 1) % 24;
        triangles.push([north, 11 * u, 11 * next]);
        triangles.push([south, 11 * next + 10, 11 * u + 10]);
    }
    (vertices, triangles)
}

/// The peg as a closed mesh.
pub(crate) fn peg_mesh() -> Mesh {
    let n = 32;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for x in [-PEG_LENGTH / 2.0, PEG_LENGTH / 2.0] {
        for k in 0..n {
            let angle = TAU * k as f64 / n as f64;
            vertices.push([x, PEG_RADIUS * angle.cos(), PEG_RADIUS * angle.sin()]);
        }
    }
    vertices.extend([[-PEG_LENGTH / 2.0, 0.0, 0.0], [PEG_LENGTH / 2.0, 0.0, 0.0]]);
    for k in 0..n {
        let l = (k + 1) % n;
        triangles.extend([[k, n + l, l], [k, n + k, n + l], [2 * n, k, l], [2 * n + 1, n + l, n + k]]);
    }
    // Counter-clockwise seen from outside.
    triangles.iter_mut().for_each(|t| t.reverse());
    (vertices, triangles)
}

/// The peg as points and normals.
pub(crate) fn peg() -> Vec<[f64; 6]> {
    let (along, around) = (201, 24);
    let mut points = Vec::new();
    for i in 0..along {
        for k in 0..around {
            let x = PEG_LENGTH * (i as f64 / (along - 1) as f64 - 0.5);
            let (sin, cos) = (TAU * k as f64 / around as f64).sin_cos();
            points.push([x, PEG_RADIUS * cos, PEG_RADIUS * sin, 0.0, cos, sin]);
        }
    }
    points
}

/// A surface over the unit square that is periodic in both directions.
fn grid(m: usize, n: usize, at: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..m {
        for j in 0..n {
            vertices.push(at(i as f64 / m as f64, j as f64 / n as f64));
            let corner = |i: usize, j: usize| i % m * n + j % n;
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            triangles.extend([[a, c, b], [a, d, c]]);
        }
    }
    (vertices, triangles)
}

pub(crate) fn obj((vertices, triangles): &Mesh) -> String {
    let mut text = String::new();
    for [x, y, z] in vertices {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [a, b, c] in triangles.iter().map(|t| t.map(|i| i + 1)) {
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text
}

/// XYZ text with one column per number of a point.
pub(crate) fn xyz<const N: usize>(points: &[[f64; N]]) -> String {
    let line = |p: &[f64; N]| p.map(|x| x.to_string()).join(" ") + "\n";
    points.iter().map(line).collect()
}

pub(crate) fn without_normals(points: &[[f64; 6]]) -> Vec<[f64; 3]> {
    points.iter().map(|&[x, y, z, ..]| [x, y, z]).collect()
}
