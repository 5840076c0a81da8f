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
/// Rows that lead towards an end of the bar: 35 degrees around its axis, more than the error of its direction next to a post.
const END_ROWS: usize = 7;
/// Growth of the ball with its distance, no unit: half of a row, so that no material passes between two directions.
const GROWTH: f32 = 0.044;
/// Least share of the ways around an end of the bar that lead out, if a bar goes on there. It need not be all: the direction of the
/// bar is not exact, and the rest of the object may be beside it.
const MIN_OPEN: f32 = 0.4;
/// Stride through the columns for that, which need no more.
const END_STRIDE: usize = 6;
/// Largest distance between the material of two neighbouring directions, in radii of the ball there: twice as wide is a gap
/// through which it passes.
const MAX_GAP: f32 = 1.5;
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
    /// How the object surrounds the ball on a bar along the unit vector `bar`. `contact` points from the ball to the contact.
    pub(super) fn enclosure(
        &self,
        (bar, contact, up): (&Vector, &Vector, &Vector),
        meter: &mut Meter,
    ) -> Result<Enclosure, Stop> {
        let mut around = Surroundings::new(self, bar);
        if around.runs_around(contact, meter)? && around.has_open_ends(meter)? {
            return Ok(Enclosure::Loop);
        }
        Ok(if self.is_in_cavity(up, meter)? { Enclosure::Cavity } else { Enclosure::Open })
    }

    /// Whether the object stops the ball on a straight way.
    pub(super) fn is_stopped(&self, way: &Vector, meter: &mut Meter) -> Result<bool, Stop> {
        Ok(self.travel(way, 0.0, meter)?.is_some())
    }

    /// How far the ball gets on a straight way until the object stops it, metres; `None` if nothing does. The ball grows on it
    /// by `growth` metres a metre.
    fn travel(&self, way: &Vector, growth: f32, meter: &mut Meter) -> Result<Option<f32>, Stop> {
        let mut travelled = 0.0;
        for step in 0..MAX_STEPS {
            let point = self.at + way * travelled;
            let radius = self.radius.max(growth * travelled);
            if self.body.is_beyond(&point, radius) {
                meter.distance_queries(step)?;
                return Ok(None);
            }
            let distance = self.body.field.distance(&point);
            // At the start the ball is known to be clear. Far from the surface the field is only a lower bound.
            let is_stopped = step > 0
                && distance < radius
                && (distance < 0.0 || self.body.surface.is_within(&point, radius));
            if is_stopped {
                meter.distance_queries(step)?;
                return Ok(Some(travelled));
            }
            travelled += (distance - radius).max(0.5 * self.radius);
        }
        meter.distance_queries(MAX_STEPS)?;
        Ok(Some(travelled))
    }

    /// Whether the ball is in a cavity with one opening, which faces down.
    fn is_in_cavity(&self, up: &Vector, meter: &mut Meter) -> Result<bool, Stop> {
        let mut ways = heapless::Vec::<Vector, SPHERE_WAYS>::new();
        for k in 0..SPHERE_WAYS {
            let way = fibonacci_direction(k, SPHERE_WAYS);
            if !self.is_stopped(&way, meter)? {
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

/// The material around a bar, seen from the ball: where the object stops it, in a grid of directions with the bar as polar axis.
struct Surroundings<'a> {
    probe: &'a Probe<'a>,
    bar: Vector,
    across: [Vector; 2],
    /// For each direction, how far the ball gets, in [`TENTHS`]; [`NOT_LOOKED`], or [`FREE`].
    travels: [u16; ROWS * COLUMNS],
    /// For each direction in which the material is connected to the contact, how often it runs around the bar from there;
    /// [`NOT_CONNECTED`] elsewhere.
    turns: [i8; ROWS * COLUMNS],
}

/// Units of a travel, metres.
const TENTHS: f32 = 1e-4;
/// Largest travel, in [`TENTHS`].
const FARTHEST: u16 = u16::MAX - 2;
const FREE: u16 = u16::MAX - 1;
const NOT_LOOKED: u16 = u16::MAX;
const NOT_CONNECTED: i8 = i8::MAX;

impl<'a> Surroundings<'a> {
    fn new(probe: &'a Probe<'a>, bar: &Vector) -> Self {
        let first = any_perpendicular(*bar);
        Self {
            probe,
            bar: *bar,
            across: [first, bar.cross(&first)],
            travels: [NOT_LOOKED; ROWS * COLUMNS],
            turns: [NOT_CONNECTED; ROWS * COLUMNS],
        }
    }

    /// The unit vector in the middle of a cell.
    fn way(&self, cell: usize) -> Vector {
        let angle = |index: usize, count: usize, whole: f32| whole * (index as f32 + 0.5) / count as f32;
        let (sin, cos) = libm::sincosf(angle(cell / COLUMNS, ROWS, core::f32::consts::PI));
        let (aside, ahead) = libm::sincosf(angle(cell % COLUMNS, COLUMNS, core::f32::consts::TAU));
        self.bar * cos + (self.across[0] * ahead + self.across[1] * aside) * sin
    }

    /// The cell of a direction of any length.
    fn cell(&self, way: &Vector) -> usize {
        let [x, y] = self.across.map(|axis| axis.dot(way));
        let polar = libm::atan2f(libm::sqrtf(x * x + y * y), self.bar.dot(way)) / core::f32::consts::PI;
        let around = libm::atan2f(y, x) / core::f32::consts::TAU;
        let row = ((polar * ROWS as f32) as usize).min(ROWS - 1);
        let column = (((around + 1.0) * COLUMNS as f32) as usize) % COLUMNS;
        row * COLUMNS + column
    }

    /// How far the ball gets in the direction of a cell, looked up once.
    fn travel(&mut self, cell: usize, meter: &mut Meter) -> Result<u16, Stop> {
        if self.travels[cell] == NOT_LOOKED {
            let travel = self.probe.travel(&self.way(cell), GROWTH, meter)?;
            let tenths = |metres: f32| ((metres / TENTHS) as u16).min(FARTHEST);
            self.travels[cell] = travel.map_or(FREE, tenths);
        }
        Ok(self.travels[cell])
    }

    /// Whether most ways around both ends of the bar lead out. Material around an axis that pierces it is no loop.
    fn has_open_ends(&mut self, meter: &mut Meter) -> Result<bool, Stop> {
        for is_second in [false, true] {
            let (mut free, mut all) = (0.0, 0.0);
            for ring in 0..END_ROWS {
                let row = if is_second { ROWS - 1 - ring } else { ring };
                // Rows far from the end cover more of the sphere.
                let weight = ring as f32 + 0.5;
                for column in (0..COLUMNS).step_by(END_STRIDE) {
                    all += weight;
                    free += if self.travel(row * COLUMNS + column, meter)? == FREE { weight } else { 0.0 };
                }
            }
            if free < MIN_OPEN * all {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the material that is connected to that in the direction `contact` runs once around the bar.
    fn runs_around(&mut self, contact: &Vector, meter: &mut Meter) -> Result<bool, Stop> {
        let mut waiting = heapless::Vec::<u16, { ROWS * COLUMNS }>::new();
        let start = self.cell(contact);
        if self.travel(start, meter)? == FREE {
            return Ok(false);
        }
        self.turns[start] = 0;
        let _ = waiting.push(start as u16);
        while let Some(cell) = waiting.pop() {
            let cell = usize::from(cell);
            let (row, column) = (cell / COLUMNS, cell % COLUMNS);
            for (down, right) in NEIGHBOURS {
                let (row, unwrapped) = (row as i32 + down, column as i32 + right);
                if !(0..ROWS as i32).contains(&row) {
                    continue;
                }
                let next = row as usize * COLUMNS + unwrapped.rem_euclid(COLUMNS as i32) as usize;
                let turns = self.turns[cell] + unwrapped.div_euclid(COLUMNS as i32) as i8;
                if self.turns[next] == turns || !self.are_connected(cell, next, meter)? {
                    continue;
                }
                if self.turns[next] != NOT_CONNECTED {
                    return Ok(true);
                }
                self.turns[next] = turns;
                // Each cell is pushed once, so that there is room.
                let _ = waiting.push(next as u16);
            }
        }
        Ok(false)
    }

    /// Whether the material in the directions of two neighbouring cells is connected, with no gap through which the bar passes.
    fn are_connected(&mut self, a: usize, b: usize, meter: &mut Meter) -> Result<bool, Stop> {
        let travels = [self.travel(a, meter)?, self.travel(b, meter)?];
        if travels.contains(&FREE) {
            return Ok(false);
        }
        let [near, far] = travels.map(|travel| f32::from(travel) * TENTHS);
        let [from, to] = [(a, near), (b, far)].map(|(cell, travel)| self.probe.at + self.way(cell) * travel);
        let radius = self.probe.radius.max(GROWTH * near.max(far));
        let length = (to - from).norm();
        let steps = libm::ceilf(length / radius) as usize;
        // A straight wire between the two may be half a direction off the straight line.
        let widest = MAX_GAP * radius + GROWTH * length;
        meter.distance_queries(steps)?;
        let is_filled = |step: usize| {
            let point = from + (to - from) * (step as f32 / steps as f32);
            self.probe.body.field.distance(&point) < widest
        };
        Ok((1..steps).all(is_filled))
    }
}

/// The rows down and columns to the right of the neighbours of a cell.
const NEIGHBOURS: [(i32, i32); 8] = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)];
