//! Large planes, as walls and tables: things to collide with, not to hang on.

use crate::geometry::{Point, Vector, any_perpendicular};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::perception::plane::Plane;
use crate::random::Random;

// Physics: what a large plane is.

/// Edge of the smallest square that makes a plane large, in cells of which the outer ones may be cut. With [`CELL`] it is
/// between 12.5 and 17.5 cm, more than what objects are hung over.
const SQUARE: usize = 7;
/// Edge of a cell of the grid on a plane, metres. The points of a surface are closer.
const CELL: f32 = 0.025;
/// Least share of the cells of the square that have points.
const MIN_FILL: f32 = 0.9;

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
/// Cells of the grid along an edge: with [`CELL`], it spans 3.2 m.
const CELLS: usize = 128;

/// Bytes of working memory.
pub(super) const fn scratch_bytes() -> usize {
    array_bytes::<Point>(PROBES).saturating_add(array_bytes::<u8>(CELLS * CELLS))
}

/// A plane with a grid on it.
struct Grid {
    plane: Plane,
    axes: [Vector; 2],
}

/// Marks with 1 the points on large planes.
pub(super) fn mark(
    points: &[Point],
    is_on_plane: &mut [u8],
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
        let grid = Grid::on(plane);
        grid.fill(points, cells, meter)?;
        if mark_squares(cells) {
            for (step, (flag, point)) in is_on_plane.iter_mut().zip(points).enumerate() {
                meter.check_at(step)?;
                *flag |= u8::from(grid.cell(point).is_some_and(|cell| is_in_or_beside_square(cells, cell)));
            }
        }
        // The next plane is searched among the other probes.
        let mut left = 0;
        for index in 0..probes.len() {
            let probe = probes[index];
            if !grid.is_near(&probe) {
                probes[left] = probe;
                left += 1;
            }
        }
        probes = &mut probes[..left];
    }
    Ok(())
}

impl Grid {
    fn on(plane: Plane) -> Self {
        let ahead = any_perpendicular(plane.normal);
        Self { plane, axes: [ahead, plane.normal.cross(&ahead)] }
    }

    fn is_near(&self, point: &Point) -> bool {
        self.plane.distance(point) < TOLERANCE
    }

    /// The cell of a point on the plane.
    fn cell(&self, point: &Point) -> Option<usize> {
        if !self.is_near(point) {
            return None;
        }
        let [x, y] = self.axes.map(|axis| libm::floorf((point - self.plane.origin).dot(&axis) / CELL));
        let half = (CELLS / 2) as f32;
        let is_inside = |x: f32| x >= -half && x < half;
        (is_inside(x) && is_inside(y)).then(|| (y + half) as usize * CELLS + (x + half) as usize)
    }

    /// Marks the cells that have points.
    fn fill(&self, points: &[Point], cells: &mut [u8], meter: &Meter) -> Result<(), Stop> {
        cells.fill(0);
        for (step, point) in points.iter().enumerate() {
            meter.check_at(step)?;
            if let Some(cell) = self.cell(point) {
                cells[cell] = OCCUPIED;
            }
        }
        Ok(())
    }
}

/// Bit of a cell that has points.
const OCCUPIED: u8 = 1;
/// Bit of a cell with points in a filled square.
const LARGE: u8 = 2;

/// Whether a cell or one of those around it is in a filled square: at the rim of a plane a cell may be cut narrow, and
/// those beside it empty.
fn is_in_or_beside_square(cells: &[u8], cell: usize) -> bool {
    let is_large =
        |offset: usize| cells.get((cell + offset).wrapping_sub(CELLS + 1)).is_some_and(|c| c & LARGE > 0);
    (0..9).any(|k| is_large(k / 3 * CELLS + k % 3))
}

/// Marks the cells with points in squares that are filled. Returns whether there is one.
fn mark_squares(cells: &mut [u8]) -> bool {
    let is_occupied = |cell: u8| usize::from(cell & OCCUPIED);
    let (mut is_any_filled, least) = (false, MIN_FILL * (SQUARE * SQUARE) as f32);
    // Cells with points in each column of the squares in these rows.
    let mut columns = [0; CELLS];
    for y in 0..CELLS {
        for (x, column) in columns.iter_mut().enumerate() {
            *column += is_occupied(cells[y * CELLS + x]);
            *column -= if y < SQUARE { 0 } else { is_occupied(cells[(y - SQUARE) * CELLS + x]) };
        }
        for (x, square) in columns.windows(SQUARE).enumerate() {
            if y + 1 >= SQUARE && square.iter().sum::<usize>() as f32 >= least {
                for row in cells.chunks_mut(CELLS).take(y + 1).skip(y + 1 - SQUARE) {
                    row[x..x + SQUARE].iter_mut().for_each(|cell| *cell |= LARGE);
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
        for density in [0.2, 0.8, 0.93, 1.0] {
            // A field of half the grid's size that reaches its border.
            let mut cells = std::vec![0; CELLS * CELLS];
            for (place, cell) in cells.iter_mut().enumerate().take(CELLS * CELLS / 2) {
                *cell = u8::from(random.next_f32() < density && place % CELLS > CELLS / 3);
            }
            let mut expected = cells.clone();
            for (x, y) in (0..=CELLS - SQUARE).flat_map(|y| (0..=CELLS - SQUARE).map(move |x| (x, y))) {
                let square = || (0..SQUARE * SQUARE).map(|k| (y + k / SQUARE) * CELLS + x + k % SQUARE);
                let occupied = square().filter(|&cell| cells[cell] & OCCUPIED > 0).count();
                if occupied as f32 >= MIN_FILL * (SQUARE * SQUARE) as f32 {
                    square().for_each(|cell| expected[cell] |= LARGE);
                }
            }
            let is_any = expected.iter().any(|cell| cell & LARGE > 0);
            assert_eq!((mark_squares(&mut cells), &cells), (is_any, &expected), "{density}");
            assert!(is_any || density < 1.0);
            assert!(!is_any || density > 0.5);
        }
    }
}
