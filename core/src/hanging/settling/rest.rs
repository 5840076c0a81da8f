//! Where a released object comes to rest, and how firmly.

use super::probability;
use crate::geometry::{Point, Pose};
use crate::mechanics::{Contact, Firmness, MAX_CONTACTS, Margin};

/// Where a released object comes to rest, and how firmly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Maps object coordinates to supporter coordinates; metres.
    pub pose: Pose,
    /// How far the centre of mass sinks from the release pose to the rest pose, metres.
    pub sinking: f32,
    /// Distance from the supporter at the release pose, metres: [`Params::clearance`](crate::Params::clearance), or
    /// less where there is no room.
    pub clearance: f32,
    /// The probability that the object hangs and stays, 0 to 1.
    pub probability: f32,
    /// Whether the object is released or rests close to a part of the supporter that no camera saw and that was guessed. The
    /// probability is then lower: another view of the supporter would say more.
    pub is_near_guess: bool,
    /// How firmly the object stays.
    pub margin: Margin,
    contacts: [Contact; MAX_CONTACTS],
    contact_count: u32,
}

impl Rest {
    pub(super) fn new(
        pose: Pose,
        (sinking, clearance): (f32, f32),
        is_near_guess: bool,
        firmness: &Firmness,
    ) -> Self {
        let Firmness { margin, contacts: bearing } = firmness;
        let mut contacts = [Contact::default(); MAX_CONTACTS];
        contacts[..bearing.len()].copy_from_slice(bearing);
        let probability = probability::of(margin, clearance) * probability::share_of_guess(is_near_guess);
        let contact_count = bearing.len() as u32;
        Self {
            pose,
            sinking,
            clearance,
            probability,
            is_near_guess,
            margin: *margin,
            contacts,
            contact_count,
        }
    }

    /// Whether nothing but what nobody saw keeps the pose from being certain.
    pub(super) fn is_firm(&self) -> bool {
        self.probability >= probability::FIRM * probability::share_of_guess(self.is_near_guess)
    }

    /// The contacts that carry the object at rest.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts[..self.contact_count as usize]
    }

    /// Whether another pose equals this rest pose to within a robot's accuracy: 5 mm at the centre of mass, and 0.1
    /// rad.
    pub(super) fn is_like(&self, other: &Pose, centre: &Point) -> bool {
        let apart = self.pose * centre - other * centre;
        apart.norm() < 0.005 && self.pose.rotation.angle_to(&other.rotation) < 0.1
    }
}
