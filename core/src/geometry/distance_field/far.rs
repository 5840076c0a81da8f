//! How far the blocks without bricks are from the mesh.

use super::Entry;
use super::brick::BLOCK;
use super::layout::Layout;
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// Fills in the distance of every block without a brick.
///
/// All of the mesh is in blocks with bricks, so the centre of another block is at least as far from the mesh as from the
/// closest of those blocks. That distance is found an axis at a time.
pub(super) struct Far<'a> {
    pub(super) layout: &'a Layout,
    pub(super) grid: &'a mut [u32],
    /// 2 for a block that is inside.
    pub(super) signs: &'a [u8],
}

/// Bytes of working memory for a grid of `blocks`.
pub(super) const fn scratch_bytes(blocks: usize) -> usize {
    array_bytes::<f32>(blocks).saturating_mul(2)
}

/// Square of the distance along one axis from the centre of a block to another block `steps` away, in blocks.
fn gap_squared(steps: usize) -> f32 {
    let gap = (steps as f32 - 0.5).max(0.0);
    gap * gap
}

impl Far<'_> {
    pub(super) fn fill(self, mut scratch: Arena) -> Result<(), OutOfMemory> {
        let mut from = scratch.slice::<f32>(self.grid.len())?;
        let mut to = scratch.slice::<f32>(self.grid.len())?;
        for (distance, &entry) in from.iter_mut().zip(self.grid.iter()) {
            *distance = if let Entry::Brick(_) = Entry::unpack(entry) { 0.0 } else { f32::INFINITY };
        }
        let mut step = 1;
        for &count in &self.layout.blocks {
            let count = count as usize;
            for block in 0..from.len() {
                let at = block / step % count;
                let mut least = from[block];
                // Outwards, until nothing further away can be closer.
                for steps in 1..count {
                    let gap = gap_squared(steps);
                    if gap >= least || steps > at && at + steps >= count {
                        break;
                    }
                    if steps <= at {
                        least = least.min(from[block - steps * step] + gap);
                    }
                    if at + steps < count {
                        least = least.min(from[block + steps * step] + gap);
                    }
                }
                to[block] = least;
            }
            core::mem::swap(&mut from, &mut to);
            step *= count;
        }
        for ((entry, &sign), &squared) in self.grid.iter_mut().zip(self.signs).zip(from.iter()) {
            if let Entry::Far(_) = Entry::unpack(*entry) {
                let distance = libm::sqrtf(squared) * BLOCK as f32;
                *entry = Entry::Far(if sign == super::sign::INSIDE { -distance } else { distance }).pack();
            }
        }
        Ok(())
    }
}
