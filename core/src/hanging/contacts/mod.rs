//! Our method: contact candidates of the object are laid on contact candidates of the supporter, about the true centre
//! of mass, and gravity decides which of the poses hang.
//!
//! | step | file |
//! |---|---|
//! | contact candidates of the object | `object_contact.rs` |
//! | contact candidates of the supporter | `support_contact.rs` |
//! | poses that lay one on the other, clear of the supporter, the most promising first | `candidates.rs` |
//! | their release, one after the other, until enough of them hang | `search.rs` |
//! | the constants of all of these | `constants.rs` |

mod candidates;
mod constants;
mod counts;
mod object_contact;
mod search;
mod support_contact;

pub use counts::{CandidateCounts, Counts, ObjectCounts, SupporterCounts};
pub use object_contact::ObjectContact;
pub(super) use search::{search, search_bytes};
pub use support_contact::SupportContact;

use super::samples::{ObjectSamples, SupporterCloud};
use crate::geometry::{Mesh, Point, Vector};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop};
use crate::perception::sampling;

/// Bytes of the contacts of an object.
pub(super) const fn object_bytes() -> usize {
    array_bytes::<ObjectContact>(constants::MAX_OBJECT_CONTACTS)
}

/// Memory for the contacts of an object.
pub(super) fn object_slots<'m>(arena: &mut Arena<'m>) -> Result<&'m mut [ObjectContact], OutOfMemory> {
    arena.slice(constants::MAX_OBJECT_CONTACTS)
}

/// Draws independent samples: contacts keep their distance as they are found, so that the samples need not.
pub(super) fn sample(
    mesh: &Mesh,
    seed: u64,
    points: &mut [Point],
    normals: &mut [Vector],
    meter: &Meter,
) -> Result<(), Stop> {
    sampling::scatter_into(mesh, seed, points, normals, meter)
}

/// Fills `slots` with the object's contacts, the deepest capture first. `Some` says why the search ended early.
pub(super) fn find_on_object(
    samples: &ObjectSamples,
    slots: &mut [ObjectContact],
    meter: &mut Meter,
) -> (ObjectCounts, Option<Stop>) {
    object_contact::Search { samples }.find(slots, meter)
}

/// Bytes of the contacts of a supporter.
pub(super) const fn supporter_bytes() -> usize {
    array_bytes::<SupportContact>(constants::MAX_SUPPORT_CONTACTS)
}

/// Memory for the contacts of a supporter.
pub(super) fn supporter_slots<'m>(arena: &mut Arena<'m>) -> Result<&'m mut [SupportContact], OutOfMemory> {
    arena.slice(constants::MAX_SUPPORT_CONTACTS)
}

/// Fills `slots` with the supporter's contacts. `Some` says why the search ended early.
pub(super) fn find_on_supporter(
    cloud: &SupporterCloud,
    slots: &mut [SupportContact],
    meter: &mut Meter,
) -> (SupporterCounts, Option<Stop>) {
    let up = cloud.params.up();
    let SupporterCloud { tree, normals, is_excluded, .. } = *cloud;
    support_contact::Search { tree, normals, is_excluded, up }.find(slots, meter)
}
