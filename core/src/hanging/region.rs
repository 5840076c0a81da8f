//! A part of an object or of a supporter.

use crate::geometry::{MAX_COORDINATE, Point, closest_point_on_triangle};
use core::fmt;

/// A part of an object or of a supporter, in its coordinates, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Region<'a> {
    /// All of it.
    #[default]
    Everywhere,
    /// What is in a box along the axes.
    Box {
        /// Lower corner.
        low: [f32; 3],
        /// Upper corner.
        high: [f32; 3],
    },
    /// What is close to points: one point for "here", or a part of the supporter's cloud.
    Points {
        /// The points.
        points: &'a [[f32; 3]],
        /// Indices of those that count; `None` for all.
        indices: Option<&'a [u32]>,
        /// Largest distance from one of them.
        radius: f32,
    },
    /// What is close to triangles of a mesh.
    Triangles {
        /// Vertices of the mesh.
        vertices: &'a [[f32; 3]],
        /// Its triangles.
        triangles: &'a [[u32; 3]],
        /// Indices of the triangles that count.
        indices: &'a [u32],
        /// Largest distance from one of them.
        radius: f32,
    },
}

/// Why a region is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionError {
    /// It contains nothing: a box whose lower corner is above the upper one, or no point or triangle.
    Empty,
    /// A coordinate or the radius is not a number, negative where it must not be, or too large.
    Number,
    /// An index names no point, triangle or vertex.
    Index {
        /// The index.
        index: u32,
        /// Number of what it counts.
        count: usize,
    },
}

impl fmt::Display for RegionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str(
                "is empty: give the lower corner of a box first, and at least one point or triangle",
            ),
            Self::Number => write!(
                f,
                "has a number that is no length in metres within ±{MAX_COORDINATE}, or a negative radius"
            ),
            Self::Index { index, count } => write!(f, "names index {index}, and there are {count}"),
        }
    }
}

impl Region<'_> {
    /// Whether the region limits anything.
    pub(super) fn is_limited(&self) -> bool {
        *self != Self::Everywhere
    }

    /// Whether a point on the surface is in the region.
    pub(super) fn contains(&self, point: &Point) -> bool {
        match *self {
            Self::Everywhere => true,
            Self::Box { low, high } => (0..3).all(|i| low[i] <= point[i] && point[i] <= high[i]),
            Self::Points { points, indices, radius } => {
                let is_near = |other: &[f32; 3]| (Point::from(*other) - point).norm() <= radius;
                match indices {
                    None => points.iter().any(is_near),
                    Some(indices) => indices.iter().any(|&index| is_near(&points[index as usize])),
                }
            }
            Self::Triangles { vertices, triangles, indices, radius } => indices.iter().any(|&index| {
                let corners = triangles[index as usize].map(|vertex| Point::from(vertices[vertex as usize]));
                (closest_point_on_triangle(&corners, point) - point).norm() <= radius
            }),
        }
    }

    pub(super) fn validate(&self) -> Result<(), RegionError> {
        let is_usable = |point: &[f32; 3]| point.iter().all(|x| x.abs() <= MAX_COORDINATE);
        let check = |is_valid: bool| if is_valid { Ok(()) } else { Err(RegionError::Number) };
        let check_indices = |indices: &[u32], count: usize| {
            let wrong = indices.iter().find(|&&index| index as usize >= count);
            wrong.map_or(Ok(()), |&index| Err(RegionError::Index { index, count }))
        };
        match *self {
            Self::Everywhere => Ok(()),
            Self::Box { low, high } => {
                check(is_usable(&low) && is_usable(&high))?;
                if (0..3).all(|i| low[i] <= high[i]) { Ok(()) } else { Err(RegionError::Empty) }
            }
            Self::Points { points, indices, radius } => {
                if points.is_empty() || indices.is_some_and(<[u32]>::is_empty) {
                    return Err(RegionError::Empty);
                }
                check_indices(indices.unwrap_or_default(), points.len())?;
                check((0.0..=MAX_COORDINATE).contains(&radius) && points.iter().all(is_usable))
            }
            Self::Triangles { vertices, triangles, indices, radius } => {
                if indices.is_empty() {
                    return Err(RegionError::Empty);
                }
                check_indices(indices, triangles.len())?;
                for &index in indices {
                    check_indices(&triangles[index as usize], vertices.len())?;
                }
                check((0.0..=MAX_COORDINATE).contains(&radius) && vertices.iter().all(is_usable))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_contains_what_is_near_its_parts() {
        let at = |x: f32, y: f32, z: f32| Point::new(x, y, z);
        let here = Region::Points { points: &[[0.0; 3], [1.0, 0.0, 0.0]], indices: Some(&[1]), radius: 0.1 };
        assert!(here.contains(&at(1.05, 0.05, 0.0)) && !here.contains(&at(0.0, 0.0, 0.0)));
        let slab = Region::Box { low: [0.0; 3], high: [1.0, 1.0, 0.1] };
        assert!(slab.contains(&at(0.5, 1.0, 0.05)) && !slab.contains(&at(0.5, 0.5, 0.11)));
        let (vertices, triangles) = ([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]);
        let face =
            Region::Triangles { vertices: &vertices, triangles: &triangles, indices: &[0], radius: 0.01 };
        assert!(face.contains(&at(0.3, 0.3, 0.005)) && !face.contains(&at(0.6, 0.6, 0.0)));
        assert!(Region::Everywhere.contains(&at(9.0, 9.0, 9.0)) && here.is_limited());
    }

    #[test]
    fn what_is_wrong_with_a_region_is_named() {
        let points = [[0.0; 3]];
        let near = |indices: Option<&'static [u32]>, radius: f32| {
            Region::Points { points: &points, indices, radius }.validate()
        };
        assert_eq!(near(None, 0.1), Ok(()));
        assert_eq!(near(Some(&[0, 1]), 0.1), Err(RegionError::Index { index: 1, count: 1 }));
        assert_eq!(near(Some(&[]), 0.1), Err(RegionError::Empty));
        assert_eq!(near(None, -0.1), Err(RegionError::Number));
        assert_eq!(near(None, f32::NAN), Err(RegionError::Number));
        let inside_out = Region::Box { low: [0.0; 3], high: [1.0, -1.0, 1.0] };
        assert_eq!(inside_out.validate(), Err(RegionError::Empty));
        let dangling =
            Region::Triangles { vertices: &points, triangles: &[[0, 0, 7]], indices: &[0], radius: 0.1 };
        assert_eq!(dangling.validate(), Err(RegionError::Index { index: 7, count: 1 }));
    }
}
