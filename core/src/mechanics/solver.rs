//! Contact impulses of one time step: projected Gauss-Seidel on velocities with Coulomb's friction cone.

use super::body::State;
use super::constants::{
    CORRECTION_SWEEPS, MAX_SOLVER_CONTACTS, PENETRATION_CORRECTION, PENETRATION_SLOP, SOLVER_SWEEPS,
    SOLVER_TOLERANCE,
};
use super::contact::{Contact, Contacts};
use crate::geometry::{Vector, any_perpendicular};
use heapless::Vec;
use nalgebra::Matrix3;

/// Impulse of a contact in the last step: the warm start of the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impulse {
    /// Index of the patch.
    pub(crate) index: u32,
    /// Impulse along the contact normal, m/s for the unit mass.
    pub(crate) normal: f32,
    /// Friction impulse in supporter coordinates, m/s for the unit mass.
    pub(crate) friction: Vector,
}

pub(crate) type Impulses = Vec<Impulse, MAX_SOLVER_CONTACTS>;

/// The unknowns and coefficients of one contact. Arrays of three are along the normal and the two tangents.
struct Row {
    /// Contact point relative to the centre of mass, metres.
    arm: Vector,
    normal: Vector,
    tangents: [Vector; 2],
    /// Change of the angular velocity by a unit impulse.
    twist: [Vector; 3],
    /// Effective mass, of the unit mass.
    mass: [f32; 3],
    /// Least velocity along the normal, m/s: the contact closes exactly its gap.
    bound: f32,
    /// Accumulated impulse, m/s for the unit mass.
    impulse: [f32; 3],
}

/// Changes the velocities of `state` so that no contact closes by more than its gap within `dt` seconds, no
/// contact pulls, and friction stays in Coulomb's cone. Returns the impulses; those of the last step,
/// `before`, are the warm start.
pub(crate) fn solve(
    state: &mut State,
    inverse_inertia: &Matrix3<f32>,
    contacts: &Contacts,
    before: &Impulses,
    (friction, gap): (f32, f32),
    dt: f32,
) -> Impulses {
    let mut rows = Vec::<Row, MAX_SOLVER_CONTACTS>::new();
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
        let bound = -(contact.gap - gap).max(0.0) / dt;
        for k in 0..3 {
            state.velocity += directions[k] * impulse[k];
            state.spin += twist[k] * impulse[k];
        }
        let _ = rows.push(Row { arm, normal, tangents, twist, mass, bound, impulse });
    }
    for _ in 0..SOLVER_SWEEPS {
        let mut largest_change = 0.0_f32;
        for row in &mut rows {
            let velocity = state.velocity_at(&row.arm);
            // Friction first: the normal condition must hold at the end of the sweep.
            let wanted =
                [0, 1].map(|k| row.impulse[k + 1] - velocity.dot(&row.tangents[k]) * row.mass[k + 1]);
            let limit = friction * row.impulse[0];
            let length = libm::sqrtf(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
            let scale = if length > limit { limit / length } else { 1.0 };
            for (k, wanted) in wanted.into_iter().enumerate() {
                let change = wanted * scale - row.impulse[k + 1];
                row.impulse[k + 1] += change;
                largest_change = largest_change.max(change.abs());
                state.velocity += row.tangents[k] * change;
                state.spin += row.twist[k + 1] * change;
            }
            let velocity = state.velocity_at(&row.arm);
            let wanted = row.impulse[0] + (row.bound - velocity.dot(&row.normal)) * row.mass[0];
            let change = wanted.max(0.0) - row.impulse[0];
            row.impulse[0] += change;
            largest_change = largest_change.max(change.abs());
            state.velocity += row.normal * change;
            state.spin += row.twist[0] * change;
        }
        if largest_change < SOLVER_TOLERANCE {
            break;
        }
    }
    let mut impulses = Impulses::new();
    for (contact, row) in contacts.iter().zip(&rows) {
        // There are no more rows than impulses fit.
        let _ = impulses.push(Impulse {
            index: contact.index,
            normal: row.impulse[0],
            friction: row.tangents[0] * row.impulse[1] + row.tangents[1] * row.impulse[2],
        });
    }
    impulses
}

/// Returns the displacement, metres, and the rotation vector, radians, that correct a fraction of the
/// penetration: they move every gap towards at least `target` metres, less the slop. Velocities do not
/// change.
pub(crate) fn separate(
    state: &State,
    inverse_inertia: &Matrix3<f32>,
    contacts: &[Contact],
    target: f32,
) -> (Vector, Vector) {
    let (mut shift, mut turn) = (Vector::zeros(), Vector::zeros());
    let mut pushes = [0.0_f32; MAX_SOLVER_CONTACTS];
    for _ in 0..CORRECTION_SWEEPS {
        for (contact, push) in contacts.iter().zip(&mut pushes) {
            let missing = (target - PENETRATION_SLOP - contact.gap) * PENETRATION_CORRECTION;
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
