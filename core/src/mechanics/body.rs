//! The object as mechanics sees it: a rigid body of one density.

use crate::geometry::{DistanceField, Point, Pose, Surface, Vector};
use nalgebra::{Matrix3, Quaternion, Translation3, UnitQuaternion};

/// A rigid body of unit mass: nothing here depends on how heavy it is. In object coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Body<'a> {
    /// The shape, for what has to be fast.
    pub(crate) field: &'a DistanceField<'a>,
    /// The shape, for what has to be exact.
    pub(crate) surface: &'a Surface<'a>,
    /// Centre of mass, metres.
    pub(crate) centre: Point,
    /// Inverse of the inertia tensor about the centre of mass, 1/m².
    pub(crate) inverse_inertia: Matrix3<f32>,
    /// Distance from the centre of mass to the farthest point of the shape, metres.
    pub(crate) reach: f32,
    /// The largest extent of the shape, metres.
    pub(crate) extent: f32,
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
    /// At rest at `pose`, object to supporter.
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

    /// The inverse of the inertia tensor in supporter coordinates.
    pub(crate) fn inverse_inertia_in(&self, state: &State) -> Matrix3<f32> {
        let rotation = state.rotation.to_rotation_matrix();
        rotation.matrix() * self.inverse_inertia * rotation.matrix().transpose()
    }

    /// Whether a point, in object coordinates, is farther than `distance` metres from a ball around the body: cheaper to ask
    /// than the field.
    pub(crate) fn is_beyond(&self, point: &Point, distance: f32) -> bool {
        let limit = self.reach + distance;
        (point - self.centre).norm_squared() > limit * limit
    }

    /// How far the farthest point of the body can be from where it was, metres.
    pub(crate) fn travel(&self, from: &State, to: &State) -> f32 {
        (to.centre - from.centre).norm() + from.rotation.angle_to(&to.rotation) * self.reach
    }
}

impl State {
    /// Moves on by a displacement and a rotation vector.
    pub(crate) fn advance(&mut self, shift: &Vector, turn: &Vector) {
        self.centre += shift;
        self.rotation = rotation_by(turn) * self.rotation;
        self.rotation.renormalize_fast();
    }

    /// The velocity of the point of the body that is `arm` from its centre of mass.
    pub(crate) fn velocity_at(&self, arm: &Vector) -> Vector {
        self.velocity + self.spin.cross(arm)
    }
}

/// The rotation about `turn` by its length in radians.
fn rotation_by(turn: &Vector) -> UnitQuaternion<f32> {
    let half = 0.5 * turn.norm();
    // sin(x) / x, without a division by zero.
    let scale = if half > 1e-3 { libm::sinf(half) / half } else { 1.0 - half * half / 6.0 };
    UnitQuaternion::new_normalize(Quaternion::from_parts(libm::cosf(half), turn * (0.5 * scale)))
}
