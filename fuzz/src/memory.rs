//! How much memory a thread has allocated, and memory with guards for the library under test.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The allocator of the system, which counts for each thread.
struct Counting;

thread_local! {
    static NOW: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

fn count(bytes: isize) {
    // A thread that ends may free after its counters are gone.
    let _ = NOW.try_with(|now| {
        now.set(now.get() + bytes);
        let _ = PEAK.try_with(|peak| peak.set(peak.get().max(now.get())));
    });
}

// SAFETY: every call goes to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: that of the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: that of the caller.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: that of the caller.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Both exist while the content is copied.
        count(size as isize);
        // SAFETY: that of the caller.
        let moved = unsafe { System.realloc(pointer, layout, size) };
        count(-(layout.size() as isize));
        moved
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The result of `work`, and the most bytes that this thread held more than before.
pub fn peak_of<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = NOW.get();
    PEAK.set(before);
    let result = work();
    (result, (PEAK.get() - before).max(0) as usize)
}

/// Bytes on either side of a [`Block`] that nobody may write.
const GUARD: usize = 64;
const GUARDED: u8 = 0xA5;

/// Memory for a call, at any alignment, that holds leftovers and has guards on both sides.
pub struct Block {
    bytes: Vec<u8>,
    start: usize,
    size: usize,
}

impl Block {
    /// `size` bytes, `offset` bytes (up to 15) behind a multiple of 16.
    pub fn new(size: usize, offset: usize) -> Self {
        let bytes = vec![GUARDED; size + 2 * GUARD + 32];
        let start = GUARD + bytes[GUARD..].as_ptr().align_offset(16) + offset % 16;
        Self { bytes, start, size }
    }

    /// The memory.
    pub fn memory(&mut self) -> &mut [u8] {
        &mut self.bytes[self.start..][..self.size]
    }

    /// Number of its bytes.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Asserts that nothing was written beyond.
    pub fn check(&self) {
        let (before, rest) = self.bytes.split_at(self.start);
        let beyond = before.iter().chain(&rest[self.size..]);
        assert!(beyond.into_iter().all(|byte| *byte == GUARDED), "a call wrote beyond its memory");
    }
}
