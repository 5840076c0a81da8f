//! The body in motion, a step at a time.

use super::body::State;
use super::contact::Contacts;
use super::neighbourhood::{Neighbourhood, Sleep};
use super::solver::{self, Impulses};
use super::{Body, GRAVITY, Support};
use crate::geometry::{Point, Vector};
use crate::monitor::{Meter, Stop};

/// How the body rubs and comes to rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Coulomb's coefficient.
    pub(crate) friction: f32,
    /// The rate at which the centre of mass loses speed while there is contact, 1/s.
    pub(crate) drag: f32,
    /// The rate at which rotation dies down while there is contact, 1/s.
    pub(crate) spin_drag: f32,
}

impl Settings {
    /// Swings out fast, which does not change where it comes to rest but for what is hardly stable.
    pub(crate) fn damped(friction: f32) -> Self {
        Self { friction, drag: 2.0, spin_drag: 15.0 }
    }

    /// Swings out as things do that rub and lose a little at each blow: found by what agrees with Bullet.
    pub(crate) fn swinging(friction: f32) -> Self {
        Self { friction, drag: 0.1, spin_drag: 1.5 }
    }

    /// Swings until friction stops it.
    pub(crate) fn undamped(friction: f32) -> Self {
        Self { friction, drag: 0.0, spin_drag: 0.0 }
    }
}

/// Seconds a step. Contacts bear because of the gap that they may close in it, so that none is missed.
pub(crate) const TIME_STEP: f32 = 0.004;

/// Contacts are kept while their gap is below this, metres, so that what rests does not lose and regain them; and gravity may close
/// them by the rest in three steps, one more than they are used for.
const NEAR_CONTACT: f32 = 0.0003 + 4.5 * TIME_STEP * TIME_STEP * GRAVITY;

pub(crate) struct Motion<'a, 's> {
    pub(crate) state: State,
    /// Whether the supporter bore any of the body in the last step.
    pub(crate) touches: bool,
    body: &'a Body<'a>,
    support: &'a Support<'a>,
    settings: Settings,
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
        const DT: f32 = TIME_STEP;
        let (body, state) = (self.body, &mut self.state);
        let scene = (body, self.support);
        self.neighbourhood.update(&mut self.contacts, scene, state, (NEAR_CONTACT, DT), meter)?;
        state.velocity += gravity * DT;
        let inverse_inertia = body.inverse_inertia_in(state);
        self.impulses = solver::solve(
            state,
            &inverse_inertia,
            &self.contacts,
            &self.impulses,
            self.settings.friction,
            DT,
        );
        self.touches = self.impulses.iter().any(|impulse| impulse.normal > 0.0);
        if self.touches {
            state.velocity *= 1.0 / (1.0 + self.settings.drag * DT);
            state.spin *= 1.0 / (1.0 + self.settings.spin_drag * DT);
        }
        let (mut shift, mut turn) = (state.velocity * DT, state.spin * DT);
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
        self.contacts.iter().zip(&self.impulses).filter(|(_, impulse)| impulse.normal > 0.0).map(
            |(contact, impulse)| (contact.position, contact.normal, impulse.normal / (TIME_STEP * GRAVITY)),
        )
    }
}
