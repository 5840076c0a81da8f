//! Values of the core, whose layout is not that of C, at the front of the caller's memory.

use crate::failure::Failure;

/// Bytes for `count` values in memory that begins at any address.
pub(crate) fn slot_bytes<P>(count: usize) -> usize {
    size_of::<P>().saturating_mul(count).saturating_add(align_of::<P>() - 1)
}

/// Fails if working memory is smaller than `needed` bytes.
pub(crate) fn check_room(memory: &[u8], needed: usize) -> Result<(), Failure> {
    let given = memory.len();
    if given < needed { Err(Failure::Memory { argument: "memory", needed, given }) } else { Ok(()) }
}

/// Splits `memory`, of at least [`slot_bytes`], into `count` values and the rest.
pub(crate) fn slots<P: Copy + Default>(memory: &mut [u8], count: usize) -> (&mut [P], &mut [u8]) {
    let skip = memory.as_ptr().align_offset(align_of::<P>());
    let aligned = memory.get_mut(skip..).unwrap_or_default();
    let bytes = size_of::<P>().saturating_mul(count).min(aligned.len());
    let (front, rest) = aligned.split_at_mut(bytes);
    let count = front.len() / size_of::<P>();
    let first = front.as_mut_ptr().cast::<P>();
    for index in 0..count {
        // SAFETY: aligned, and within the bytes counted above.
        unsafe { first.add(index).write(P::default()) };
    }
    // SAFETY: all of them are initialised, and the memory is borrowed as long as they are.
    (unsafe { core::slice::from_raw_parts_mut(first, count) }, rest)
}
