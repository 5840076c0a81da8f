use crate::border::{DETAIL, Public, Region, check_public, input, keep_apart, report};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::monitor::{hangpose_monitor, set_threads};
use crate::status::*;
use core::ffi::c_void;
use hangpose_core::Threads;

/// A part of a call: to be called once with the argument that comes with it.
pub type hangpose_task = Option<unsafe extern "C" fn(argument: *mut c_void)>;

/// Runs `first(first_argument)` and `second(second_argument)`, at the same time where that is possible, and returns when both have
/// returned. `context` is that of hangpose_threads.
pub type hangpose_join = Option<
    unsafe extern "C" fn(
        context: *mut c_void,
        first: hangpose_task,
        first_argument: *mut c_void,
        second: hangpose_task,
        second_argument: *mut c_void,
    ),
>;

/// A second thread of the caller's, which the library uses but neither starts nor ends by itself. Results are the same without it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_threads {
    /// sizeof(hangpose_threads).
    pub struct_size: u32,
    /// Runs two functions at the same time. Several calls that use the monitor may call it at once.
    pub join: hangpose_join,
    /// Given to `join` as it is; may be null.
    pub context: *mut c_void,
}

// SAFETY: `repr(C)`, `struct_size` first; null is `None`, and the caller vouches for any other function.
unsafe impl Public for hangpose_threads {
    const NAME: &'static str = "threads";
}

// SAFETY: the caller promises in the header that any thread may call `join` with `context`.
unsafe impl Sync for hangpose_threads {}

/// Calls the closure that `argument` leads to.
unsafe extern "C" fn run(argument: *mut c_void) {
    // SAFETY: `join` below passes pointers to closures that live until it returns, each to one call.
    let task = unsafe { &mut *argument.cast::<&mut (dyn FnMut() + Send)>() };
    task();
}

impl Threads for hangpose_threads {
    fn join(&self, first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send)) {
        let Some(join) = self.join else {
            first();
            return second();
        };
        let (mut first, mut second) = (first, second);
        let arguments = [(&raw mut first).cast(), (&raw mut second).cast()];
        // SAFETY: the caller's function calls each task once, on any thread, with the argument that comes with it, and has returned
        // from both before it returns; so the closures are alive and each has one user.
        unsafe { join(self.context, Some(run), arguments[0], Some(run), arguments[1]) };
    }
}

/// Lends the calls that use `monitor` a second thread, until hangpose_monitor_init. `threads` must stay where it is and as it is until
/// then. No call may be using the monitor. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_use_threads(
    monitor: *mut hangpose_monitor,
    threads: *const hangpose_threads,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let lend = || {
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("monitor", monitor, 1),
            Region::read("threads", threads, 1),
        ])?;
        check_public(threads)?;
        // SAFETY: the caller vouches for the struct, and that it stays until the monitor is initialised anew.
        let threads: &'static hangpose_threads = unsafe { input(threads) }?;
        if threads.join.is_none() {
            return Err(Failure::Null { argument: "threads.join" });
        }
        // SAFETY: the caller vouches for the monitor, and that no call is using it.
        unsafe { set_threads(monitor, threads) }?;
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, lend) }
}
