//! Why nothing can be planned.

use super::task::MotionError;
use crate::geometry::MAX_COORDINATE;
use crate::hanging::{PredictError, RequestError};
use crate::memory::OutOfMemory;
use crate::monitor::Unfinished;
use crate::params::ParamsError;
use core::fmt;

/// Why nothing can be planned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanError {
    /// A constant is out of range.
    Params(ParamsError),
    /// The request is invalid.
    Request(RequestError),
    /// The motion is invalid.
    Motion(MotionError),
    /// The goal, its rest pose included, is too far away or not a number, or its rotation is not a unit quaternion.
    Goal,
    /// The memory is too small.
    OutOfMemory(OutOfMemory),
    /// The object, or the one with this index that hangs already, was analysed without [`voxels`](crate::Params::voxels).
    NoDistanceField {
        /// `None` for the object.
        hung: Option<usize>,
    },
    /// The monitor was cancelled before the obstacles were arranged. A search that is cancelled is
    /// [`PlanFailure::Stopped`](super::PlanFailure::Stopped), so that only [`Clearance::new`](super::Clearance::new) returns this.
    Cancelled,
    /// A path was found, but there is no room for it.
    TooManyWaypoints {
        /// Waypoints of the path.
        needed: usize,
        /// Waypoints that there was room for.
        given: usize,
    },
}

impl From<ParamsError> for PlanError {
    fn from(error: ParamsError) -> Self {
        Self::Params(error)
    }
}

impl From<RequestError> for PlanError {
    fn from(error: RequestError) -> Self {
        Self::Request(error)
    }
}

impl From<MotionError> for PlanError {
    fn from(error: MotionError) -> Self {
        Self::Motion(error)
    }
}

impl From<Unfinished> for PlanError {
    fn from(unfinished: Unfinished) -> Self {
        match unfinished {
            Unfinished::OutOfMemory(error) => Self::OutOfMemory(error),
            // Nothing that is counted against a work limit is done where this can happen.
            Unfinished::Stopped(_) => Self::Cancelled,
        }
    }
}

impl From<OutOfMemory> for PlanError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl From<PredictError> for PlanError {
    fn from(error: PredictError) -> Self {
        match error {
            PredictError::Params(error) => Self::Params(error),
            PredictError::OutOfMemory(error) => Self::OutOfMemory(error),
            PredictError::Request(error) => Self::Request(error),
            // A plan ends at its goal, and lets nothing go elsewhere.
            PredictError::Release => Self::Goal,
            PredictError::NoDistanceField => Self::NoDistanceField { hung: None },
        }
    }
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Params(error) => error.fmt(f),
            Self::Request(error) => error.fmt(f),
            Self::Motion(error) => error.fmt(f),
            Self::Goal => {
                write!(f, "the goal needs positions within ±{MAX_COORDINATE} metres and unit quaternions")
            }
            Self::OutOfMemory(error) => error.fmt(f),
            Self::Cancelled => f.write_str("the search was cancelled"),
            Self::NoDistanceField { hung: None } => f.write_str(
                "the object was analysed with voxels = 0: analyse it with voxels to plan its motion",
            ),
            Self::NoDistanceField { hung: Some(index) } => write!(
                f,
                "object {index} that hangs already was analysed with voxels = 0: analyse it with voxels to plan around it"
            ),
            Self::TooManyWaypoints { needed, given } => write!(
                f,
                "the path has {needed} waypoints and there is room for {given}: give more room, or allow longer steps"
            ),
        }
    }
}

impl core::error::Error for PlanError {}
