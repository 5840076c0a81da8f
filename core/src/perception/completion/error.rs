//! Why a volume cannot be completed.

use crate::Stop;
use crate::memory::OutOfMemory;

/// Why a volume cannot be completed. It is then as it was before the call, unless that was cancelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CompletionError {
    /// The volume is sparse.
    Sparse,
    /// A length of the settings is negative or not a number.
    Settings {
        /// Thickness given, metres.
        thickness: f32,
        /// Radius given, metres.
        radius: f32,
    },
    /// The memory is smaller than [`Completion::bytes`](super::Completion::bytes).
    OutOfMemory(OutOfMemory),
    /// The monitor stopped the call.
    Stopped(Stop),
}

impl core::fmt::Display for CompletionError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Sparse => {
                write!(f, "a sparse volume does not know what is free: complete a dense one with a crop box")
            }
            Self::Settings { thickness, radius } => write!(
                f,
                "the thickness {thickness} and the radius {radius} must be positive numbers of metres or zero"
            ),
            Self::OutOfMemory(error) => error.fmt(f),
            Self::Stopped(Stop::Cancelled) => write!(f, "the completion was cancelled"),
            Self::Stopped(Stop::WorkLimit) => write!(f, "the work limit was reached: raise it"),
        }
    }
}

impl core::error::Error for CompletionError {}

impl From<OutOfMemory> for CompletionError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl From<Stop> for CompletionError {
    fn from(error: Stop) -> Self {
        Self::Stopped(error)
    }
}
