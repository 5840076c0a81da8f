//! The contacts that a step is solved for.

use crate::geometry::{Point, Vector};
use heapless::Vec;

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
    /// The touched point of the body against its centre of mass, in its own coordinates.
    pub(super) anchor: Vector,
    /// The gap less the anchor's place along the normal: what stays while the normal does.
    pub(super) offset: f32,
}

pub(crate) type Contacts = Vec<Contact, MOST>;

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
