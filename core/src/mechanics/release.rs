//! The release pose of a rest pose: clear of every contact, and close to the rest pose.

use super::constants::{FIELD_BAND_RATIO, RELEASE_EXCESS, RELEASE_LIFT, RELEASE_LIFTS, RELEASE_STEPS};
use super::contact::Contacts;
use super::neighbourhood::{Neighbourhood, Sleep};
use super::{Body, Support, solver};
use crate::geometry::{Pose, Vector};
use crate::monitor::{Meter, Stop};

/// Moves the body from the rest pose `rest` until every gap is at least `clearance` metres, or as close to
/// that as the supporter permits: first straight up, which is how an object is taken off, then out of the
/// contacts in any direction. Returns the pose, object to supporter coordinates, and its least gap, at most
/// `clearance`.
pub(crate) fn release_pose(
    scene: (&Body, &Support),
    rest: &Pose,
    clearance: f32,
    up: &Vector,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<(Pose, f32), Stop> {
    let body = scene.0;
    let mut state = body.at(rest);
    let mut neighbourhood = Neighbourhood::new(sleeps);
    let mut contacts = Contacts::new();
    let mut best = (*rest, f32::NEG_INFINITY);
    for step in 0..RELEASE_STEPS {
        neighbourhood.update(&mut contacts, scene, &state, (clearance, 0.0), meter)?;
        // Beyond its band the field is only a lower bound: measure larger gaps on the mesh.
        let to_object = body.pose(&state).inverse();
        let far = FIELD_BAND_RATIO * body.field.band();
        for contact in contacts.iter_mut().filter(|contact| contact.gap > far) {
            meter.distance_queries(1)?;
            let at = to_object * contact.position;
            contact.gap = contact.gap.max((body.surface.closest_point(&at) - at).norm());
        }
        let gap = contacts.iter().map(|contact| contact.gap).fold(clearance, f32::min);
        if gap > best.1 {
            best = (body.pose(&state), gap);
        }
        if gap >= clearance {
            break;
        }
        let (shift, turn) = if step < RELEASE_LIFTS {
            (up * (clearance - gap).min(RELEASE_LIFT), Vector::zeros())
        } else {
            solver::separate(&state, &body.inverse_inertia_in(&state), &contacts, clearance + RELEASE_EXCESS)
        };
        neighbourhood.record_motion(&state, &shift, &turn);
        state.advance(&shift, &turn);
    }
    Ok(best)
}
