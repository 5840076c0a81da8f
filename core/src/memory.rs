//! Typed slices of memory that the caller owns.
//!
//! Every model is built inside one byte slice that the caller hands in: a static array, a `Vec` or a C buffer.
//! Beside each `analyze` stands a const `bytes` that says how much it takes.

use bytemuck::Pod;

/// Every slice of an [`Arena`] begins at a multiple of this many bytes.
const ALIGNMENT: usize = 16;

/// The memory handed in is smaller than what the call needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfMemory {
    /// Bytes that the call needs, whatever the alignment of the memory.
    pub needed: usize,
    /// Bytes that were handed in.
    pub given: usize,
}

impl core::fmt::Display for OutOfMemory {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { needed, given } = self;
        write!(f, "{needed} bytes of memory are needed and {given} were given")
    }
}

impl core::error::Error for OutOfMemory {}

/// Largest sizes of the inputs for which memory is reserved. Smaller inputs need no more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Vertices of the object's mesh.
    pub vertices: usize,
    /// Triangles of the object's mesh.
    pub triangles: usize,
    /// Points sampled from it: [`Params::samples`](crate::Params::samples).
    pub samples: usize,
    /// Nodes of the object's distance field: [`Params::voxels`](crate::Params::voxels).
    pub voxels: usize,
    /// Points of the supporter's cloud.
    pub points: usize,
}

impl Limits {
    /// Zero of everything, for naming only the limits that matter: `Limits { voxels, ..Limits::NONE }`.
    pub const NONE: Self = Self { vertices: 0, triangles: 0, samples: 0, voxels: 0, points: 0 };

    /// For a supporter of `points` points, and no object.
    pub const fn of_points(points: usize) -> Self {
        Self { points, ..Self::NONE }
    }
}

/// Bytes that an [`Arena`] spends on `count` values of `T`.
pub(crate) const fn array_bytes<T>(count: usize) -> usize {
    count.saturating_mul(size_of::<T>()).saturating_add(ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT
}

/// The larger of two sizes, in const.
pub(crate) const fn larger(a: usize, b: usize) -> usize {
    if a > b { a } else { b }
}

/// Bytes that a model takes whose arrays add up to `arrays`, wherever its memory begins.
pub(crate) const fn model_bytes(arrays: usize) -> usize {
    arrays.saturating_add(ALIGNMENT - 1)
}

/// Hands out slices from the front of one block of memory, for as long as the block is borrowed.
pub(crate) struct Arena<'m> {
    free: &'m mut [u8],
}

impl<'m> Arena<'m> {
    /// Takes over `memory`, or says that it is smaller than `needed` bytes.
    pub(crate) fn new(memory: &'m mut [u8], needed: usize) -> Result<Self, OutOfMemory> {
        if memory.len() < needed {
            return Err(OutOfMemory { needed, given: memory.len() });
        }
        let skip = memory.as_ptr().align_offset(ALIGNMENT).min(memory.len());
        Ok(Self { free: &mut memory[skip..] })
    }

    /// `count` zeroed values that live as long as the memory.
    pub(crate) fn slice<T: Pod>(&mut self, count: usize) -> Result<&'m mut [T], OutOfMemory> {
        let slice = self.unset(count)?;
        slice.fill(T::zeroed());
        Ok(slice)
    }

    /// `count` values, whatever the memory holds, that live as long as the memory: for large arrays of which each value is
    /// written before it is read, and most are often not needed.
    pub(crate) fn unset<T: Pod>(&mut self, count: usize) -> Result<&'m mut [T], OutOfMemory> {
        const { assert!(align_of::<T>() <= ALIGNMENT && size_of::<T>() > 0) };
        let bytes = array_bytes::<T>(count);
        let too_small = OutOfMemory { needed: bytes, given: self.free.len() };
        if bytes > self.free.len() {
            return Err(too_small);
        }
        let (taken, rest) = core::mem::take(&mut self.free).split_at_mut(bytes);
        self.free = rest;
        let values = taken.get_mut(..count.saturating_mul(size_of::<T>()));
        values.and_then(|values| bytemuck::try_cast_slice_mut(values).ok()).ok_or(too_small)
    }

    /// What is left, for working memory that is given back when the result goes out of scope.
    pub(crate) fn scratch(&mut self) -> Arena<'_> {
        Arena { free: self.free }
    }

    /// Bytes not handed out yet.
    #[cfg(test)]
    pub(crate) fn left(&self) -> usize {
        self.free.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_zeroed_aligned_and_apart() {
        let mut memory = vec![0xAB_u8; 1000];
        for offset in 0..40 {
            let needed = model_bytes(array_bytes::<u8>(3) + array_bytes::<u64>(5) + array_bytes::<f32>(7));
            let mut arena = Arena::new(&mut memory[offset..offset + needed], needed).unwrap();
            let bytes = arena.slice::<u8>(3).unwrap();
            let words = arena.slice::<u64>(5).unwrap();
            let floats = arena.slice::<f32>(7).unwrap();
            assert!(bytes == [0; 3] && words == [0; 5] && floats == [0.0; 7]);
            bytes.fill(255);
            words.fill(u64::MAX);
            floats.fill(f32::NAN);
            assert!(bytes == [255; 3] && words == [u64::MAX; 5], "slices overlap at offset {offset}");
        }
    }

    #[test]
    fn scratch_is_given_back() {
        let mut memory = [0_u8; 256];
        let mut arena = Arena::new(&mut memory, 200).unwrap();
        let before = arena.left();
        assert!(arena.scratch().slice::<u32>(50).is_ok());
        assert_eq!(arena.left(), before);
        assert!(arena.slice::<u32>(50).is_ok());
    }

    #[test]
    fn too_small_names_both_sizes() {
        let error = Arena::new(&mut [0; 10], 11).err().unwrap();
        assert_eq!(error, OutOfMemory { needed: 11, given: 10 });
        let mut memory = [0_u8; 64];
        let mut arena = Arena::new(&mut memory, 0).unwrap();
        assert!(arena.slice::<u64>(usize::MAX).is_err());
        assert!(arena.slice::<u64>(1000).is_err());
    }
}
