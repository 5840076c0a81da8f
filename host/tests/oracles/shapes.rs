//! Test shapes for the queries, about 1 m wide around the origin unless a test scales and moves them.

use crate::random::Random;
use hangpose::analyze_object;
use hangpose_core::geometry::{Mesh, Point, Surface};
use hangpose_core::{Monitor, Params};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;

/// One or more bodies.
#[derive(Clone)]
pub(crate) struct Shape {
    pub(crate) name: String,
    pub(crate) vertices: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// End of each body in `triangles`.
    pub(crate) bodies: Vec<usize>,
    /// Whether every body bounds a volume.
    pub(crate) is_closed: bool,
}

impl Shape {
    pub(crate) fn from_file(name: String, vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self { name, vertices, bodies: vec![triangles.len()], triangles, is_closed: false }
    }

    fn new(name: &str, vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>, is_closed: bool) -> Self {
        Self {
            name: name.into(),
            vertices: vertices.iter().map(|v| v.cast::<f32>().into()).collect(),
            bodies: vec![triangles.len()],
            triangles,
            is_closed,
        }
    }

    pub(crate) fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles).unwrap()
    }

    /// The shape scaled, then translated, then rounded to `f32`.
    pub(crate) fn placed(&self, scale: f64, offset: Vector3<f64>) -> Self {
        let place = |v: &[f32; 3]| (Vector3::from(*v).cast() * scale + offset).cast::<f32>().into();
        Self {
            name: format!("{} times {scale} at {} m", self.name, offset.amax()),
            vertices: self.vertices.iter().map(place).collect(),
            ..self.clone()
        }
    }

    fn turned(mut self, axis_angle: Vector3<f64>) -> Self {
        let rotation = Rotation3::new(axis_angle);
        for v in &mut self.vertices {
            *v = (rotation * Vector3::from(*v).cast()).cast::<f32>().into();
        }
        self
    }

    fn with(mut self, name: &str, other: &Self) -> Self {
        let (vertices, triangles) = (self.vertices.len() as u32, self.triangles.len());
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + vertices)));
        self.bodies.extend(other.bodies.iter().map(|end| end + triangles));
        self.is_closed &= other.is_closed;
        self.name = name.into();
        self
    }

    /// Builds the core's surface through the public interface, and calls `check` with it and the shape in the same frame, that of the
    /// object.
    pub(crate) fn with_surface<R>(&self, check: impl FnOnce(&Surface, &Self) -> R) -> R {
        // Few samples and no distance field, since only the surface is used.
        let params = Params { samples: 100, ..Params::paper() };
        let (mesh, mut memory) = (self.mesh(), Vec::new());
        let object = analyze_object(&mesh, &params, &mut memory, &Monitor::new()).unwrap();
        let vertices = self.vertices.iter().map(|vertex| (object.frame() * Point::from(*vertex)).into());
        check(object.surface(), &Self { vertices: vertices.collect(), ..self.clone() })
    }
}

fn turn(step: u32, steps: u32) -> (f64, f64) {
    (TAU * f64::from(step) / f64::from(steps)).sin_cos()
}

/// `rows` rings of `columns` vertices joined by quads; `wrap` joins the last ring to the first.
fn band(
    name: &str,
    [rows, columns]: [u32; 2],
    wrap: bool,
    vertex: impl Fn(u32, u32) -> Vector3<f64>,
) -> Shape {
    let vertices =
        (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))).map(|(i, j)| vertex(i, j)).collect();
    let mut triangles = Vec::new();
    for i in 0..if wrap { rows } else { rows - 1 } {
        for j in 0..columns {
            let at = |i: u32, j: u32| i % rows * columns + j % columns;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Shape::new(name, vertices, triangles, wrap)
}

/// Closes a band with fans over its first and last ring.
fn capped(mut shape: Shape, columns: u32) -> Shape {
    let rings = shape.vertices.len() as u32 - columns;
    for (first, flip) in [(0, false), (rings, true)] {
        let ring = &shape.vertices[first as usize..(first + columns) as usize];
        let centre = ring.iter().map(|&v| Vector3::from(v)).sum::<Vector3<f32>>() / columns as f32;
        let tip = shape.vertices.len() as u32;
        shape.vertices.push(centre.into());
        for j in 0..columns {
            let (a, b) = (first + j, first + (j + 1) % columns);
            shape.triangles.push(if flip { [tip, b, a] } else { [tip, a, b] });
        }
    }
    shape.bodies = vec![shape.triangles.len()];
    shape.is_closed = true;
    shape
}

pub(crate) fn torus(rows: u32, columns: u32) -> Shape {
    band("torus", [rows, columns], true, |i, j| {
        let ((si, ci), (sj, cj)) = (turn(i, rows), turn(j, columns));
        let radius = 0.4 + 0.1 * cj;
        Vector3::new(radius * ci, radius * si, 0.1 * sj)
    })
}

pub(crate) fn ball() -> Shape {
    let (rows, columns) = (31, 48);
    let rings = band("ball", [rows, columns], false, |i, j| {
        let ((si, ci), (sj, cj)) = (turn(i + 1, 2 * (rows + 1)), turn(j, columns));
        Vector3::new(0.5 * si * cj, 0.5 * si * sj, 0.5 * ci)
    });
    // The caps are flat: a ball with two small flats.
    capped(rings, columns)
}

/// A box with sides divided into `n` by `n` squares. An open box lacks the sixth side.
pub(crate) fn cube(n: u32, open: bool) -> Shape {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for side in 0..if open { 5 } else { 6 } {
        let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0 } else { -1.0 });
        let base = vertices.len() as u32;
        for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            let at = |k: u32| f64::from(k) / f64::from(n) - 0.5;
            let mut v = Vector3::zeros();
            v[axis] = 0.5 * sign;
            (v[(axis + 1) % 3], v[(axis + 2) % 3]) = (sign * at(i), at(j));
            vertices.push(v);
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let a = base + i * (n + 1) + j;
            triangles.extend([[a, a + n + 1, a + n + 2], [a, a + n + 2, a + 1]]);
        }
    }
    Shape::new(if open { "open box" } else { "box" }, vertices, triangles, !open)
}

