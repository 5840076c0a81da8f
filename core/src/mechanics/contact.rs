//! The contacts that a step is solved for.

use super::body::State;
use super::touch::{Nearest, refine};
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use heapless::Vec;
use nalgebra::Rotation3;

/// Contacts solved for at once, at most; a rigid body needs no more than a handful.
pub(crate) const MOST: usize = 12;

/// A place where the body is at, or close to, the supporter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// Of the supporter's patch.
    pub(crate) index: u32,
    /// Supporter coordinates, metres.
    pub(crate) position: Point,
    /// Unit vector along which the supporter pushes the body.
    pub(crate) normal: Vector,
    /// Distance between the surfaces, negative in penetration, metres.
    pub(crate) gap: f32,
    /// Where on the patch, along and across it, metres.
    on_patch: [f32; 2],
    /// The touched point of the body against its centre of mass, in its own coordinates.
    pub(super) anchor: Vector,
    /// The gap less the anchor's place along the normal: what stays while the normal does.
    offset: f32,
}

pub(crate) type Contacts = Vec<Contact, MOST>;

/// A body that the patch's push would bring closer, by more than this cosine, is behind the patch: it touches another side of the
/// supporter, not this one,
const BEHIND: f32 = 0.3;
/// unless it is less than so many voxels away: then it is a sheet without an inside, whose gap is positive on either side, that has
/// begun to pass through.
const SHEET: f32 = 0.5;

impl Contact {
    /// Of a patch with what is nearest to it, if they touch on that side.
    pub(super) fn new(
        (body, support): (&Body, &Support),
        state: &State,
        index: usize,
        &Nearest { at, offset: on_patch, gap, gradient }: &Nearest,
    ) -> Option<Self> {
        let gradient = state.rotation * gradient;
        let normal = support.patches[index].push(-gradient, on_patch);
        let is_behind = gap > 0.0 && normal.dot(&gradient) > BEHIND;
        if is_behind && gap > SHEET * body.field.voxel_size() {
            return None;
        }
        let gap = if is_behind { -gap } else { gap };
        let anchor = at - body.centre;
        let position = state.centre + state.rotation * anchor;
        let offset = gap - position.coords.dot(&normal);
        Some(Self { index: index as u32, position, normal, gap, on_patch, anchor, offset })
    }

    /// Asks the body's surface itself instead of its field; false if it turns out that they touch on another side.
    pub(super) fn refine(
        &mut self,
        scene: (&Body, &Support),
        state: &State,
        rotation: &Rotation3<f32>,
    ) -> bool {
        let ((body, support), index) = (scene, self.index as usize);
        let place = body.centre + rotation.inverse_transform_vector(&(support.place(index) - state.centre));
        let gradient = -rotation.inverse_transform_vector(&self.normal);
        let found = Nearest { at: body.centre + self.anchor, offset: self.on_patch, gap: self.gap, gradient };
        let nearest = refine(body, &support.patches[index], rotation, &place, found);
        let refined = Self::new(scene, state, index, &nearest);
        if let Some(contact) = refined {
            *self = contact;
        }
        refined.is_some()
    }

    /// Goes along with the body to `state`; `rotation` is that of the state.
    pub(super) fn carry(&mut self, state: &State, rotation: &Rotation3<f32>) {
        self.position = state.centre + rotation * self.anchor;
        // The supporter stands still: the gap opens by what the touched point moved along the normal.
        self.gap = self.offset + self.position.coords.dot(&self.normal);
    }
}

/// Contacts closer to each other than this, metres, and with similar normals are one.
const APART: f32 = 0.003;

/// Adds a contact unless a deeper one stands for it.
pub(super) fn keep(contacts: &mut Contacts, contact: Contact) {
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
