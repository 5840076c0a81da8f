//! Large planes, as walls and tables: things to collide with, not to hang on.

use crate::geometry::{Point, Vector, any_perpendicular};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::perception::plane::Plane;
use crate::random::Random;
use heapless::Vec;

// Physics: what a large plane is.

/// The grid on which a large plane is looked for. The smallest square that makes a plane large is between 12.5 and 17.5 cm, more
/// than what objects are hung over.
const FINE: Resolution = Resolution { cell: 0.025, square: 7 };
/// The grid for planes whose points are too far apart for that: squares between 10 and 20 cm.
const COARSE: Resolution = Resolution { cell: 0.05, square: 4 };
/// Least share of the cells of the square that have points.
const MIN_FILL: f32 = 0.9;
/// Least share of the places of a plane that have points, of those that would have some if as many points were strewn over it at
/// random. Larger: planes with noise or small holes count as lattices. Smaller: lattices count as planes: of wires 6 mm thick every
/// 2 cm, half of the area is wire.
const MIN_SOLID: f32 = 0.85;
/// Most points of a cell whose neighbours may be empty by chance: of cells with two points on average a seventh is empty, and
/// most of the others have no more than this. On a rack of bars they have many.
const FEW: u8 = 3;

/// Ratio of the points of a cell to those of one beside it above which the other is a sliver, cut by the rim of the plane. Larger:
/// slivers hide the rim from the cells behind them, which are thinned. Smaller: chance makes rims inside a sparse plane. Set by hand.
const SLIVER: u8 = 4;

// Tolerances.

/// Largest distance from a plane to its points, metres: three times the noise of a good depth camera at one metre.
const TOLERANCE: f32 = 0.004;

// Budget.

/// Points among which planes are searched.
const PROBES: usize = 2048;
/// Largest number of planes.
const MAX_PLANES: usize = 8;
/// A plane that is looked at has more than one in so many of the probes.
const MIN_SHARE: usize = 25;
/// Cells of a grid along an edge: it spans 3.2 or 6.4 m.
const CELLS: usize = 128;
/// Cells that tell a plane from a lattice of wires.
const MAX_LOOKED_INTO: usize = 32;
/// Places of such a cell along an edge: bits of a `u64`.
const PLACES: usize = 8;

/// Bytes of working memory.
pub(super) const fn scratch_bytes() -> usize {
    array_bytes::<Point>(PROBES).saturating_add(array_bytes::<u8>(CELLS * CELLS))
}

/// How fine a grid is.
#[derive(Clone, Copy)]
struct Resolution {
    /// Edge of a cell, metres.
    cell: f32,
    /// Edge of the smallest square that makes a plane large, in cells of which the outer ones may be cut.
    square: usize,
}

/// A plane with a grid on it.
struct Grid {
    plane: Plane,
    axes: [Vector; 2],
    resolution: Resolution,
}

/// Mark of a point on a large plane, around which there is nothing but plane.
pub(super) const INSIDE: u8 = 1;
/// Mark of a point on a large plane near its rim.
pub(super) const RIM: u8 = 2;

