//! The search for contacts: patches of the supporter that cannot touch the body yet are skipped between
//! steps.

use super::body::State;
use super::constants::{CARRIED_STEPS, CARRY_TRAVEL, PIVOT_TRAVEL};
use super::contact::{Contact, Contacts, add_contact};
use super::odometer::Odometer;
use super::touch::nearest_on_patch;
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};
use nalgebra::Rotation3;

/// Sleep of a patch or a group of patches: the distance that the body must travel before it can touch it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Sleep {
    /// Upper bound of the distance from the pivot to the points of the body that can reach it before the
    /// odometer restarts, metres.
    radius: f32,
    /// Reading of the odometer at `radius` up to which there can be no contact, metres.
    until: f32,
}

impl Sleep {
    /// Converts the sleep from the odometer `before` to one that starts at zero with its pivot at `pivot`. The patches are
    /// within `extent` metres of `centre`.
    fn restart(&mut self, before: &Odometer, pivot: &Point, centre: &Point, extent: f32) {
        let left = self.until - before.reading(self.radius);
        *self = Self { radius: (centre - pivot).norm() + extent + PIVOT_TRAVEL, until: left };
    }
}

/// [`Sleep::until`] of a group of which a patch is near the body.
const OPEN: f32 = f32::NEG_INFINITY;

/// State of the search for contacts.
pub(crate) struct Neighbourhood<'s> {
    /// Sleeps of the patches, followed by those of the groups.
    sleeps: &'s mut [Sleep],
    odometer: Odometer,
    /// Whether the pivot of the odometer is at contacts; `None` before the first update.
    is_pivot_at_contacts: Option<bool>,
    /// Number of steps for which the current contacts may still move along with the body.
    carries_left: u8,
    /// Reading of the odometer for the whole body up to which they may, metres.
    carry_limit: f32,
}

impl<'s> Neighbourhood<'s> {
    /// Starts with all patches awake. `sleeps` is working memory of [`Support::sleepers`] elements.
    pub(crate) fn new(sleeps: &'s mut [Sleep]) -> Self {
        sleeps.fill(Sleep::default());
        let odometer = Odometer::new(Vector::zeros());
        Self { sleeps, odometer, is_pivot_at_contacts: None, carries_left: 0, carry_limit: -1.0 }
    }

    /// Records a motion of the body from `state`: displacement, metres, and rotation vector, radians.
    pub(crate) fn record_motion(&mut self, state: &State, shift: &Vector, turn: &Vector) {
        self.odometer.add(state, shift, turn);
    }

    /// Forces a search for contacts in the next update.
    #[cfg(test)]
    pub(super) fn force_search(&mut self) {
        self.carries_left = 0;
    }

    /// Restarts the odometer with the pivot at the mean contact point, where a hanging body moves least.
    fn restart(&mut self, contacts: &Contacts, support: &Support, state: &State) {
        let anchors: Vector = contacts.iter().map(|contact| contact.anchor).sum();
        let before =
            core::mem::replace(&mut self.odometer, Odometer::new(anchors / contacts.len().max(1) as f32));
        self.is_pivot_at_contacts = Some(!contacts.is_empty());
        let pivot = self.odometer.pivot(state);
        let count = support.patches.len();
        debug_assert!(self.sleeps.len() >= Support::sleepers(count));
        let (patches, groups) = self.sleeps.split_at_mut_checked(count).unwrap_or_default();
        for (sleep, position) in patches.iter_mut().zip(support.positions()) {
            sleep.restart(&before, &pivot, &position, 0.0);
        }
        for (sleep, group) in groups.iter_mut().zip(support.groups) {
            sleep.restart(&before, &pivot, &group.centre, group.radius);
        }
        self.carries_left = 0;
    }

