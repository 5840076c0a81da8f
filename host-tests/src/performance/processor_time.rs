//! The processor time that a thread has used, which other programs do not change. This file has the unsafe code of it.

use std::time::Duration;

/// The clock of the processor time of one thread.
#[derive(Clone, Copy)]
pub struct ThreadClock(libc::clockid_t);

impl ThreadClock {
    /// The clock of the calling thread, which other threads may read as long as that one lives.
    pub fn of_this_thread() -> Option<Self> {
        let mut clock = 0;
        // SAFETY: the thread is the calling one, and the clock is written to a variable of the right type.
        let status = unsafe { libc::pthread_getcpuclockid(libc::pthread_self(), &raw mut clock) };
        (status == 0).then_some(Self(clock))
    }

    /// Processor time that the thread has used; `None` if it has ended.
    pub fn now(self) -> Option<Duration> {
        let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
        // SAFETY: the system checks the clock and writes to a variable of the right type.
        let status = unsafe { libc::clock_gettime(self.0, &raw mut time) };
        let (seconds, nanoseconds) = (u64::try_from(time.tv_sec).ok()?, u32::try_from(time.tv_nsec).ok()?);
        (status == 0).then(|| Duration::new(seconds, nanoseconds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn counts_work_and_not_sleep() {
        let clock = ThreadClock::of_this_thread().unwrap();
        let before = clock.now().unwrap();
        std::thread::sleep(Duration::from_millis(100));
        let slept = clock.now().unwrap() - before;
        assert!(slept < Duration::from_millis(50), "{slept:?}");
        let start = Instant::now();
        while clock.now().unwrap() - before < Duration::from_millis(60) {
            std::hint::spin_loop();
        }
        // The thread has worked for 10 ms at least, which takes as long.
        assert!(start.elapsed() >= Duration::from_millis(10));
        let other = std::thread::scope(|scope| scope.spawn(|| clock.now()).join().unwrap());
        assert!(other.unwrap() >= Duration::from_millis(60));
    }
}
