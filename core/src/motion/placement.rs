//! Where the thing that moves is, the way from one place to the next, and how far that is.

use crate::geometry::{Point, Pose, Vector, rotation_by};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Quaternion, Translation3, UnitQuaternion};

/// Pose of the moving thing by its centre: small enough for thousands of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Placement {
    /// The centre in supporter coordinates, metres.
    pub(super) centre: [f32; 3],
    /// Unit quaternion x, y, z, w.
    pub(super) rotation: [f32; 4],
}

/// A motion from one placement to another: the centre moves straight while the rotation axis stays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    /// Displacement of the centre, metres.
    pub(super) shift: Vector,
    /// Rotation vector in supporter coordinates, radians.
    pub(super) turn: Vector,
}

impl Placement {
    /// The placement of something with this centre, in its own coordinates, at a pose.
    pub(super) fn of(pose: &Pose, centre: &Point) -> Self {
        Self::new(pose * centre, pose.rotation)
    }

    pub(super) fn new(centre: Point, rotation: UnitQuaternion<f32>) -> Self {
        Self { centre: centre.into(), rotation: rotation.coords.into() }
    }

    pub(super) fn centre(&self) -> Point {
        self.centre.into()
    }

    pub(super) fn rotation(&self) -> UnitQuaternion<f32> {
        UnitQuaternion::new_unchecked(Quaternion::from(self.rotation))
    }

    /// The pose of something with this centre, in its own coordinates.
    pub(super) fn pose(&self, centre: &Point) -> Pose {
        let rotation = self.rotation();
        let shift = self.centre() - rotation * centre;
        Pose::from_parts(Translation3::from(shift), rotation)
    }

    /// The shortest motion to another placement.
    pub(super) fn leg_to(&self, to: &Self) -> Leg {
        let difference = to.rotation() * self.rotation().inverse();
        Leg { shift: to.centre() - self.centre(), turn: rotation_vector(&difference) }
    }

    /// The placement after a share of a motion, 0 to 1.
    pub(super) fn after(&self, leg: &Leg, share: f32) -> Self {
        let mut rotation = rotation_by(&(leg.turn * share)) * self.rotation();
        rotation.renormalize_fast();
        Self::new(self.centre() + leg.shift * share, rotation)
    }
}

impl Leg {
    /// Stays where it is.
    pub(super) const NONE: Self =
        Self { shift: Vector::new(0.0, 0.0, 0.0), turn: Vector::new(0.0, 0.0, 0.0) };

    /// Upper bound of the displacement of any point within `reach` of the centre, metres.
    pub(super) fn travel(&self, reach: f32) -> f32 {
        self.shift.norm() + self.turn.norm() * reach
    }

    pub(super) fn scaled(&self, share: f32) -> Self {
        Self { shift: self.shift * share, turn: self.turn * share }
    }
}

/// Rotation vector, axis times angle of 0 to π.
fn rotation_vector(rotation: &UnitQuaternion<f32>) -> Vector {
    let (imaginary, scalar) = (rotation.imag(), rotation.scalar());
    let sine = imaginary.norm();
    // Of the two quaternions of a rotation, the one with the smaller angle.
    let angle = 2.0 * libm::atan2f(sine, scalar.abs());
    let scale = if sine > 1e-6 { angle / sine } else { 2.0 };
    imaginary * if scalar < 0.0 { -scale } else { scale }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leg_ends_where_it_leads() {
        let mut random = crate::random::Random::new(3);
        for _ in 0..1000 {
            let mut next = || random.next_f32() * 2.0 - 1.0;
            let mut placement = || {
                let rotation = Quaternion::new(next(), next(), next(), next());
                Placement::new(Point::new(next(), next(), next()), UnitQuaternion::new_normalize(rotation))
            };
            let (from, to) = (placement(), placement());
            let leg = from.leg_to(&to);
            let (end, half) = (from.after(&leg, 1.0), from.after(&leg, 0.5));
            assert!((end.centre() - to.centre()).norm() < 1e-5);
            assert!(end.rotation().angle_to(&to.rotation()) < 2e-3);
            assert!(leg.turn.norm() <= core::f32::consts::PI + 1e-5);
            assert!(half.rotation().angle_to(&to.rotation()) < 0.5 * leg.turn.norm() + 2e-3);
        }
    }
}
