//! Distances of the blocks without bricks from the mesh.

use super::brick::{BLOCK, STEP};
use super::frame::Frame;
use super::layout::Layout;
use super::nearest::{NONE, Nearest};
use super::{Entry, understated};
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// Fills in the distance of every block without a brick.
///
/// All of the mesh is in blocks with bricks, so the centre of another block is at least as far from the mesh as from the
/// closest of those blocks. That distance is found an axis at a time. Close to the bricks, where it is far less than the distance to the
/// mesh, the nearest triangles spread on from them: a block measures its distance to the triangles that are nearest to its neighbours.
pub(super) struct Far<'a> {
    pub(super) layout: &'a Layout,
    pub(super) grid: &'a mut [u32],
    pub(super) nearest: &'a Nearest<'a>,
    pub(super) frames: &'a [Frame],
    /// 2 for a block that is inside.
    pub(super) signs: &'a [u8],
}

/// Bytes of working memory for a grid of `blocks`.
pub(super) const fn scratch_bytes(blocks: usize) -> usize {
    array_bytes::<f32>(blocks).saturating_mul(2).saturating_add(array_bytes::<u32>(blocks))
}

/// Distance to a block with a brick up to which nearest triangles spread, blocks.
const CLOSE: f32 = 4.0;
/// Passes of that spreading at most.
const ROUNDS: usize = 8;

/// Square of the distance along one axis from the centre of a block to another block `steps` away, in blocks.
fn gap_squared(steps: usize) -> f32 {
    let gap = (steps as f32 - 0.5).max(0.0);
    gap * gap
}

/// The least square of the distance of a block, the one at place `at` of `count` along an axis, by those of the blocks along
/// that axis, which are `step` apart.
#[inline]
fn least_along(squares: &[f32], block: usize, step: usize, at: usize, count: usize) -> f32 {
    let mut least = squares[block];
    // Outwards, until nothing further away can be closer.
    for steps in 1..count {
        let gap = gap_squared(steps);
        if gap >= least || steps > at && at + steps >= count {
            break;
        }
        if steps <= at {
            least = least.min(squares[block - steps * step] + gap);
        }
        if at + steps < count {
            least = least.min(squares[block + steps * step] + gap);
        }
    }
    least
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
            for layer in (0..from.len()).step_by(step * count) {
                for at in 0..count {
                    let first = layer + at * step;
                    for block in first..first + step {
                        to[block] = least_along(from, block, step, at, count);
                    }
                }
            }
            core::mem::swap(&mut from, &mut to);
            step *= count;
        }
        let triangles = scratch.slice::<u32>(self.grid.len())?;
        self.ask_neighbours(from, to, triangles);
        let distances = from.iter().zip(to.iter());
        for ((entry, &sign), (&squared, &to_triangle)) in self.grid.iter_mut().zip(self.signs).zip(distances)
        {
            if let Entry::Far(_) = Entry::unpack(*entry) {
                let to_brick = libm::sqrtf(squared) * BLOCK as f32;
                let to_triangle = understated(libm::sqrtf(to_triangle));
                let distance = if to_triangle.is_finite() { to_brick.max(to_triangle) } else { to_brick };
                *entry = Entry::Far(if sign == super::sign::INSIDE { -distance } else { distance }).pack();
            }
        }
        Ok(())
    }

    /// Finds a near triangle for the centre of every block that is close to a brick, and the square of the distance to it, in voxels;
    /// infinite for others. `to_bricks` are the squares of the distances to bricks, in blocks.
    fn ask_neighbours(&self, to_bricks: &[f32], squares: &mut [f32], triangles: &mut [u32]) {
        squares.fill(f32::INFINITY);
        triangles.fill(NONE);
        for round in 0..ROUNDS {
            let mut changed = false;
            for k in 0..self.grid.len() {
                // There and back, so that it spreads far at once.
                let block = if round % 2 == 0 { k } else { self.grid.len() - 1 - k };
                // Zero at blocks with bricks.
                if to_bricks[block] == 0.0 || to_bricks[block] > CLOSE * CLOSE {
                    continue;
                }
                let (place, centre) = (self.layout.place(block), self.layout.centre(block));
                for (axis, step) in STEP.into_iter().enumerate() {
                    for forward in [false, true] {
                        let Some(next) = self.layout.beside(place, axis, forward) else { continue };
                        let triangle = match Entry::unpack(self.grid[next]) {
                            // The middle of the side that they have in common.
                            Entry::Brick(brick) => {
                                let middle = STEP.iter().sum::<usize>() * (BLOCK as usize / 2);
                                let half = BLOCK as usize / 2 * step;
                                let node = if forward { middle - half } else { middle + half };
                                self.nearest.triangles[brick][node]
                            }
                            Entry::Far(_) => triangles[next],
                        };
                        if triangle == NONE || triangle == triangles[block] {
                            continue;
                        }
                        let square = self.frames[triangle as usize].distance_squared(&centre);
                        if square < squares[block] {
                            (squares[block], triangles[block]) = (square, triangle);
                            changed = true;
                        }
                    }
                }
            }
            if !changed {
                break;
            }
        }
    }
}
