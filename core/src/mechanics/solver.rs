//! Impulses between the body and the supporter in one time step: projected Gauss-Seidel on velocities, Coulomb's cone.

use super::body::State;
use super::contact::{Contact, Contacts, MOST};
use crate::geometry::{Vector, any_perpendicular};
use heapless::Vec;
use nalgebra::Matrix3;

/// What a contact did in the last step, to start the next one from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impulse {
    pub(crate) index: u32,
    pub(crate) normal: f32,
    pub(crate) friction: Vector,
}

pub(crate) type Impulses = Vec<Impulse, MOST>;

struct Row {
    arm: Vector,
    normal: Vector,
    tangents: [Vector; 2],
    /// Change of spin by a unit impulse along the normal and the tangents.
    twist: [Vector; 3],
    mass: [f32; 3],
    bound: f32,
    impulse: [f32; 3],
}

/// The impulses are gone through so often at most,
const ITERATIONS: usize = 12;
/// or until none changes by more than this, metres per second for the unit mass: a fraction of a thousandth of what gravity does in a step.
const SETTLED: f32 = 1e-5;

/// Changes the velocities so that no contact closes by more than its gap in `dt`, and returns the impulses.
pub(crate) fn solve(
    state: &mut State,
    inverse_inertia: &Matrix3<f32>,
    contacts: &Contacts,
    before: &Impulses,
    friction: f32,
    dt: f32,
) -> Impulses {
    let mut rows = Vec::<Row, MOST>::new();
    for contact in contacts {
        let arm = contact.position - state.centre;
        let normal = contact.normal;
        let first = any_perpendicular(normal);
        let tangents = [first, normal.cross(&first)];
        let directions = [normal, tangents[0], tangents[1]];
        let twist = directions.map(|d| inverse_inertia * arm.cross(&d));
        let mass = core::array::from_fn(|k| 1.0 / (1.0 + arm.cross(&directions[k]).dot(&twist[k])));
        let warm = before.iter().find(|i| i.index == contact.index);
        let impulse =
            warm.map_or([0.0; 3], |i| [i.normal, i.friction.dot(&tangents[0]), i.friction.dot(&tangents[1])]);
        let bound = -contact.gap.max(0.0) / dt;
        for k in 0..3 {
            state.velocity += directions[k] * impulse[k];
            state.spin += twist[k] * impulse[k];
        }
        let _ = rows.push(Row { arm, normal, tangents, twist, mass, bound, impulse });
    }
    for _ in 0..ITERATIONS {
        let mut most_changed = 0.0_f32;
        for row in &mut rows {
            let velocity = state.velocity_at(&row.arm);
            // Friction first, so that the normal, which must hold, has the last word.
            let wanted =
                [0, 1].map(|k| row.impulse[k + 1] - velocity.dot(&row.tangents[k]) * row.mass[k + 1]);
            let most = friction * row.impulse[0];
            let length = libm::sqrtf(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
            let scale = if length > most { most / length } else { 1.0 };
            for (k, wanted) in wanted.into_iter().enumerate() {
                let change = wanted * scale - row.impulse[k + 1];
                row.impulse[k + 1] += change;
                most_changed = most_changed.max(change.abs());
                state.velocity += row.tangents[k] * change;
                state.spin += row.twist[k + 1] * change;
            }
            let velocity = state.velocity_at(&row.arm);
            let wanted = row.impulse[0] + (row.bound - velocity.dot(&row.normal)) * row.mass[0];
            let change = wanted.max(0.0) - row.impulse[0];
            row.impulse[0] += change;
            most_changed = most_changed.max(change.abs());
            state.velocity += row.normal * change;
            state.spin += row.twist[0] * change;
        }
        if most_changed < SETTLED {
            break;
        }
    }
    contacts
        .iter()
        .zip(&rows)
        .map(|(contact, row)| Impulse {
            index: contact.index,
            normal: row.impulse[0],
            friction: row.tangents[0] * row.impulse[1] + row.tangents[1] * row.impulse[2],
        })
        .collect()
}

/// Penetration that is left alone, metres, so that contacts do not come and go.
const SLOP: f32 = 1e-4;
/// The share of the rest that is taken away in a step.
const SHARE: f32 = 0.3;

/// The displacement and the rotation vector that bring the body out of what it penetrates.
pub(crate) fn separate(
    state: &State,
    inverse_inertia: &Matrix3<f32>,
    contacts: &[Contact],
    target: f32,
) -> (Vector, Vector) {
    let (mut shift, mut turn) = (Vector::zeros(), Vector::zeros());
    let mut pushes = [0.0_f32; MOST];
    for _ in 0..4 {
        for (contact, push) in contacts.iter().zip(&mut pushes) {
            let missing = (target - SLOP - contact.gap) * SHARE;
            if missing <= 0.0 && *push == 0.0 {
                continue;
            }
            let arm = contact.position - state.centre;
            let twist = inverse_inertia * arm.cross(&contact.normal);
            let mass = 1.0 / (1.0 + arm.cross(&contact.normal).dot(&twist));
            let moved = (shift + turn.cross(&arm)).dot(&contact.normal);
            let change = (*push + (missing - moved) * mass).max(0.0) - *push;
            *push += change;
            shift += contact.normal * change;
            turn += twist * change;
        }
    }
    (shift, turn)
}