/// Marks the points on large planes with [`INSIDE`] or [`RIM`].
pub(super) fn mark(
    points: &[Point],
    on_plane: &mut [u8],
    mut scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    let mut probes = scratch.slice::<Point>(points.len().min(PROBES))?;
    let cells = scratch.slice::<u8>(CELLS * CELLS)?;
    let count = probes.len();
    for (k, probe) in probes.iter_mut().enumerate() {
        *probe = points[k * points.len() / count];
    }
    let mut random = Random::new(0);
    for _ in 0..MAX_PLANES {
        meter.check_cancelled()?;
        let Some(plane) = Plane::search(probes, TOLERANCE, count / MIN_SHARE, &mut random) else { break };
        meter.check_cancelled()?;
        let mut grid = Grid::on(plane, FINE);
        if grid.fill(points, cells, meter)? {
            grid = Grid::on(plane, COARSE);
            grid.fill(points, cells, meter)?;
        }
        if mark_squares(cells, grid.resolution.square) && grid.is_solid(points, cells, meter)? {
            for (step, (flag, point)) in on_plane.iter_mut().zip(points).enumerate() {
                meter.check_at(step)?;
                if let Some(cell) = grid.cell(point)
                    && is_in_or_beside_square(cells, cell)
                {
                    // A cell that the rim cuts to a sliver has few points.
                    let least = cells.get(cell).map_or(0, |own| own / POINT / SLIVER);
                    let is_inside = around(cells, cell).all(|c| c & OCCUPIED > 0 && c / POINT >= least);
                    *flag = if is_inside { INSIDE } else { (*flag).max(RIM) };
                }
            }
        }
        // The next plane is searched among the other probes.
        let mut left = 0;
        for index in 0..probes.len() {
            let probe = probes[index];
            if plane.distance(&probe) >= TOLERANCE {
                probes[left] = probe;
                left += 1;
            }
        }
        probes = &mut probes[..left];
    }
    Ok(())
}

impl Grid {
    fn on(plane: Plane, resolution: Resolution) -> Self {
        let ahead = any_perpendicular(plane.normal);
        Self { plane, axes: [ahead, plane.normal.cross(&ahead)], resolution }
    }

    /// Where a point is on the plane, in cells.
    fn place(&self, point: &Point) -> [f32; 2] {
        self.axes.map(|axis| (point - self.plane.origin).dot(&axis) / self.resolution.cell)
    }

    /// The cell of a point on the plane.
    fn cell(&self, point: &Point) -> Option<usize> {
        if self.plane.distance(point) >= TOLERANCE {
            return None;
        }
        let [x, y] = self.place(point).map(libm::floorf);
        let half = (CELLS / 2) as f32;
        let is_inside = |x: f32| x >= -half && x < half;
        (is_inside(x) && is_inside(y)).then(|| (y + half) as usize * CELLS + (x + half) as usize)
    }

    /// Marks the cells that have points, and returns whether most have so few that the others may be empty by chance.
    fn fill(&self, points: &[Point], cells: &mut [u8], meter: &Meter) -> Result<bool, Stop> {
        cells.fill(0);
        for (step, point) in points.iter().enumerate() {
            meter.check_at(step)?;
            if let Some(cell) = self.cell(point) {
                cells[cell] = cells[cell].saturating_add(POINT) & !LARGE | OCCUPIED;
            }
        }
        let occupied = || cells.iter().filter(|cell| **cell > 0);
        Ok(2 * occupied().filter(|cell| **cell / POINT <= FEW).count() > occupied().count())
    }

    /// Whether the plane is more than a lattice of wires: in some of its cells, points are nearly everywhere.
    fn is_solid(&self, points: &[Point], cells: &[u8], meter: &Meter) -> Result<bool, Stop> {
        let is_inner = |cell: &usize| around(cells, *cell).all(|c| c & LARGE > 0);
        let inner = (0..cells.len()).filter(is_inner).count();
        let apart = inner.div_ceil(MAX_LOOKED_INTO).max(1);
        // The cells, how many points each has, and in which of its places.
        let mut looked_into = Vec::<(usize, u32, u64), MAX_LOOKED_INTO>::new();
        for cell in (0..cells.len()).filter(is_inner).step_by(apart) {
            let _ = looked_into.push((cell, 0, 0));
        }
        for (step, point) in points.iter().enumerate() {
            meter.check_at(step)?;
            let Some(cell) = self.cell(point) else { continue };
            let Ok(index) = looked_into.binary_search_by_key(&cell, |looked_into| looked_into.0) else {
                continue;
            };
            let part = |at: f32| ((at - libm::floorf(at)) * PLACES as f32) as usize % PLACES;
            let [x, y] = self.place(point).map(part);
            let (_, count, places) = &mut looked_into[index];
            *count += 1;
            *places |= 1 << (y * PLACES + x);
        }
        let all = (PLACES * PLACES) as f32;
        let strewn = |count: u32| all * (1.0 - libm::expf(-(count as f32) / all));
        let expected: f32 = looked_into.iter().map(|(_, count, _)| strewn(*count)).sum();
        let found: f32 = looked_into.iter().map(|(_, _, places)| places.count_ones() as f32).sum();
        Ok(found >= MIN_SOLID * expected)
    }
}

