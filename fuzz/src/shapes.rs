//! Small meshes and clouds that are drawn from bytes: plausible ones, and the same near and in degeneracy.

use crate::draw::Draw;
use std::f32::consts::TAU;

/// A mesh as a caller gives it.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawnMesh {
    pub(crate) vertices: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) viewpoints: Vec<[f32; 3]>,
}

/// A cloud as a caller gives it.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawnCloud {
    pub(crate) points: Vec<[f32; 3]>,
    pub(crate) normals: Option<Vec<[f32; 3]>>,
    pub(crate) viewpoints: Vec<[f32; 3]>,
    pub(crate) marks: Option<Vec<u8>>,
    pub(crate) region: Option<[[f32; 3]; 2]>,
}

/// Factors of the size, all of which a caller may give.
const SCALES: [f32; 8] = [1.0, 1.0, 1.0, 1e-3, 1e-6, 10.0, 1e3, 1e5];

pub(crate) fn mesh(draw: &mut Draw) -> DrawnMesh {
    let mut mesh = match draw.below(8) {
        0 => ring(0.03, 0.004, 12, 6),
        1 => ring(0.02 + 0.02 * draw.part(), 0.012 * draw.part(), 3 + draw.below(14), 3 + draw.below(6)),
        2 => cup(3 + draw.below(10)),
        3 => cuboid([0.02, 0.03, 0.05]),
        4 => hook(3 + draw.below(6)),
        5 => fan(draw),
        6 => sheet(1 + draw.below(6), 1 + draw.below(6)),
        _ => soup(draw),
    };
    if draw.one_in(4) {
        let second = cuboid([0.01 * draw.part(), 0.02, 0.04]);
        append(&mut mesh, &second, draw.shares().map(|x| 0.05 * x));
    }
    for _ in 0..draw.below(8) {
        spoil_mesh(&mut mesh, draw);
    }
    if draw.one_in(3) {
        scale(&mut mesh.vertices, draw);
    }
    if draw.one_in(4) {
        mesh.viewpoints = (0..1 + draw.below(3)).map(|_| draw.place(0.3)).collect();
    }
    mesh
}

pub(crate) fn cloud(draw: &mut Draw) -> DrawnCloud {
    let mut cloud = match draw.below(8) {
        0 => peg(0.004, 0.08, 24, 8),
        1 => peg(0.02 * draw.part(), 0.2 * draw.part(), 2 + draw.below(40), 1 + draw.below(10)),
        2 => plate(2 + draw.below(12), 2 + draw.below(12)),
        3 => line(1 + draw.below(200)),
        4 => copies(1 + draw.below(100), draw.shares().map(|x| 0.1 * x)),
        5 => {
            let mut cloud = peg(0.004, 0.08, 24, 8);
            add_points(&mut cloud, &plate(10, 10));
            cloud
        }
        6 => {
            let mesh = hook(5);
            DrawnCloud { points: mesh.vertices, ..DrawnCloud::default() }
        }
        _ => {
            let points = (0..1 + draw.below(64)).map(|_| draw.shares().map(|x| 0.1 * x)).collect();
            DrawnCloud { points, ..DrawnCloud::default() }
        }
    };
    for _ in 0..draw.below(8) {
        spoil_cloud(&mut cloud, draw);
    }
    if draw.one_in(3) {
        scale(&mut cloud.points, draw);
    }
    match draw.below(4) {
        0 | 1 => {}
        2 => cloud.normals = None,
        _ => cloud.normals = Some(cloud.points.iter().map(|_| draw.place(1.0)).collect()),
    }
    if draw.one_in(4) {
        cloud.viewpoints = (0..1 + draw.below(3)).map(|_| draw.place(0.3)).collect();
    }
    if draw.one_in(6) {
        cloud.marks = Some(cloud.points.iter().map(|_| draw.byte() % 2).collect());
    }
    if draw.one_in(6) {
        let (low, high) = (draw.shares(), draw.shares());
        cloud.region = Some([
            [0, 1, 2].map(|i| draw.or_number(0.1 * low[i].min(high[i]))),
            [0, 1, 2].map(|i| draw.or_number(0.1 * low[i].max(high[i]))),
        ]);
    }
    cloud
}

