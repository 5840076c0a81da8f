//! Conversion of the pointers of a C caller into references. Every argument from C passes through this module.
//!
//! The module checks what can be checked: null, alignment, `struct_size`, counts, overlaps. The rest are the
//! obligations of the caller, given at the top of the header: a pointer that is not null leads to a valid value of
//! its type, or to as many as the count says, and nobody else writes there during the call.

use crate::detail::hangpose_detail;
use crate::failure::{Failure, Reason};
use crate::status::{HANGPOSE_OK, HANGPOSE_WORK_LIMIT, hangpose_status};

/// A struct that C fills in or reads.
///
/// # Safety
///
/// It is `repr(C)`, its first field is the `u32` `struct_size`, every bit pattern is a valid value, and `NAME` is
/// the name of the argument in the header.
pub(crate) unsafe trait Public: Copy {
    const NAME: &'static str;
}

/// Checks that `pointer` is not null and is aligned for a `T`.
pub(crate) fn check<T>(argument: &'static str, pointer: *const T) -> Result<(), Failure> {
    if pointer.is_null() {
        Err(Failure::Null { argument })
    } else if !pointer.is_aligned() {
        Err(Failure::Misaligned { argument, alignment: align_of::<T>() })
    } else {
        Ok(())
    }
}

/// Checks that `pointer` leads to a `T` of this header.
pub(crate) fn check_public<T: Public>(pointer: *const T) -> Result<(), Failure> {
    check(T::NAME, pointer)?;
    // SAFETY: not null and aligned; the caller vouches that a struct with a `struct_size` begins here, whatever its
    // size. Only this field is read.
    let given = unsafe { pointer.cast::<u32>().read() } as usize;
    check_size::<T>(given)
}

/// Checks that `given` is the size of a `T` of this header.
pub(crate) fn check_size<T: Public>(given: usize) -> Result<(), Failure> {
    let expected = size_of::<T>();
    if given == expected { Ok(()) } else { Err(Failure::StructSize { argument: T::NAME, given, expected }) }
}

/// A struct that C filled in.
///
/// # Safety
///
/// The obligations of the caller at the top of this file.
pub(crate) unsafe fn input<'a, T: Public>(pointer: *const T) -> Result<&'a T, Failure> {
    check_public(pointer)?;
    // SAFETY: not null, aligned and of the right size; every bit pattern is a `T`. The caller vouches for the rest.
    Ok(unsafe { &*pointer })
}

/// A struct that C filled in, or null.
///
/// # Safety
///
/// The obligations of the caller at the top of this file.
pub(crate) unsafe fn optional_input<'a, T: Public>(pointer: *const T) -> Result<Option<&'a T>, Failure> {
    // SAFETY: those of this function.
    if pointer.is_null() { Ok(None) } else { unsafe { input(pointer) }.map(Some) }
}

/// A struct for the result.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, and the struct does not overlap what the call reads.
pub(crate) unsafe fn output<'a, T: Public>(pointer: *mut T) -> Result<&'a mut T, Failure> {
    check_public(pointer)?;
    // SAFETY: not null, aligned and of the right size; every bit pattern is a `T`. The caller vouches for the rest.
    Ok(unsafe { &mut *pointer })
}

/// `count` structs that C filled in, at least one.
///
/// # Safety
///
/// The obligations of the caller at the top of this file.
pub(crate) unsafe fn inputs<'a, T: Public>(
    field: &'static str,
    pointer: *const T,
    count: u32,
) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Err(Failure::Count { field, count: 0, most: u32::MAX as usize });
    }
    // The first struct tells whether the others have the size of this header.
    check_public(pointer)?;
    check_count::<T>(field, count)?;
    // SAFETY: not null, aligned, and short enough for a slice; every bit pattern is a `T`. The caller vouches for the
    // rest.
    let structs = unsafe { core::slice::from_raw_parts(pointer, count as usize) };
    structs.iter().try_for_each(|one| check_public(one))?;
    Ok(structs)
}

