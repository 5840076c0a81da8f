//! From where to let go so that the object comes to rest as found: a little off every contact.

use super::contact::{Contacts, Near, Neighbourhood};
use super::settle::world_inertia;
use super::{Body, Support, solver};
use crate::geometry::{Pose, Vector};

/// Moves the body from `rest` to where every gap is at least `clearance` metres, or as close to that as there is room.
/// Returns the pose and the least gap.
pub fn release_pose(
    body: &Body,
    support: &Support,
    rest: &Pose,
    clearance: f32,
    up: &Vector,
    near: &mut [Near],
) -> (Pose, f32) {
    const STEPS: usize = 30;
    let mut state = body.at(rest);
    let mut neighbourhood = Neighbourhood::new(near);
    let mut contacts = Contacts::new();
    let mut best = (*rest, f32::NEG_INFINITY);
    for step in 0..STEPS {
        neighbourhood.update(&mut contacts, body, support, &state, clearance, 0.0);
        let gap = contacts.iter().map(|c| c.gap).fold(clearance, f32::min);
        if gap > best.1 {
            best = (body.pose(&state), gap);
        }
        if contacts.is_empty() {
            break;
        }
        // Straight up first: that is how an object is put down.
        let (mut shift, mut turn) = (up * (clearance - gap).min(0.0005), Vector::zeros());
        if step >= STEPS / 3 {
            (shift, turn) =
                solver::separate(&state, &world_inertia(body, &state), &contacts, clearance + 2e-4);
        }
        state.advance(&shift, &turn);
        neighbourhood.moved(shift.norm() + turn.norm() * body.reach);
    }
    best
}
