//! Where things are that an object may hang on, and what is near them: the rest of a room is only in the background.

use super::merge::hash;
use crate::geometry::Point;
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// Edge of the cells, metres. What is within this distance of a thing is near it, and nothing beyond two diagonals: a pan
/// that hangs on a hook reaches no farther.
const CELL: f32 = 0.2;
/// Bits of each table, a power of two. Two cells with the same bit make a place near that is not, which costs only time.
const BITS: usize = 1 << 16;

/// The cells around some points.
pub(super) struct Surroundings<'s> {
    near: &'s [u8],
}

impl<'s> Surroundings<'s> {
    /// Bytes of memory, whatever the points.
    pub(super) const BYTES: usize = array_bytes::<u8>(BITS / 8).saturating_mul(2);

    /// The surroundings of these points.
    pub(super) fn of<'p>(
        points: impl Iterator<Item = &'p Point>,
        arena: &mut Arena<'s>,
    ) -> Result<Self, OutOfMemory> {
        let (occupied, near) = (arena.slice::<u8>(BITS / 8)?, arena.slice::<u8>(BITS / 8)?);
        for point in points {
            let [x, y, z] = cell(point);
            if !is_set(occupied, bit([x, y, z])) {
                set(occupied, bit([x, y, z]));
                for k in 0..27 {
                    set(near, bit([x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]));
                }
            }
        }
        Ok(Self { near })
    }

    /// Whether a point is near one of the points.
    pub(super) fn has(&self, point: &Point) -> bool {
        is_set(self.near, bit(cell(point)))
    }
}

fn is_set(table: &[u8], bit: usize) -> bool {
    table[bit / 8] >> (bit % 8) & 1 > 0
}

fn set(table: &mut [u8], bit: usize) {
    table[bit / 8] |= 1 << (bit % 8);
}

/// The cell that a point is in.
fn cell(point: &Point) -> [i32; 3] {
    [point.x, point.y, point.z].map(|x| libm::floorf(x / CELL) as i32)
}

/// The bit of a cell.
fn bit(cell: [i32; 3]) -> usize {
    hash(cell.map(|x| x as u32)) as usize % BITS
}
