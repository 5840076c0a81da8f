//! Rigid shapes as the judges need them.

/// A rigid shape: its closed surface, and convex parts that fill it. Metres; a supporter stands with z up.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Vertices of the surface.
    pub vertices: Vec<[f32; 3]>,
    /// Corners of its triangles, counter-clockwise seen from outside. Bodies may overlap.
    pub triangles: Vec<[u32; 3]>,
    /// Convex parts that together are the shape.
    pub parts: Vec<Part>,
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