    /// Updates `contacts` for `state`. They are the contacts whose gap may fall below `margin` metres in the
    /// steps of `time_step` seconds until the next search. If there are more than the list holds, a spread
    /// subset remains.
    ///
    /// Between searches the contacts move along with the body, for [`CARRIED_STEPS`] steps or until a point
    /// of the body may have moved by [`CARRY_TRAVEL`].
    pub(crate) fn update(
        &mut self,
        contacts: &mut Contacts,
        scene: (&Body, &Support),
        state: &State,
        (margin, time_step): (f32, f32),
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        let (body, support) = scene;
        let rotation = state.rotation.to_rotation_matrix();
        let is_pivot_off_contacts =
            self.is_pivot_at_contacts.is_none_or(|at_contacts| !at_contacts && !contacts.is_empty());
        if is_pivot_off_contacts || self.odometer.reading(0.0) > PIVOT_TRAVEL {
            self.restart(contacts, support, state);
        }
        let whole = self.odometer.max_radius(body.reach);
        if self.carries_left > 0 && self.odometer.reading(whole) <= self.carry_limit {
            self.carries_left -= 1;
            contacts.iter_mut().for_each(|contact| contact.move_with_body(state, &rotation));
            return Ok(());
        }
        let horizon = f32::from(1 + CARRIED_STEPS) * time_step;
        let closing = |speed: f32| (speed * horizon).min(CARRY_TRAVEL + speed * time_step);
        self.carries_left = CARRIED_STEPS;
        self.carry_limit = self.odometer.reading(whole) + CARRY_TRAVEL;
        let search = Search { scene, state, rotation: &rotation, margin, closing: &closing };
        let mut queries = 0;
        contacts.clear();
        let count = support.patches.len();
        debug_assert!(self.sleeps.len() >= Support::sleepers(count));
        let (patches, groups) = self.sleeps.split_at_mut_checked(count).unwrap_or_default();
        for (group, group_sleep) in support.groups.iter().zip(groups) {
            let reading = self.odometer.reading(group_sleep.radius);
            if group_sleep.until > reading {
                continue;
            }
            let is_awake = |sleep: &&Sleep| sleep.until <= self.odometer.reading(sleep.radius);
            // One patch is searched as fast as the group is tested.
            if group_sleep.until != OPEN && patches[group.patches()].iter().filter(is_awake).count() > 1 {
                let arm = group.centre - state.centre;
                let speed = state.velocity_at(&arm).norm() + state.spin.norm() * group.radius;
                let reach = group.radius + margin + closing(speed);
                let at = body.centre + rotation.inverse_transform_vector(&arm);
                queries += 1;
                let distance = body.field.distance(&at);
                if distance > reach {
                    group_sleep.until = reading + distance - reach;
                    continue;
                }
            }
            // Distance that the body must travel before the first patch of the group is searched again.
            let mut slack = f32::INFINITY;
            for index in group.patches() {
                let sleep = &mut patches[index];
                let reading = self.odometer.reading(sleep.radius);
                if sleep.until > reading {
                    slack = slack.min(sleep.until - reading);
                    continue;
                }
                queries += 1;
                match search.nearest(index) {
                    Err(travel) => {
                        sleep.until = reading + travel;
                        slack = slack.min(travel);
                    }
                    Ok(contact) => {
                        slack = 0.0;
                        if let Some(contact) = contact {
                            queries += 1;
                            add_contact(contacts, contact);
                        }
                    }
                }
            }
            group_sleep.until = if slack > 0.0 { reading + slack } else { OPEN };
        }
        queries += contacts.len();
        contacts.retain_mut(|contact| contact.refine(scene, state, &rotation));
        meter.distance_queries(queries)
    }
}

/// The search for contacts in one state.
struct Search<'a, C> {
    scene: (&'a Body<'a>, &'a Support<'a>),
    state: &'a State,
    rotation: &'a Rotation3<f32>,
    /// Gap up to which a contact at rest is kept, metres.
    margin: f32,
    /// Distance by which a gap that closes with a speed may close until the next search, metres.
    closing: C,
}

impl<C: Fn(f32) -> f32> Search<'_, C> {
    /// The contact of a patch that may touch until the next search, if the patch faces the body.
    ///
    /// # Errors
    ///
    /// If the patch is farther away: the distance that the body must travel first, metres.
    fn nearest(&self, index: usize) -> Result<Option<Contact>, f32> {
        let Self { scene: (body, support), state, rotation, .. } = *self;
        let (position, patch) = (support.position(index), &support.patches[index]);
        let arm = position - state.centre;
        // A point near the pivot hardly moves, however fast the rest of the body does.
        let velocity = state.velocity_at(&arm);
        // Only motion along the gradient closes a gap. Where there is no gradient, any may.
        let margin = |gradient: &Vector| {
            let is_known = *gradient != Vector::zeros();
            let speed = if is_known { gradient.dot(&velocity).max(0.0) } else { velocity.norm() };
            self.margin + (self.closing)(speed)
        };
        let at = body.centre + rotation.inverse_transform_vector(&arm);
        let nearest = nearest_on_patch(body, patch, rotation, &at, margin)?;
        let is_near = nearest.gap <= margin(&(rotation * nearest.gradient));
        Ok(is_near.then(|| Contact::new(self.scene, state, index, &nearest)).flatten())
    }
}
