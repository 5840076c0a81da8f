//! How far the object may be from its release pose when it is let go.

use super::rest::Tolerance;
use crate::geometry::Pose;
use crate::mechanics::{Body, Contact, Margin};

/// Share of the clearance that an error of the position may use up: the rest is for the errors of the cloud and the mesh.
const USABLE_CLEARANCE: f32 = 0.9;
/// Share of the error of the centre of mass that is tolerated. A displacement of the object against the contacts shifts its
/// weight as such an error does.
const USABLE_RADIUS: f32 = 0.5;

/// The tolerance of a pose with `clearance` metres between object and supporter at release, and these contacts at rest.
///
/// An object that is displaced by less than the clearance, in any direction, touches nothing. A rotation about the centre of mass
/// moves the points near the contacts by the angle times their distance from it.
pub(super) fn of(
    body: &Body,
    rest: &Pose,
    clearance: f32,
    margin: &Margin,
    contacts: &[Contact],
) -> Tolerance {
    let position = (USABLE_CLEARANCE * clearance).min(USABLE_RADIUS * margin.centre_of_mass_radius);
    let centre = rest * body.centre;
    let arm = contacts.iter().map(|contact| (contact.position - centre).norm()).fold(0.0, f32::max);
    Tolerance { position, rotation: if arm > 0.0 { position / arm } else { 0.0 } }
}
