//! How far the body can have moved, without asking where it was.

use super::body::State;
use crate::geometry::{Point, Vector};

/// Adds up the motion of one point of the body, the pivot, and the turning about it. What hangs swings about where it is held:
/// there, where contacts are, it moves little, however far its other end does.
pub(crate) struct Odometer {
    /// From the centre of mass to the pivot, in the body's coordinates.
    pivot: Vector,
    /// The way of the pivot, metres.
    way: f32,
    /// The angle turned, radians.
    angle: f32,
}

impl Odometer {
    pub(crate) fn new(pivot: Vector) -> Self {
        Self { pivot, way: 0.0, angle: 0.0 }
    }

    /// Adds a displacement of the centre of mass and a rotation vector about it.
    pub(crate) fn add(&mut self, state: &State, shift: &Vector, turn: &Vector) {
        self.way += (shift + turn.cross(&(state.rotation * self.pivot))).norm();
        self.angle += turn.norm();
    }

    /// How far anything of the body within `radius` metres of the pivot can have moved, metres.
    pub(crate) fn reading(&self, radius: f32) -> f32 {
        self.way + self.angle * radius
    }

    /// The distance from the pivot to a point, metres.
    pub(crate) fn radius(&self, state: &State, point: &Point) -> f32 {
        (point - state.centre - state.rotation * self.pivot).norm()
    }

    /// The largest radius of a body whose centre of mass has this reach, metres.
    pub(crate) fn greatest_radius(&self, reach: f32) -> f32 {
        reach + self.pivot.norm()
    }
}
