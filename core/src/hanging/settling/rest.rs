//! Where a released object comes to rest, and how firmly.

use super::probability;
use crate::geometry::{Point, Pose};
use crate::mechanics::{Contact, Firmness, MAX_CONTACTS, Margin, Unseen};

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
    /// How much of what matters at the release pose no camera has seen. The probability is lower by it.
    pub unseen: Unseen,
    /// How firmly the object stays.
    pub margin: Margin,
    contacts: [Contact; MAX_CONTACTS],
    contact_count: u32,
}

impl Rest {
    pub(super) fn new(
        pose: Pose,
        (sinking, clearance): (f32, f32),
        unseen: Unseen,
        firmness: &Firmness,
    ) -> Self {
        let Firmness { margin, contacts: bearing } = firmness;
        let mut contacts = [Contact::default(); MAX_CONTACTS];
        contacts[..bearing.len()].copy_from_slice(bearing);
        let probability = probability::of(margin, clearance, &unseen);
        let contact_count = bearing.len() as u32;
        Self { pose, sinking, clearance, probability, unseen, margin: *margin, contacts, contact_count }
    }

    /// Whether nothing but what nobody saw keeps the pose from being certain.
    pub(super) fn is_firm(&self) -> bool {
        probability::is_firm(self.probability, &self.unseen)
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
