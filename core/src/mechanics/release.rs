//! From where to let go so that the object comes to rest as found: a little off every contact.

use super::contact::Contacts;
use super::neighbourhood::{Neighbourhood, Sleep};
use super::{Body, Support, solver};
use crate::geometry::{Pose, Vector};
use crate::monitor::{Meter, Stop};

/// Moves the body from `rest` to where every gap is at least `clearance` metres, or as close to that as there is room.
/// Returns the pose and its least gap, at most `clearance`.
pub(crate) fn release_pose(
    scene: (&Body, &Support),
    rest: &Pose,
    clearance: f32,
    up: &Vector,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<(Pose, f32), Stop> {
    /// First straight up, which is how an object is taken off,
    const LIFTS: usize = 10;
    /// and then to wherever there is room.
    const STEPS: usize = 30;
    let body = scene.0;
    let mut state = body.at(rest);
    let mut neighbourhood = Neighbourhood::new(sleeps);
    let mut contacts = Contacts::new();
    let mut best = (*rest, f32::NEG_INFINITY);
    for step in 0..STEPS {
        neighbourhood.update(&mut contacts, scene, &state, (clearance, 0.0), meter)?;
        // Beyond its band the field may say no more than that something is there.
        let to_object = body.pose(&state).inverse();
        let far = 0.9 * body.field.band();
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
        let (shift, turn) = if step < LIFTS {
            (up * (clearance - gap).min(0.0005), Vector::zeros())
        } else {
            solver::separate(&state, &body.inverse_inertia_in(&state), &contacts, clearance + 2e-4)
        };
        neighbourhood.moves(&state, &shift, &turn);
        state.advance(&shift, &turn);
    }
    Ok(best)
}
