//! Rigid shapes as the judges need them.

use hangpose::geometry::Mesh;
use std::collections::HashMap;

/// A rigid shape: its surface, and convex parts that are as solid as it is. Metres; a supporter stands with z up.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Vertices of the surface.
    pub vertices: Vec<[f32; 3]>,
    /// Corners of its triangles, counter-clockwise seen from outside. Bodies may overlap.
    pub triangles: Vec<[u32; 3]>,
    /// Convex parts that together are the shape, or its shell.
    pub parts: Vec<Part>,
    /// Whether the parts are only its outermost layer.
    pub is_shell: bool,
}

/// A convex part of a shape.
#[derive(Clone, Debug)]
pub enum Part {
    /// The convex hull of points.
    Hull(Vec<[f32; 3]>),
    /// All that is within `radius` of a segment.
    Capsule {
        /// Where the segment begins.
        from: [f32; 3],
        /// Where it ends.
        to: [f32; 3],
        /// The radius, metres.
        radius: f32,
    },
    /// A box.
    Cuboid {
        /// Its middle.
        centre: [f32; 3],
        /// Unit vectors along its edges, right-handed.
        axes: [[f32; 3]; 3],
        /// Half its edge lengths, metres.
        half_extents: [f32; 3],
    },
}

impl Solid {
    /// The surface as the predictor takes it.
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles).expect("every vertex is finite and every index in range")
    }

    /// Whether the surface bounds a volume: each edge is gone along as often one way as the other. Vertices at the same
    /// position count as one.
    pub fn is_closed(&self) -> bool {
        // Adding zero makes -0 and 0 the same.
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
