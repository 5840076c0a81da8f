//! Where a released object comes to rest, and how firmly.

use super::probability::{self, Given};
use crate::geometry::{Pose, Symmetry, Vector, least_angle};
use crate::hanging::request::Distance;
use crate::mechanics::{Body, Contact, Frames, Kind, MAX_CONTACTS, Margin, Unseen};

/// How far the object may be from its release pose when it is let go, in any direction: it still touches nothing, and comes to
/// rest as it would have. An error of the position and one of the rotation add up: half of either is fine together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tolerance {
    /// Displacement, metres.
    pub position: f32,
    /// Rotation about the centre of mass, radians.
    pub rotation: f32,
}

/// Where a released object comes to rest, and how firmly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Maps object coordinates to supporter coordinates; metres.
    pub pose: Pose,
    /// How the object hangs.
    pub kind: Kind,
    /// How far the centre of mass sinks from the release pose to the rest pose, metres.
    pub sinking: f32,
    /// Distance from the supporter at the release pose, metres: [`Params::clearance`](crate::Params::clearance), or
    /// less where there is no room.
    pub clearance: f32,
    /// How far the object may be from the release pose when it is let go.
    pub tolerance: Tolerance,
    /// The probability that the object hangs and stays, 0 to 1.
    pub probability: f32,
    /// The probability that it also stays when gravity tilts by 21.8 degrees towards any side, 0 to 1: what a robot that moves the
    /// supporter needs. Among poses that are sure to hang it tells which is the firmest.
    pub robustness: f32,
    /// How much of what matters at the release pose no camera has seen. The probability is lower by it.
    pub unseen: Unseen,
    /// How firmly the object stays.
    pub margin: Margin,
    /// Height of the opening of the object in which the bar lies, over the distance from the centre of mass to the farthest point;
    /// at most 1.
    pub(super) opening: f32,
    contacts: [Contact; MAX_CONTACTS],
    contact_count: u8,
    /// [`Rest::play`], micrometres.
    play: u16,
}

impl Rest {
    pub(super) fn new(
        pose: Pose,
        given: &Given,
        (sinking, opening): (f32, f32),
        tolerance: Tolerance,
        margin: Margin,
        bearing: &[Contact],
    ) -> Self {
        let mut contacts = [Contact::default(); MAX_CONTACTS];
        for (to, from) in contacts.iter_mut().zip(bearing) {
            *to = *from;
        }
        let &Given { kind, clearance, unseen, .. } = given;
        let probability = probability::of(&margin, given);
        let robustness = probability::of_robust(&margin, given);
        let contact_count = bearing.len().min(MAX_CONTACTS) as u8;
        Self {
            pose,
            kind,
            sinking,
            clearance,
            tolerance,
            probability,
            robustness,
            unseen,
            margin,
            opening,
            contacts,
            contact_count,
            play: (given.play * 1e6) as u16,
        }
    }

    /// A rest pose that another program gives, for a path to it: nothing else is known of it. All numbers are zero, and the
    /// kind is [`Kind::Balanced`], which says least.
    pub fn at(pose: Pose) -> Self {
        Self {
            pose,
            kind: Kind::Balanced,
            sinking: 0.0,
            clearance: 0.0,
            tolerance: Tolerance::default(),
            probability: 0.0,
            robustness: 0.0,
            unseen: Unseen::default(),
            margin: Margin::default(),
            opening: 0.0,
            contacts: [Contact::default(); MAX_CONTACTS],
            contact_count: 0,
            play: 0,
        }
    }

    /// The probability less a reserve, for the rank.
    pub(super) fn cautious(&self, body: &Body) -> f32 {
        let &Self { kind, clearance, unseen, .. } = self;
        let (play, centre_error) = (self.play(), body.centre_error);
        let given = Given { kind, clearance, play, centre_error, unseen, spacing: 0.0 };
        probability::cautious(&self.margin, &given)
    }

    /// Whether nothing but what nobody knows of the object and the supporter keeps the pose from being certain.
    pub(super) fn is_firm(&self) -> bool {
        probability::is_firm(&self.margin, self.clearance, &self.unseen)
    }

    /// Whether the pose is as good as ends a long search.
    pub(super) fn is_reliable(&self) -> bool {
        probability::is_reliable(&self.margin, self.clearance, &self.unseen)
    }

    /// Longest travel of the centre of mass without contact while the object is lifted off, metres, up to 4 mm. Where it is
    /// little, the object fits hardly over what it hangs on.
    pub fn play(&self) -> f32 {
        f32::from(self.play) * 1e-6
    }

    /// The contacts that carry the object at rest.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts[..self.contact_count as usize]
    }

    /// The same in the caller's coordinates.
    pub(in crate::hanging) fn outwards(mut self, frames: &Frames) -> Self {
        let to_object = frames.object.rotation.inverse();
        let to_supporter = frames.supporter.rotation.inverse();
        self.pose = frames.outwards(&self.pose);
        for contact in self.contacts.iter_mut().take(self.contact_count as usize) {
            contact.position = frames.on_supporter(&contact.position);
            contact.normal = to_supporter * contact.normal;
        }
        let Unseen { object_view, supporter_view, .. } = self.unseen;
        self.unseen.object_view = (to_object * Vector::from(object_view)).into();
        self.unseen.supporter_view = (to_supporter * Vector::from(supporter_view)).into();
        self
    }

    /// Whether another pose is closer to this rest pose than a distance, after turns of the object that its symmetries, about axes in the
    /// caller's coordinates, allow. They leave the centre of mass in place.
    pub(super) fn is_like(
        &self,
        other: &Pose,
        body: &Body,
        symmetries: &[Symmetry],
        distance: &Distance,
    ) -> bool {
        let apart = self.pose * body.centre - other * body.centre;
        let frame = body.frame.rotation;
        let rotation = frame.inverse() * self.pose.rotation.inverse() * other.rotation * frame;
        apart.norm() < distance.position && least_angle(symmetries, &rotation) < distance.rotation
    }
}
