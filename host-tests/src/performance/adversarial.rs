//! Meshes and clouds of any size that are hard for trees, grids and neighbour searches.

use crate::performance::refine::{Triangles, refine, weld};
use crate::shapes::Random;
use crate::shapes::vector::{add, scale, single, unit};
use std::f64::consts::TAU;

/// Length of a shape along its longest side, metres, where its name does not say another.
const SIZE: f64 = 0.1;

/// Meshes of about `count` triangles with their names.
pub fn meshes(count: usize) -> Vec<(&'static str, Triangles)> {
    vec![
        ("sheet", sheet(count)),
        ("on one line", line(count)),
        ("copies of one triangle", soup(count, |_, _| [[0.0; 3], [0.05, 0.0, 0.0], [0.0, 0.05, 0.0]])),
        ("sphere", sphere(count)),
        ("nested spheres", nested(count)),
        ("comb", comb(count)),
        ("wire spiral", coil(count)),
        ("fractal", fractal(count)),
        ("needles through one point", soup(count, |random, _| needle(random))),
        ("large triangles in any place", soup(count, |random, _| [0; 3].map(|_| inside(random, SIZE)))),
        (
            "one of 100 m among tiny ones",
            soup(count, |random, i| if i == 0 { huge() } else { small(random, 1e-4) }),
        ),
        (
            "sizes of 0.1 µm to 0.1 m",
            soup(count, |random, _| {
                let size = SIZE * 10_f64.powf(random.range(-6.0, 0.0));
                small(random, size)
            }),
        ),
    ]
}

/// Clouds of `count` points with their names.
pub fn clouds(count: usize) -> Vec<(&'static str, Vec<[f32; 3]>)> {
    let mut random = Random::named("adversarial clouds", 1);
    let mut of = |point: &mut dyn FnMut(&mut Random, f64) -> [f64; 3]| {
        (0..count).map(|i| point(&mut random, i as f64 / count as f64).map(|x| x as f32)).collect::<Vec<_>>()
    };
    vec![
        ("on one plane", of(&mut |random, _| [random.range(0.0, SIZE), random.range(0.0, SIZE), 0.0])),
        ("grid on one plane", {
            let columns = count.isqrt().max(1);
            (0..count).map(|i| [(i % columns) as f32 * 1e-3, (i / columns) as f32 * 1e-3, 0.0]).collect()
        }),
        ("on one line", of(&mut |_, part| [SIZE * part, 0.0, 0.0])),
        ("copies of one point", of(&mut |_, _| [0.01, 0.02, 0.03])),
        ("filled ball", of(&mut |random, _| inside(random, SIZE))),
        ("sphere", of(&mut |random, _| scale(direction(random), 0.5 * SIZE))),
        (
            "comb",
            of(&mut |random, part| {
                let (s, c) = random.range(0.0, TAU).sin_cos();
                let tooth = (part * 100.0).floor();
                [tooth * 3e-3 + 5e-4 * c, random.range(0.0, SIZE), 5e-4 * s]
            }),
        ),
        (
            "wire spiral",
            of(&mut |random, part| {
                let ((s, c), (u, v)) = ((part * 40.0 * TAU).sin_cos(), random.range(0.0, TAU).sin_cos());
                let radius = 0.02 + 1e-3 * v;
                [radius * c, radius * s, SIZE * part + 1e-3 * u]
            }),
        ),
        ("half within 1 µm", of(&mut |random, part| inside(random, if part < 0.5 { 1e-6 } else { SIZE }))),
        (
            "two groups 1000 m apart",
            of(&mut |random, part| {
                let [x, y, z] = inside(random, SIZE);
                [if part < 0.5 { x } else { x + 1000.0 }, y, z]
            }),
        ),
        (
            "distances of 0.1 µm to 0.1 m",
            of(&mut |random, _| {
                let distance = SIZE * 10_f64.powf(random.range(-6.0, 0.0));
                scale(direction(random), distance)
            }),
        ),
    ]
}

fn direction(random: &mut Random) -> [f64; 3] {
    unit([0; 3].map(|_| random.gaussian()))
}

/// A point of a ball of this diameter.
fn inside(random: &mut Random, diameter: f64) -> [f64; 3] {
    let radius = 0.5 * diameter * random.range(0.0, 1.0).cbrt();
    scale(direction(random), radius)
}

/// A triangle of this size somewhere in the room of the shape.
fn small(random: &mut Random, size: f64) -> [[f64; 3]; 3] {
    let at = inside(random, SIZE);
    [0; 3].map(|_| add(at, inside(random, size)))
}

/// A sliver as long as the shape, through the origin.
fn needle(random: &mut Random) -> [[f64; 3]; 3] {
    let to = scale(direction(random), 0.5 * SIZE);
    let beside = inside(random, 1e-4);
    [scale(to, -1.0), to, add(to, beside)]
}

fn huge() -> [[f64; 3]; 3] {
    [[-50.0, -50.0, -0.1], [50.0, -50.0, 0.1], [0.0, 50.0, 0.0]]
}

