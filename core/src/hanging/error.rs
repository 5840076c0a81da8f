//! Why an object or a supporter cannot be analysed, and why nothing can be predicted.

use super::request::RequestError;
use crate::geometry::MAX_COORDINATE;
use crate::memory::OutOfMemory;
use crate::monitor::{Stop, Unfinished};
use crate::params::ParamsError;

/// Why an object or a supporter cannot be analysed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnalysisError {
    /// A constant is out of range.
    Params(ParamsError),
    /// The memory is too small.
    OutOfMemory(OutOfMemory),
    /// The monitor was cancelled.
    Cancelled,
}

impl From<ParamsError> for AnalysisError {
    fn from(error: ParamsError) -> Self {
        Self::Params(error)
    }
}

impl From<OutOfMemory> for AnalysisError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl From<Unfinished> for AnalysisError {
    fn from(unfinished: Unfinished) -> Self {
        match unfinished {
            Unfinished::OutOfMemory(error) => Self::OutOfMemory(error),
            // Nothing that is counted against a work limit is done where this can happen.
            Unfinished::Stopped(_) => Self::Cancelled,
        }
    }
}

impl From<Stop> for AnalysisError {
    fn from(stop: Stop) -> Self {
        Unfinished::from(stop).into()
    }
}

impl core::fmt::Display for AnalysisError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Params(error) => error.fmt(f),
            Self::OutOfMemory(error) => error.fmt(f),
            Self::Cancelled => write!(f, "the analysis was cancelled"),
        }
    }
}

impl core::error::Error for AnalysisError {}

/// Why nothing can be predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PredictError {
    /// A constant is out of range.
    Params(ParamsError),
    /// The memory is too small.
    OutOfMemory(OutOfMemory),
    /// The request is invalid.
    Request(RequestError),
    /// The pose at which the object is let go is too far away or not a number, or its rotation is not a unit quaternion.
    Release,
    /// The params ask to let the object go, but it was analysed without [`voxels`](crate::Params::voxels).
    NoDistanceField,
}

impl From<ParamsError> for PredictError {
    fn from(error: ParamsError) -> Self {
        Self::Params(error)
    }
}

impl From<RequestError> for PredictError {
    fn from(error: RequestError) -> Self {
        Self::Request(error)
    }
}

impl From<OutOfMemory> for PredictError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl core::fmt::Display for PredictError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Params(error) => error.fmt(f),
            Self::OutOfMemory(error) => error.fmt(f),
            Self::Request(error) => error.fmt(f),
            Self::Release => write!(
                f,
                "the pose of the release needs a position within ±{MAX_COORDINATE} metres and a unit quaternion"
            ),
            Self::NoDistanceField => f.write_str(
                "the object was analysed with voxels = 0: analyse it and the supporter with the params of the prediction",
            ),
        }
    }
}

impl core::error::Error for PredictError {}
