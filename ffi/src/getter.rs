//! Code that the getters of objects and supporters share.

use crate::border::{DETAIL, Public, Region, keep_apart, output, report};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::handle::{Handle, Model};
use crate::status::{HANGPOSE_OK, hangpose_status};

/// Writes what `read` returns for a model to `answer`.
///
/// # Safety
///
/// Those of [`Handle::share`], and the obligations of the C caller at the top of `border.rs`.
pub(crate) unsafe fn get<M: Model, T: Public>(
    handle: *const Handle<M>,
    answer: *mut T,
    detail: *mut hangpose_detail,
    read: impl FnOnce(&M) -> Result<T, Failure>,
) -> hangpose_status {
    let get = || {
        // SAFETY: those of this function.
        let shared = unsafe { Handle::share(handle) }?;
        let [handle, arena] = shared.regions();
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written(T::NAME, answer, 1),
            handle,
            arena,
        ])?;
        // SAFETY: the caller vouches for the pointer, and it is apart from the rest.
        let answer = unsafe { output(answer) }?;
        *answer = read(shared.model())?;
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, get) }
}

/// The item with this index.
pub(crate) fn at<T>(mut items: impl ExactSizeIterator<Item = T>, index: u32) -> Result<T, Failure> {
    let count = items.len();
    items.nth(index as usize).ok_or(Failure::Index { argument: "index", index, count })
}
