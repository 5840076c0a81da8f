//! Which patches of the supporter may touch the body, kept between steps.

use super::body::State;
use super::contact::{Contact, Contacts, keep};
use super::odometer::Odometer;
use super::touch::nearest_on_patch;
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};

/// How far the body may move before it can touch something: a patch of the supporter, or any of a group.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Sleep {
    /// What can come to it before the odometer starts anew is not farther than this from the pivot, metres.
    radius: f32,
    /// The reading of the odometer for that radius up to which it cannot be in contact.
    until: f32,
}

impl Sleep {
    /// Goes on by an odometer that starts anew, after another; what sleeps is within `extent` metres of `place`.
    fn restart(&mut self, before: &Odometer, now: &Odometer, state: &State, place: &Point, extent: f32) {
        let left = self.until - before.reading(self.radius);
        *self = Self { radius: now.radius(state, place) + extent + MOST_WAY, until: left };
    }
}

/// What is asleep, and what sleeps until when.
pub(crate) struct Neighbourhood<'s> {
    /// The patches', and after them the groups'.
    sleeps: &'s mut [Sleep],
    odometer: Odometer,
    /// Whether the pivot is where the body is held; `None` as long as there is none.
    is_held: Option<bool>,
    /// How often the last contacts may still be carried along,
    carries: u8,
    /// and the reading for the whole body up to which they may.
    carried_until: f32,
}

/// The pivot moves no farther than this, metres, before the odometer starts anew.
const MOST_WAY: f32 = 0.006;

/// Contacts are looked for again after they were carried along for so many steps,
const CARRIES: u8 = 1;
/// or when any point of the body may have moved farther than this, metres.
const CARRY: f32 = 0.003;

impl<'s> Neighbourhood<'s> {
    /// Everything is awake. `sleeps` is working memory, of [`Support::sleepers`].
    pub(crate) fn new(sleeps: &'s mut [Sleep]) -> Self {
        sleeps.fill(Sleep { radius: 0.0, until: f32::NEG_INFINITY });
        let odometer = Odometer::new(Vector::zeros());
        Self { sleeps, odometer, is_held: None, carries: 0, carried_until: -1.0 }
    }

    /// Tells by what displacement and rotation vector the body moves on from `state`.
    pub(crate) fn moves(&mut self, state: &State, shift: &Vector, turn: &Vector) {
        self.odometer.add(state, shift, turn);
    }

    /// The next contacts are looked for, not carried along.
    #[cfg(test)]
    pub(super) fn carry_no_more(&mut self) {
        self.carries = 0;
    }

    /// Starts the odometer anew, with the pivot where the body is held.
    fn restart(&mut self, contacts: &Contacts, support: &Support, state: &State) {
        let anchors: Vector = contacts.iter().map(|contact| contact.anchor).sum();
        let before =
            core::mem::replace(&mut self.odometer, Odometer::new(anchors / contacts.len().max(1) as f32));
        self.is_held = Some(!contacts.is_empty());
        let (patches, groups) = self.sleeps.split_at_mut(support.patches.len());
        for (sleep, place) in patches.iter_mut().zip(support.places()) {
            sleep.restart(&before, &self.odometer, state, &place, 0.0);
        }
        for (sleep, group) in groups.iter_mut().zip(support.groups) {
            sleep.restart(&before, &self.odometer, state, &group.centre, group.radius);
        }
        self.carries = 0;
    }

    /// Brings `contacts` up to date: those whose gap may fall below `margin` metres in the steps of `time_step` seconds until
    /// they are looked for again, at most [`MOST`](super::contact::MOST) that stand for all.
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
        let is_badly_held = self.is_held.is_none_or(|is_held| !is_held && !contacts.is_empty());
        if is_badly_held || self.odometer.reading(0.0) > MOST_WAY {
            self.restart(contacts, support, state);
        }
        let whole = self.odometer.greatest_radius(body.reach);
        if self.carries > 0 && self.odometer.reading(whole) <= self.carried_until {
            self.carries -= 1;
            contacts.iter_mut().for_each(|contact| contact.carry(state, &rotation));
            return Ok(());
        }
        let horizon = f32::from(1 + CARRIES) * time_step;
        let closing = |speed: f32| (speed * horizon).min(CARRY + speed * time_step);
        (self.carries, self.carried_until) = (CARRIES, self.odometer.reading(whole) + CARRY);
        contacts.clear();
        let mut queries = 0;
        let (patches, groups) = self.sleeps.split_at_mut(support.patches.len());
        for (group, group_sleep) in support.groups.iter().zip(groups) {
            let reading = self.odometer.reading(group_sleep.radius);
            if group_sleep.until > reading {
                continue;
            }
            let arm = group.centre - state.centre;
            let speed = state.velocity_at(&arm).norm() + state.spin.norm() * group.radius;
            let most = group.radius + margin + closing(speed);
            let at = body.centre + rotation.inverse_transform_vector(&arm);
            queries += 1;
            let distance = body.field.distance(&at);
            if distance > most {
                group_sleep.until = reading + distance - most;
                continue;
            }
            for index in group.patches() {
                let sleep = &mut patches[index];
                let reading = self.odometer.reading(sleep.radius);
                if sleep.until > reading {
                    continue;
                }
                let arm = support.place(index) - state.centre;
                // What is near a pivot hardly moves, however fast the rest does.
                let margin = margin + closing(state.velocity_at(&arm).norm());
                let at = body.centre + rotation.inverse_transform_vector(&arm);
                queries += 1;
                match nearest_on_patch(body, &support.patches[index], &rotation, &at, margin) {
                    Err(way) => sleep.until = reading + way,
                    Ok(nearest) => {
                        queries += 1;
                        if nearest.gap <= margin
                            && let Some(contact) = Contact::new(scene, state, index, &nearest)
                        {
                            keep(contacts, contact);
                        }
                    }
                }
            }
        }
        queries += contacts.len();
        contacts.retain_mut(|contact| contact.refine(scene, state, &rotation));
        meter.distance_queries(queries)
    }
}
