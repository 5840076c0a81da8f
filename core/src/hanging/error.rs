//! Why an object or a supporter cannot be analysed.

use crate::memory::OutOfMemory;
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