/// Bit of a cell that has points.
const OCCUPIED: u8 = 1;
/// Bit of a cell with points in a filled square.
const LARGE: u8 = 2;
/// A point of a cell. 63 are counted at most.
const POINT: u8 = 4;

/// Whether a cell or one of those around it is in a filled square: at the rim of a plane a cell may be cut narrow, and
/// those beside it empty.
fn is_in_or_beside_square(cells: &[u8], cell: usize) -> bool {
    around(cells, cell).any(|cell| cell & LARGE > 0)
}

/// A cell and those around it; empty beyond the grid.
fn around(cells: &[u8], cell: usize) -> impl Iterator<Item = u8> + '_ {
    (0..9).map(move |k| {
        let beside = (cell + k / 3 * CELLS + k % 3).checked_sub(CELLS + 1);
        beside.and_then(|beside| cells.get(beside)).copied().unwrap_or(0)
    })
}

/// Marks the cells with points in squares with edges of `square` cells that are filled. Returns whether there is one.
fn mark_squares(cells: &mut [u8], square: usize) -> bool {
    let is_occupied = |cell: u8| usize::from(cell & OCCUPIED);
    let (mut is_any_filled, least) = (false, MIN_FILL * (square * square) as f32);
    // Cells with points in each column of the squares in these rows.
    let mut columns = [0; CELLS];
    for y in 0..CELLS {
        for (x, column) in columns.iter_mut().enumerate() {
            *column += is_occupied(cells[y * CELLS + x]);
            *column -= if y < square { 0 } else { is_occupied(cells[(y - square) * CELLS + x]) };
        }
        for (x, counts) in columns.windows(square).enumerate() {
            if y + 1 >= square && counts.iter().sum::<usize>() as f32 >= least {
                for row in cells.chunks_mut(CELLS).take(y + 1).skip(y + 1 - square) {
                    row[x..x + square].iter_mut().for_each(|cell| *cell |= LARGE);
                }
                is_any_filled = true;
            }
        }
    }
    is_any_filled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_marked_as_one_by_one() {
        let mut random = Random::new(4);
        for (density, square) in [(0.2, 7), (0.8, 7), (0.93, 7), (1.0, 7), (0.3, 4), (0.93, 4)] {
            // A field of half the grid's size that reaches its border.
            let mut cells = std::vec![0; CELLS * CELLS];
            for (place, cell) in cells.iter_mut().enumerate().take(CELLS * CELLS / 2) {
                *cell = u8::from(random.next_f32() < density && place % CELLS > CELLS / 3);
            }
            let mut expected = cells.clone();
            for (x, y) in (0..=CELLS - square).flat_map(|y| (0..=CELLS - square).map(move |x| (x, y))) {
                let all = || (0..square * square).map(|k| (y + k / square) * CELLS + x + k % square);
                let occupied = all().filter(|&cell| cells[cell] & OCCUPIED > 0).count();
                if occupied as f32 >= MIN_FILL * (square * square) as f32 {
                    all().for_each(|cell| expected[cell] |= LARGE);
                }
            }
            let is_any = expected.iter().any(|cell| cell & LARGE > 0);
            assert_eq!((mark_squares(&mut cells, square), &cells), (is_any, &expected), "{density}");
            assert!(is_any || density < 1.0);
            assert!(!is_any || density > 0.5);
        }
    }
}
