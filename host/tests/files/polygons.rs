//! Triangulations cover polygons of every shape and keep their winding order.

use crate::samples::*;

/// An L of area 3 in the plane, counter-clockwise.
const L: [[f32; 2]; 6] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];

/// An OBJ of the prism of height 1 over a polygon, with `turn` applied to its vertices.
fn prism(polygon: &[[f32; 2]], turn: impl Fn([f32; 3]) -> [f32; 3]) -> String {
    let n = polygon.len();
    let mut out = String::new();
    for height in [0.0, 1.0] {
        for [x, y] in polygon {
            let [x, y, z] = turn([*x, *y, height]);
            out += &format!("v {x} {y} {z}\n");
        }
    }
    let list = |indices: Vec<usize>| indices.iter().map(|i| format!(" {}", i + 1)).collect::<String>();
    out += &format!("f{}\nf{}\n", list((0..n).rev().collect()), list((n..2 * n).collect()));
    for i in 0..n {
        let next = (i + 1) % n;
        out += &format!("f{}\n", list(vec![i, next, next + n, i + n]));
    }
    out
}

fn assert_prism(polygon: &[[f32; 2]], turn: impl Fn([f32; 3]) -> [f32; 3], expected: f64) {
    let mesh = mesh("prism.obj", prism(polygon, turn)).unwrap();
    assert!(is_closed(&mesh));
    assert!((volume(&mesh) - expected).abs() < 1e-4, "{}", volume(&mesh));
    assert_eq!(mesh.triangles.len(), 4 * polygon.len() - 4);
}

#[test]
fn a_concave_polygon_keeps_its_area() {
    let vertices = L.map(|[x, y]| format!("v {x} {y} 0\n")).concat();
    let mesh = mesh("l.obj", vertices + "f 1 2 3 4 5 6\n").unwrap();
    assert_eq!((mesh.triangles.len(), area(&mesh)), (4, 3.0));
}

#[test]
fn a_concave_prism_is_closed_and_not_inside_out_however_it_lies() {
    assert_prism(&L, |p| p, 3.0);
    assert_prism(&L, |[x, y, z]| [z, x, y], 3.0);
    assert_prism(&L, |[x, y, z]| [y, z, x], 3.0);
    assert_prism(&L, |[x, y, z]| [x, -y, -z], 3.0);
    let (s, c) = 0.7_f32.sin_cos();
    assert_prism(&L, |[x, y, z]| [x, c * y - s * z, s * y + c * z], 3.0);
    assert_prism(
        &L,
        |[x, y, z]| [0.6 * x - 0.8 * (s * y + c * z), c * y - s * z, 0.8 * x + 0.6 * (s * y + c * z)],
        3.0,
    );
}

#[test]
fn corners_on_straight_edges_stay_so_that_nothing_tears() {
    let polygon = [
        [0.0, 0.0],
        [0.5, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
        [0.0, 1.0],
    ];
    assert_prism(&polygon, |p| p, 3.0);
    assert_prism(&polygon, |[x, y, z]| [z, x, y], 3.0);
}

#[test]
fn a_dart_is_cut_along_its_inner_diagonal_whichever_corner_is_first() {
    let dart = [[0.0, 0.0], [2.0, -1.0], [0.0, 3.0], [-2.0, -1.0]];
    for first in 0..4 {
        let turned: Vec<_> = (0..4).map(|i| dart[(first + i) % 4]).collect();
        // Two triangles of base 3 and height 2.
        assert_prism(&turned, |p| p, 6.0);
    }
}

#[test]
fn a_star_with_many_points_keeps_its_area() {
    // 100 corners alternate between two circles: 100 triangles of area sin(2 pi / 100) / 2 times both radii.
    let star: Vec<[f32; 2]> = (0..100)
        .map(|i| {
            let (s, c) = (std::f32::consts::TAU * i as f32 / 100.0).sin_cos();
            let radius = if i % 2 == 0 { 1.0 } else { 0.4 };
            [radius * c, radius * s]
        })
        .collect();
    assert_prism(&star, |[x, y, z]| [z, x, y], 100.0 * 0.4 * (std::f64::consts::TAU / 100.0).sin() / 2.0);
}

#[test]
fn a_polygon_without_area_does_no_harm() {
    let line = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nv 0 1 0\nf 1 2 3 4 5\nf 1 2 6\n";
    let mesh = mesh("line.obj", line).unwrap();
    assert_eq!(mesh.triangles.len(), 4);
    assert_eq!(mesh.notes, ["3 of 4 triangles have no area."]);
}
