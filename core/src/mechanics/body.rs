//! The object as mechanics sees it: a rigid body of one density.

use crate::geometry::{DistanceField, Point, Pose, Vector};
use nalgebra::{Matrix3, Translation3, UnitQuaternion};

/// A rigid body: shape, centre of mass and inertia, in object coordinates. Its mass is one: nothing here depends on it.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    /// The shape.
    pub field: &'a DistanceField<'a>,
    /// Centre of mass, metres.
    pub centre: Point,
    /// Inverse of the inertia tensor of a unit mass about the centre, 1/m².
    pub inverse_inertia: Matrix3<f32>,
    /// Distance from the centre of mass to the farthest point of the shape, metres.
    pub reach: f32,
    /// The largest extent of the shape, metres.
    pub extent: f32,
}

/// Where the body is and how it moves, in supporter coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    /// The centre of mass, metres.
    pub(crate) centre: Point,
    pub(crate) rotation: UnitQuaternion<f32>,
    /// Of the centre of mass, m/s.
    pub(crate) velocity: Vector,
    /// Angular velocity, rad/s.
    pub(crate) spin: Vector,
}

impl Body<'_> {
    /// At rest at `pose`.
    pub(crate) fn at(&self, pose: &Pose) -> State {
        State {
            centre: pose * self.centre,
            rotation: pose.rotation,
            velocity: Vector::zeros(),
            spin: Vector::zeros(),
        }
    }

    /// The pose, object to supporter, of a state.
    pub(crate) fn pose(&self, state: &State) -> Pose {
        let shift = state.centre - state.rotation * self.centre;
        Pose::from_parts(Translation3::from(shift), state.rotation)
    }
}

impl State {
    /// Moves on by the displacement and the rotation vector given.
    pub(crate) fn advance(&mut self, shift: &Vector, turn: &Vector) {
        self.centre += shift;
        self.rotation = rotation_by(turn) * self.rotation;
        self.rotation.renormalize_fast();
    }
}

/// The rotation about `turn` by its length in radians.
pub(crate) fn rotation_by(turn: &Vector) -> UnitQuaternion<f32> {
    let half = 0.5 * turn.norm();
    // sin(x)/x without a division by zero.
    let scale = if half > 1e-4 { libm::sinf(half) / half } else { 1.0 - half * half / 6.0 };
    let imaginary = turn * (0.5 * scale);
    UnitQuaternion::new_normalize(nalgebra::Quaternion::from_parts(libm::cosf(half), imaginary))
}
