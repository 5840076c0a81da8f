//! Blocks of 8 x 8 x 8 voxels and the hash table that finds them.

use crate::memory::{Arena, OutOfMemory, array_bytes};

/// Voxels along the edge of a block.
pub(crate) const BLOCK: u32 = 8;
/// Voxels of a block.
pub(crate) const BLOCK_VOXELS: usize = (BLOCK * BLOCK * BLOCK) as usize;
/// Index of the voxel at the world's origin, along each axis. Voxels have indices below twice of it, which at 1 mm spans
/// 65 m and leaves an `f32` coordinate a resolution of a five-hundredth of a voxel.
pub(crate) const VOXEL_RANGE: u32 = 1 << 15;
/// Bits of a block's coordinate along an axis.
const COORDINATE_BITS: u32 = 13;
const COORDINATE_MASK: u64 = (1 << COORDINATE_BITS) - 1;
const _: () = assert!(2 * VOXEL_RANGE / BLOCK == 1 << COORDINATE_BITS);

/// Coordinates of a block, in blocks, packed into one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Key(u64);

impl Key {
    /// Fits no block.
    pub(crate) const NONE: Self = Self(u64::MAX);

    /// The block at these coordinates, each below 2^13.
    #[inline]
    pub(crate) fn of_block([x, y, z]: [u32; 3]) -> Self {
        Self(u64::from(x) | u64::from(y) << COORDINATE_BITS | u64::from(z) << (2 * COORDINATE_BITS))
    }

    /// The block around a voxel.
    #[inline]
    pub(crate) fn of_voxel(voxel: [u32; 3]) -> Self {
        Self::of_block(voxel.map(|x| x / BLOCK))
    }

    /// Index of the block's first voxel along each axis.
    pub(crate) fn first_voxel(self) -> [u32; 3] {
        [0, 1, 2].map(|i| (self.0 >> (i * COORDINATE_BITS) & COORDINATE_MASK) as u32 * BLOCK)
    }
}

/// Index of a voxel in its block.
#[inline]
pub(crate) fn place_in_block([x, y, z]: [u32; 3]) -> usize {
    (x % BLOCK + BLOCK * (y % BLOCK) + BLOCK * BLOCK * (z % BLOCK)) as usize
}

/// Which blocks are stored, numbered in the order in which they were added. Open addressing with linear probing, at most
/// half full.
pub(super) struct Blocks<'m> {
    keys: &'m mut [u64],
    /// Zero, or the number of a block plus one.
    slots: &'m mut [u32],
    count: usize,
}

/// Number of slots for `blocks` blocks.
const fn slot_count(blocks: usize) -> usize {
    match blocks.saturating_mul(2).checked_next_power_of_two() {
        Some(slots) => slots,
        None => usize::MAX,
    }
}

impl<'m> Blocks<'m> {
    pub(super) const fn bytes(blocks: usize) -> usize {
        array_bytes::<u64>(blocks).saturating_add(array_bytes::<u32>(slot_count(blocks)))
    }

    pub(super) fn new(blocks: usize, arena: &mut Arena<'m>) -> Result<Self, OutOfMemory> {
        Ok(Self { keys: arena.slice(blocks)?, slots: arena.slice(slot_count(blocks))?, count: 0 })
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn limit(&self) -> usize {
        self.keys.len()
    }

    pub(super) fn key(&self, block: usize) -> Key {
        Key(self.keys[block])
    }

    /// The number of the block with this key, or the free slot where it would be noted.
    #[inline]
    fn search(&self, key: Key) -> Result<usize, usize> {
        let mask = self.slots.len() - 1;
        // Multiplicative hashing (Knuth, "The Art of Computer Programming", 6.4): the upper half of the product is mixed.
        let mut slot = (key.0.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize & mask;
        loop {
            match self.slots[slot] as usize {
                0 => return Err(slot),
                number if self.keys[number - 1] == key.0 => return Ok(number - 1),
                _ => slot = (slot + 1) & mask,
            }
        }
    }

    #[inline]
    pub(super) fn find(&self, key: Key) -> Option<usize> {
        self.search(key).ok()
    }

    /// Makes sure that the block is stored; false if there is no room for it.
    #[inline]
    pub(super) fn insert(&mut self, key: Key) -> bool {
        match self.search(key) {
            Ok(_) => true,
            Err(_) if self.count == self.keys.len() => false,
            Err(slot) => {
                self.keys[self.count] = key.0;
                self.count += 1;
                self.slots[slot] = self.count as u32;
                true
            }
        }
    }

    /// Keeps the first `count` blocks.
    pub(super) fn truncate(&mut self, count: usize) {
        self.slots.fill(0);
        self.count = 0;
        for block in 0..count {
            self.insert(self.key(block));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;
    use std::collections::HashMap;

    #[test]
    fn finds_what_a_map_of_the_standard_library_finds() {
        let blocks = 300;
        let needed = model_bytes(Blocks::bytes(blocks));
        let mut memory = vec![0; needed];
        let mut table = Blocks::new(blocks, &mut Arena::new(&mut memory, needed).unwrap()).unwrap();
        let (mut map, mut random) = (HashMap::new(), Random::new(3));
        let mut draw = || [(); 3].map(|()| 4090 + random.next_u32() % 9);
        while map.len() < blocks {
            let block = draw();
            let next = map.len();
            map.entry(block).or_insert(next);
            assert!(table.insert(Key::of_block(block)));
        }
        let agrees = |table: &Blocks, block: [u32; 3], count: usize| {
            let expected = map.get(&block).copied().filter(|number| *number < count);
            assert_eq!(table.find(Key::of_block(block)), expected, "{block:?}");
        };
        for _ in 0..3000 {
            agrees(&table, draw(), blocks);
        }
        let absent = Key::of_block([1, 2, 3]);
        assert!(!table.insert(absent) && table.find(absent).is_none());
        table.truncate(100);
        assert_eq!(table.count(), 100);
        for _ in 0..3000 {
            agrees(&table, draw(), 100);
        }
        assert!(table.insert(absent) && table.find(absent) == Some(100));
    }

    #[test]
    fn keys_hold_the_coordinates() {
        for block in [[0, 0, 0], [8191, 0, 4096], [1, 8191, 8191]] {
            assert_eq!(Key::of_block(block).first_voxel(), block.map(|x| x * BLOCK));
        }
        assert_eq!(Key::of_voxel([7, 8, 17]), Key::of_block([0, 1, 2]));
    }
}
