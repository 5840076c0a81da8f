//! Contacts between the body and the supporter.

use super::body::State;
use super::constants::{BEHIND_COSINE, MAX_SOLVER_CONTACTS, MERGE_COSINE, MERGE_DISTANCE, SHEET_DEPTH};
use super::touch::{Nearest, refine};
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use heapless::Vec;
use nalgebra::Rotation3;

/// A point where the body touches a patch of the supporter, or may touch it within the next steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// Index of the patch.
    pub(crate) index: u32,
    /// Position in supporter coordinates, metres.
    pub(crate) position: Point,
    /// Contact normal: the unit vector along which the supporter pushes the body, in supporter coordinates.
    pub(crate) normal: Vector,
    /// Signed distance between the surfaces, negative in penetration, metres.
    pub(crate) gap: f32,
    /// Offset on the patch, along and across it, metres.
    on_patch: [f32; 2],
    /// Contact point relative to the centre of mass, in object coordinates, metres.
    pub(super) anchor: Vector,
    /// Gap minus the component of the position along the normal, metres: constant while the contact moves
    /// along with the body.
    offset: f32,
}

pub(crate) type Contacts = Vec<Contact, MAX_SOLVER_CONTACTS>;

impl Contact {
    /// Makes a contact of a patch and its nearest point to the body.
    ///
    /// Returns `None` if the body is behind the patch: then it touches another side of the supporter. A body
    /// that is less than [`SHEET_DEPTH`] behind the patch is a sheet without an inside that has begun to pass
    /// through; its gap becomes negative.
    pub(super) fn new(
        (body, support): (&Body, &Support),
        state: &State,
        index: usize,
        &Nearest { at, offset: on_patch, gap, gradient }: &Nearest,
    ) -> Option<Self> {
        let gradient = state.rotation * gradient;
        let normal = support.patches[index].contact_normal(-gradient, on_patch);
        let is_behind = gap > 0.0 && normal.dot(&gradient) > BEHIND_COSINE;
        if is_behind && gap > SHEET_DEPTH * body.field.voxel_size() {
            return None;
        }
        let gap = if is_behind { -gap } else { gap };
        let anchor = at - body.centre;
        let position = state.centre + state.rotation * anchor;
        let offset = gap - position.coords.dot(&normal);
        Some(Self { index: index as u32, position, normal, gap, on_patch, anchor, offset })
    }

    /// Refines the contact with the mesh instead of the field. Returns false if the body turns out to be
    /// behind the patch.
    pub(super) fn refine(
        &mut self,
        scene: (&Body, &Support),
        state: &State,
        rotation: &Rotation3<f32>,
    ) -> bool {
        let ((body, support), index) = (scene, self.index as usize);
        let patch_at =
            body.centre + rotation.inverse_transform_vector(&(support.position(index) - state.centre));
        let gradient = -rotation.inverse_transform_vector(&self.normal);
        let found = Nearest { at: body.centre + self.anchor, offset: self.on_patch, gap: self.gap, gradient };
        let nearest = refine(body, &support.patches[index], rotation, &patch_at, found);
        let refined = Self::new(scene, state, index, &nearest);
        if let Some(contact) = refined {
            *self = contact;
        }
        refined.is_some()
    }

    /// Moves the contact point along with the body to `state`; `rotation` is that of the state.
    pub(super) fn move_with_body(&mut self, state: &State, rotation: &Rotation3<f32>) {
        self.position = state.centre + rotation * self.anchor;
        // The supporter is fixed: the gap grows by the displacement of the contact point along the normal.
        self.gap = self.offset + self.position.coords.dot(&self.normal);
    }
}

/// Adds a contact, or merges it with one that is close and has a similar normal; the deeper of the two
/// remains.
pub(super) fn add_contact(contacts: &mut Contacts, contact: Contact) {
    let same = contacts.iter().position(|other| {
        (other.position - contact.position).norm_squared() < MERGE_DISTANCE * MERGE_DISTANCE
            && other.normal.dot(&contact.normal) > MERGE_COSINE
    });
    if let Some(slot) = same {
        if contact.gap < contacts[slot].gap {
            contacts[slot] = contact;
        }
        return;
    }
    if let Err(contact) = contacts.push(contact) {
        replace_most_redundant(contacts, contact);
    }
}

/// Adds a contact to a full list. Of the two most similar contacts, the one with the larger gap is dropped.
///
/// Between flat faces the corners matter. The deepest contacts alone would be near one corner in one step and
/// near another in the next, and the body would rock.
fn replace_most_redundant(contacts: &mut Contacts, contact: Contact) {
    // Opposite normals, as on the two sides of a thin bar, make contacts that are close less similar.
    let dissimilarity =
        |a: &Contact, b: &Contact| (a.position - b.position).norm_squared() * (2.0 - a.normal.dot(&b.normal));
    let at = |contacts: &Contacts, i: usize| contacts.get(i).copied().unwrap_or(contact);
    let (mut least, mut pair) = (f32::INFINITY, [0, 0]);
    for a in 0..=contacts.len() {
        for b in 0..a {
            let distance = dissimilarity(&at(contacts, a), &at(contacts, b));
            if distance < least {
                (least, pair) = (distance, [a, b]);
            }
        }
    }
    let [a, b] = pair;
    let dropped = if at(contacts, a).gap >= at(contacts, b).gap { a } else { b };
    if let Some(slot) = contacts.get_mut(dropped) {
        *slot = contact;
    }
}
