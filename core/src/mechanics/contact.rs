//! Where the body and the supporter touch.

use super::body::State;
use super::odometer::Odometer;
use super::patch::Patch;
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};
use heapless::Vec;
use nalgebra::Rotation3;

/// Contacts solved for at once, at most; a rigid body needs no more than a handful.
pub(crate) const MOST: usize = 12;

/// A place where the body is at, or close to, the supporter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// Of the supporter's point, in tree order.
    pub(crate) index: u32,
    /// Supporter coordinates, metres.
    pub(crate) position: Point,
    /// Unit vector along which the supporter pushes the body.
    pub(crate) normal: Vector,
    /// Distance between the surfaces, negative in penetration, metres.
    pub(crate) gap: f32,
    /// The touched point of the body against its centre of mass, in its own coordinates.
    anchor: Vector,
    /// The gap less the anchor's place along the normal: what stays while the normal does.
    offset: f32,
}

pub(crate) type Contacts = Vec<Contact, MOST>;

/// A point of the supporter near the body, and how far the body may move before it can touch it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Near {
    index: u32,
    /// No part of the body that can come to it within the list's life is farther than this from the pivot, metres.
    radius: f32,
    /// The reading of the odometer for that radius up to which it cannot be in contact.
    sleeps_until: f32,
}

/// The points of the supporter near the body, kept between steps.
pub(crate) struct Neighbourhood<'s> {
    near: &'s mut [Near],
    count: usize,
    /// Since the list was made.
    odometer: Odometer,
    /// How often the last contacts may still be carried along,
    carries: u8,
    /// and the reading for the whole body up to which they may.
    carried_until: f32,
    /// The reading for the whole body up to which no point outside the list can be in contact.
    valid_until: f32,
}

/// How far around the body points are gathered, metres.
const SURROUNDINGS: f32 = 0.03;

impl<'s> Neighbourhood<'s> {
    pub(crate) fn new(near: &'s mut [Near]) -> Self {
        let odometer = Odometer::new(Vector::zeros());
        Self { near, count: 0, odometer, carries: 0, carried_until: -1.0, valid_until: -1.0 }
    }

    /// Tells by what displacement and rotation vector the body moves on from `state`.
    pub(crate) fn moves(&mut self, state: &State, shift: &Vector, turn: &Vector) {
        self.odometer.add(state, shift, turn);
    }

    /// Lists the representatives around the body, so that nothing farther off is looked at for a while.
    fn gather(
        &mut self,
        contacts: &Contacts,
        (body, support): (&Body, &Support),
        state: &State,
        reach: f32,
    ) -> usize {
        let surroundings = SURROUNDINGS.max(2.0 * reach);
        let anchors: Vector = contacts.iter().map(|contact| contact.anchor).sum();
        self.odometer = Odometer::new(anchors / contacts.len().max(1) as f32);
        let to_object = body.pose(state).inverse();
        let mut queries = 0;
        self.count = 0;
        support.tree.bvh().descend(|_, node| {
            let aabb = node.aabb();
            queries += 1;
            let (centre, limit) = (to_object * aabb.centre(), surroundings + 0.5 * aabb.diagonal());
            if body.is_beyond(&centre, limit) || body.field.distance(&centre) > limit {
                return false;
            }
            for index in node.items().into_iter().flatten().filter(|&i| !support.patches[i].is_empty()) {
                let radius = self.odometer.radius(state, &support.tree.points()[index]) + surroundings;
                self.near[self.count] = Near { index: index as u32, radius, sleeps_until: -1.0 };
                self.count += 1;
            }
            true
        });
        self.valid_until = surroundings - reach;
        queries
    }

