//! Rigid shapes for the judges.

use hangpose::geometry::Mesh;
use nalgebra::{Isometry3, Point3, Vector3};
use std::collections::HashMap;

/// A rigid shape: its surface and convex parts that fill it. Metres; a supporter has z up.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Vertices of the surface, m.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of its triangles, counter-clockwise seen from outside. Bodies may overlap.
    pub triangles: Vec<[u32; 3]>,
    /// Convex parts whose union is the shape, or its shell.
    pub parts: Vec<Part>,
    /// Whether the parts are only a shell along the surface.
    pub is_shell: bool,
}

/// A convex part of a shape.
#[derive(Clone, Debug)]
pub enum Part {
    /// The convex hull of points, m.
    Hull(Vec<[f32; 3]>),
    /// All points within `radius` of a segment.
    Capsule {
        /// Start of the segment.
        from: [f32; 3],
        /// End of the segment.
        to: [f32; 3],
        /// Radius, m.
        radius: f32,
    },
    /// A box.
    Cuboid {
        /// Centre.
        centre: [f32; 3],
        /// Unit vectors along its edges, right-handed.
        axes: [[f32; 3]; 3],
        /// Half edge lengths, m.
        half_extents: [f32; 3],
    },
}

impl Solid {
    /// The surface as the predictor takes it.
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles).expect("every vertex is finite and every index in range")
    }

    /// The same shape in another size.
    pub fn scaled(&self, factor: f32) -> Self {
        let scale = |point: &[f32; 3]| point.map(|x| x * factor);
        let parts = self.parts.iter().map(|part| match part {
            Part::Hull(points) => Part::Hull(points.iter().map(scale).collect()),
            Part::Capsule { from, to, radius } => {
                Part::Capsule { from: scale(from), to: scale(to), radius: radius * factor }
            }
            Part::Cuboid { centre, axes, half_extents } => {
                Part::Cuboid { centre: scale(centre), axes: *axes, half_extents: scale(half_extents) }
            }
        });
        Self { vertices: self.vertices.iter().map(scale).collect(), parts: parts.collect(), ..self.clone() }
    }

    /// This shape with others at their poses, as one rigid shape.
    pub fn with<'a>(&self, others: impl IntoIterator<Item = (&'a Solid, Isometry3<f32>)>) -> Self {
        let mut all = self.clone();
        for (other, pose) in others {
            let place = |point: &[f32; 3]| -> [f32; 3] { (pose * Point3::from(*point)).into() };
            let turn = |axis: [f32; 3]| -> [f32; 3] { (pose * Vector3::from(axis)).into() };
            let first = all.vertices.len() as u32;
            all.vertices.extend(other.vertices.iter().map(place));
            all.triangles
                .extend(other.triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
            all.parts.extend(other.parts.iter().map(|part| match part {
                Part::Hull(points) => Part::Hull(points.iter().map(place).collect()),
                Part::Capsule { from, to, radius } => {
                    Part::Capsule { from: place(from), to: place(to), radius: *radius }
                }
                Part::Cuboid { centre, axes, half_extents } => {
                    Part::Cuboid { centre: place(centre), axes: axes.map(turn), half_extents: *half_extents }
                }
            }));
            all.is_shell |= other.is_shell;
        }
        all
    }

    /// Whether the surface bounds a volume: triangles use each edge equally often in both directions. Vertices at the
    /// same position count as one.
    pub fn is_closed(&self) -> bool {
        // Adding zero turns -0 into 0.
        let at = |index: u32| self.vertices[index as usize].map(|x| (x + 0.0).to_bits());
        let mut ways: HashMap<_, i32> = HashMap::new();
        for &[a, b, c] in &self.triangles {
            for [from, to] in [[a, b], [b, c], [c, a]].map(|edge| edge.map(at)) {
                *ways.entry(if from < to { (from, to) } else { (to, from) }).or_default() +=
                    from.cmp(&to) as i32;
            }
        }
        ways.values().all(|&ways| ways == 0)
    }
}
