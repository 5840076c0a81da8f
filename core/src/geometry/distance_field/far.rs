//! Distances of the blocks without bricks from the mesh.

use super::brick::{BLOCK, STEP};
use super::frame::Frame;
use super::layout::{Layout, MOST_BLOCKS_ALONG};
use super::nearest::{NONE, Nearest};
use super::{Entry, understated};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};

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
    array_bytes::<f32>(blocks)
        .saturating_add(array_bytes::<u32>(blocks))
        .saturating_add(array_bytes::<u8>(blocks))
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

/// The least square of the distance of the block at place `at` of a line, by those of all blocks of the line.
#[inline]
fn least_along(squares: &[f32], at: usize) -> f32 {
    let mut least = squares[at];
    // Outwards, until nothing further away can be closer.
    for steps in 1..squares.len() {
        let gap = gap_squared(steps);
        if gap >= least || steps > at && at + steps >= squares.len() {
            break;
        }
        if steps <= at {
            least = least.min(squares[at - steps] + gap);
        }
        if at + steps < squares.len() {
            least = least.min(squares[at + steps] + gap);
        }
    }
    least
}

/// The square of the distance to a brick, in blocks, that stands in a block's entry until its distance is known.
fn to_brick(entry: u32) -> f32 {
    if let Entry::Brick(_) = Entry::unpack(entry) { 0.0 } else { f32::from_bits(entry) }
}

impl Far<'_> {
    pub(super) fn fill(mut self, mut scratch: Arena, meter: &Meter) -> Result<(), Unfinished> {
        self.measure_to_bricks(meter)?;
        let squares = scratch.unset::<f32>(self.grid.len())?;
        let triangles = scratch.unset::<u32>(self.grid.len())?;
        self.ask_neighbours(squares, triangles, scratch.unset(self.grid.len())?, meter)?;
        for ((entry, &sign), &to_triangle) in self.grid.iter_mut().zip(self.signs).zip(squares.iter()) {
            if let Entry::Far(_) = Entry::unpack(*entry) {
                let to_brick = libm::sqrtf(to_brick(*entry)) * BLOCK as f32;
                let to_triangle = understated(libm::sqrtf(to_triangle));
                let distance = if to_triangle.is_finite() { to_brick.max(to_triangle) } else { to_brick };
                *entry = Entry::Far(if sign == super::sign::INSIDE { -distance } else { distance }).pack();
            }
        }
        Ok(())
    }

    /// Writes the square of the distance to the closest brick, in blocks, to the entry of every block without one.
    fn measure_to_bricks(&mut self, meter: &Meter) -> Result<(), Stop> {
        for entry in self.grid.iter_mut() {
            if let Entry::Far(_) = Entry::unpack(*entry) {
                *entry = f32::INFINITY.to_bits();
            }
        }
        let mut step = 1;
        for &count in &self.layout.blocks {
            let count = count as usize;
            let mut line = [0.0; MOST_BLOCKS_ALONG];
            let line = &mut line[..count];
            for layer in (0..self.grid.len()).step_by((step * count).max(1)) {
                for first in layer..layer + step {
                    meter.check_cancelled()?;
                    let blocks = || (first..).step_by(step).take(count);
                    for (square, block) in line.iter_mut().zip(blocks()) {
                        *square = to_brick(self.grid[block]);
                    }
                    for (at, block) in blocks().enumerate() {
                        if line[at] > 0.0 {
                            self.grid[block] = least_along(line, at).to_bits();
                        }
                    }
                }
            }
            step *= count;
        }
        Ok(())
    }

    /// Finds a near triangle for the centre of every block that is close to a brick, and the square of the distance to it, in voxels;
    /// infinite for others. `changed` is working memory, as is `triangles`.
    fn ask_neighbours(
        &self,
        squares: &mut [f32],
        triangles: &mut [u32],
        changed: &mut [u8],
        meter: &Meter,
    ) -> Result<(), Stop> {
        squares.fill(f32::INFINITY);
        triangles.fill(NONE);
        // The round in which a block got its triangle, counted from one.
        changed.fill(0);
        for round in 1..=ROUNDS {
            let mut has_changed = false;
            for k in 0..self.grid.len() {
                meter.check_at(k)?;
                // There and back, so that it spreads far at once.
                let block = if round % 2 == 1 { k } else { self.grid.len() - 1 - k };
                let to_brick = to_brick(self.grid[block]);
                if to_brick == 0.0 || to_brick > CLOSE * CLOSE {
                    continue;
                }
                let (place, centre) = (self.layout.place(block), self.layout.centre(block));
                for (axis, step) in STEP.into_iter().enumerate() {
                    for forward in [false, true] {
                        let Some(next) = self.layout.beside(place, axis, forward) else { continue };
                        // What has not changed since the round before was tried then.
                        let triangle = match Entry::unpack(self.grid[next]) {
                            // The middle of the side that they have in common.
                            Entry::Brick(brick) if round == 1 => {
                                let middle = STEP.iter().sum::<usize>() * (BLOCK as usize / 2);
                                let half = BLOCK as usize / 2 * step;
                                let node = if forward { middle - half } else { middle + half };
                                self.nearest.triangles[brick][node]
                            }
                            Entry::Far(_) if usize::from(changed[next]) + 1 >= round => triangles[next],
                            _ => continue,
                        };
                        if triangle == NONE || triangle == triangles[block] {
                            continue;
                        }
                        let square = self.frames[triangle as usize].distance_squared(&centre);
                        if square < squares[block] {
                            (squares[block], triangles[block], changed[block]) =
                                (square, triangle, round as u8);
                            has_changed = true;
                        }
                    }
                }
            }
            if !has_changed {
                break;
            }
        }
        Ok(())
    }
}
