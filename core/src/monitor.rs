//! Watching, stopping and helping a call from outside.

use crate::memory::OutOfMemory;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// A second thread of the caller's, for parts of a call that do not depend on each other.
pub trait Threads: Sync {
    /// Calls both functions, once each, at the same time where that is possible, and returns when both have returned.
    fn join(&self, first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send));
}

/// Lets another thread see how far a call is and stop it, bounds the work that each call may do, and lends it a second thread.
///
/// The work limit counts rays and distance queries, winding numbers among them, not time, so a limited call gives the same answer on
/// every machine. Filtering a cloud and its normals are not counted: each of its points is asked about a fixed number of times. The
/// limit is meant per call, not for all calls that share the monitor. A second thread changes no answer, either.
pub struct Monitor<'t> {
    progress: AtomicU32,
    cancelled: AtomicBool,
    work_limit: u64,
    threads: Option<&'t dyn Threads>,
}

impl<'t> Monitor<'t> {
    /// A monitor without a work limit.
    pub const fn new() -> Self {
        Self::with_work_limit(u64::MAX)
    }

    /// A monitor under which each call does at most `limit` rays and distance queries, and then returns the
    /// best that it has so far and says that it is partial.
    pub const fn with_work_limit(limit: u64) -> Self {
        Self {
            progress: AtomicU32::new(0),
            cancelled: AtomicBool::new(false),
            work_limit: limit,
            threads: None,
        }
    }

    /// Lends a second thread to the calls under this monitor.
    pub const fn with_threads(self, threads: &'t dyn Threads) -> Self {
        Self { threads: Some(threads), ..self }
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

impl Default for Monitor<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl core::fmt::Debug for Monitor<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Monitor")
            .field("progress", &self.progress())
            .field("is_cancelled", &self.is_cancelled())
            .field("work_limit", &self.work_limit)
            .field("has_threads", &self.threads.is_some())
            .finish()
    }
}

const PROGRESS_STEPS: f32 = 10_000.0;
/// Short steps, of less than a microsecond, between two looks at the monitor. A budget: the look costs a nanosecond, and a cancelled
/// call is to end within a millisecond.
const STEPS_A_CHECK: usize = 256;

/// Why a call ended before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// [`Monitor::cancel`] was called.
    Cancelled,
    /// The monitor's work limit was reached.
    WorkLimit,
}

/// Why a part of an analysis ended before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unfinished {
    OutOfMemory(OutOfMemory),
    Stopped(Stop),
}

impl From<OutOfMemory> for Unfinished {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl From<Stop> for Unfinished {
    fn from(stop: Stop) -> Self {
        Self::Stopped(stop)
    }
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
#[derive(Clone, Copy)]
pub(crate) struct Meter<'a> {
    monitor: &'a Monitor<'a>,
    pub(crate) work: Work,
    /// Poses tested for collision.
    pub(crate) poses: usize,
}

impl<'a> Meter<'a> {
    pub(crate) fn new(monitor: &'a Monitor<'a>) -> Self {
        monitor.progress.store(0, Ordering::Relaxed);
        Self { monitor, work: Work::default(), poses: 0 }
    }

    /// Nobody stops what it counts.
    #[cfg(test)]
    pub(crate) fn unwatched() -> Meter<'static> {
        static NOBODY: Monitor<'static> = Monitor::new();
        Meter::new(&NOBODY)
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

    /// Whether the call was cancelled, where nothing is done that counts against the work limit.
    pub(crate) fn check_cancelled(&self) -> Result<(), Stop> {
        if self.monitor.is_cancelled() { Err(Stop::Cancelled) } else { Ok(()) }
    }

    /// The same, once in [`STEPS_A_CHECK`] short steps of a loop.
    pub(crate) fn check_at(&self, step: usize) -> Result<(), Stop> {
        if step.is_multiple_of(STEPS_A_CHECK) { self.check_cancelled() } else { Ok(()) }
    }

    /// Whether [`run_both`](Self::run_both) has a second thread.
    pub(crate) fn has_threads(&self) -> bool {
        self.monitor.threads.is_some()
    }

    /// Runs `first`, and then `second` unless `is_enough` of the first result; with a second thread both at the same time. Results and
    /// booked work do not depend on that: what `second` did in vain is forgotten.
    ///
    /// # Errors
    ///
    /// If a part is stopped. `second` may have run twice then.
    pub(crate) fn run_both<T: Send>(
        &mut self,
        mut first: impl FnMut(&mut Self) -> Result<T, Stop> + Send,
        mut second: impl FnMut(&mut Self) -> Result<T, Stop> + Send,
        is_enough: impl FnOnce(&T) -> bool,
    ) -> Result<(T, Option<T>), Stop> {
        let before = *self;
        let mut ahead = None;
        let first = match self.monitor.threads {
            None => first(self),
            Some(threads) => {
                let mut result = Err(Stop::Cancelled);
                let mut other = before;
                threads.join(&mut || result = first(self), &mut || ahead = Some((second(&mut other), other)));
                result
            }
        }?;
        if is_enough(&first) {
            return Ok((first, None));
        }
        if let Some((result, other)) = ahead {
            let after_first = *self;
            self.work.rays += other.work.rays - before.work.rays;
            self.work.distance_queries += other.work.distance_queries - before.work.distance_queries;
            self.poses += other.poses - before.poses;
            // Both parts had the whole rest of the limit to themselves; where it does not suffice for both, the second has to stop
            // where it would have stopped after the first.
            if self.check().is_ok() {
                return Ok((first, Some(result?)));
            }
            *self = after_first;
        }
        let second = second(self)?;
        Ok((first, Some(second)))
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
pub(crate) mod tests {
    use super::*;

    /// A new thread for each second part.
    pub(crate) struct ScopedThreads;

    impl Threads for ScopedThreads {
        fn join(&self, first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send)) {
            std::thread::scope(|scope| {
                scope.spawn(second);
                first();
            });
        }
    }

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

    /// Whatever each part needs, what is enough and where the limit is.
    #[test]
    fn a_second_thread_changes_neither_results_nor_work() {
        for limit in 0..=12 {
            for (a, b) in [(0, 0), (3, 4), (4, 3), (9, 1), (1, 9)] {
                for enough in [false, true] {
                    let run = |monitor: &Monitor| {
                        let mut meter = Meter::new(monitor);
                        let part = |rays: usize| {
                            move |meter: &mut Meter| (0..rays).try_for_each(|_| meter.rays(1)).map(|()| rays)
                        };
                        let before = meter.distance_queries(2);
                        let both = before.and_then(|()| meter.run_both(part(a), part(b), |_| enough));
                        (both, meter.work)
                    };
                    let alone = run(&Monitor::with_work_limit(limit));
                    assert_eq!(run(&Monitor::with_work_limit(limit).with_threads(&ScopedThreads)), alone);
                    let needed = 2 + a + if enough { 0 } else { b };
                    assert_eq!(alone.0.is_ok(), limit >= needed as u64);
                }
            }
        }
    }
}