/// The address at which the call stores a pointer or a number.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, `T` is a pointer or a number, and the address does not overlap
/// what the call reads.
pub(crate) unsafe fn place<'a, T>(argument: &'static str, pointer: *mut T) -> Result<&'a mut T, Failure> {
    check(argument, pointer)?;
    // SAFETY: not null and aligned, and every bit pattern is a `T`. The caller vouches for the rest.
    Ok(unsafe { &mut *pointer })
}

/// `count` rows of three numbers.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, and `T` is `f32` or `u32`.
pub(crate) unsafe fn rows<'a, T>(
    argument: &'static str,
    pointer: *const T,
    count: u32,
) -> Result<&'a [[T; 3]], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check(argument, pointer)?;
    check_count::<[T; 3]>(argument, count)?;
    // SAFETY: not null, aligned, and short enough for a slice; every bit pattern is a `T`. The caller vouches for the
    // rest.
    Ok(unsafe { core::slice::from_raw_parts(pointer.cast(), count as usize) })
}

/// `count` numbers or structs, at least one.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, and every bit pattern is a `T`.
pub(crate) unsafe fn elements<'a, T>(
    argument: &'static str,
    pointer: *const T,
    count: u32,
) -> Result<&'a [T], Failure> {
    check(argument, pointer)?;
    check_count::<T>(argument, count)?;
    // SAFETY: not null, aligned, and short enough for a slice; every bit pattern is a `T`. The caller vouches for the
    // rest.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count as usize) })
}

/// `count` bytes for the call to write.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, and the bytes do not overlap what the call reads.
pub(crate) unsafe fn bytes_mut<'a>(
    argument: &'static str,
    pointer: *mut u8,
    count: u32,
) -> Result<&'a mut [u8], Failure> {
    check(argument, pointer)?;
    check_count::<u8>(argument, count)?;
    // SAFETY: as in `elements`, and nobody else uses them. The caller vouches for the rest.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, count as usize) })
}

/// `count` rows of three numbers for the call to write.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, the rows do not overlap what the call reads, and `T` is
/// `f32` or `u32`.
pub(crate) unsafe fn rows_mut<'a, T>(
    argument: &'static str,
    pointer: *mut T,
    count: u32,
) -> Result<&'a mut [[T; 3]], Failure> {
    check(argument, pointer)?;
    check_count::<[T; 3]>(argument, count)?;
    // SAFETY: as in `rows`, and nobody else uses them. The caller vouches for the rest.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer.cast(), count as usize) })
}

/// Checks that `count` values of type `T` fit into the address space.
fn check_count<T>(field: &'static str, count: u32) -> Result<(), Failure> {
    let most = isize::MAX as usize / size_of::<T>();
    if count as usize <= most { Ok(()) } else { Err(Failure::Count { field, count: count as usize, most }) }
}

/// Memory for models and work.
///
/// # Safety
///
/// The obligations of the caller at the top of this file, and the memory does not overlap what the call reads.
pub(crate) unsafe fn memory<'a>(pointer: *mut u8, size: usize) -> Result<&'a mut [u8], Failure> {
    let most = isize::MAX as usize;
    if size == 0 {
        return Ok(&mut []);
    }
    check("memory", pointer)?;
    if size > most || pointer.addr().checked_add(size).is_none() {
        return Err(Failure::Count { field: "memory_size", count: size, most });
    }
    // SAFETY: not null and short enough for a slice, and nobody else uses it. C may not have initialised it, but no
    // byte is read before it is written: the core's arena zeroes the memory that it hands out, and this crate writes
    // its models and poses completely.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, size) })
}

/// Memory that a call reads or writes, as far as its extent is known.
#[derive(Clone, Copy)]
pub(crate) struct Region {
    name: &'static str,
    start: usize,
    bytes: usize,
    is_written: bool,
}

impl Region {
    pub(crate) fn read<T>(name: &'static str, pointer: *const T, count: usize) -> Self {
        let bytes = if pointer.is_null() { 0 } else { count.saturating_mul(size_of::<T>()) };
        Self { name, start: pointer.addr(), bytes, is_written: false }
    }

