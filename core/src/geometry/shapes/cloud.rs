//! Point clouds in the caller's memory, validated.

use super::aabb::Aabb;
use super::mesh::{MAX_COUNT, is_usable};
use crate::geometry::{MAX_COORDINATE, Point};

/// A checked view of a point cloud, in metres. Nothing is copied.
#[derive(Clone, Copy, Debug)]
pub struct Cloud<'a> {
    points: &'a [Point],
    normals: Option<&'a [[f32; 3]]>,
    viewpoints: &'a [Point],
    may_hang: Option<&'a [u8]>,
    region: Option<Aabb>,
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
    /// A coordinate of a viewpoint is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Viewpoint {
        /// Index of the viewpoint.
        viewpoint: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// The number of marks differs from the number of points.
    MarkCount {
        /// Number of points.
        points: usize,
        /// Number of marks.
        marks: usize,
    },
    /// A corner of the region is infinite or not a number, or its lower corner is above the upper one.
    Region {
        /// Lower corner, metres.
        low: [f32; 3],
        /// Upper corner, metres.
        high: [f32; 3],
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
            Self::Viewpoint { viewpoint, position } => {
                write!(
                    f,
                    "viewpoint {viewpoint}, {position:?}, is not a point in metres within ±{MAX_COORDINATE}"
                )
            }
            Self::MarkCount { points, marks } => {
                write!(f, "there are {points} points and {marks} marks: give one for each point, or none")
            }
            Self::Region { low, high } => write!(
                f,
                "the region from {low:?} to {high:?} is empty: give the lower corner first, then the upper one, in metres"
            ),
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
        Ok(Self {
            points: bytemuck::cast_slice(points),
            normals,
            viewpoints: &[],
            may_hang: None,
            region: None,
        })
    }

    /// Sets the positions of the sensor (metres, in the cloud's frame) from which the points were seen. Estimated normals
    /// face one of them.
    pub fn seen_from(self, viewpoints: &'a [[f32; 3]]) -> Result<Self, CloudError> {
        if let Some(viewpoint) = viewpoints.iter().position(|p| !is_usable(p)) {
            return Err(CloudError::Viewpoint { viewpoint, position: viewpoints[viewpoint] });
        }
        Ok(Self { viewpoints: bytemuck::cast_slice(viewpoints), ..self })
    }

    /// Limits the places to hang on to marked points: those whose mark, one a point, is not 0. The others are obstacles.
    pub fn hang_on(self, marks: &'a [u8]) -> Result<Self, CloudError> {
        if marks.len() != self.points.len() {
            return Err(CloudError::MarkCount { points: self.points.len(), marks: marks.len() });
        }
        Ok(Self { may_hang: Some(marks), ..self })
    }

    /// Limits the places to hang on to a box (metres, in the cloud's frame). Points outside are obstacles.
    pub fn hang_within(self, low: [f32; 3], high: [f32; 3]) -> Result<Self, CloudError> {
        let is_ordered = |i: usize| low[i].is_finite() && high[i].is_finite() && low[i] <= high[i];
        if !(0..3).all(is_ordered) {
            return Err(CloudError::Region { low, high });
        }
        Ok(Self { region: Some(Aabb { min: low.into(), max: high.into() }), ..self })
    }

    /// Whether an object may hang on this point of the cloud, as far as the caller says.
    pub(crate) fn may_hang_on(&self, point: usize) -> bool {
        self.may_hang.is_none_or(|marks| marks[point] != 0)
            && self.region.is_none_or(|region| region.distance_squared(&self.points[point]) <= 0.0)
    }

    /// The points.
    pub fn points(&self) -> &'a [Point] {
        self.points
    }

    /// The normals as they were given.
    pub fn normals(&self) -> Option<&'a [[f32; 3]]> {
        self.normals
    }

    /// Positions of the sensor, metres, in the cloud's frame.
    pub fn viewpoints(&self) -> &'a [Point] {
        self.viewpoints
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
        let error = cloud.seen_from(&[[0.0; 3], [f32::NAN; 3]]).unwrap_err();
        assert!(matches!(error, CloudError::Viewpoint { viewpoint: 1, .. }));
        assert!(cloud.seen_from(&[[1.0; 3]]).is_ok());
        assert_eq!(cloud.hang_on(&[1]).unwrap_err(), CloudError::MarkCount { points: 2, marks: 1 });
        let (low, high) = ([0.0; 3], [1.0, 1.0, -1.0]);
        assert_eq!(cloud.hang_within(low, high).unwrap_err(), CloudError::Region { low, high });
    }

    #[test]
    fn marks_and_the_region_limit_the_places() {
        let points = [[0.0; 3], [1.0, 2.0, 3.0], [5.0; 3]];
        let cloud = Cloud::new(&points, None).unwrap();
        let allowed = |cloud: &Cloud| [0, 1, 2].map(|point| cloud.may_hang_on(point));
        assert_eq!(allowed(&cloud), [true; 3]);
        let within = cloud.hang_within([0.0; 3], [1.0, 2.0, 3.0]).unwrap();
        assert_eq!(allowed(&within), [true, true, false]);
        assert_eq!(allowed(&within.hang_on(&[0, 1, 1]).unwrap()), [false, true, false]);
    }
}
