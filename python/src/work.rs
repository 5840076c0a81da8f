//! Long calls: other threads of Python run meanwhile, progress is reported, and an interrupt stops the call.

use hangpose::Monitor;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// Time between two looks at signals and at the progress.
const PERIOD: Duration = Duration::from_millis(20);

/// Runs `work` without the interpreter's lock. Meanwhile it calls `progress` with the share that is done, 0 to 1, and looks for
/// signals. An exception, of `progress` or by a signal, cancels the work and is raised when that has ended.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    monitor: &Monitor,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let progress = progress.map(|progress| progress.clone().unbind());
    let (result, error) = py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel::<()>();
            let worker = scope.spawn(move || {
                // Dropped when the work is done, which ends the wait below.
                let _sender = sender;
                work()
            });
            let mut error = None;
            while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(PERIOD) {
                if error.is_some() {
                    continue;
                }
                let looked = Python::attach(|py| {
                    py.check_signals()?;
                    match &progress {
                        Some(progress) => progress.call1(py, (monitor.progress(),)).map(|_| ()),
                        None => Ok(()),
                    }
                });
                if let Err(raised) = looked {
                    monitor.cancel();
                    error = Some(raised);
                }
            }
            (worker.join().unwrap_or_else(|panic| resume_unwind(panic)), error)
        })
    });
    match (error, &progress) {
        (Some(error), _) => Err(error),
        (None, Some(progress)) => progress.call1(py, (1.0,)).map(|_| result),
        (None, None) => Ok(result),
    }
}
