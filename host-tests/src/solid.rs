//! Rigid shapes for the judges.

use hangpose::geometry::Mesh;
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
