//! The thing that is hung on.

use super::AnalysisError;
use super::support_contact::{self, SupportContact};
use super::supportability::{self, SupportSite, Supportability, SupportabilityCounts};
use crate::geometry::{Cloud, PointTree, Vector};
use crate::mechanics::{Room, Support};
use crate::memory::{Arena, Limits, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::{Candidates, Params};
use crate::perception::normals;

/// Normals shorter than this are taken as not given.
const NO_DIRECTION: f32 = 1e-6;
/// Normals whose length is within this of one are taken as of unit length.
const UNIT_LENGTH: f32 = 1e-3;

/// A supporter, analysed: points and support sites, in supporter coordinates. Immutable; any number of threads
/// may match it at once.
#[derive(Clone, Copy)]
pub struct Supporter<'m> {
    support: Support<'m>,
    contacts: &'m [SupportContact],
    sites: &'m [SupportSite],
    normals: NormalCounts,
    counts: SupportabilityCounts,
    work: Work,
    stopped: Option<Stop>,
}

/// What had to be done to the normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NormalCounts {
    /// Normals that were missing or zero, and were estimated from the neighbouring points.
    pub estimated: usize,
    /// Normals that were not of unit length, and were scaled to it.
    pub renormalised: usize,
}

impl<'m> Supporter<'m> {
    /// Bytes of memory for any supporter within `limits`.
    pub const fn bytes(limits: &Limits) -> usize {
        let points = limits.points;
        let model = PointTree::bytes(points)
            .saturating_add(array_bytes::<SupportSite>(supportability::MAX_SITES))
            .saturating_add(array_bytes::<SupportContact>(support_contact::MAX_CONTACTS))
            .saturating_add(Room::bytes(points));
        let scratch = larger(
            PointTree::scratch_bytes(points),
            // In the tree's order, and in the cloud's.
            array_bytes::<Vector>(points).saturating_mul(2).saturating_add(larger(
                normals::scratch_bytes(points),
                larger(supportability::scratch_bytes(points), array_bytes::<u8>(points)),
            )),
        );
        model_bytes(model.saturating_add(scratch))
    }

    /// Analyses `cloud` in `memory`, which must hold [`Supporter::bytes`] for its size. The cloud need not stay.
    pub fn analyze(
        cloud: &Cloud,
        params: &Params,
        memory: &'m mut [u8],
        monitor: &Monitor,
    ) -> Result<Self, AnalysisError> {
        params.validate()?;
        let points = cloud.points();
        let limits = Limits { points: points.len(), ..Limits::NONE };
        let mut arena = Arena::new(memory, Self::bytes(&limits))?;
        let mut meter = Meter::new(monitor);

        let tree = PointTree::build(points, &mut arena)?;
        let sites = arena.slice::<SupportSite>(supportability::MAX_SITES)?;

        let room = Room::new(points.len(), &mut arena)?;
        let contacts = arena.slice::<SupportContact>(support_contact::MAX_CONTACTS)?;
        let mut scratch = arena.scratch();
        let in_tree_order = scratch.slice::<Vector>(points.len())?;
        let mut normals = NormalCounts::default();
        if let Some(given) = cloud.normals() {
            for (normal, &index) in in_tree_order.iter_mut().zip(tree.order()) {
                let given = Vector::from(given[index as usize]);
                let length = given.norm();
                if length > NO_DIRECTION {
                    *normal = given / length;
                    normals.renormalised += usize::from((length - 1.0).abs() > UNIT_LENGTH);
                }
            }
        }
        let viewpoint = cloud.viewpoint();
        normals.estimated =
            normals::complete(&tree, in_tree_order, viewpoint, params.up(), scratch.scratch())?;
        meter.check().map_err(|_| AnalysisError::Cancelled)?;

        let mut counts = SupportabilityCounts::default();
        let (mut site_count, mut contact_count) = (0, 0);
        let found;
        let support = if params.settle || params.candidates == Candidates::Contacts {
            Support::fit(tree, in_tree_order, room, scratch.scratch())?
        } else {
            Support::bare(tree)
        };
        match params.candidates {
            Candidates::Sites => {
                let in_cloud_order = scratch.slice::<Vector>(points.len())?;
                for (normal, &index) in in_tree_order.iter().zip(tree.order()) {
                    in_cloud_order[index as usize] = *normal;
                }
                let search = Supportability { tree: &tree, points, normals: in_cloud_order, params };
                let (left, stop) = search.find(sites, &mut meter, scratch)?;
                (counts, site_count, found) = (left, left.sites, stop.map_or(Ok(()), Err));
            }
            Candidates::Contacts => {
                let search = support_contact::Search { tree: &tree, normals: in_tree_order, up: params.up() };
                (contact_count, found) = search.find(contacts, &mut counts, &mut meter);
            }
        }
        let stopped = found.err();
        if stopped == Some(Stop::Cancelled) {
            return Err(AnalysisError::Cancelled);
        }
        let (sites, contacts) = (&sites[..site_count], &contacts[..contact_count]);
        let work = meter.work;
        Ok(Self { support, contacts, sites, normals, counts, work, stopped })
    }

    /// The supporter as mechanics sees it.
    pub(super) fn support(&self) -> &Support<'m> {
        &self.support
    }

    /// Where something can lie on the supporter: [`Candidates::Contacts`].
    pub fn contacts(&self) -> &'m [SupportContact] {
        self.contacts
    }

    /// The points, for neighbour queries.
    pub fn points(&self) -> &PointTree<'m> {
        &self.support.tree
    }

    /// Where something can be hung, the thinnest site first: [`Candidates::Sites`].
    pub fn sites(&self) -> &'m [SupportSite] {
        self.sites
    }

    /// What had to be done to the normals that were given.
    pub fn normals(&self) -> NormalCounts {
        self.normals
    }

    /// What was left after each step of the search for sites.
    pub fn counts(&self) -> SupportabilityCounts {
        self.counts
    }

    /// Rays and distance queries spent.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Why the search for sites ended early, if it did; then there may be more than [`sites`](Self::sites).
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }
}