    /// Brings `contacts` up to date: those whose gap may fall below `margin` metres in the steps of `time_step` seconds until
    /// they are looked for again, at most [`MOST`] that stand for all.
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
        let whole = self.odometer.greatest_radius(body.reach);
        if self.carries > 0 && self.odometer.reading(whole) <= self.carried_until {
            self.carries -= 1;
            for contact in contacts.iter_mut() {
                contact.position = state.centre + rotation * contact.anchor;
                // The supporter stands still: the gap opens by what the touched point moved along the normal.
                contact.gap = contact.offset + contact.position.coords.dot(&contact.normal);
            }
            return Ok(());
        }
        let horizon = f32::from(1 + CARRIES) * time_step;
        let closing = |speed: f32| (speed * horizon).min(CARRY + speed * time_step);
        let mut queries = 0;
        if self.odometer.reading(whole) > self.valid_until {
            queries += self.gather(contacts, scene, state, margin + support.reach);
        }
        (self.carries, self.carried_until) = (CARRIES, self.odometer.reading(whole) + CARRY);
        contacts.clear();
        for near in &mut self.near[..self.count] {
            let reading = self.odometer.reading(near.radius);
            if near.sleeps_until > reading {
                continue;
            }
            let index = near.index as usize;
            let arm = support.tree.points()[index] - state.centre;
            // What is near a pivot hardly moves, however fast the rest does.
            let margin = margin + closing(state.velocity_at(&arm).norm());
            let at = body.centre + rotation.inverse_transform_vector(&arm);
            queries += 1;
            let patch = &support.patches[index];
            let sleep = |bound: f32| reading + (bound - patch.reach() - margin).max(0.0);
            let nearest = match nearest_on_patch(body, patch, &rotation, &at, margin) {
                Ok(nearest) => nearest,
                Err(bound) => {
                    near.sleeps_until = sleep(bound);
                    continue;
                }
            };
            queries += 1;
            if nearest.gap > margin {
                continue;
            }
            let Nearest { at, mut gap, .. } = nearest;
            let normal = patch.push(-nearest.gradient, &nearest.step);
            if gap > 0.0 && normal.dot(&nearest.gradient) > BEHIND {
                if gap > SHEET * body.field.voxel_size() {
                    continue;
                }
                gap = -gap;
            }
            let anchor = at - body.centre;
            let position = state.centre + rotation * anchor;
            let offset = gap - position.coords.dot(&normal);
            keep(contacts, Contact { index: near.index, position, normal, gap, anchor, offset });
        }
        meter.distance_queries(queries)
    }
}

/// A body that the patch's push would bring closer, by more than this cosine, is behind the patch: it touches another side of the
/// supporter, not this one,
const BEHIND: f32 = 0.3;
/// unless it is less than so many voxels away: then it is a sheet without an inside, whose gap is positive on either side, that has
/// begun to pass through.
const SHEET: f32 = 0.5;
/// Contacts are looked for again after they were carried along for so many steps,
const CARRIES: u8 = 1;
/// or when any point of the body may have moved farther than this, metres.
const CARRY: f32 = 0.003;

/// Where a patch is nearest to, or deepest in, the body.
pub(super) struct Nearest {
    /// In object coordinates.
    at: Point,
    /// From the patch's point, in supporter coordinates.
    pub(super) step: Vector,
    /// Between the surfaces, metres, and its gradient in supporter coordinates.
    pub(super) gap: f32,
    gradient: Vector,
}

impl Nearest {
    /// At a step from the patch's point, which is `at`, with the field there.
    fn new(at: &Point, step: Vector, (gap, gradient): (f32, Vector), rotation: &Rotation3<f32>) -> Self {
        let at = at + rotation.inverse_transform_vector(&step);
        Self { at, step, gap, gradient: rotation * gradient }
    }
}

/// Looks for that place from the patch's point `at`, in object coordinates; `rotation` is the object's. If no part of the patch is
/// closer than `margin` metres, as far as the field can tell from there, says how far the point is at least.
pub(super) fn nearest_on_patch(
    body: &Body,
    patch: &Patch,
    rotation: &Rotation3<f32>,
    at: &Point,
    margin: f32,
) -> Result<Nearest, f32> {
    let stations = || {
        let all = patch.stations().filter_map(|station| {
            let there = at + rotation.inverse_transform_vector(&station);
            let (gap, gradient) = body.field.sample(&there);
            if gap < 0.0 {
                return Some(Nearest::new(at, station, (gap - patch.wire_radius(), gradient), rotation));
            }
            let step = patch.facing(station, &(rotation * gradient));
            let there = at + rotation.inverse_transform_vector(&step);
            Some(Nearest::new(at, step, body.field.sample_near(&there).ok()?, rotation))
        });
        all.min_by(|a, b| a.gap.total_cmp(&b.gap))
    };
    let start = match body.field.sample_near(at) {
        Err(bound) if bound > patch.reach() + margin => return Err(bound),
        // The field is exact close to the body only, and a long patch may pass it far from its point.
        Err(bound) => stations().ok_or(bound)?,
        Ok((gap, _)) if patch.is_all_around() => return stations().ok_or(gap),
        Ok(sample) => Nearest::new(at, Vector::zeros(), sample, rotation),
    };
    if patch.is_all_around() {
        return Ok(start);
    }
    // The rim of a patch comes closer than its point, by about this.
    if start.gap - patch.fall(&start.gradient) > margin {
        return if start.step == Vector::zeros() { Err(start.gap) } else { Ok(start) };
    }
    Ok(descend(body, patch, rotation, at, start))
}

