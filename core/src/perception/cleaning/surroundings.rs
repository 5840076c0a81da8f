//! Where things are that an object may hang on, and what is near them: the rest of a room is only in the background.

use super::cubes::{cube, hash};
use crate::geometry::Point;
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Unfinished};

/// Edge of the cells, metres. What is within this distance of a thing is near it, and nothing beyond two diagonals: most
/// objects that hang there reach no farther.
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
        meter: &Meter,
    ) -> Result<Self, Unfinished> {
        let (occupied, near) = (arena.slice::<u8>(BITS / 8)?, arena.slice::<u8>(BITS / 8)?);
        for (step, point) in points.enumerate() {
            meter.check_at(step)?;
            let [x, y, z] = cube(point, CELL);
            if !is_set(occupied, bit([x, y, z])) {
                set(occupied, bit([x, y, z]));
                for k in 0..27 {
                    let around = [(x, k % 3), (y, k / 3 % 3), (z, k / 9)];
                    set(near, bit(around.map(|(x, step)| x.wrapping_add(step).wrapping_sub(1))));
                }
            }
        }
        Ok(Self { near })
    }

    /// Whether a point is near one of the points.
    pub(super) fn has(&self, point: &Point) -> bool {
        is_set(self.near, bit(cube(point, CELL)))
    }
}

fn is_set(table: &[u8], bit: usize) -> bool {
    table[bit / 8] >> (bit % 8) & 1 > 0
}

fn set(table: &mut [u8], bit: usize) {
    table[bit / 8] |= 1 << (bit % 8);
}

/// The bit of a cell.
fn bit(cell: [u32; 3]) -> usize {
    hash(cell) as usize % BITS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;

    #[test]
    fn what_is_within_a_cell_is_near_and_nearly_nothing_beyond_two_diagonals() {
        let mut random = Random::new(3);
        let mut point = |size: f32| {
            let mut next = || size * (random.next_f32() - 0.5);
            Point::new(next(), next(), next())
        };
        let things: std::vec::Vec<Point> = (0..50).map(|_| point(4.0)).collect();
        let needed = model_bytes(Surroundings::BYTES);
        let mut memory = std::vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let near = Surroundings::of(things.iter(), &mut arena, &Meter::unwatched()).unwrap();
        let mut wrong = 0;
        for _ in 0..20_000 {
            let place = point(6.0);
            let distance = things.iter().map(|thing| (thing - place).norm()).fold(f32::MAX, f32::min);
            assert!(near.has(&place) || distance > CELL, "{place}");
            wrong += u32::from(near.has(&place) && distance > 2.0 * 3_f32.sqrt() * CELL);
        }
        // Cells that share a bit: 1350 of 65,536.
        assert!(wrong < 20_000 / 20, "{wrong}");
    }
}
