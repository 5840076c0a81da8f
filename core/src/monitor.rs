//! Watching and stopping a call from outside.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Lets another thread see how far a call is and stop it, and bounds the work that each call may do.
///
/// The work limit counts rays and distance queries, not time, so a limited call gives the same answer on every
/// machine. It is meant per call, not for all calls that share the monitor.
#[derive(Debug)]
pub struct Monitor {
    progress: AtomicU32,
    cancelled: AtomicBool,
    work_limit: u64,
}

impl Monitor {
    /// A monitor without a work limit.
    pub const fn new() -> Self {
        Self::with_work_limit(u64::MAX)
    }

    /// A monitor under which each call does at most `limit` rays and distance queries, and then returns the
    /// best that it has so far and says that it is partial.
    pub const fn with_work_limit(limit: u64) -> Self {
        Self { progress: AtomicU32::new(0), cancelled: AtomicBool::new(false), work_limit: limit }
    }

    /// How far the current call is, from 0 to 1.
    pub fn progress(&self) -> f32 {
        self.progress.load(Ordering::Relaxed) as f32 / PROGRESS_STEPS
    }

    /// Asks the call that runs under this monitor to stop soon; calls that start later stop at once.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether [`cancel`](Self::cancel) was called.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl Default for Monitor {
    fn default() -> Self {
        Self::new()
    }
}

const PROGRESS_STEPS: f32 = 10_000.0;

/// Why a call ended before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// [`Monitor::cancel`] was called.
    Cancelled,
    /// The monitor's work limit was reached.
    WorkLimit,
}

/// What a call did, in the units of the work limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Rays cast at a mesh.
    pub rays: u64,
    /// Distance and inside-outside queries against a mesh or a point set.
    pub distance_queries: u64,
}

/// Counts the work of one call and says when it must stop.
pub(crate) struct Meter<'a> {
    monitor: &'a Monitor,
    pub(crate) work: Work,
    /// Poses tested for collision.
    pub(crate) poses: usize,
}

impl<'a> Meter<'a> {
    pub(crate) fn new(monitor: &'a Monitor) -> Self {
        monitor.progress.store(0, Ordering::Relaxed);
        Self { monitor, work: Work::default(), poses: 0 }
    }

    /// Shows progress, a fraction from 0 to 1.
    pub(crate) fn progress(&self, fraction: f32) {
        self.monitor.progress.store((fraction * PROGRESS_STEPS) as u32, Ordering::Relaxed);
    }

    /// Books `count` rays before they are cast.
    pub(crate) fn rays(&mut self, count: usize) -> Result<(), Stop> {
        self.work.rays += count as u64;
        self.check()
    }

    /// Books `count` distance queries before they are made.
    pub(crate) fn distance_queries(&mut self, count: usize) -> Result<(), Stop> {
        self.work.distance_queries += count as u64;
        self.check()
    }

    pub(crate) fn check(&self) -> Result<(), Stop> {
        self.check_with(0)
    }

    /// Whether the call may go on with `queries` distance queries more, which are booked later.
    pub(crate) fn check_with(&self, queries: usize) -> Result<(), Stop> {
        if self.monitor.is_cancelled() {
            Err(Stop::Cancelled)
        } else if self.work.rays + self.work.distance_queries + queries as u64 > self.monitor.work_limit {
            Err(Stop::WorkLimit)
        } else {
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_and_cancel_stop_the_call() {
        let monitor = Monitor::with_work_limit(10);
        let mut meter = Meter::new(&monitor);
        assert_eq!(meter.rays(6), Ok(()));
        assert_eq!(meter.distance_queries(4), Ok(()));
        assert_eq!(meter.rays(1), Err(Stop::WorkLimit));
        meter.progress(0.25);
        assert_eq!(monitor.progress(), 0.25);
        let mut second = Meter::new(&monitor);
        assert_eq!((second.rays(10), monitor.progress()), (Ok(()), 0.0));
        monitor.cancel();
        assert_eq!(second.check(), Err(Stop::Cancelled));
    }
}