/// The place where a patch touches is looked for in so many steps at most,
const DESCENTS: usize = 4;
/// until it is flat there: a slope below this,
const FLAT: f32 = 0.02;
/// and of strides up to so many times as long as first thought.
const LONGEST_STRIDE: f32 = 4.0;
/// What leads uphill was too far by this.
const SHORTER: f32 = 0.3;

/// Goes on from a place of a patch to the nearest one, by the secant method in either direction.
fn descend(body: &Body, patch: &Patch, rotation: &Rotation3<f32>, at: &Point, start: Nearest) -> Nearest {
    let mut nearest = start;
    let first = patch.strides(&nearest.step);
    let (mut strides, mut slope) = (first, patch.slope(&nearest.step, &nearest.gradient));
    for _ in 0..DESCENTS {
        let way: [f32; 2] = core::array::from_fn(|k| -strides[k] * slope[k]);
        let step = patch.moved(&nearest.step, way);
        let there = at + rotation.inverse_transform_vector(&step);
        let next = Nearest::new(at, step, body.field.sample(&there), rotation);
        if next.gap >= nearest.gap {
            strides = strides.map(|stride| stride * SHORTER);
            continue;
        }
        let next_slope = patch.slope(&next.step, &next.gradient);
        nearest = next;
        for k in 0..2 {
            let change = next_slope[k] - slope[k];
            if change * way[k] > 0.0 {
                strides[k] = (way[k] / change).min(first[k] * LONGEST_STRIDE);
            }
        }
        slope = next_slope;
        if slope.iter().all(|slope| slope.abs() < FLAT) {
            break;
        }
    }
    nearest
}

/// Contacts closer to each other than this, metres, and with similar normals are one.
const APART: f32 = 0.003;

/// Adds a contact unless a deeper one stands for it.
fn keep(contacts: &mut Contacts, contact: Contact) {
    let same = contacts.iter().position(|other| {
        (other.position - contact.position).norm_squared() < APART * APART
            && other.normal.dot(&contact.normal) > 0.9
    });
    if let Some(place) = same {
        if contact.gap < contacts[place].gap {
            contacts[place] = contact;
        }
        return;
    }
    if let Err(contact) = contacts.push(contact) {
        make_room(contacts, contact);
    }
}

/// Puts a contact into a full list. Of the two that say most nearly the same, the one that is farther off makes way: where flat lies
/// on flat the corners matter, and the deepest points, all near one corner today and another tomorrow, would rock it about.
fn make_room(contacts: &mut Contacts, contact: Contact) {
    // Of two at one place, one on each side of a bar, both matter.
    let unlike =
        |a: &Contact, b: &Contact| (a.position - b.position).norm_squared() * (2.0 - a.normal.dot(&b.normal));
    let at = |contacts: &Contacts, i: usize| contacts.get(i).copied().unwrap_or(contact);
    let (mut least, mut pair) = (f32::INFINITY, [0, 0]);
    for a in 0..=contacts.len() {
        for b in 0..a {
            let distance = unlike(&at(contacts, a), &at(contacts, b));
            if distance < least {
                (least, pair) = (distance, [a, b]);
            }
        }
    }
    let [a, b] = pair;
    let goes = if at(contacts, a).gap >= at(contacts, b).gap { a } else { b };
    if let Some(slot) = contacts.get_mut(goes) {
        *slot = contact;
    }
}
