//! Placements that the trees grow towards.

use super::placement::Placement;
use super::search::{START, Search};
use crate::geometry::{Vector, rotation_by};
use core::f32::consts::TAU;
use nalgebra::{Quaternion, UnitQuaternion};

// Shares of the samples. Set by hand.

/// Share of the samples that are starts.
const OF_STARTS: f32 = 0.25;
/// Share of these whose rotation is that of the start: on the way out any may be the one that passes.
const AS_IT_STARTS: f32 = 0.5;
/// Share of the other samples whose position is near the goal.
const NEAR_GOAL: f32 = 0.5;
/// Shares of the samples with the rotation of the goal, and with one close to it.
const ROTATED_AS_GOAL: [f32; 2] = [0.4, 0.3];
/// Samples after which these shares are less than half: what comes free without turning much has come free.
const WIDER_AFTER: usize = 100;
/// What is close to a rotation, radians.
const CLOSE_ROTATION: f32 = 0.8;

impl Search<'_, '_, '_> {
    /// A placement to grow towards.
    pub(super) fn sample(&mut self, starts: usize) -> Placement {
        if self.random.next_f32() < OF_STARTS {
            let index = (self.random.next_f32() * starts as f32) as usize;
            let start = self.trees[START].placement(index.min(starts - 1));
            if self.random.next_f32() < AS_IT_STARTS {
                return start;
            }
            return Placement::new(start.centre(), self.rotation());
        }
        let goal = self.goal;
        let centre = if self.random.next_f32() < NEAR_GOAL {
            let distance = self.random.next_f32() * self.space.moving.reach;
            goal.centre() + self.direction() * distance
        } else {
            let at = Vector::from([(); 3].map(|()| self.random.next_f32()));
            self.region.min + self.region.extents().component_mul(&at)
        };
        let shares = if self.sampled < WIDER_AFTER {
            ROTATED_AS_GOAL
        } else {
            ROTATED_AS_GOAL.map(|share| 0.4 * share)
        };
        let (choice, [same, close]) = (self.random.next_f32(), shares);
        let rotation = if choice < same {
            goal.rotation()
        } else if choice < same + close {
            let angle = self.random.next_f32() * CLOSE_ROTATION;
            rotation_by(&(self.direction() * angle)) * goal.rotation()
        } else {
            self.rotation()
        };
        Placement::new(centre, rotation)
    }

    /// A unit vector, uniform over the sphere.
    fn direction(&mut self) -> Vector {
        let (z, angle) = (2.0 * self.random.next_f32() - 1.0, TAU * self.random.next_f32());
        let across = libm::sqrtf((1.0 - z * z).max(0.0));
        Vector::new(across * libm::cosf(angle), across * libm::sinf(angle), z)
    }

    /// A rotation, uniform over SO(3) (Shoemake, "Uniform Random Rotations", 1992).
    fn rotation(&mut self) -> UnitQuaternion<f32> {
        let share = self.random.next_f32();
        let [a, b] = [(); 2].map(|()| TAU * self.random.next_f32());
        let (low, high) = (libm::sqrtf(1.0 - share), libm::sqrtf(share));
        let (sin_a, cos_a) = libm::sincosf(a);
        let (sin_b, cos_b) = libm::sincosf(b);
        UnitQuaternion::new_normalize(Quaternion::new(high * cos_b, low * sin_a, low * cos_a, high * sin_b))
    }
}
