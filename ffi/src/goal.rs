//! A pose of C as the goal of a path.

use crate::border::input;
use crate::failure::{Failure, Place};
use crate::pose::{HANGPOSE_MAX_CONTACTS, hangpose_contact, hangpose_pose, pose_of};
use hangpose_core::geometry::{MAX_COORDINATE, Pose};
use hangpose_core::hanging::{HangingPose, Rest};
use hangpose_core::mechanics::Contact;

/// Name of the argument in the header.
pub(crate) const GOAL: &str = "goal";

/// # Safety
///
/// The obligations of the caller, see `border`.
pub(crate) unsafe fn goal(pointer: *const hangpose_pose) -> Result<HangingPose, Failure> {
    // SAFETY: those of this function.
    let goal = unsafe { input(pointer) }.map_err(|failure| match failure {
        Failure::Null { .. } => Failure::Null { argument: GOAL },
        Failure::Misaligned { alignment, .. } => Failure::Misaligned { argument: GOAL, alignment },
        Failure::StructSize { given, expected, .. } => {
            Failure::StructSize { argument: GOAL, given, expected }
        }
        failure => failure,
    })?;
    if goal.has_pose != 1 {
        return Err(Failure::NoGoal { value: goal.has_pose });
    }
    let pose = pose("goal.position", goal.position, "goal.quaternion", goal.quaternion)?;
    let rest = match goal.has_rest {
        0 => None,
        1 => Some(rest(goal)?),
        value => return Err(Failure::Choice { field: "goal.has_rest", value, most: 1 }),
    };
    Ok(HangingPose { pose, rest, matched: None })
}

/// Where the object rests, and the contacts that carry it; the planner needs no more.
fn rest(goal: &hangpose_pose) -> Result<Rest, Failure> {
    let pose = pose("goal.rest_position", goal.rest_position, "goal.rest_quaternion", goal.rest_quaternion)?;
    let count = goal.contact_count as usize;
    let Some(given) = goal.contacts.get(..count) else {
        return Err(Failure::Count { field: "goal.contact_count", count, most: HANGPOSE_MAX_CONTACTS });
    };
    let is_number = |contact: &hangpose_contact| {
        contact.position.iter().chain(&contact.normal).all(|x| x.abs() <= MAX_COORDINATE)
            && contact.force.is_finite()
    };
    if let Some(index) = given.iter().position(|contact| !is_number(contact)) {
        let place = Place { index: Some(index), ..Place::of("goal.contacts") };
        return Err(Failure::Goal { spot: place.into() });
    }
    let mut contacts = [Contact::default(); HANGPOSE_MAX_CONTACTS];
    for (slot, &hangpose_contact { position, normal, force }) in contacts.iter_mut().zip(given) {
        *slot = Contact { position: position.into(), normal: normal.into(), force };
    }
    Ok(Rest::at(pose, &contacts[..count]))
}

fn pose(
    position_field: &'static str,
    position: [f32; 3],
    quaternion_field: &'static str,
    quaternion: [f32; 4],
) -> Result<Pose, Failure> {
    let wrong = |place: Place| Failure::Goal { spot: place.into() };
    if !position.iter().all(|x| x.abs() <= MAX_COORDINATE) {
        return Err(wrong(Place::of(position_field).coordinate(None, position)));
    }
    pose_of(position, quaternion).ok_or_else(|| wrong(Place::of(quaternion_field)))
}
