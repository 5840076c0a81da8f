//! How the object encloses a point: all around in a plane, with a way out on both sides of it or on one.

use super::Body;
use crate::geometry::{Point, Vector, any_perpendicular, fibonacci_direction, rotate_about, unit_or};
use crate::monitor::{Meter, Stop};

/// How the object encloses a ball that lies in a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Enclosure {
    /// The ball can leave in the plane.
    Open,
    /// It cannot leave in the plane, but on both sides of it: a bar along the plane's normal runs through a loop.
    Loop,
    /// It cannot leave in the plane, and on one side of it at most: a tip is in a cavity.
    Cavity,
}

/// Straight ways out that are tried in a plane, evenly around.
const WAYS: usize = 32;
/// Ways out that are tried on either side of a plane.
const SIDE_WAYS: usize = 48;
/// Least cosine between these and the plane's normal.
const SIDE_COSINE: f32 = 0.1;
/// Cells along each side of the grid on which crooked ways out are looked for. A larger number finds narrower ones, at more time.
const CELLS: usize = 96;
/// Most steps of a way. One step is at least half the ball's radius.
const MAX_STEPS: usize = 200;

impl Enclosure {
    /// How `body` encloses a ball of `radius` metres at `at` in the plane with unit normal `normal`, in object coordinates.
    pub(super) fn across(
        body: &Body,
        at: &Point,
        normal: &Vector,
        radius: f32,
        meter: &mut Meter,
    ) -> Result<Self, Stop> {
        let (u, ball) = (any_perpendicular(*normal), Ball { body, at, radius });
        for k in 0..WAYS {
            // Opposite ways first: a hook is open on one side.
            let turn = (k / 2) as f32 / WAYS as f32 + 0.5 * (k % 2) as f32;
            if !ball.is_stopped(&rotate_about(*normal, core::f32::consts::TAU * turn, u), meter)? {
                return Ok(Self::Open);
            }
        }
        if Grid::around(&ball, [u, normal.cross(&u)]).lets_out(&ball, meter)? {
            return Ok(Self::Open);
        }
        for side in [*normal, -normal] {
            let mut is_closed = true;
            for way in (0..2 * SIDE_WAYS).map(|k| fibonacci_direction(k, 2 * SIDE_WAYS)) {
                is_closed = is_closed && (way.dot(&side) < SIDE_COSINE || ball.is_stopped(&way, meter)?);
            }
            if is_closed {
                return Ok(Self::Cavity);
            }
        }
        Ok(Self::Loop)
    }
}

/// Directions that are probed around a ball in a cavity.
const SPHERE_WAYS: usize = 64;
/// Largest share of them that leads out of a cavity. From a point on its rim it would be a half.
const MAX_OPENING: f32 = 0.45;
/// Cosine to the axis of the opening below which a way does not lead out of it, but through a hole.
const OPENING_COSINE: f32 = -0.2;
/// Directions through holes that a cavity may have, as a cap has below its strap. Two opposite cones lead out of a loop.
const MAX_HOLES: usize = 2;

/// Whether a ball of `radius` metres at `at` is in a cavity with one opening, which does not face up. In object coordinates.
pub(super) fn is_in_cavity(
    body: &Body,
    at: &Point,
    up: &Vector,
    radius: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let mut ways = heapless::Vec::<Vector, SPHERE_WAYS>::new();
    for k in 0..SPHERE_WAYS {
        let way = fibonacci_direction(k, SPHERE_WAYS);
        if !(Ball { body, at, radius }).is_stopped(&way, meter)? {
            let _ = ways.push(way);
            if ways.len() as f32 > MAX_OPENING * SPHERE_WAYS as f32 {
                return Ok(false);
            }
        }
    }
    let axis = unit_or(ways.iter().sum(), Vector::zeros());
    let holes = ways.iter().filter(|way| way.dot(&axis) < OPENING_COSINE).count();
    Ok(!ways.is_empty() && holes <= MAX_HOLES && axis.dot(up) < 0.0)
}

