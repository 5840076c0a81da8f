//! nanoflann's k-d tree as a peer. This file has the unsafe code of it.

use std::ffi::c_void;
use std::marker::PhantomData;

unsafe extern "C" {
    fn hangpose_nanoflann_create(points: *const f32, count: usize) -> *mut c_void;
    fn hangpose_nanoflann_destroy(index: *mut c_void);
    fn hangpose_nanoflann_search(
        index: *const c_void,
        query: *const f32,
        k: usize,
        found: *mut u32,
        squares: *mut f32,
    ) -> usize;
}

/// A k-d tree over borrowed points.
pub struct Tree<'a> {
    index: *mut c_void,
    points: PhantomData<&'a [[f32; 3]]>,
}

impl<'a> Tree<'a> {
    /// Arranges points.
    pub fn new(points: &'a [[f32; 3]]) -> Self {
        // SAFETY: the pointer leads to three numbers for each of the counted points, which outlive the tree.
        let index = unsafe { hangpose_nanoflann_create(points.as_ptr().cast(), points.len()) };
        Self { index, points: PhantomData }
    }

    /// The `K` nearest points, nearest first, and the squares of their distances.
    pub fn nearest<const K: usize>(&self, query: &[f32; 3]) -> ([u32; K], [f32; K]) {
        let (mut found, mut squares) = ([0; K], [0.0; K]);
        // SAFETY: the index is alive, the query has three numbers, and both arrays have `K` places.
        unsafe {
            hangpose_nanoflann_search(
                self.index,
                query.as_ptr(),
                K,
                found.as_mut_ptr(),
                squares.as_mut_ptr(),
            );
        }
        (found, squares)
    }
}

impl Drop for Tree<'_> {
    fn drop(&mut self) {
        // SAFETY: the index came from `create` and is not used again.
        unsafe { hangpose_nanoflann_destroy(self.index) }
    }
}