/// Triangles without common vertices.
fn soup(count: usize, mut triangle: impl FnMut(&mut Random, usize) -> [[f64; 3]; 3]) -> Triangles {
    let mut random = Random::named("adversarial meshes", 1);
    let vertices =
        (0..count).flat_map(|i| triangle(&mut random, i)).map(|vertex| vertex.map(|x| x as f32)).collect();
    (vertices, (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// A flat square.
fn sheet(count: usize) -> Triangles {
    let s = SIZE as f32;
    refine((vec![[0.0; 3], [s, 0.0, 0.0], [s, s, 0.0], [0.0, s, 0.0]], vec![[0, 1, 2], [0, 2, 3]]), count)
}

/// Triangles without area, in a row.
fn line(count: usize) -> Triangles {
    let step = SIZE / count as f64;
    soup(count, |_, i| [0.0, 0.5, 1.0].map(|part| [step * (i as f64 + part), 0.0, 0.0]))
}

fn octahedron(radius: f64) -> Triangles {
    let r = radius as f32;
    let vertices =
        vec![[r, 0.0, 0.0], [-r, 0.0, 0.0], [0.0, r, 0.0], [0.0, -r, 0.0], [0.0, 0.0, r], [0.0, 0.0, -r]];
    let triangles =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    (vertices, triangles)
}

/// All points of it are equally far from its centre.
fn sphere_of(count: usize, radius: f64) -> Triangles {
    let (mut vertices, triangles) = refine(octahedron(radius), count);
    for vertex in &mut vertices {
        let length = vertex.iter().map(|x| x * x).sum::<f32>().sqrt();
        *vertex = vertex.map(|x| x * radius as f32 / length);
    }
    (vertices, triangles)
}

fn sphere(count: usize) -> Triangles {
    sphere_of(count, 0.5 * SIZE)
}

/// Ten spheres around one centre.
fn nested(count: usize) -> Triangles {
    joined((1..=10).map(|i| sphere_of(count / 10, 0.05 * SIZE * f64::from(i))))
}

fn joined(parts: impl Iterator<Item = Triangles>) -> Triangles {
    let mut whole = Triangles::default();
    for (vertices, triangles) in parts {
        let first = whole.0.len() as u32;
        whole.0.extend(vertices);
        whole.1.extend(triangles.iter().map(|triangle| triangle.map(|index| first + index)));
    }
    whole
}

/// A cuboid between two corners.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Triangles {
    let corner =
        |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { high[axis] } else { low[axis] } as f32);
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (
        (0..8).map(corner).collect(),
        sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    )
}

/// Thin teeth on a bar.
fn comb(count: usize) -> Triangles {
    let teeth = (count / 12).max(2);
    let pitch = SIZE / teeth as f64;
    let bar = cuboid([0.0, -0.005, 0.0], [SIZE, 0.0, 0.003]);
    joined(std::iter::once(bar).chain((0..teeth).map(|i| {
        let x = pitch * i as f64;
        cuboid([x, 0.0, 0.0], [x + 0.5 * pitch, 0.05, 0.003])
    })))
}

/// A wire of 40 turns, open at its ends.
fn coil(count: usize) -> Triangles {
    const SIDES: usize = 6;
    let rows = (count / (2 * SIDES)).max(2);
    let point = |i: usize| {
        let (turn, (u, v)) = (
            40.0 * TAU * (i / SIDES) as f64 / rows as f64,
            (TAU * (i % SIDES) as f64 / SIDES as f64).sin_cos(),
        );
        let (radius, z) = (0.02 + 5e-4 * v, SIZE * (i / SIDES) as f64 / rows as f64 + 5e-4 * u);
        [radius * turn.cos(), radius * turn.sin(), z].map(|x| x as f32)
    };
    let at = |row: usize, side: usize| (row * SIDES + side % SIDES) as u32;
    let cells = (0..rows).flat_map(|row| (0..SIDES).map(move |side| (row, side)));
    let triangles = cells.flat_map(|(row, side)| {
        let [a, b, c, d] = [at(row, side), at(row + 1, side), at(row + 1, side + 1), at(row, side + 1)];
        [[a, b, c], [a, c, d]]
    });
    ((0..(rows + 1) * SIDES).map(point).collect(), triangles.collect())
}

/// Tetrahedra at the corners of tetrahedra (Sierpinski's), as deep as `count` allows.
fn fractal(count: usize) -> Triangles {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let (mut places, mut size) = (vec![[0.0; 3]], 0.5 * SIZE);
    while 4 * 4 * places.len() <= count {
        size *= 0.5;
        places =
            places.iter().flat_map(|place| corners.map(|corner| add(*place, scale(corner, size)))).collect();
    }
    let (vertices, triangles) = joined(places.iter().map(|place| {
        let vertices = corners.map(|corner| single(add(*place, scale(corner, size))));
        (vertices.to_vec(), vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    }));
    weld(&vertices, &triangles)
}