/// A tube bent into a hook, of a radius of 1 cm for each 10 cm of the shape.
pub(crate) fn bent_tube() -> Shape {
    let (rows, columns) = (60, 16);
    let rings = band("bent tube", [rows, columns], false, |i, j| {
        let (s, c) = turn(i, 80);
        let (sj, cj) = turn(j, columns);
        let out = Vector3::new(c, s, 0.0);
        // A pitch breaks the symmetry.
        out * (0.4 + 0.05 * cj) + Vector3::z() * (0.003 * f64::from(i) + 0.05 * sj)
    });
    capped(rings, columns)
}

/// Unconnected triangles at random positions.
fn soup(random: &mut Random) -> Shape {
    let vertices: Vec<_> = (0..300)
        .flat_map(|_| {
            let centre = random.in_cube() * 0.4;
            [(); 3].map(|()| centre + random.in_cube() * 0.1)
        })
        .collect();
    Shape::new("soup", vertices, (0..300).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(), false)
}

/// Long thin triangles with aspect ratios of 10^-2 to 10^-5, among triangles without area.
pub(crate) fn slivers(random: &mut Random) -> Shape {
    let mut vertices = Vec::new();
    for i in 0..300 {
        let (a, long) = (random.in_cube() * 0.3, random.direction() * 0.4);
        let width = 10_f64.powf(-2.0 - 3.0 * random.unit()) * 0.4;
        let beside = a + long * random.unit() + random.direction() * width;
        vertices.extend(match i % 10 {
            0 => [a, a + long, a],
            1 => [a, a, a],
            _ => [a, a + long, beside],
        });
    }
    Shape::new("slivers", vertices, (0..300).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(), false)
}

/// A closed rod of long thin triangles with fans of thin triangles at its ends.
fn rod() -> Shape {
    let columns = 1000;
    let rings = band("rod", [2, columns], false, |i, j| {
        let (s, c) = turn(j, columns);
        Vector3::new(0.02 * c, 0.02 * s, 0.5 - f64::from(i))
    });
    capped(rings, columns)
}

/// A torus of 20 000 triangles with random bumps.
fn bumpy(random: &mut Random) -> Shape {
    let mut shape = torus(100, 100);
    for v in &mut shape.vertices {
        *v = (Vector3::from(*v).cast() + random.in_cube() * 0.001).cast::<f32>().into();
    }
    shape.name = "bumpy torus".into();
    shape
}

/// All shapes, around the origin.
pub(crate) fn all() -> Vec<Shape> {
    let mut random = Random(1);
    let lopsided = Vector3::new(0.3, -0.5, 1.1);
    let overlapping = ball()
        .placed(0.8, Vector3::new(0.1, 0.15, -0.1))
        .with("overlapping", &cube(3, false).turned(lopsided));
    vec![
        soup(&mut random),
        slivers(&mut random),
        cube(8, false),
        cube(5, true).turned(lopsided),
        ball(),
        torus(64, 24),
        bent_tube(),
        rod().turned(lopsided),
        overlapping,
        bumpy(&mut random),
    ]
}

/// All shapes at sizes from 1 cm to 10 m, some far from the origin.
pub(crate) fn all_places() -> Vec<Shape> {
    let far = Vector3::new(100.0, -70.0, 30.0);
    let places = [(0.01, 0.0), (0.2, 0.0), (0.2, 1.0), (10.0, 0.0), (10.0, 1.0)];
    all()
        .iter()
        .flat_map(|shape| places.map(|(scale, distance)| shape.placed(scale, far * distance)))
        .collect()
}
