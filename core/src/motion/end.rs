//! How planning ends early.

use super::error::PlanError;
use super::failure::PlanFailure;
use crate::memory::OutOfMemory;
use crate::monitor::Stop;

/// An answer that is not a path, or an error.
pub(super) enum End {
    Failure(PlanFailure),
    Error(PlanError),
}

impl From<PlanFailure> for End {
    fn from(failure: PlanFailure) -> Self {
        Self::Failure(failure)
    }
}

impl From<Stop> for End {
    fn from(stop: Stop) -> Self {
        Self::Failure(PlanFailure::Stopped(stop))
    }
}

impl From<PlanError> for End {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Cancelled => Stop::Cancelled.into(),
            error => Self::Error(error),
        }
    }
}

impl From<OutOfMemory> for End {
    fn from(error: OutOfMemory) -> Self {
        Self::Error(error.into())
    }
}