    pub(crate) fn written<T>(name: &'static str, pointer: *const T, count: usize) -> Self {
        Self { is_written: true, ..Self::read(name, pointer, count) }
    }

    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    fn overlaps(&self, other: &Self) -> bool {
        let end = |region: &Self| region.start.saturating_add(region.bytes);
        self.bytes > 0 && other.bytes > 0 && self.start < end(other) && other.start < end(self)
    }
}

/// Name of a detail argument in the header.
pub(crate) const DETAIL: &str = "detail";

/// Fails if memory that the call writes overlaps anything else. The detail comes first, so that it is known whether
/// it may be written.
pub(crate) fn keep_apart(regions: &[Region]) -> Result<(), Failure> {
    debug_assert!(regions[1..].iter().all(|region| region.name != DETAIL));
    for (index, one) in regions.iter().enumerate() {
        for other in regions.iter().skip(index + 1) {
            if one.overlaps(other) && (one.is_written || other.is_written) {
                let (written, other) = if one.is_written { (one, other) } else { (other, one) };
                return Err(Failure::Overlap { written: written.name, other: other.name });
            }
        }
    }
    Ok(())
}

/// Makes a call and writes its result to `detail`, unless `detail` is null.
///
/// # Safety
///
/// The obligations of the caller at the top of this file.
pub(crate) unsafe fn report<R: Reason>(
    detail: *mut hangpose_detail,
    call: impl FnOnce() -> Result<hangpose_status, R>,
) -> hangpose_status {
    if !detail.is_null()
        && let Err(failure) = check_public(detail.cast_const())
    {
        return failure.status();
    }
    let result = call();
    let is_apart =
        !matches!(&result, Err(reason) if reason.overlap().is_some_and(|[written, _]| written == DETAIL));
    // SAFETY: checked above. A detail that overlaps another argument is not written.
    if is_apart && let Some(detail) = unsafe { detail.as_mut() } {
        match &result {
            Ok(status) => detail.answer(*status),
            Err(reason) => detail.failure(reason),
        }
    }
    result.unwrap_or_else(|reason| reason.status())
}

/// Does what [`report`] does for a call that stores a model at `place`, and stores null there if it makes none. A place
/// that overlaps another argument is not written.
///
/// # Safety
///
/// The obligations of the caller at the top of this file.
pub(crate) unsafe fn report_model<T, R: Reason>(
    argument: &'static str,
    place: *mut *mut T,
    detail: *mut hangpose_detail,
    call: impl FnOnce() -> Result<hangpose_status, R>,
) -> hangpose_status {
    let mut is_apart = true;
    let watched = || {
        call().inspect_err(|reason| is_apart = !reason.overlap().is_some_and(|both| both.contains(&argument)))
    };
    // SAFETY: those of this function.
    let status = unsafe { report(detail, watched) };
    let is_made = matches!(status, HANGPOSE_OK | HANGPOSE_WORK_LIMIT);
    if !is_made && is_apart && check(argument, place.cast_const()).is_ok() {
        // SAFETY: not null and aligned. The caller vouches for the rest.
        unsafe { place.write(core::ptr::null_mut()) };
    }
    status
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_detail {
    const NAME: &'static str = DETAIL;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_written_must_be_apart() {
        let bytes = [0_u8; 30];
        let (a, b) = (Region::read("a", &bytes[0], 10), Region::read("b", &bytes[5], 10));
        assert_eq!(keep_apart(&[a, b]), Ok(()));
        let c = Region::written("c", &bytes[15], 10);
        assert_eq!(keep_apart(&[a, b, c]), Ok(()));
        let d = Region::written("d", &bytes[14], 1);
        assert_eq!(keep_apart(&[a, b, c, d]), Err(Failure::Overlap { written: "d", other: "b" }));
        assert_eq!(keep_apart(&[d, c, b]), Err(Failure::Overlap { written: "d", other: "b" }));
        let everything = Region::written("everything", &bytes[29], usize::MAX);
        assert_eq!(keep_apart(&[a, b, c, everything]), Ok(()));
        assert_eq!(keep_apart(&[a, Region::written("none", core::ptr::null::<u8>(), 40)]), Ok(()));
    }
}
