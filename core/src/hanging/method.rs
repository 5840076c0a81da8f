//! The one place that knows which methods there are, and chooses by [`Params::candidates`].
//!
//! A method is a folder with the same entry points: `object_bytes`, `object_slots`, `sample` and `find_on_object`; the
//! same for a supporter; `search`, which writes poses; and `Counts::empty_stage`, which names the step that left
//! nothing.

use super::contacts::{self, ObjectContact, SupportContact};
use super::error::PredictError;
use super::found::Found;
use super::pose::HangingPose;
use super::samples::{ObjectSamples, SupporterCloud};
use super::scene::Scene;
use super::sites::{self, HangingSite, SupportSite};
use super::stage::Stage;
use crate::geometry::{Mesh, Point, Vector};
use crate::memory::{Arena, OutOfMemory};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::params::{Candidates, Params};

/// Memory for what a method keeps of an object.
pub(super) enum ObjectSlots<'m> {
    Sites(&'m mut [HangingSite]),
    Contacts(&'m mut [ObjectContact]),
}

/// What a method found on an object, in its frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum ObjectPlaces<'m> {
    /// By the published method.
    Sites {
        /// The hanging sites, the best encircled first.
        sites: &'m [HangingSite],
        /// How much was left after each step.
        counts: sites::ObjectCounts,
    },
    /// By the contact method.
    Contacts {
        /// The contact candidates, the deepest capture first.
        contacts: &'m [ObjectContact],
        /// How much was left after each step.
        counts: contacts::ObjectCounts,
    },
}

/// Bytes of what a method keeps of an object. The sum over the methods, because `Limits` do not say which one it is
/// for.
pub(super) const fn object_bytes() -> usize {
    sites::object_bytes().saturating_add(contacts::object_bytes())
}

/// Bytes of working memory for `samples` points of an object and what is found on them, for any method.
pub(super) const fn object_scratch_bytes(samples: usize) -> usize {
    // Contacts are sampled and found in place.
    sites::object_scratch_bytes(samples)
}

/// Draws points and outward normals from a mesh as the method needs them.
pub(super) fn sample(
    mesh: &Mesh,
    params: &Params,
    points: &mut [Point],
    normals: &mut [Vector],
    scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    match params.candidates {
        Candidates::Sites => sites::sample(mesh, params.seed, points, normals, scratch, meter),
        Candidates::Contacts => Ok(contacts::sample(mesh, params.seed, points, normals, meter)?),
    }
}

impl<'m> ObjectSlots<'m> {
    pub(super) fn new(params: &Params, arena: &mut Arena<'m>) -> Result<Self, OutOfMemory> {
        Ok(match params.candidates {
            Candidates::Sites => Self::Sites(sites::object_slots(arena)?),
            Candidates::Contacts => Self::Contacts(contacts::object_slots(arena)?),
        })
    }

    /// Fills the slots. `Some` says why the search ended early.
    pub(super) fn find(
        self,
        samples: &ObjectSamples,
        meter: &mut Meter,
        scratch: Arena,
    ) -> Result<(ObjectPlaces<'m>, Option<Stop>), Unfinished> {
        Ok(match self {
            Self::Sites(slots) => {
                let (counts, stop) = sites::find_on_object(samples, slots, meter, scratch)?;
                (ObjectPlaces::Sites { sites: &slots[..counts.sites], counts }, stop)
            }
            Self::Contacts(slots) => {
                let (counts, stop) = contacts::find_on_object(samples, slots, meter);
                (ObjectPlaces::Contacts { contacts: &slots[..counts.contacts], counts }, stop)
            }
        })
    }
}

impl<'m> ObjectPlaces<'m> {
    /// None by another method.
    pub(super) fn sites(&self) -> &'m [HangingSite] {
        if let Self::Sites { sites, .. } = *self { sites } else { &[] }
    }

    /// None by another method.
    pub(super) fn contacts(&self) -> &'m [ObjectContact] {
        if let Self::Contacts { contacts, .. } = *self { contacts } else { &[] }
    }

    pub(super) fn counts(&self) -> ObjectCounts {
        match *self {
            Self::Sites { counts, .. } => ObjectCounts::Sites(counts),
            Self::Contacts { counts, .. } => ObjectCounts::Contacts(counts),
        }
    }
}

/// Memory for what a method keeps of a supporter.
pub(super) enum SupporterSlots<'m> {
    Sites(&'m mut [SupportSite]),
    Contacts(&'m mut [SupportContact]),
}

/// What a method found on a supporter, in its frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum SupporterPlaces<'m> {
    /// By the published method.
    Sites {
        /// The support sites, the thinnest first.
        sites: &'m [SupportSite],
        /// How much was left after each step.
        counts: sites::SupporterCounts,
    },
    /// By the contact method.
    Contacts {
        /// The contact candidates, those on level ground first.
        contacts: &'m [SupportContact],
        /// How much was left after each step.
        counts: contacts::SupporterCounts,
    },
}