/// One change that makes a mesh worse.
fn spoil_mesh(mesh: &mut DrawnMesh, draw: &mut Draw) {
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    if vertices == 0 || triangles == 0 {
        return;
    }
    let (a, b) = (draw.below(vertices), draw.below(vertices));
    match draw.below(14) {
        // Two vertices in one place, or next to each other by the least step of a number.
        0 => mesh.vertices[a] = mesh.vertices[b],
        1 => mesh.vertices[a] = mesh.vertices[b].map(f32::next_up),
        // Three vertices on a line.
        2 => {
            let (from, to, at) = (mesh.vertices[draw.below(vertices)], mesh.vertices[b], draw.share());
            mesh.vertices[a] = [0, 1, 2].map(|i| from[i] + at * (to[i] - from[i]));
        }
        // A spike.
        3 => mesh.vertices[a][draw.below(3)] *= draw.pick(&[10.0, 1e3, 1e5, -1.0, 1e-3]),
        4 => mesh.vertices[a][draw.below(3)] = draw.number(),
        // Nearly flat, or flat.
        5 => {
            let (axis, factor) = (draw.below(3), draw.pick(&[0.0, 1e-8, 1e-6, 1e-4, 1e-2]));
            mesh.vertices.iter_mut().for_each(|vertex| vertex[axis] *= factor);
        }
        6 => {
            let copy = mesh.triangles[draw.below(triangles)];
            mesh.triangles.push(copy);
        }
        // The other way round.
        7 => mesh.triangles[draw.below(triangles)].swap(0, 1),
        8 => mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1)),
        9 => drop(mesh.triangles.swap_remove(draw.below(triangles))),
        10 => mesh.triangles[draw.below(triangles)][draw.below(3)] = b as u32,
        11 => mesh.triangles[draw.below(triangles)][draw.below(3)] = draw.word(),
        // A huge triangle beside small ones.
        12 => {
            let first = vertices as u32;
            mesh.vertices.extend([[1e3, 0.0, 0.0], [0.0, 1e3, 0.0], [-1e3, -1e3, draw.share()]]);
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        _ => {
            let far = draw.shares().map(|x| 1e4 * x);
            mesh.vertices.iter_mut().for_each(|vertex| *vertex = [0, 1, 2].map(|i| vertex[i] + far[i]));
        }
    }
}

/// One change that makes a cloud worse.
fn spoil_cloud(cloud: &mut DrawnCloud, draw: &mut Draw) {
    let count = cloud.points.len();
    if count == 0 {
        return;
    }
    let (a, b) = (draw.below(count), draw.below(count));
    match draw.below(10) {
        0 => cloud.points[a] = cloud.points[b],
        1 => cloud.points[a] = cloud.points[b].map(f32::next_up),
        2 => cloud.points[a][draw.below(3)] *= draw.pick(&[10.0, 1e3, 1e5, -1.0, 1e-3]),
        3 => cloud.points[a][draw.below(3)] = draw.number(),
        4 => {
            let (axis, factor) = (draw.below(3), draw.pick(&[0.0, 1e-8, 1e-6, 1e-4, 1e-2]));
            cloud.points.iter_mut().for_each(|point| point[axis] *= factor);
        }
        5 => {
            if let Some(normals) = &mut cloud.normals {
                normals[a] = draw.shares();
            }
        }
        6 => {
            if let Some(normals) = &mut cloud.normals {
                normals.iter_mut().for_each(|normal| *normal = normal.map(|x| -x));
            }
        }
        7 => {
            if let Some(normals) = &mut cloud.normals {
                normals[a] = [0.0; 3];
            }
        }
        8 => {
            let far = draw.shares().map(|x| 1e4 * x);
            cloud.points.iter_mut().for_each(|point| *point = [0, 1, 2].map(|i| point[i] + far[i]));
        }
        _ => {
            let half = count / 2;
            cloud.points.truncate(half);
            if let Some(normals) = &mut cloud.normals {
                normals.truncate(half);
            }
        }
    }
}

fn scale(points: &mut [[f32; 3]], draw: &mut Draw) {
    let factor = draw.pick(&SCALES);
    points.iter_mut().for_each(|point| *point = point.map(|x| factor * x));
}

fn append(mesh: &mut DrawnMesh, other: &DrawnMesh, by: [f32; 3]) {
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(other.vertices.iter().map(|vertex| [0, 1, 2].map(|i| vertex[i] + by[i])));
    mesh.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|index| first + index)));
}

fn add_points(cloud: &mut DrawnCloud, other: &DrawnCloud) {
    cloud.points.extend_from_slice(&other.points);
    if let (Some(normals), Some(others)) = (&mut cloud.normals, &other.normals) {
        normals.extend_from_slice(others);
    }
}

fn turn(step: usize, steps: usize) -> (f32, f32) {
    (TAU * step as f32 / steps as f32).sin_cos()
}

/// A grid of quadrilaterals that is closed in both directions.
fn torus(rows: usize, columns: usize, at: impl Fn(usize, usize) -> [f32; 3]) -> DrawnMesh {
    let index = |row: usize, column: usize| (row % rows * columns + column % columns) as u32;
    let cells = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let triangles = cells().flat_map(|(row, column)| {
        let [a, b] = [index(row, column), index(row + 1, column)];
        let [c, d] = [index(row + 1, column + 1), index(row, column + 1)];
        [[a, b, c], [a, c, d]]
    });
    DrawnMesh {
        vertices: cells().map(|(row, column)| at(row, column)).collect(),
        triangles: triangles.collect(),
        viewpoints: Vec::new(),
    }
}

