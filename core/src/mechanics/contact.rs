//! Where the object and the supporter touch.

use super::Body;
use super::body::State;
use crate::geometry::{Point, PointTree, Vector};
use bytemuck::{Pod, Zeroable};
use heapless::Vec;

/// The supporter as mechanics sees it: points that stand for discs of its surface.
#[derive(Clone, Copy)]
pub struct Support<'a> {
    /// The points.
    pub tree: &'a PointTree<'a>,
    /// Unit normals in tree order.
    pub normals: &'a [Vector],
    /// Radius of the disc around each point, metres.
    pub disc: f32,
    /// Which points stand for their neighbours: not zero.
    pub is_chosen: &'a [u8],
}

/// Contacts solved for at once, at most; a rigid body needs no more than a handful.
pub(crate) const MAX_CONTACTS: usize = 12;

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

pub(crate) type Contacts = Vec<Contact, MAX_CONTACTS>;

/// A point of the supporter near the body, and how far the body may move before it can touch it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Near {
    index: u32,
    /// The odometer below which it cannot be in contact.
    sleeps_until: f32,
}

/// The points of the supporter near the body, kept between steps.
pub(crate) struct Neighbourhood<'s> {
    near: &'s mut [Near],
    count: usize,
    /// How far any point of the body can have moved since the start, metres.
    odometer: f32,
    /// The odometer up to which the last contacts can be carried along.
    carried_until: f32,
    /// The odometer up to which no point outside the list can be in contact.
    valid_until: f32,
    /// Whether there were more points near than the list holds.
    pub(crate) is_crowded: bool,
}

/// How far around the body points are gathered, metres.
const SURROUNDINGS: f32 = 0.02;

impl<'s> Neighbourhood<'s> {
    pub(crate) fn new(near: &'s mut [Near]) -> Self {
        Self { near, count: 0, odometer: 0.0, carried_until: -1.0, valid_until: -1.0, is_crowded: false }
    }

    /// Tells that no point of the body moved farther than `distance` since the last call.
    pub(crate) fn moved(&mut self, distance: f32) {
        self.odometer += distance;
    }

    fn gather(&mut self, body: &Body, support: &Support, state: &State, reach: f32) {
        self.count = 0;
        DEBUG[4].fetch_add(1, core::sync::atomic::Ordering::Relaxed);
        let surroundings = SURROUNDINGS.max(2.0 * reach);
        let to_object = body.pose(state).inverse();
        support.tree.bvh().descend(|_, node| {
            let aabb = node.aabb();
            let radius = 0.5 * aabb.diagonal();
            if body.field.distance(&(to_object * aabb.centre())) - radius > surroundings {
                return false;
            }
            for index in node.items().into_iter().flatten().filter(|&i| support.is_chosen[i] > 0) {
                if self.count < self.near.len() {
                    self.near[self.count] = Near { index: index as u32, sleeps_until: -1.0 };
                    self.count += 1;
                } else {
                    self.is_crowded = true;
                }
            }
            true
        });
        self.valid_until = self.odometer + surroundings - reach;
    }

    /// Brings `contacts` up to date: those with a gap below `margin`, at most [`MAX_CONTACTS`] that stand for all.
    pub(crate) fn update(
        &mut self,
        contacts: &mut Contacts,
        body: &Body,
        support: &Support,
        state: &State,
        margin: f32,
        time_step: f32,
    ) {
        let rotation = state.rotation.to_rotation_matrix();
        if self.odometer <= self.carried_until {
            for contact in contacts.iter_mut() {
                contact.position = state.centre + rotation * contact.anchor;
                // The supporter stands still: what the touched point moved along the normal opens or closes the gap.
                contact.gap = contact.offset + contact.position.coords.dot(&contact.normal);
            }
            return;
        }
        let margin = margin + CARRY;
        self.carried_until = self.odometer + CARRY;
        // A disc's rim comes nearer than its centre.
        let reach = margin + support.disc;
        if self.odometer > self.valid_until {
            self.gather(body, support, state, reach);
        }
        contacts.clear();
        DEBUG[0].fetch_add(1, core::sync::atomic::Ordering::Relaxed);
        for near in &mut self.near[..self.count] {
            if near.sleeps_until > self.odometer {
                continue;
            }
            DEBUG[1].fetch_add(1, core::sync::atomic::Ordering::Relaxed);
            let point = support.tree.points()[near.index as usize];
            let arm = point - state.centre;
            // What is near a pivot hardly moves, however fast the rest does.
            let margin = margin + (state.velocity + state.spin.cross(&arm)).norm() * time_step;
            let reach = margin + support.disc;
            let mut at = body.centre + rotation.inverse_transform_vector(&arm);
            let (mut gap, mut gradient) = body.field.sample(&at);
            if gap > reach {
                near.sleeps_until = self.odometer + gap - reach;
                continue;
            }
            let normal = rotation.inverse_transform_vector(&support.normals[near.index as usize]);
            let slope = gradient - normal * gradient.dot(&normal);
            let least = gap - support.disc * slope.norm();
            if least > margin {
                near.sleeps_until = self.odometer + least - margin;
                continue;
            }
            if gap > -0.001 {
                let (best, found) = nearest_on_disc(body, at, gap, gradient, &normal, support.disc);
                (at, gap, gradient) = (best, found.0, found.1);
            }
            if gap > margin {
                near.sleeps_until = self.odometer + gap - margin;
                continue;
            }
            DEBUG[2].fetch_add(1, core::sync::atomic::Ordering::Relaxed);
            let normal = -(rotation * gradient);
            let anchor = at - body.centre;
            let position = state.centre + rotation * anchor;
            let offset = gap - position.coords.dot(&normal);
            keep(contacts, Contact { index: near.index, position, normal, gap, anchor, offset });
        }
    }
}

/// How far the body may move before contacts are looked for again, metres.
const CARRY: f32 = 0.0002;
/// dbg
pub static DEBUG: [core::sync::atomic::AtomicU64; 6] = [const { core::sync::atomic::AtomicU64::new(0) }; 6];

/// The point of the disc around `at` that is nearest to, or deepest in, the body.
fn nearest_on_disc(
    body: &Body,
    at: Point,
    gap: f32,
    gradient: Vector,
    normal: &Vector,
    radius: f32,
) -> (Point, (f32, Vector)) {
    let (mut best, mut found) = (at, (gap, gradient));
    for _ in 0..1 {
        let slope = found.1 - normal * found.1.dot(normal);
        let steepness = slope.norm();
        if steepness < 0.1 {
            break;
        }
        // On a round body of this radius the foot of the perpendicular is about that far.
        const ROUNDNESS: f32 = 0.002;
        let step = slope * (-(found.0.max(0.0) + ROUNDNESS));
        let mut candidate = best + step;
        let offset = candidate - at;
        let distance = offset.norm();
        if distance > radius {
            candidate = at + offset * (radius / distance);
        }
        let sample = body.field.sample(&candidate);
        if sample.0 >= found.0 {
            break;
        }
        (best, found) = (candidate, sample);
    }
    (best, found)
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
        // Full: the one that is farthest off makes way.
        let farthest = (0..contacts.len()).max_by(|&a, &b| contacts[a].gap.total_cmp(&contacts[b].gap));
        if let Some(place) = farthest
            && contact.gap < contacts[place].gap
        {
            contacts[place] = contact;
        }
    }
}