/// Bytes of what a method keeps of a supporter; the sum over the methods, as for an object.
pub(super) const fn supporter_bytes() -> usize {
    sites::supporter_bytes().saturating_add(contacts::supporter_bytes())
}

/// Bytes of working memory for finding places on a supporter of `points`, for any method.
pub(super) const fn supporter_scratch_bytes(points: usize) -> usize {
    sites::supporter_scratch_bytes(points)
}

/// Whether duplicates and strays stay in the cloud, as in the published method.
pub(super) fn takes_cloud_as_it_is(params: &Params) -> bool {
    params.candidates == Candidates::Sites
}

impl<'m> SupporterSlots<'m> {
    pub(super) fn new(params: &Params, arena: &mut Arena<'m>) -> Result<Self, OutOfMemory> {
        Ok(match params.candidates {
            Candidates::Sites => Self::Sites(sites::supporter_slots(arena)?),
            Candidates::Contacts => Self::Contacts(contacts::supporter_slots(arena)?),
        })
    }

    /// Fills the slots. `Some` says why the search ended early.
    pub(super) fn find(
        self,
        cloud: &SupporterCloud,
        meter: &mut Meter,
        scratch: Arena,
    ) -> Result<(SupporterPlaces<'m>, Option<Stop>), Unfinished> {
        Ok(match self {
            Self::Sites(slots) => {
                let (counts, stop) = sites::find_on_supporter(cloud, slots, meter, scratch)?;
                (SupporterPlaces::Sites { sites: &slots[..counts.sites], counts }, stop)
            }
            Self::Contacts(slots) => {
                let (counts, stop) = contacts::find_on_supporter(cloud, slots, meter);
                (SupporterPlaces::Contacts { contacts: &slots[..counts.contacts], counts }, stop)
            }
        })
    }
}

impl<'m> SupporterPlaces<'m> {
    /// None by another method.
    pub(super) fn sites(&self) -> &'m [SupportSite] {
        if let Self::Sites { sites, .. } = *self { sites } else { &[] }
    }

    /// None by another method.
    pub(super) fn contacts(&self) -> &'m [SupportContact] {
        if let Self::Contacts { contacts, .. } = *self { contacts } else { &[] }
    }

    pub(super) fn counts(&self) -> SupporterCounts {
        match *self {
            Self::Sites { counts, .. } => SupporterCounts::Sites(counts),
            Self::Contacts { counts, .. } => SupporterCounts::Contacts(counts),
        }
    }
}

/// How much was left after each step of the search for places on an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectCounts {
    /// Of the published method.
    Sites(sites::ObjectCounts),
    /// Of the contact method.
    Contacts(contacts::ObjectCounts),
}

/// How much was left after each step of the search for places on a supporter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupporterCounts {
    /// Of the published method.
    Sites(sites::SupporterCounts),
    /// Of the contact method.
    Contacts(contacts::SupporterCounts),
}

/// How much was left after each step of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchCounts {
    /// Of the published method.
    Sites(sites::Counts),
    /// Of the contact method.
    Contacts(contacts::Counts),
}

impl SearchCounts {
    /// The first step that left nothing.
    pub(super) fn empty_stage(&self) -> Option<Stage> {
        match self {
            Self::Sites(counts) => counts.empty_stage(),
            Self::Contacts(counts) => counts.empty_stage(),
        }
    }
}

/// Bytes of working memory for [`search`] by any method, beside that for settling.
pub(super) const fn search_bytes() -> usize {
    // Sites are matched in place.
    contacts::search_bytes()
}

/// Searches with the method of the params and writes the best poses to `poses`, best first. Places that another method
/// found count as none.
pub(super) fn search(
    scene: &Scene,
    (object, supporter): (&ObjectPlaces, &SupporterPlaces),
    poses: &mut [HangingPose],
    arena: Arena,
    meter: &mut Meter,
) -> Result<Found<SearchCounts>, PredictError> {
    Ok(match scene.params.candidates {
        Candidates::Sites => {
            let mut counts = sites::Counts::default();
            if let ObjectPlaces::Sites { counts: found, .. } = *object {
                counts.object = found;
            }
            if let SupporterPlaces::Sites { counts: found, .. } = *supporter {
                counts.supporter = found;
            }
            let places = (object.sites(), supporter.sites());
            sites::search(scene, places, counts, poses, arena, meter)?.map(SearchCounts::Sites)
        }
        Candidates::Contacts => {
            let mut counts = contacts::Counts::default();
            if let ObjectPlaces::Contacts { counts: found, .. } = *object {
                counts.object = found;
            }
            if let SupporterPlaces::Contacts { counts: found, .. } = *supporter {
                counts.supporter = found;
            }
            let places = (object.contacts(), supporter.contacts());
            contacts::search(scene, places, counts, poses, arena, meter)?.map(SearchCounts::Contacts)
        }
    })
}
