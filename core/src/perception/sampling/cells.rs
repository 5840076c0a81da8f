//! Candidates sorted into a sparse grid of cubes, for the neighbours of each.

use super::{Candidate, MAX_SAMPLES, OVERSAMPLING};
use crate::geometry::Point;
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Unfinished};
use crate::sort::sort;
use core::ops::Range;

/// A sparse grid of cubes as wide as the largest distance that matters.
///
/// Cubes are numbered by z, then y, then x, and candidates sorted by the number of their cube, so that the three
/// cubes side by side along x hold neighbours in the order. Nine such rows surround a cube.
pub(super) struct Cells<'s> {
    /// For each place in the order, which of the drawn candidates is there.
    pub(super) order: &'s [u32],
    /// Coordinates of the candidates in the order, and as many as [`LANES`] without meaning behind them.
    coordinates: [&'s [f32]; 3],
    /// The cube of each candidate, as an index into the cubes that hold any.
    cell_of: &'s [u32],
    /// For each such cube, where its candidates begin; one entry more than cubes.
    starts: &'s [u32],
    /// For each such cube, the cubes that hold any of each of the nine rows around it, packed by [`pack`].
    rows: &'s [[u32; ROWS]],
}

/// Candidates whose distances are computed at once.
pub(super) const LANES: usize = 4;

/// Rows of cubes around a cube, its own included.
const ROWS: usize = 9;
/// The row that a cube is in itself.
const OWN_ROW: usize = 4;

/// Bits of a cube's number for each axis, and of a candidate's index, which share a sort key. Cubes beyond the
/// last share its number, which costs only time.
const AXIS_BITS: u32 = 14;
const INDEX_BITS: u32 = 22;
const _: () = assert!(3 * AXIS_BITS + INDEX_BITS == u64::BITS);
const _: () = assert!(MAX_SAMPLES * OVERSAMPLING < 1 << INDEX_BITS);

/// Cubes are counted from one along each axis, so that there are numbers below those of every row around one.
const FIRST_CELL: u64 = 1;
const LAST_CELL: u64 = (1 << AXIS_BITS) - 2;

fn number([x, y, z]: [u64; 3]) -> u64 {
    (z << AXIS_BITS | y) << AXIS_BITS | x
}

/// The number of the first cube in row `row` around cube `number`: one less than that of the cube straight beside it.
fn row_number(number: u64, row: usize) -> u64 {
    let (dy, dz) = (row as u64 % 3, row as u64 / 3);
    // At the border numbers run over into other rows; those hold nothing that is close.
    number + (dz << (2 * AXIS_BITS)) + (dy << AXIS_BITS) - (1 << (2 * AXIS_BITS)) - (1 << AXIS_BITS) - 1
}

/// Up to three cubes after each other, in a word.
fn pack(first: usize, count: usize) -> u32 {
    (first << 2 | count) as u32
}

impl<'s> Cells<'s> {
    pub(super) const fn bytes(candidates: usize) -> usize {
        array_bytes::<u64>(candidates)
            .saturating_add(array_bytes::<u32>(candidates).saturating_mul(2))
            .saturating_add(array_bytes::<f32>(candidates.saturating_add(LANES)).saturating_mul(3))
            .saturating_add(array_bytes::<u32>(candidates.saturating_add(1)))
            .saturating_add(array_bytes::<[u32; ROWS]>(candidates))
    }

    /// Bytes of working memory of [`sort`](Self::sort).
    pub(super) const fn scratch_bytes(candidates: usize) -> usize {
        array_bytes::<u64>(candidates)
    }

    /// Sorts `drawn` into cubes of this width, metres.
    pub(super) fn sort(
        drawn: &[Candidate],
        width: f32,
        scratch: &mut Arena<'s>,
        meter: &Meter,
    ) -> Result<Self, Unfinished> {
        let order = scratch.unset::<u32>(drawn.len())?;
        let [xs, ys, zs] = [(); 3].map(|()| scratch.slice::<f32>(drawn.len() + LANES));
        let mut coordinates = [xs?, ys?, zs?];
        let numbers = scratch.unset::<u64>(drawn.len())?;
        let cell_of = scratch.unset::<u32>(drawn.len())?;
        let starts = scratch.unset::<u32>(drawn.len() + 1)?;
        let rows = scratch.unset::<[u32; ROWS]>(drawn.len())?;

        let low = drawn.iter().fold(Point::from([f32::INFINITY; 3]), |low, c| low.inf(&c.position.into()));
        // Sort keys first: number and index.
        for (index, (key, candidate)) in numbers.iter_mut().zip(drawn).enumerate() {
            let offset = (Point::from(candidate.position) - low) / width;
            let cell = offset.map(|x| (x as u64 + FIRST_CELL).min(LAST_CELL)).into();
            *key = number(cell) << INDEX_BITS | index as u64;
        }
        sort(numbers, scratch.scratch().unset(drawn.len())?, meter, |a, b| a < b)?;
        let mut cells = 0;
        for place in 0..drawn.len() {
            meter.check_at(place)?;
            let key = numbers[place];
            let index = (key & ((1 << INDEX_BITS) - 1)) as usize;
            order[place] = index as u32;
            for (to, from) in coordinates.iter_mut().zip(drawn[index].position) {
                to[place] = from;
            }
            // Numbers move to the front, over keys that were read.
            if place == 0 || numbers[cells - 1] != key >> INDEX_BITS {
                (numbers[cells], starts[cells]) = (key >> INDEX_BITS, place as u32);
                cells += 1;
            }
            cell_of[place] = cells as u32 - 1;
        }
        starts[cells] = drawn.len() as u32;
        let (numbers, rows) = (&numbers[..cells], &mut rows[..cells]);
        for row in 0..ROWS {
            // Both the cubes and the rows beside them ascend, so one pass finds all.
            let mut first = 0;
            for (cell, rows) in rows.iter_mut().enumerate() {
                meter.check_at(cell)?;
                let target = row_number(numbers[cell], row);
                while first < cells && numbers[first] < target {
                    first += 1;
                }
                let count =
                    numbers[first..].iter().take(3).take_while(|&&number| number <= target + 2).count();
                rows[row] = pack(first, count);
            }
        }
        let coordinates = coordinates.map(|of_axis| &*of_axis);
        Ok(Self { order, coordinates, cell_of, starts: &starts[..=cells], rows })
    }

