//! What a method's search found.

use super::settling::SettlingCounts;
use crate::monitor::Stop;

/// What a search found.
pub(super) struct Found<C> {
    /// How many poses it wrote.
    pub(super) poses: usize,
    /// How much was left after each step.
    pub(super) counts: C,
    /// What became of the poses that it released.
    pub(super) settling: SettlingCounts,
    /// Why it ended early, if it did.
    pub(super) stop: Option<Stop>,
}

impl<C> Found<C> {
    /// The same with the counts wrapped.
    pub(super) fn map<D>(self, wrap: impl FnOnce(C) -> D) -> Found<D> {
        let Self { poses, counts, settling, stop } = self;
        Found { poses, counts: wrap(counts), settling, stop }
    }
}
