//! Point clouds in the caller's memory, validated.

use super::mesh::{MAX_COUNT, is_usable};
use crate::geometry::{MAX_COORDINATE, Point};

/// A checked view of a point cloud, in metres. Nothing is copied.
#[derive(Clone, Copy, Debug)]
pub struct Cloud<'a> {
    points: &'a [Point],
    normals: Option<&'a [[f32; 3]]>,
    viewpoint: Option<Point>,
}

/// Why a point cloud cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CloudError {
    /// There are no points.
    Empty,
    /// More points than a `u32` can index.
    TooLarge {
        /// Number given.
        count: usize,
        /// Largest number allowed.
        limit: usize,
    },
    /// A coordinate is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Coordinate {
        /// Index of the point.
        point: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// A component of a normal is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Normal {
        /// Index of the point.
        point: usize,
        /// Its normal.
        normal: [f32; 3],
    },
    /// The number of normals differs from the number of points.
    NormalCount {
        /// Number of points.
        points: usize,
        /// Number of normals.
        normals: usize,
    },
    /// A coordinate of the viewpoint is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Viewpoint {
        /// Its coordinates.
        position: [f32; 3],
    },
}

impl core::fmt::Display for CloudError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Empty => write!(f, "the point cloud has no points: give at least one that the camera saw"),
            Self::TooLarge { count, limit } => {
                write!(f, "the point cloud has {count} points and at most {limit} are possible: thin it out")
            }
            Self::Coordinate { point, position } => write!(
                f,
                "point {point} is at {position:?}: every coordinate must be a number of metres within ±{MAX_COORDINATE} (drop the points that the camera did not see)"
            ),
            Self::Normal { point, normal } => write!(
                f,
                "the normal of point {point} is {normal:?}: give numbers, or zeros where it is not known"
            ),
            Self::NormalCount { points, normals } => {
                write!(f, "there are {points} points and {normals} normals: give one for each point, or none")
            }
            Self::Viewpoint { position } => {
                write!(f, "the viewpoint {position:?} is not a point in metres within ±{MAX_COORDINATE}")
            }
        }
    }
}

impl core::error::Error for CloudError {}

impl<'a> Cloud<'a> {
    /// Checks `points` (metres) and their `normals`, which point out of the solid. Normals of any length are
    /// fine; zeros mark a point whose normal is unknown. Unknown normals are estimated.
    pub fn new(points: &'a [[f32; 3]], normals: Option<&'a [[f32; 3]]>) -> Result<Self, CloudError> {
        if points.is_empty() {
            return Err(CloudError::Empty);
        }
        if points.len() > MAX_COUNT {
            return Err(CloudError::TooLarge { count: points.len(), limit: MAX_COUNT });
        }
        if let Some(point) = points.iter().position(|p| !is_usable(p)) {
            return Err(CloudError::Coordinate { point, position: points[point] });
        }
        if let Some(normals) = normals {
            if normals.len() != points.len() {
                return Err(CloudError::NormalCount { points: points.len(), normals: normals.len() });
            }
            if let Some(point) = normals.iter().position(|n| !is_usable(n)) {
                return Err(CloudError::Normal { point, normal: normals[point] });
            }
        }
        Ok(Self { points: bytemuck::cast_slice(points), normals, viewpoint: None })
    }

    /// Sets the position of the sensor (metres, in the cloud's frame), which estimated normals face.
    pub fn seen_from(self, viewpoint: [f32; 3]) -> Result<Self, CloudError> {
        if !is_usable(&viewpoint) {
            return Err(CloudError::Viewpoint { position: viewpoint });
        }
        Ok(Self { viewpoint: Some(viewpoint.into()), ..self })
    }

    /// The points.
    pub fn points(&self) -> &'a [Point] {
        self.points
    }

    /// The normals as they were given.
    pub fn normals(&self) -> Option<&'a [[f32; 3]]> {
        self.normals
    }

    /// Position of the sensor, metres, in the cloud's frame.
    pub fn viewpoint(&self) -> Option<Point> {
        self.viewpoint
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_what_is_broken() {
        let points = [[0.0; 3], [1.0, 2.0, 3.0]];
        assert_eq!(Cloud::new(&[], None).unwrap_err(), CloudError::Empty);
        let normals = [[0.0, 0.0, 1.0]];
        let error = Cloud::new(&points, Some(&normals)).unwrap_err();
        assert_eq!(error, CloudError::NormalCount { points: 2, normals: 1 });
        let error = Cloud::new(&[[0.0; 3], [0.0, f32::NAN, 0.0]], None).unwrap_err();
        assert!(matches!(error, CloudError::Coordinate { point: 1, .. }));
        let error = Cloud::new(&points, Some(&[[0.0; 3], [f32::INFINITY; 3]])).unwrap_err();
        assert!(matches!(error, CloudError::Normal { point: 1, .. }));
        let cloud = Cloud::new(&points, Some(&points)).unwrap();
        assert!(cloud.seen_from([f32::NAN; 3]).is_err() && cloud.seen_from([1.0; 3]).is_ok());
    }
}
