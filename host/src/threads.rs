//! A second thread for a call of the core.

use crate::Threads;

/// Starts a thread of the operating system for the second part of what runs at the same time, and ends it with that part.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScopedThreads;

impl Threads for ScopedThreads {
    fn join(&self, first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send)) {
        std::thread::scope(|scope| {
            scope.spawn(second);
            first();
        });
    }
}
