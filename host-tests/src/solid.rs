//! Rigid shapes as the judges need them.

use parry3d::transformation::vhacd::{VHACD, VHACDParameters};

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

/// Voxels along the longest side of a mesh that is taken apart, and how hollow a part may be, as a fraction of it.
const RESOLUTION: u32 = 80;
const CONCAVITY: f32 = 0.005;

impl Solid {
    /// A mesh of unknown make, taken apart into parts that are about convex; and what these parts fill, whose surface
    /// is closed even if the mesh's is not.
    pub fn take_apart(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> (Self, Self) {
        let points: Vec<_> = vertices.iter().map(|&v| v.into()).collect();
        let parameters =
            VHACDParameters { resolution: RESOLUTION, concavity: CONCAVITY, ..VHACDParameters::default() };
        let hulls = VHACD::decompose(&parameters, &points, &triangles, true)
            .compute_exact_convex_hulls(&points, &triangles);
        let (mut parts, mut filled) = (Vec::new(), Self::default());
        for (corners, faces) in hulls {
            let corners: Vec<[f32; 3]> = corners.into_iter().map(Into::into).collect();
            let first = filled.vertices.len() as u32;
            filled.vertices.extend(&corners);
            filled.triangles.extend(faces.iter().map(|face| face.map(|corner| corner + first)));
            parts.push(Part::Hull(outermost(&corners)));
        }
        filled.parts.clone_from(&parts);
        (Self { vertices, triangles, parts }, filled)
    }
}

/// Directions in which a part that was cut out of a mesh keeps its outermost corner. The engines' time goes with the
/// corners, and exact hulls of scans have hundreds.
const DIRECTIONS: u32 = 48;

fn outermost(corners: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5_f32.sqrt());
    let mut kept: Vec<usize> = (0..DIRECTIONS)
        .filter_map(|k| {
            let z = 1.0 - (2 * k + 1) as f32 / DIRECTIONS as f32;
            let (sin, cos) = libm::sincosf(golden_angle * k as f32);
            let across = (1.0 - z * z).sqrt();
            let along =
                |corner: &[f32; 3]| corner[0] * across * cos + corner[1] * across * sin + corner[2] * z;
            (0..corners.len()).max_by(|&a, &b| along(&corners[a]).total_cmp(&along(&corners[b])))
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|index| corners[index]).collect()
}
