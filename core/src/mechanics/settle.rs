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

/// The body in motion.
pub(crate) struct Motion<'a, 's> {
    pub(crate) body: &'a Body<'a>,
    pub(crate) support: &'a Support<'a>,
    pub(crate) state: State,
    pub(crate) touches: bool,
    pub(crate) contacts: Contacts,
    neighbourhood: Neighbourhood<'s>,
    impulses: Impulses,
}

impl<'a, 's> Motion<'a, 's> {
    pub(crate) fn new(body: &'a Body, support: &'a Support, state: State, near: &'s mut [Near]) -> Self {
        Self {
            body,
            support,
            state,
            touches: false,
            contacts: Contacts::new(),
            neighbourhood: Neighbourhood::new(near),
            impulses: Impulses::new(),
        }
    }

    pub(crate) fn step(&mut self, gravity: &Vector, settings: &Settings) {
        let (state, body, dt) = (&mut self.state, self.body, settings.time_step);
        let margin = 0.0003 + dt * dt * 9.81;
        self.neighbourhood.update(&mut self.contacts, body, self.support, state, margin, dt);
        state.velocity += gravity * dt;
        let inverse = world_inertia(body, state);
        self.impulses = solver::solve(state, &inverse, &self.contacts, &self.impulses, settings.friction, dt);
        self.touches = self.impulses.iter().any(|i| i.normal > 0.0);
        if self.touches {
            state.velocity *= 1.0 / (1.0 + settings.damping[0] * dt);
            state.spin *= 1.0 / (1.0 + settings.damping[1] * dt);
        }
        let (mut shift, mut turn) = (state.velocity * dt, state.spin * dt);
        if self.contacts.iter().any(|c| c.gap < 0.0) {
            let (s, t) = solver::separate(state, &inverse, &self.contacts, 0.0);
            shift += s;
            turn += t;
        }
        state.advance(&shift, &turn);
        self.neighbourhood.moved(shift.norm() + turn.norm() * body.reach);
    }
}

/// Lets the body go at `release`.
pub fn settle(body: &Body, support: &Support, release: &Pose, settings: &Settings, near: &mut [Near]) -> Settled {
    let start = body.at(release);
    let down = settings.gravity.normalize();
    let limit = 0.06_f32.max(0.5 * body.extent);
    let mut motion = Motion::new(body, support, start, near);
    let mut mark = start;
    let mut fate = Fate::Moves;
    let mut steps = 0;
    while steps < settings.steps {
        steps += 1;
        motion.step(&settings.gravity, settings);
        let state = &motion.state;
        let sank = down.dot(&(state.centre - start.centre));
        if sank > limit {
            fate = Fate::Falls;
            break;
        }
        if steps % WINDOW == 0 {
            let moved = (state.centre - mark.centre).norm()
                + state.rotation.angle_to(&mark.rotation) * body.reach;
            if motion.touches && moved < STILL {
                fate = Fate::Rests;
                break;
            }
            mark = *state;
        }
    }
    let (state, contacts) = (motion.state, motion.contacts);
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
