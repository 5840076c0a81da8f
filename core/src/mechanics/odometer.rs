//! Upper bounds of the distance that points of the body have moved, without storing past states.

use super::body::State;
use crate::geometry::{Point, Vector};

/// Sums up the path length of one point of the body, the pivot, and the rotation about it. A hanging body
/// swings about its contacts: near them it moves little, however far its other end moves.
pub(crate) struct Odometer {
    /// Pivot relative to the centre of mass, in object coordinates, metres.
    pivot: Vector,
    /// Path length of the pivot, metres.
    path: f32,
    /// Sum of the rotation angles, radians.
    angle: f32,
}

impl Odometer {
    pub(crate) fn new(pivot: Vector) -> Self {
        Self { pivot, path: 0.0, angle: 0.0 }
    }

    /// Adds a motion from `state`: the displacement of the centre of mass, metres, and the rotation vector
    /// about it, radians.
    pub(crate) fn add(&mut self, state: &State, shift: &Vector, turn: &Vector) {
        self.path += (shift + turn.cross(&(state.rotation * self.pivot))).norm();
        self.angle += turn.norm();
    }

    /// Upper bound of the distance that any point of the body within `radius` metres of the pivot has moved,
    /// metres.
    pub(crate) fn reading(&self, radius: f32) -> f32 {
        self.path + self.angle * radius
    }

    /// Position of the pivot in supporter coordinates, metres.
    pub(crate) fn pivot(&self, state: &State) -> Point {
        state.centre + state.rotation * self.pivot
    }

    /// Upper bound of the distance from the pivot to any point of the body, metres; `reach` is that from the
    /// centre of mass.
    pub(crate) fn max_radius(&self, reach: f32) -> f32 {
        reach + self.pivot.norm()
    }
}