/// A ring around the z axis: radius of the centre line and of the tube, metres.
pub(crate) fn ring(radius: f32, thickness: f32, rows: usize, columns: usize) -> DrawnMesh {
    torus(rows, columns, |row, column| {
        let ((s, c), (u, v)) = (turn(row, rows), turn(column, columns));
        let r = radius + thickness * v;
        [r * c, r * s, thickness * u]
    })
}

/// An open cup.
fn cup(sides: usize) -> DrawnMesh {
    let mut mesh = DrawnMesh { vertices: vec![[0.0; 3], [0.0, 0.0, 0.004]], ..DrawnMesh::default() };
    for (radius, z) in [(0.03, 0.0), (0.03, 0.08), (0.027, 0.08), (0.027, 0.004)] {
        mesh.vertices.extend((0..sides).map(|side| {
            let (s, c) = turn(side, sides);
            [radius * c, radius * s, z]
        }));
    }
    let at = |ring: usize, side: usize| (2 + ring * sides + side % sides) as u32;
    for side in 0..sides {
        mesh.triangles.push([0, at(0, side + 1), at(0, side)]);
        for ring in 0..3 {
            let [a, b] = [at(ring, side), at(ring, side + 1)];
            let [c, d] = [at(ring + 1, side + 1), at(ring + 1, side)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh.triangles.push([1, at(3, side), at(3, side + 1)]);
    }
    mesh
}

fn cuboid(size: [f32; 3]) -> DrawnMesh {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { size[axis] } else { -size[axis] });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    DrawnMesh {
        vertices: (0..8).map(corner).collect(),
        triangles: sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        viewpoints: Vec::new(),
    }
}

/// Three quarters of a ring, open at its ends.
fn hook(columns: usize) -> DrawnMesh {
    let mut mesh = ring(0.03, 0.004, 16, columns);
    mesh.triangles.truncate(mesh.triangles.len() * 3 / 4);
    mesh
}

/// Triangles that share one corner.
fn fan(draw: &mut Draw) -> DrawnMesh {
    let count = 2 + draw.below(30);
    let mut vertices = vec![[0.0; 3]];
    vertices.extend((0..count).map(|_| draw.shares().map(|x| 0.05 * x)));
    let triangles = (1..count as u32).map(|i| [0, i, i + 1]).collect();
    DrawnMesh { vertices, triangles, viewpoints: Vec::new() }
}

/// A flat grid.
fn sheet(rows: usize, columns: usize) -> DrawnMesh {
    let at = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
    let places = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column)));
    DrawnMesh {
        vertices: places.map(|(row, column)| [0.01 * row as f32, 0.01 * column as f32, 0.0]).collect(),
        triangles: (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (row, column)))
            .flat_map(|(row, column)| {
                let [a, b] = [at(row, column), at(row + 1, column)];
                let [c, d] = [at(row + 1, column + 1), at(row, column + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
        viewpoints: Vec::new(),
    }
}

/// Any vertices and any triangles.
fn soup(draw: &mut Draw) -> DrawnMesh {
    let count = 1 + draw.below(24);
    let vertices: Vec<_> = (0..count).map(|_| [draw.number(), draw.number(), draw.number()]).collect();
    let triangles = (0..draw.below(40)).map(|_| [0; 3].map(|_: u32| draw.below(count) as u32)).collect();
    DrawnMesh { vertices, triangles, viewpoints: Vec::new() }
}

/// A peg along the y axis: radius and length, metres.
pub(crate) fn peg(radius: f32, length: f32, rows: usize, columns: usize) -> DrawnCloud {
    let places = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let normal = |column: usize| {
        let (s, c) = turn(column, columns);
        [s, 0.0, c]
    };
    let point = |(row, column): (usize, usize)| {
        let [x, _, z] = normal(column);
        [radius * x, length * row as f32 / rows as f32, radius * z]
    };
    DrawnCloud {
        points: places().map(point).collect(),
        normals: Some(places().map(|(_, column)| normal(column)).collect()),
        ..DrawnCloud::default()
    }
}

/// A level grid of points, 1 cm apart.
fn plate(rows: usize, columns: usize) -> DrawnCloud {
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let points: Vec<_> = places.map(|(row, column)| [0.01 * row as f32, 0.01 * column as f32, 0.0]).collect();
    let normals = Some(vec![[0.0, 0.0, 1.0]; points.len()]);
    DrawnCloud { points, normals, ..DrawnCloud::default() }
}

fn line(count: usize) -> DrawnCloud {
    let points: Vec<_> = (0..count).map(|i| [0.0, 0.001 * i as f32, 0.0]).collect();
    let normals = Some(vec![[0.0, 0.0, 1.0]; count]);
    DrawnCloud { points, normals, ..DrawnCloud::default() }
}

fn copies(count: usize, of: [f32; 3]) -> DrawnCloud {
    DrawnCloud { points: vec![of; count], ..DrawnCloud::default() }
}
