use crate::border::{DETAIL, Public, Region, check, check_public, check_size, keep_apart, report};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::status::*;
use hangpose_core::{Monitor, Threads};

/// Value of `work_limit` for no limit.
pub const HANGPOSE_NO_WORK_LIMIT: u64 = 0xFFFF_FFFF_FFFF_FFFF;

/// Lets other threads read the progress of a call and cancel it, and limits the work of each call. It must not be
/// moved or overwritten while a call uses it. Its words are atomic: any thread, and a signal handler, may read the
/// progress and cancel at any time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_monitor {
    /// sizeof(hangpose_monitor), set by hangpose_monitor_init.
    pub struct_size: u32,
    /// Private to the library.
    pub magic: u32,
    /// Private to the library.
    pub words: [u64; 4],
}

const MAGIC: u32 = 0x4d6f_6e31;
const _: () =
    assert!(size_of::<Monitor>() <= size_of::<[u64; 4]>() && align_of::<Monitor>() <= align_of::<u64>());

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_monitor {
    const NAME: &'static str = "monitor";
}

/// Initialises a monitor, or resets a used one for the next call: not cancelled, no progress. No call may be using
/// it. `struct_size` is sizeof(hangpose_monitor). Returns HANGPOSE_OK, or an error.
///
/// `work_limit` is the greatest number of rays and distance queries in each call that takes the monitor, or
/// HANGPOSE_NO_WORK_LIMIT. A call that reaches it returns the best result so far. The limit counts work and not
/// time, so a limited call gives the same result on every machine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_init(
    monitor: *mut hangpose_monitor,
    struct_size: usize,
    work_limit: u64,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let init = || {
        check_size::<hangpose_monitor>(struct_size)?;
        keep_apart(&[Region::written(DETAIL, detail, 1), Region::written("monitor", monitor, 1)])?;
        check(hangpose_monitor::NAME, monitor.cast_const())?;
        // SAFETY: not null, aligned, and of the size that the caller vouches for. The words have the size and alignment
        // of a monitor, see above.
        unsafe {
            monitor.write(hangpose_monitor { struct_size: struct_size as u32, magic: MAGIC, words: [0; 4] });
            (&raw mut (*monitor).words).cast::<Monitor>().write(Monitor::with_work_limit(work_limit));
        }
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, init) }
}

/// Makes the call that uses this monitor stop soon; later calls stop at once, until hangpose_monitor_init. Does
/// nothing if the monitor is null or was never initialised.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_cancel(monitor: *mut hangpose_monitor) {
    // SAFETY: the caller vouches for the pointer.
    if let Ok(Some(monitor)) = unsafe { of(monitor) } {
        monitor.cancel();
    }
}

/// Returns 1 if hangpose_monitor_cancel was called, else 0; 0 if the monitor is null or was never initialised.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_is_cancelled(monitor: *const hangpose_monitor) -> u32 {
    // SAFETY: the caller vouches for the pointer.
    let is_cancelled = unsafe { of(monitor) }.is_ok_and(|monitor| monitor.is_some_and(|m| m.is_cancelled()));
    u32::from(is_cancelled)
}

/// Returns the progress of the call that uses this monitor, from 0 to 1; 0 if the monitor is null or was never
/// initialised.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_progress(monitor: *const hangpose_monitor) -> f32 {
    // SAFETY: the caller vouches for the pointer.
    unsafe { of(monitor) }.ok().flatten().map_or(0.0, Monitor::progress)
}

/// Lends a second thread to the monitor.
///
/// # Safety
///
/// The pointer is null or leads to a `hangpose_monitor` that is not used meanwhile.
pub(crate) unsafe fn set_threads(
    monitor: *mut hangpose_monitor,
    threads: &'static dyn Threads,
) -> Result<(), Failure> {
    check(hangpose_monitor::NAME, monitor.cast_const())?;
    // SAFETY: those of this function.
    unsafe { of(monitor) }?;
    // SAFETY: `of` found a monitor there, which nobody else uses.
    let inner = unsafe { &mut *(&raw mut (*monitor).words).cast::<Monitor>() };
    *inner = core::mem::take(inner).with_threads(threads);
    Ok(())
}

/// The core's monitor inside, or `None` for null.
///
/// # Safety
///
/// The pointer is null or leads to a `hangpose_monitor` that is not moved during the call.
pub(crate) unsafe fn of<'a>(
    monitor: *const hangpose_monitor,
) -> Result<Option<&'a Monitor<'static>>, Failure> {
    if monitor.is_null() {
        return Ok(None);
    }
    let uninitialised = Failure::Handle { argument: hangpose_monitor::NAME, maker: "hangpose_monitor_init" };
    check_public(monitor).map_err(|failure| match failure {
        // A monitor that was never initialised has no size either.
        Failure::StructSize { .. } => uninitialised,
        failure => failure,
    })?;
    // SAFETY: not null, aligned, and of the right size. Only this word is read, because other threads may change the
    // rest.
    if unsafe { (&raw const (*monitor).magic).read() } != MAGIC {
        return Err(uninitialised);
    }
    // SAFETY: `hangpose_monitor_init` has put a monitor there.
    Ok(Some(unsafe { &*(&raw const (*monitor).words).cast::<Monitor>() }))
}
