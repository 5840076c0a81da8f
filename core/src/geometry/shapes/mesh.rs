//! Triangle meshes in the caller's memory, validated.

use super::Aabb;
use crate::geometry::{MAX_COORDINATE, Point, Pose};

/// A checked view of a triangle mesh: corners counter-clockwise seen from outside, in metres.
///
/// Open, self-overlapping and multi-body meshes are allowed. Degenerate triangles are ignored.
/// Nothing is copied.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    vertices: &'a [Point],
    triangles: &'a [[u32; 3]],
    viewpoints: &'a [Point],
    /// From the coordinates of the vertices to those of [`corners`](Self::corners).
    frame: Pose,
}

/// Why a mesh cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeshError {
    /// There are no triangles.
    Empty,
    /// More triangles or vertices than a `u32` can index.
    TooLarge {
        /// Number given.
        count: usize,
        /// Largest number allowed.
        limit: usize,
    },
    /// A coordinate is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Coordinate {
        /// Index of the vertex.
        vertex: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// A triangle refers to a vertex that does not exist.
    Index {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex that it refers to.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate of a viewpoint is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Viewpoint {
        /// Index of the viewpoint.
        viewpoint: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// No triangle has an area.
    AllDegenerate {
        /// Number of triangles.
        triangles: usize,
    },
}

impl core::fmt::Display for MeshError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Empty => write!(f, "the mesh has no triangles: export it with faces"),
            Self::TooLarge { count, limit } => {
                write!(
                    f,
                    "the mesh has {count} vertices or triangles and at most {limit} are possible: decimate it"
                )
            }
            Self::Coordinate { vertex, position } => write!(
                f,
                "vertex {vertex} is at {position:?}: every coordinate must be a number of metres within ±{MAX_COORDINATE}"
            ),
            Self::Index { triangle, vertex, vertices } => {
                write!(
                    f,
                    "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices, counted from 0"
                )
            }
            Self::Viewpoint { viewpoint, position } => write!(
                f,
                "viewpoint {viewpoint}, {position:?}, is not a point in metres within ±{MAX_COORDINATE}"
            ),
            Self::AllDegenerate { triangles } => {
                write!(
                    f,
                    "all {triangles} triangles are degenerate: none has an area (is the mesh flattened, or scaled to nothing?)"
                )
            }
        }
    }
}

impl core::error::Error for MeshError {}

/// The most vertices, triangles or points that a mesh or a cloud may have, so that a `u32` can index what is built on
/// them.
pub const MAX_COUNT: usize = 1 << 28;

