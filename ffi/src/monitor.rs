use crate::border::{DETAIL, Public, Region, check, check_public, check_size, keep_apart, report};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::status::*;
use hangpose_core::Monitor;

/// No limit: a call takes as long as it takes.
pub const HANGPOSE_NO_WORK_LIMIT: u64 = 0xFFFF_FFFF_FFFF_FFFF;

/// Lets another thread see how far a call is and stop it, and bounds the work that each call may do. Must not be moved
/// or overwritten while a call runs with it. Its words are atomic: any thread, and a signal handler, may read the
/// progress and cancel at any time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_monitor {
    /// sizeof(hangpose_monitor), set by hangpose_monitor_init.
    pub struct_size: u32,
    /// The library's.
    pub magic: u32,
    /// The library's.
    pub words: [u64; 4],
}

const MAGIC: u32 = 0x4d6f_6e31;
const _: () =
    assert!(size_of::<Monitor>() <= size_of::<[u64; 4]>() && align_of::<Monitor>() <= align_of::<u64>());

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_monitor {
    const NAME: &'static str = "monitor";
}

/// Readies a monitor, or a used one for the next call: not cancelled, no progress. `struct_size` is
/// sizeof(hangpose_monitor). Under it each call does at most `work_limit` rays and distance queries, and then returns
/// the best that it has so far; HANGPOSE_NO_WORK_LIMIT for all that it takes. The limit counts work and not time, so a
/// limited call gives the same answer on every machine.
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
        // SAFETY: not null, aligned, and of the size that the caller vouches for. The words are as large and aligned
        // as a monitor, see above.
        unsafe {
            monitor.write(hangpose_monitor { struct_size: struct_size as u32, magic: MAGIC, words: [0; 4] });
            (&raw mut (*monitor).words).cast::<Monitor>().write(Monitor::with_work_limit(work_limit));
        }
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report(detail, init) }
}

/// Asks the call that runs under this monitor to stop soon; calls that start later stop at once. Does nothing to a
/// monitor that is null or was never readied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_cancel(monitor: *mut hangpose_monitor) {
    // SAFETY: the caller vouches for the pointer.
    if let Ok(Some(monitor)) = unsafe { of(monitor) } {
        monitor.cancel();
    }
}

/// Whether hangpose_monitor_cancel was called: 1 or 0, and 0 of a monitor that is null or was never readied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_is_cancelled(monitor: *const hangpose_monitor) -> u32 {
    // SAFETY: the caller vouches for the pointer.
    let is_cancelled = unsafe { of(monitor) }.is_ok_and(|monitor| monitor.is_some_and(|m| m.is_cancelled()));
    u32::from(is_cancelled)
}

/// How far the call is that runs under this monitor, from 0 to 1; 0 of a monitor that is null or was never readied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_monitor_progress(monitor: *const hangpose_monitor) -> f32 {
    // SAFETY: the caller vouches for the pointer.
    unsafe { of(monitor) }.ok().flatten().map_or(0.0, Monitor::progress)
}

/// The core's monitor inside, where C gives one.
///
/// # Safety
///
/// The pointer is null or leads to a `hangpose_monitor` that is not moved meanwhile.
pub(crate) unsafe fn of<'a>(monitor: *const hangpose_monitor) -> Result<Option<&'a Monitor>, Failure> {
    if monitor.is_null() {
        return Ok(None);
    }
    let unready = Failure::Handle { argument: hangpose_monitor::NAME, maker: "hangpose_monitor_init" };
    check_public(monitor).map_err(|failure| match failure {
        // One that was never readied has no size either.
        Failure::StructSize { .. } => unready,
        failure => failure,
    })?;
    // SAFETY: not null, aligned, and of the right size. Only this word is read, since the others change meanwhile.
    if unsafe { (&raw const (*monitor).magic).read() } != MAGIC {
        return Err(unready);
    }
    // SAFETY: `hangpose_monitor_init` has put a monitor there.
    Ok(Some(unsafe { &*(&raw const (*monitor).words).cast::<Monitor>() }))
}