    /// The candidates in a row around a cube.
    #[inline]
    fn row(&self, cell: usize, row: usize) -> Range<usize> {
        let packed = self.rows[cell][row];
        let (first, count) = ((packed >> 2) as usize, (packed & 3) as usize);
        if count == 0 {
            return 0..0;
        }
        self.starts[first] as usize..self.starts[first + count] as usize
    }

    /// Visits all candidates of the cubes around candidate `index`, itself included: calls `visit` with a place and the
    /// squares of the distances to the candidates there and behind; infinite for those that do not belong to the row.
    pub(super) fn visit_all(&self, index: usize, mut visit: impl FnMut(usize, [f32; LANES])) {
        let cell = self.cell_of[index] as usize;
        for row in 0..ROWS {
            self.visit(index, self.row(cell, row), &mut visit);
        }
    }

    /// The same for the candidates behind `index` in the order: over all candidates every pair is visited once.
    pub(super) fn visit_behind(&self, index: usize, mut visit: impl FnMut(usize, [f32; LANES])) {
        let cell = self.cell_of[index] as usize;
        self.visit(index, index + 1..self.row(cell, OWN_ROW).end, &mut visit);
        for row in OWN_ROW + 1..ROWS {
            self.visit(index, self.row(cell, row), &mut visit);
        }
    }

    #[inline]
    fn visit(&self, index: usize, places: Range<usize>, visit: &mut impl FnMut(usize, [f32; LANES])) {
        let from = self.coordinates.map(|of_axis| of_axis[index]);
        for place in places.clone().step_by(LANES) {
            let left = places.end - place;
            let mut squares = [0.0; LANES];
            for (of_axis, from) in self.coordinates.iter().zip(from) {
                for (square, x) in squares.iter_mut().zip(&of_axis[place..place + LANES]) {
                    *square += (x - from) * (x - from);
                }
            }
            for (lane, square) in squares.iter_mut().enumerate() {
                *square = if lane < left { *square } else { f32::INFINITY };
            }
            visit(place, squares);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;

    #[test]
    fn neighbours_and_pairs_agree_with_brute_force() {
        let mut random = Random::new(8);
        let mut next = |size: f32| size * random.next_f32();
        // A cube, a clump, and the corner of a box, where cubes have the lowest numbers.
        let mut positions: Vec<[f32; 3]> = (0..300).map(|_| [next(1.0), next(1.0), next(1.0)]).collect();
        positions.extend((0..60).map(|_| [0.5 + next(0.01), next(0.01), next(0.01)]));
        positions.extend((0..40).map(|_| [next(0.4), 0.0, 0.0]));
        let drawn: Vec<Candidate> =
            positions.iter().map(|&position| Candidate { position, triangle: 0 }).collect();
        for width in [0.05, 0.3, 2.0] {
            let mut memory =
                vec![0xAA; model_bytes(Cells::bytes(drawn.len()) + Cells::scratch_bytes(drawn.len()))];
            let mut arena = Arena::new(&mut memory, 0).unwrap();
            let cells = Cells::sort(&drawn, width, &mut arena, &Meter::unwatched()).unwrap();
            let square = |i: usize, j: usize| {
                let [a, b] = [i, j].map(|place| drawn[cells.order[place] as usize].position);
                (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f32>()
            };
            let check = |i: usize, found: Vec<(usize, [f32; LANES])>, first: usize| {
                let all = found.iter().flat_map(|(place, squares)| (*place..).zip(*squares));
                let near: Vec<_> = all.filter(|(_, square)| *square < width * width).collect();
                let places = first..drawn.len();
                let expected =
                    places.map(|j| (j, square(i, j))).filter(|(_, square)| *square < width * width);
                assert!(near.into_iter().eq(expected), "{i} with {width}");
            };
            for i in 0..drawn.len() {
                let (mut all, mut behind) = (Vec::new(), Vec::new());
                cells.visit_all(i, |place, squares| all.push((place, squares)));
                cells.visit_behind(i, |place, squares| behind.push((place, squares)));
                check(i, all, 0);
                check(i, behind, i + 1);
            }
        }
    }
}
