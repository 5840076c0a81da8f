//! How the object surrounds a point of the bar that carries it: as a loop, as a cavity, or with a way out.

use super::Body;
use crate::geometry::{Point, Vector, any_perpendicular, fibonacci_direction, unit_or};
use crate::monitor::{Meter, Stop};

/// A ball on the axis of a bar, and the object around it, in object coordinates.
pub(super) struct Probe<'a> {
    pub(super) body: &'a Body<'a>,
    /// Centre of the ball, metres.
    pub(super) at: Point,
    /// Radius of the ball, metres: a gap through which it does not pass is closed.
    pub(super) radius: f32,
}

/// How the object surrounds a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Enclosure {
    /// Ways lead out all along the bar.
    Open,
    /// Ways lead out towards both ends of the bar, and the material is all around between them.
    Loop,
    /// Nearly all ways that lead out lead through one opening below.
    Cavity,
}

/// Rows of the grid of directions, from one end of the bar to the other: 5 degrees each.
const ROWS: usize = 36;
/// Columns of the grid of directions, around the bar.
const COLUMNS: usize = 2 * ROWS;
/// Rows that lead towards an end of the bar: 60 degrees around its axis, as far as a thin loop hangs askew.
const END_ROWS: usize = ROWS / 3;
/// Growth of the ball with its distance, no unit: half of a row, so that no material passes between two directions.
const GROWTH: f32 = 0.044;
/// Free ways that lead to an end at least, of [`ROWS`] times [`COLUMNS`]. Fewer are a hole through which no bar passes.
const MIN_WAYS: usize = 16;
/// Most steps of a way.
const MAX_STEPS: usize = 200;

/// Directions that are probed around a ball in a cavity.
const SPHERE_WAYS: usize = 64;
/// Largest share of them that leads out of a cavity. From a point on its rim it would be a half.
const MAX_OPENING: f32 = 0.45;
/// Cosine to the axis of the opening below which a way does not lead out of it, but through a hole.
const HOLE_COSINE: f32 = -0.2;
/// Directions through holes that a cavity may have, as a cap has below its strap.
const MAX_HOLES: usize = 2;
/// Largest cosine between up and the axis of the opening of a cavity that stands over a tip.
const MAX_RISE: f32 = -0.25;

impl Probe<'_> {
    /// How the object surrounds the ball on a bar along the unit vector `bar`.
    pub(super) fn enclosure(&self, bar: &Vector, up: &Vector, meter: &mut Meter) -> Result<Enclosure, Stop> {
        if Directions::around(bar).ends(self, meter)? == Ends::Parted {
            return Ok(Enclosure::Loop);
        }
        Ok(if self.is_in_cavity(up, meter)? { Enclosure::Cavity } else { Enclosure::Open })
    }

    /// Whether the object stops the ball on a straight way. The ball grows on it by `growth` metres a metre.
    pub(super) fn is_stopped(&self, way: &Vector, growth: f32, meter: &mut Meter) -> Result<bool, Stop> {
        let mut travelled = 0.0;
        for step in 0..MAX_STEPS {
            let point = self.at + way * travelled;
            let radius = self.radius.max(growth * travelled);
            if self.body.is_beyond(&point, radius) {
                meter.distance_queries(step)?;
                return Ok(false);
            }
            let gap = self.body.field.distance(&point) - radius;
            // At the start the ball is known to be clear. Far from the surface the field is only a lower bound.
            if gap < 0.0 && step > 0 && (gap + radius < 0.0 || self.body.surface.is_within(&point, radius)) {
                meter.distance_queries(step)?;
                return Ok(true);
            }
            travelled += gap.max(0.5 * self.radius);
        }
        meter.distance_queries(MAX_STEPS)?;
        Ok(true)
    }

    /// Whether the ball is in a cavity with one opening, which faces down.
    fn is_in_cavity(&self, up: &Vector, meter: &mut Meter) -> Result<bool, Stop> {
        let mut ways = heapless::Vec::<Vector, SPHERE_WAYS>::new();
        for k in 0..SPHERE_WAYS {
            let way = fibonacci_direction(k, SPHERE_WAYS);
            if !self.is_stopped(&way, 0.0, meter)? {
                let _ = ways.push(way);
                if ways.len() as f32 > MAX_OPENING * SPHERE_WAYS as f32 {
                    return Ok(false);
                }
            }
        }
        let axis = unit_or(ways.iter().sum(), Vector::zeros());
        let holes = ways.iter().filter(|way| way.dot(&axis) < HOLE_COSINE).count();
        Ok(!ways.is_empty() && holes <= MAX_HOLES && axis.dot(up) < MAX_RISE)
    }
}

