//! How much was left after each step, as the JSON has it: one shape for both methods, zeros for the steps of the other one.

use hangpose::hanging::{self, SearchCounts, contacts, sites};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct Counts {
    hangability: ObjectCounts,
    supportability: SupporterCounts,
    matching: MatchingCounts,
    settling: SettlingCounts,
}

#[derive(Default, Serialize)]
pub(super) struct ObjectCounts {
    contact_points: usize,
    clusters: usize,
    with_free_space: usize,
    encircled: usize,
    sites: usize,
    contacts: usize,
}

#[derive(Default, Serialize)]
pub(super) struct SupporterCounts {
    contact_points: usize,
    clusters: usize,
    sites: usize,
    contacts: usize,
}

#[derive(Default, Serialize)]
struct MatchingCounts {
    pairs: usize,
    fitting: usize,
    clear: usize,
}

#[derive(Serialize)]
struct SettlingCounts {
    candidates: usize,
    clear: usize,
    #[serde(flatten)]
    settling: hanging::SettlingCounts,
}

impl From<&hanging::Counts> for Counts {
    fn from(counts: &hanging::Counts) -> Self {
        let (hangability, supportability, matching, candidates) = match counts.search {
            SearchCounts::Sites(sites::Counts { object, supporter, matching }) => {
                let sites::MatchingCounts { pairs, fitting, clear } = matching;
                let matching = MatchingCounts { pairs, fitting, clear };
                (object.into(), supporter.into(), matching, contacts::CandidateCounts::default())
            }
            SearchCounts::Contacts(contacts::Counts { object, supporter, candidates }) => {
                (object.into(), supporter.into(), MatchingCounts::default(), candidates)
            }
        };
        let contacts::CandidateCounts { made: candidates, clear } = candidates;
        let settling = SettlingCounts { candidates, clear, settling: counts.settling };
        Self { hangability, supportability, matching, settling }
    }
}

impl From<hanging::ObjectCounts> for ObjectCounts {
    fn from(counts: hanging::ObjectCounts) -> Self {
        match counts {
            hanging::ObjectCounts::Sites(counts) => counts.into(),
            hanging::ObjectCounts::Contacts(counts) => counts.into(),
        }
    }
}

impl From<sites::ObjectCounts> for ObjectCounts {
    fn from(counts: sites::ObjectCounts) -> Self {
        let sites::ObjectCounts { contact_points, clusters, with_free_space, encircled, sites } = counts;
        Self { contact_points, clusters, with_free_space, encircled, sites, contacts: 0 }
    }
}

impl From<contacts::ObjectCounts> for ObjectCounts {
    fn from(contacts::ObjectCounts { contact_points, contacts }: contacts::ObjectCounts) -> Self {
        Self { contact_points, contacts, ..Self::default() }
    }
}

impl From<hanging::SupporterCounts> for SupporterCounts {
    fn from(counts: hanging::SupporterCounts) -> Self {
        match counts {
            hanging::SupporterCounts::Sites(counts) => counts.into(),
            hanging::SupporterCounts::Contacts(counts) => counts.into(),
        }
    }
}

impl From<sites::SupporterCounts> for SupporterCounts {
    fn from(counts: sites::SupporterCounts) -> Self {
        let sites::SupporterCounts { contact_points, clusters, sites } = counts;
        Self { contact_points, clusters, sites, contacts: 0 }
    }
}

impl From<contacts::SupporterCounts> for SupporterCounts {
    fn from(contacts::SupporterCounts { contact_points, contacts }: contacts::SupporterCounts) -> Self {
        Self { contact_points, contacts, ..Self::default() }
    }
}