impl<'a> Mesh<'a> {
    /// Checks `vertices` (metres) and `triangles` (indices into them).
    pub fn new(vertices: &'a [[f32; 3]], triangles: &'a [[u32; 3]]) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        let count = vertices.len().max(triangles.len());
        if count > MAX_COUNT {
            return Err(MeshError::TooLarge { count, limit: MAX_COUNT });
        }
        for (vertex, position) in vertices.iter().enumerate() {
            if !is_usable(position) {
                return Err(MeshError::Coordinate { vertex, position: *position });
            }
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices.len()) {
                return Err(MeshError::Index { triangle, vertex, vertices: vertices.len() });
            }
        }
        let vertices = bytemuck::cast_slice(vertices);
        let mesh = Self { vertices, triangles, viewpoints: &[], frame: Pose::identity() };
        if mesh.solid_triangles().next().is_none() {
            return Err(MeshError::AllDegenerate { triangles: triangles.len() });
        }
        Ok(mesh)
    }

    /// Sets the positions of the cameras (metres, in the mesh's frame) whose images the mesh was made from. What is in the
    /// shadow of the mesh for all of them was not seen: the object may be there as well, and poses that have the supporter
    /// there are less probable. Without viewpoints the mesh is all of the object.
    pub fn seen_from(self, viewpoints: &'a [[f32; 3]]) -> Result<Self, MeshError> {
        if let Some(viewpoint) = viewpoints.iter().position(|p| !is_usable(p)) {
            return Err(MeshError::Viewpoint { viewpoint, position: viewpoints[viewpoint] });
        }
        Ok(Self { viewpoints: bytemuck::cast_slice(viewpoints), ..self })
    }

    /// Positions of the cameras, metres, in the mesh's frame.
    pub fn viewpoints(&self) -> &'a [Point] {
        self.viewpoints
    }

    /// All vertices, also those that no triangle uses.
    pub fn vertices(&self) -> &'a [Point] {
        self.vertices
    }

    /// Corner indices of all triangles.
    pub fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    /// The same with the corners of its triangles in another frame, to which `frame` leads; vertices and viewpoints stay.
    pub(crate) fn in_frame(self, frame: &Pose) -> Self {
        Self { frame: *frame, ..self }
    }

    /// Corners of triangle `index`, degenerate or not.
    pub(crate) fn corners(&self, index: usize) -> [Point; 3] {
        self.triangles[index].map(|v| self.frame * self.vertices[v as usize])
    }

    /// The indices of the triangles that have an area, in order.
    pub(crate) fn solid_triangles(&self) -> impl Iterator<Item = u32> + use<'a> {
        let mesh = *self;
        (0..self.triangles.len() as u32)
            .filter(move |&t| super::triangle::has_area(&mesh.corners(t as usize)))
    }

    /// Points of the surface with weights, m², that give the integral of every polynomial of up to second order over it: the middles of the
    /// edges of each triangle, each with a third of its area.
    pub(crate) fn quadrature(&self) -> impl Iterator<Item = (Point, f32)> + use<'a> {
        let mesh = *self;
        (0..self.triangles.len()).flat_map(move |index| {
            let corners = mesh.corners(index);
            let weight = super::triangle::scaled_normal(&corners).norm() / 6.0;
            let [a, b, c] = corners;
            [(a, b), (b, c), (c, a)].map(|(from, to)| (nalgebra::center(&from, &to), weight))
        })
    }

    /// The box around all triangles.
    pub fn aabb(&self) -> Aabb {
        Aabb::of(self.triangles.iter().flatten().map(|&v| &self.vertices[v as usize]))
    }
}

/// Whether every coordinate is finite and within [`MAX_COORDINATE`].
pub(crate) fn is_usable(position: &[f32; 3]) -> bool {
    position.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn accepts_a_square_with_a_degenerate_triangle() {
        let mesh = Mesh::new(&SQUARE, &[[0, 1, 2], [1, 1, 2], [0, 2, 3]]).unwrap();
        assert_eq!(mesh.solid_triangles().collect::<Vec<_>>(), [0, 2]);
        assert_eq!(mesh.aabb().extents(), crate::geometry::Vector::new(1.0, 1.0, 0.0));
    }

    #[test]
    fn names_what_is_broken() {
        let check =
            |vertices: &[[f32; 3]], triangles: &[[u32; 3]]| Mesh::new(vertices, triangles).unwrap_err();
        assert_eq!(check(&SQUARE, &[]), MeshError::Empty);
        assert_eq!(check(&[], &[]), MeshError::Empty);
        assert_eq!(
            check(&SQUARE, &[[0, 1, 2], [0, 1, 4]]),
            MeshError::Index { triangle: 1, vertex: 4, vertices: 4 }
        );
        assert_eq!(check(&SQUARE, &[[0, 1, 1], [2, 2, 2]]), MeshError::AllDegenerate { triangles: 2 });
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9] {
            let mut vertices = SQUARE;
            vertices[2][1] = bad;
            assert!(
                matches!(check(&vertices, &[[0, 1, 3]]), MeshError::Coordinate { vertex: 2, .. }),
                "{bad}"
            );
            let mesh = Mesh::new(&SQUARE, &[[0, 1, 2]]).unwrap();
            let error = mesh.seen_from(&[[0.0; 3], [0.0, bad, 0.0]]).unwrap_err();
            assert!(matches!(error, MeshError::Viewpoint { viewpoint: 1, .. }), "{bad}");
        }
    }
}