/// The directions around a bar, which is the polar axis.
struct Directions {
    bar: Vector,
    across: [Vector; 2],
    states: [State; ROWS * COLUMNS],
    /// Whether free ways join the two ends of the bar.
    are_joined: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Unknown,
    /// The way is free.
    Free,
    /// The way is free, and free ones join it with the first end of the bar.
    First,
    /// The way is free, and free ones join it with the second end of the bar.
    Second,
    /// The object stops the ball.
    Stopped,
}

/// What leads towards the ends of a bar.
#[derive(Clone, Copy, PartialEq)]
enum Ends {
    /// Nothing leads towards one of them.
    Closed,
    /// Free ways lead towards both, and join them around the object's material.
    Joined,
    /// Free ways lead towards both, and material is all around between them.
    Parted,
}

impl Directions {
    fn around(bar: &Vector) -> Self {
        let first = any_perpendicular(*bar);
        let across = [first, bar.cross(&first)];
        Self { bar: *bar, across, states: [State::Unknown; ROWS * COLUMNS], are_joined: false }
    }

    /// The unit vector in the middle of a cell.
    fn way(&self, row: usize, column: usize) -> Vector {
        let angle = |index: usize, count: usize, whole: f32| whole * (index as f32 + 0.5) / count as f32;
        let (sin, cos) = libm::sincosf(angle(row, ROWS, core::f32::consts::PI));
        let (aside, ahead) = libm::sincosf(angle(column, COLUMNS, core::f32::consts::TAU));
        self.bar * cos + (self.across[0] * ahead + self.across[1] * aside) * sin
    }

    /// What leads towards the ends of the bar.
    fn ends(&mut self, probe: &Probe, meter: &mut Meter) -> Result<Ends, Stop> {
        let (count, rows) = (ROWS * COLUMNS, END_ROWS * COLUMNS);
        if !self.join_nearest(0..rows, State::First, probe, meter)? {
            return Ok(Ends::Closed);
        }
        // What is joined with the first end may lead towards the second one as well.
        let is_second = self.join_nearest((count - rows..count).rev(), State::Second, probe, meter)?;
        Ok(match (is_second, self.are_joined) {
            (_, true) => Ends::Joined,
            (true, false) => Ends::Parted,
            (false, false) => Ends::Closed,
        })
    }

    /// Joins free ways from the first of some cells that is free, passing over holes. Returns whether there is one.
    fn join_nearest(
        &mut self,
        cells: impl Iterator<Item = usize>,
        end: State,
        probe: &Probe,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        for index in cells {
            match self.look(index, probe, meter)? {
                State::Free => {
                    self.states[index] = end;
                    if self.spread(end, probe, meter)? >= MIN_WAYS {
                        return Ok(true);
                    }
                    self.states
                        .iter_mut()
                        .filter(|state| **state == end)
                        .for_each(|state| *state = State::Stopped);
                }
                State::First => {
                    self.are_joined = true;
                    return Ok(false);
                }
                _ => {}
            }
        }
        Ok(false)
    }

    /// Looks whether the way of a cell is free, once.
    fn look(&mut self, index: usize, probe: &Probe, meter: &mut Meter) -> Result<State, Stop> {
        if self.states[index] == State::Unknown {
            let way = self.way(index / COLUMNS, index % COLUMNS);
            let is_stopped = probe.is_stopped(&way, GROWTH, meter)?;
            self.states[index] = if is_stopped { State::Stopped } else { State::Free };
        }
        Ok(self.states[index])
    }

    /// Joins free ways next to those of an end, in sweeps of alternating order, until there are no more. Returns their number.
    fn spread(&mut self, end: State, probe: &Probe, meter: &mut Meter) -> Result<usize, Stop> {
        let (mut count, mut is_backwards) = (1, false);
        loop {
            let before = count;
            for k in 0..ROWS * COLUMNS {
                let index = if is_backwards { ROWS * COLUMNS - 1 - k } else { k };
                let is_open = matches!(self.states[index], State::Unknown | State::Free);
                if is_open && self.is_next_to(end, index) && self.look(index, probe, meter)? == State::Free {
                    self.states[index] = end;
                    count += 1;
                }
            }
            if count == before {
                return Ok(count);
            }
            is_backwards = !is_backwards;
        }
    }

    fn is_next_to(&self, end: State, index: usize) -> bool {
        let (row, column) = (index / COLUMNS, index % COLUMNS);
        let is_there = |row: usize, column: usize| self.states[row * COLUMNS + column] == end;
        is_there(row, (column + 1) % COLUMNS)
            || is_there(row, (column + COLUMNS - 1) % COLUMNS)
            || row > 0 && is_there(row - 1, column)
            || row + 1 < ROWS && is_there(row + 1, column)
    }
}
