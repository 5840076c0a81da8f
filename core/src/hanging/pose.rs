//! What a prediction is made of.

use super::{Cost, probability};
use crate::geometry::{Point, Pose};
use crate::mechanics::{Contact, Firmness, MAX_CONTACTS, Margin};

/// A pose in which the object hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HangingPose {
    /// Where to let the object go: maps object coordinates to supporter coordinates; metres. `T_ij` of section II-D, or as close
    /// to where it comes to rest as the clearance allows.
    pub pose: Pose,
    /// What gravity then makes of it, if gravity was asked ([`Params::settle`](crate::Params::settle)).
    pub rest: Option<Rest>,
    /// The sites that it joins, if it comes from the paper's matching ([`Candidates::Sites`](crate::Candidates::Sites)).
    pub matched: Option<SiteMatch>,
}

impl Default for HangingPose {
    fn default() -> Self {
        Self { pose: Pose::identity(), rest: None, matched: None }
    }
}

/// An object site on a support site: section II-D.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SiteMatch {
    /// What it costs.
    pub cost: Cost,
    /// Index among [`Object::sites`](super::Object::sites).
    pub object_site: u32,
    /// Index among [`Supporter::sites`](super::Supporter::sites).
    pub support_site: u32,
    /// Whether the object's hanging direction is laid against the supporter's instead of along it.
    pub is_reversed: bool,
}

impl SiteMatch {
    /// The order of the ranking: by total cost, then by sites, so that it is the same however it is computed.
    pub(super) fn is_better(&self, other: &Self) -> bool {
        let sites = |m: &Self| (m.support_site, m.object_site, m.is_reversed);
        self.cost.total.total_cmp(&other.cost.total).then(sites(self).cmp(&sites(other))).is_lt()
    }
}

/// Where a released object comes to rest, and how firmly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Maps object coordinates to supporter coordinates; metres.
    pub pose: Pose,
    /// How far the centre of mass sinks from the release to there, metres.
    pub sinking: f32,
    /// How far the object is off the supporter where it is let go, metres: [`Params::clearance`](crate::Params::clearance), or less
    /// where there is no room.
    pub clearance: f32,
    /// The probability that it hangs and stays.
    pub probability: f32,
    /// By how much it stays.
    pub margin: Margin,
    contacts: [Contact; MAX_CONTACTS],
    contact_count: u32,
}

impl Rest {
    pub(super) fn new(pose: Pose, sinking: f32, clearance: f32, firmness: &Firmness) -> Self {
        let Firmness { margin, contacts: bearing } = firmness;
        let mut contacts = [Contact::default(); MAX_CONTACTS];
        contacts[..bearing.len()].copy_from_slice(bearing);
        let probability = probability::of(margin, clearance);
        let contact_count = bearing.len() as u32;
        Self { pose, sinking, clearance, probability, margin: *margin, contacts, contact_count }
    }

    /// Where the supporter bears the object at rest.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts[..self.contact_count as usize]
    }

    /// Whether another pose is the same, as far as a robot cares.
    pub(super) fn is_like(&self, other: &Pose, centre: &Point) -> bool {
        let apart = self.pose * centre - other * centre;
        apart.norm() < 0.005 && self.pose.rotation.angle_to(&other.rotation) < 0.1
    }
}
