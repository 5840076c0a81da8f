//! What becomes of the object when it is let go.

use super::body::State;
use super::contact::{Contacts, Near, Neighbourhood};
use super::solver::{self, Impulses};
use super::{Body, Support};
use crate::geometry::{Pose, Vector};
use nalgebra::Matrix3;

/// How gravity and friction act.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// m/s², in supporter coordinates.
    pub gravity: Vector,
    /// Coulomb's coefficient.
    pub friction: f32,
    /// Seconds a step.
    pub time_step: f32,
    /// At most.
    pub steps: usize,
    /// Rates at which motion and rotation die down while there is contact, 1/s.
    pub damping: [f32; 2],
}

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It rests on the supporter.
    Rests,
    /// It has sunk too far.
    Falls,
    /// It still moved when the steps were used up, or is wedged.
    Moves,
}

/// Where it ended, and how.
#[derive(Clone, Copy, Debug)]
pub struct Settled {
    /// How.
    pub fate: Fate,
    /// Object to supporter.
    pub pose: Pose,
    /// How far the centre of mass sank along gravity, metres.
    pub sank: f32,
    /// Radians between start and end.
    pub turned: f32,
    /// Steps taken.
    pub steps: usize,
    /// Contacts at the end.
    pub contacts: usize,
}

/// Below this motion of any point over the window, it rests.
const WINDOW: usize = 20;
const STILL: f32 = 0.0004;

/// Lets the body go at `release`.
pub fn settle(body: &Body, support: &Support, release: &Pose, settings: &Settings, near: &mut [Near]) -> Settled {
    let mut state = body.at(release);
    let start = state;
    let down = settings.gravity.normalize();
    let limit = 0.06_f32.max(0.5 * body.extent);
    let dt = settings.time_step;
    let mut neighbourhood = Neighbourhood::new(near);
    let mut impulses = Impulses::new();
    let mut mark = state;
    let mut contacts = Contacts::new();
    let mut fate = Fate::Moves;
    let mut steps = 0;
    let keep = settings.damping.map(|rate| 1.0 / (1.0 + rate * dt));
    while steps < settings.steps {
        steps += 1;
        let speed = state.velocity.norm() + state.spin.norm() * body.reach;
        let margin = 0.0005 + dt * (speed + dt * 9.81);
        contacts = neighbourhood.contacts(body, support, &state, margin);
        state.velocity += settings.gravity * dt;
        let inverse = world_inertia(body, &state);
        impulses = solver::solve(&mut state, &inverse, &contacts, &impulses, settings.friction, dt);
        let touches = impulses.iter().any(|i| i.normal > 0.0);
        if touches {
            state.velocity *= keep[0];
            state.spin *= keep[1];
        }
        let (mut shift, mut turn) = (state.velocity * dt, state.spin * dt);
        if contacts.iter().any(|c| c.gap < 0.0) {
            let (s, t) = solver::separate(&state, &inverse, &contacts, 0.0);
            shift += s;
            turn += t;
        }
        state.advance(&shift, &turn);
        neighbourhood.moved(shift.norm() + turn.norm() * body.reach);
        let sank = down.dot(&(state.centre - start.centre));
        if sank > limit {
            fate = Fate::Falls;
            break;
        }
        if steps % WINDOW == 0 {
            let moved = (state.centre - mark.centre).norm()
                + state.rotation.angle_to(&mark.rotation) * body.reach;
            if touches && moved < STILL {
                fate = Fate::Rests;
                break;
            }
            mark = state;
        }
    }
    Settled {
        fate,
        pose: body.pose(&state),
        sank: down.dot(&(state.centre - start.centre)),
        turned: start.rotation.angle_to(&state.rotation),
        steps,
        contacts: contacts.len(),
    }
}

pub(crate) fn world_inertia(body: &Body, state: &State) -> Matrix3<f32> {
    let rotation = state.rotation.to_rotation_matrix();
    rotation.matrix() * body.inverse_inertia * rotation.matrix().transpose()
}
