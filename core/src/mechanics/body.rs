//! The object in the simulation: a rigid body of uniform density.

use super::Views;
use crate::geometry::{DistanceField, Point, Pose, Surface, Vector, rotation_by};
use nalgebra::{Matrix3, Translation3, UnitQuaternion};

/// A rigid body in the frame of the object, here as in all of the mechanics called object coordinates. Its mass is one, because no result
/// depends on the mass.
#[derive(Clone, Copy)]
pub(crate) struct Body<'a> {
    /// The signed distance field, for fast queries.
    pub(crate) field: &'a DistanceField<'a>,
    /// The mesh, for exact queries.
    pub(crate) surface: &'a Surface<'a>,
    /// Centre of mass, metres.
    pub(crate) centre: Point,
    /// By how much the centre of mass may be wrong, metres; zero if it is given or the mesh is closed.
    pub(crate) centre_error: f32,
    /// Inverse of the inertia tensor about the centre of mass, 1/m².
    pub(crate) inverse_inertia: Matrix3<f32>,
    /// Distance from the centre of mass to the farthest point of the shape, metres.
    pub(crate) reach: f32,
    /// The largest extent of the shape, metres.
    pub(crate) extent: f32,
    /// Where it was seen from.
    pub(crate) views: Views<'a>,
    /// From the caller's object coordinates to these.
    pub(crate) frame: &'a Pose,
}

/// Position and velocity of the body, in supporter coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    /// Centre of mass, metres.
    pub(crate) centre: Point,
    /// Rotation from object to supporter coordinates.
    pub(crate) rotation: UnitQuaternion<f32>,
    /// Velocity of the centre of mass, m/s.
    pub(crate) velocity: Vector,
    /// Angular velocity, rad/s.
    pub(crate) spin: Vector,
}

impl Body<'_> {
    /// State of rest at `pose`, object to supporter coordinates.
    pub(crate) fn at(&self, pose: &Pose) -> State {
        State {
            centre: pose * self.centre,
            rotation: pose.rotation,
            velocity: Vector::zeros(),
            spin: Vector::zeros(),
        }
    }

    /// Pose of a state, object to supporter coordinates.
    pub(crate) fn pose(&self, state: &State) -> Pose {
        let shift = state.centre - state.rotation * self.centre;
        Pose::from_parts(Translation3::from(shift), state.rotation)
    }

    /// Inverse of the inertia tensor in supporter coordinates, 1/m².
    pub(crate) fn inverse_inertia_in(&self, state: &State) -> Matrix3<f32> {
        let rotation = state.rotation.to_rotation_matrix();
        rotation.matrix() * self.inverse_inertia * rotation.matrix().transpose()
    }

    /// Whether a point in object coordinates is farther than `distance` metres from the bounding sphere
    /// around the centre of mass. This test is cheaper than a query of the field.
    pub(crate) fn is_beyond(&self, point: &Point, distance: f32) -> bool {
        let limit = self.reach + distance;
        (point - self.centre).norm_squared() > limit * limit
    }

    /// The same shape with its mass around a point in object coordinates, with a radius of gyration in metres.
    pub(crate) fn with_mass_at(&self, centre: Point, radius: f32) -> Self {
        Self {
            centre,
            inverse_inertia: Matrix3::identity() / (radius * radius),
            reach: self.reach + (centre - self.centre).norm(),
            ..*self
        }
    }

    /// Upper bound of the displacement of any point of the body between two states, metres.
    pub(crate) fn travel(&self, from: &State, to: &State) -> f32 {
        (to.centre - from.centre).norm() + from.rotation.angle_to(&to.rotation) * self.reach
    }
}

impl State {
    /// Advances by a displacement, metres, and a rotation vector, radians.
    pub(crate) fn advance(&mut self, shift: &Vector, turn: &Vector) {
        self.centre += shift;
        self.rotation = rotation_by(turn) * self.rotation;
        self.rotation.renormalize_fast();
    }

    /// Velocity of the point of the body at `arm` from its centre of mass, m/s.
    pub(crate) fn velocity_at(&self, arm: &Vector) -> Vector {
        self.velocity + self.spin.cross(arm)
    }
}
