//! Why the surface of a volume cannot be given.

use crate::Stop;
use crate::memory::OutOfMemory;

/// Why the surface of a volume cannot be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IsosurfaceError {
    /// The memory is smaller than [`Isosurface::bytes`](super::Isosurface::bytes).
    OutOfMemory(OutOfMemory),
    /// More vertices or triangles than a mesh may have.
    TooLarge {
        /// Number needed.
        count: usize,
        /// Largest number allowed.
        limit: usize,
    },
    /// The list of vertices is too short.
    Vertices {
        /// Number of vertices.
        needed: usize,
        /// Length of the list.
        limit: usize,
    },
    /// The list of triangles is too short.
    Triangles {
        /// Number of triangles.
        needed: usize,
        /// Length of the list.
        limit: usize,
    },
    /// The monitor stopped the call.
    Stopped(Stop),
}

impl core::fmt::Display for IsosurfaceError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::OutOfMemory(error) => error.fmt(f),
            Self::TooLarge { count, limit } => write!(
                f,
                "the surface has {count} vertices or triangles and at most {limit} are possible: take larger voxels or a smaller crop box"
            ),
            Self::Vertices { needed, limit } => {
                write!(f, "the surface has {needed} vertices and the list holds {limit}: give a longer one")
            }
            Self::Triangles { needed, limit } => {
                write!(f, "the surface has {needed} triangles and the list holds {limit}: give a longer one")
            }
            Self::Stopped(Stop::Cancelled) => write!(f, "the search for the surface was cancelled"),
            Self::Stopped(Stop::WorkLimit) => write!(f, "the work limit was reached: raise it"),
        }
    }
}

impl core::error::Error for IsosurfaceError {}

impl From<OutOfMemory> for IsosurfaceError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl From<Stop> for IsosurfaceError {
    fn from(error: Stop) -> Self {
        Self::Stopped(error)
    }
}