/// Whether the object stops a ball of `radius` metres on the straight way from `at` in the direction `way`, in object
/// coordinates.
pub(super) fn is_stopped(
    body: &Body,
    at: &Point,
    radius: f32,
    way: &Vector,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    Ball { body, at, radius }.is_stopped(way, meter)
}

/// A ball in object coordinates, metres.
struct Ball<'a> {
    body: &'a Body<'a>,
    at: &'a Point,
    radius: f32,
}

impl Ball<'_> {
    /// Whether the object stops the ball on a straight way.
    fn is_stopped(&self, way: &Vector, meter: &mut Meter) -> Result<bool, Stop> {
        let mut travelled = 0.0;
        for step in 0..MAX_STEPS {
            let point = self.at + way * travelled;
            if self.is_out(&point) {
                meter.distance_queries(step)?;
                return Ok(false);
            }
            let gap = self.body.field.distance(&point) - self.radius;
            if gap < 0.0 && step > 0 {
                meter.distance_queries(step)?;
                return Ok(true);
            }
            travelled += gap.max(0.5 * self.radius);
        }
        meter.distance_queries(MAX_STEPS)?;
        Ok(true)
    }

    /// Whether the ball at `point` is outside the object's bounding sphere.
    fn is_out(&self, point: &Point) -> bool {
        self.body.is_beyond(point, self.radius)
    }
}

/// Cells of a plane around the ball's start, which is in the middle one.
struct Grid {
    axes: [Vector; 2],
    /// Width of a cell, metres.
    width: f32,
    states: [State; CELLS * CELLS],
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Unknown,
    /// The ball gets there.
    Reached,
    /// The object is in the way.
    Blocked,
}

impl Grid {
    fn around(ball: &Ball, axes: [Vector; 2]) -> Self {
        let far = (ball.at - ball.body.centre).norm() + ball.body.reach + ball.radius;
        Self { axes, width: far / (CELLS / 2 - 1) as f32, states: [State::Unknown; CELLS * CELLS] }
    }

    fn centre(&self, ball: &Ball, column: usize, row: usize) -> Point {
        let offset = |index: usize| (index as f32 - (CELLS / 2) as f32) * self.width;
        ball.at + self.axes[0] * offset(column) + self.axes[1] * offset(row)
    }

    /// Whether the ball gets out from cell to cell. Sweeps in alternating order need no queue, and few rounds.
    fn lets_out(&mut self, ball: &Ball, meter: &mut Meter) -> Result<bool, Stop> {
        let middle = CELLS / 2;
        self.states[middle * CELLS + middle] = State::Reached;
        // Nothing fits between the centres of two neighbouring cells that are both farther than this from the object.
        let clear = ball.radius.max(0.5 * self.width);
        let mut is_backwards = false;
        loop {
            let (mut has_changed, mut queries) = (false, 0);
            for k in 0..CELLS * CELLS {
                let index = if is_backwards { CELLS * CELLS - 1 - k } else { k };
                let (row, column) = (index / CELLS, index % CELLS);
                let is_reached = |at: usize| self.states[at] == State::Reached;
                let is_next = self.states[index] == State::Unknown
                    && (column > 0 && is_reached(index - 1)
                        || column + 1 < CELLS && is_reached(index + 1)
                        || row > 0 && is_reached(index - CELLS)
                        || row + 1 < CELLS && is_reached(index + CELLS));
                if !is_next {
                    continue;
                }
                let point = self.centre(ball, column, row);
                if ball.is_out(&point) {
                    return Ok(true);
                }
                queries += 1;
                let is_free = ball.body.field.distance(&point) > clear;
                self.states[index] = if is_free { State::Reached } else { State::Blocked };
                has_changed = true;
            }
            meter.distance_queries(queries)?;
            if !has_changed {
                return Ok(false);
            }
            is_backwards = !is_backwards;
        }
    }
}
