//! The body in motion, a step at a time.

use super::body::State;
use super::contact::Contacts;
use super::neighbourhood::{Neighbourhood, Sleep};
use super::solver::{self, Impulses};
use super::{Body, GRAVITY, Support};
use crate::geometry::{Point, Vector};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// How the body rubs and comes to rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Coulomb's coefficient.
    pub(crate) friction: f32,
    /// The rate at which the centre of mass loses speed while there is contact, 1/s.
    pub(crate) drag: f32,
    /// The rate at which rotation dies down while there is contact, 1/s.
    pub(crate) spin_drag: f32,
    /// [`Params::time_step`], s.
    pub(crate) time_step: f32,
    /// [`Params::settle_time`], s.
    pub(crate) settle_time: f32,
    /// [`Params::rest_speed`], m/s.
    pub(crate) rest_speed: f32,
}

impl Settings {
    /// Swings out fast, which does not change where it comes to rest but for what is hardly stable.
    pub(crate) fn damped(params: &Params) -> Self {
        Self::new(params, 2.0, 15.0)
    }

    /// Swings out as things do that rub and lose a little at each blow: found by what agrees with Bullet.
    pub(crate) fn swinging(params: &Params) -> Self {
        Self::new(params, 0.1, 1.5)
    }

    /// Swings until friction stops it.
    pub(crate) fn undamped(params: &Params) -> Self {
        Self::new(params, 0.0, 0.0)
    }

    fn new(params: &Params, drag: f32, spin_drag: f32) -> Self {
        let &Params { friction, time_step, settle_time, rest_speed, .. } = params;
        Self { friction, drag, spin_drag, time_step, settle_time, rest_speed }
    }

    /// Number of time steps in `seconds`, rounded.
    pub(super) fn steps(&self, seconds: f32) -> usize {
        libm::roundf(seconds / self.time_step) as usize
    }

    /// Gap below which a contact is kept, metres: a constant margin, so that a body at rest does not lose and regain contacts, and the
    /// distance that gravity can close in three steps (`g (3 dt)² / 2`), one step more than contacts are used for.
    fn contact_margin(&self) -> f32 {
        0.0003 + 4.5 * self.time_step * self.time_step * GRAVITY
    }
}

pub(crate) struct Motion<'a, 's> {
    pub(crate) state: State,
    /// Whether the supporter bore any of the body in the last step.
    pub(crate) touches: bool,
    body: &'a Body<'a>,
    support: &'a Support<'a>,
    pub(super) settings: Settings,
    contacts: Contacts,
    impulses: Impulses,
    neighbourhood: Neighbourhood<'s>,
}

impl<'a, 's> Motion<'a, 's> {
    /// From `state`. `sleeps` is working memory, of [`Support::sleepers`].
    pub(crate) fn new(
        (body, support): (&'a Body, &'a Support),
        state: State,
        settings: Settings,
        sleeps: &'s mut [Sleep],
    ) -> Self {
        Self {
            state,
            touches: false,
            body,
            support,
            settings,
            contacts: Contacts::new(),
            impulses: Impulses::new(),
            neighbourhood: Neighbourhood::new(sleeps),
        }
    }

    /// Lets gravity act for a step: semi-implicit Euler. The term of the gyroscope is left out: what spins so fast that it
    /// matters does not hang.
    pub(crate) fn step(&mut self, gravity: &Vector, meter: &mut Meter) -> Result<(), Stop> {
        let (body, state, dt) = (self.body, &mut self.state, self.settings.time_step);
        let margin = self.settings.contact_margin();
        let scene = (body, self.support);
        self.neighbourhood.update(&mut self.contacts, scene, state, (margin, dt), meter)?;
        state.velocity += gravity * dt;
        let inverse_inertia = body.inverse_inertia_in(state);
        self.impulses = solver::solve(
            state,
            &inverse_inertia,
            &self.contacts,
            &self.impulses,
            self.settings.friction,
            dt,
        );
        self.touches = self.impulses.iter().any(|impulse| impulse.normal > 0.0);
        if self.touches {
            state.velocity *= 1.0 / (1.0 + self.settings.drag * dt);
            state.spin *= 1.0 / (1.0 + self.settings.spin_drag * dt);
        }
        let (mut shift, mut turn) = (state.velocity * dt, state.spin * dt);
        if self.contacts.iter().any(|contact| contact.gap < 0.0) {
            let (apart, aside) = solver::separate(state, &inverse_inertia, &self.contacts, 0.0);
            shift += apart;
            turn += aside;
        }
        self.neighbourhood.moves(state, &shift, &turn);
        state.advance(&shift, &turn);
        Ok(())
    }

    /// Where the supporter bears the body: the place, the direction of its push, and its force in multiples of the weight.
    pub(crate) fn bearing(&self) -> impl Iterator<Item = (Point, Vector, f32)> + '_ {
        let weight = self.settings.time_step * GRAVITY;
        let bearing = self.contacts.iter().zip(&self.impulses).filter(|(_, impulse)| impulse.normal > 0.0);
        bearing.map(move |(contact, impulse)| (contact.position, contact.normal, impulse.normal / weight))
    }
}
