//! Why nothing hangs.

use super::counts::Counts;
use super::stage::Stage;

/// Why nothing hangs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rejection {
    /// The first step that left nothing.
    pub stage: Stage,
    /// How much was left after each step.
    pub counts: Counts,
}
