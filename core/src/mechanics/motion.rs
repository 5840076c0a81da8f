//! The simulation of the body, one time step at a time.

use super::body::State;
use super::constants::{CONTACT_MARGIN, DRAG, GRAVITY, SPIN_DRAG, SWING_DRAG, SWING_SPIN_DRAG};
use super::contact::Contacts;
use super::neighbourhood::{Neighbourhood, Sleep};
use super::solver::{self, Impulses};
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// Friction, damping, time step and rest criterion of a simulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Coulomb's coefficient of friction.
    pub(crate) friction: f32,
    /// Damping rate of the centre of mass while there is contact, 1/s.
    pub(crate) drag: f32,
    /// Damping rate of the rotation while there is contact, 1/s.
    pub(crate) spin_drag: f32,
    /// Gap that contacts keep, metres: nothing for what rests.
    pub(crate) gap: f32,
    /// [`Params::time_step`], s.
    pub(crate) time_step: f32,
    /// [`Params::settle_time`], s.
    pub(crate) settle_time: f32,
    /// [`Params::rest_speed`], m/s.
    pub(crate) rest_speed: f32,
}

impl Settings {
    /// Strong damping, for finding rest poses. It changes where a body rests only if the equilibrium is
    /// barely stable.
    pub(crate) fn damped(params: &Params) -> Self {
        Self::new(params, DRAG, SPIN_DRAG)
    }

    /// Realistic damping, of friction and impacts: the agreement with Bullet determined its rates.
    pub(crate) fn swinging(params: &Params) -> Self {
        Self::new(params, SWING_DRAG, SWING_SPIN_DRAG)
    }

    /// No damping: only friction ends a swing.
    pub(crate) fn undamped(params: &Params) -> Self {
        Self::new(params, 0.0, 0.0)
    }

    /// Strong damping and no friction, at a distance from the supporter, for what is pulled off.
    pub(super) fn pulled(params: &Params, gap: f32) -> Self {
        Self { friction: 0.0, gap, ..Self::damped(params) }
    }

    fn new(params: &Params, drag: f32, spin_drag: f32) -> Self {
        let &Params { friction, time_step, settle_time, rest_speed, .. } = params;
        Self { friction, drag, spin_drag, gap: 0.0, time_step, settle_time, rest_speed }
    }

    /// Number of time steps in `seconds`, rounded.
    pub(super) fn steps(&self, seconds: f32) -> usize {
        libm::roundf(seconds / self.time_step) as usize
    }

    /// Gap below which a contact at rest is kept, metres: [`CONTACT_MARGIN`], and the distance that gravity closes
    /// in the two steps for which contacts are used, `g (2 dt)² / 2`.
    fn contact_margin(&self) -> f32 {
        CONTACT_MARGIN + self.gap + 2.0 * self.time_step * self.time_step * GRAVITY
    }
}

/// A body that moves under gravity, in contact with a supporter.
pub(crate) struct Motion<'a, 's> {
    pub(crate) state: State,
    /// Whether any contact carried the body in the last step.
    pub(crate) touches: bool,
    pub(super) settings: Settings,
    body: &'a Body<'a>,
    support: &'a Support<'a>,
    contacts: Contacts,
    impulses: Impulses,
    neighbourhood: Neighbourhood<'s>,
}

impl<'a, 's> Motion<'a, 's> {
    /// Starts at `state`. `sleeps` is working memory of [`Support::sleepers`] elements.
    pub(crate) fn new(
        (body, support): (&'a Body, &'a Support),
        state: State,
        settings: Settings,
        sleeps: &'s mut [Sleep],
    ) -> Self {
        Self {
            state,
            touches: false,
            settings,
            body,
            support,
            contacts: Contacts::new(),
            impulses: Impulses::new(),
            neighbourhood: Neighbourhood::new(sleeps),
        }
    }

    /// Advances by one time step with semi-implicit Euler; `gravity` is in m/s². The gyroscopic term is left
    /// out: a body that spins fast enough for it to matter does not hang.
    pub(crate) fn step(&mut self, gravity: &Vector, meter: &mut Meter) -> Result<(), Stop> {
        let Settings { friction, drag, spin_drag, gap, time_step: dt, .. } = self.settings;
        let (body, state) = (self.body, &mut self.state);
        let scene = (body, self.support);
        let margin = self.settings.contact_margin();
        self.neighbourhood.update(&mut self.contacts, scene, state, (margin, dt), meter)?;
        state.velocity += gravity * dt;
        let inverse_inertia = body.inverse_inertia_in(state);
        self.impulses =
            solver::solve(state, &inverse_inertia, &self.contacts, &self.impulses, (friction, gap), dt);
        self.touches = self.impulses.iter().any(|impulse| impulse.normal > 0.0);
        if self.touches {
            state.velocity *= 1.0 / (1.0 + drag * dt);
            state.spin *= 1.0 / (1.0 + spin_drag * dt);
        }
        let (mut shift, mut turn) = (state.velocity * dt, state.spin * dt);
        if self.contacts.iter().any(|contact| contact.gap < gap) {
            let (shift_out, turn_out) = solver::separate(state, &inverse_inertia, &self.contacts, gap);
            shift += shift_out;
            turn += turn_out;
        }
        // The impulses on a body that is kilometres away from what it touches grow beyond all numbers. It stays where it was, and
        // rests nowhere.
        if !(shift.norm_squared() + turn.norm_squared()).is_finite() {
            self.touches = false;
            return Ok(());
        }
        self.neighbourhood.record_motion(state, &shift, &turn);
        state.advance(&shift, &turn);
        Ok(())
    }

    /// The contacts that carried the body in the last step: position, contact normal, and normal force in
    /// multiples of the weight.
    pub(crate) fn loaded_contacts(&self) -> impl Iterator<Item = (Point, Vector, f32)> + '_ {
        let weight = self.settings.time_step * GRAVITY;
        let loaded = self.contacts.iter().zip(&self.impulses).filter(|(_, impulse)| impulse.normal > 0.0);
        loaded.map(move |(contact, impulse)| (contact.position, contact.normal, impulse.normal / weight))
    }
}
