//! The thing that is hung on.

use super::AnalysisError;
use super::contacts::SupportContact;
use super::method::{self, SupporterCounts, SupporterPlaces, SupporterSlots};
use super::samples::SupporterCloud;
use super::sites::SupportSite;
use crate::geometry::{
    Aabb, Cloud, Point, PointTree, PointTreeSlots, Pose, Vector, Viewpoints, upright_frame,
};
use crate::mechanics::{Room, Support};
use crate::memory::{Arena, Limits, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::Params;
use crate::perception::cleaning::{self, Cleaned, CleaningCounts, spacing};
use crate::perception::normals::{self, Changed};
use crate::perception::{far_side, visibility};

/// Normals shorter than this are taken as not given.
const NO_DIRECTION: f32 = 1e-6;
/// Normals whose length is within this of one are taken as of unit length.
const UNIT_LENGTH: f32 = 1e-3;

/// A supporter, analysed: points and the places on which something may hang. Immutable; any number of threads may use it at once.
///
/// It is analysed in a frame of its own, about the mean of its points and turned to the direction across gravity in which they spread most, so
/// that nothing depends on the coordinates in which the cloud is given. [`points`](Self::points) are in this [`frame`](Self::frame), and
/// all else that is told is in supporter coordinates, those of the cloud.
#[derive(Clone, Copy)]
pub struct Supporter<'m> {
    support: Support<'m>,
    places: SupporterPlaces<'m>,
    cleaning: CleaningCounts,
    given: usize,
    guessed: usize,
    normals: NormalCounts,
    work: Work,
    stopped: Option<Stop>,
}

/// What had to be done to the normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NormalCounts {
    /// Normals that were missing or zero, and were estimated from the neighbouring points: all of the cloud, where the given ones are no
    /// normals of the surface on which the points are.
    pub estimated: usize,
    /// Normals that were not of unit length, and were scaled to it.
    pub renormalised: usize,
    /// Normals that were given and reversed: all of them, where they pointed into the solid, or some, where their signs
    /// did not agree.
    pub reversed: usize,
}

impl<'m> Supporter<'m> {
    /// Bytes of memory for any supporter within `limits`.
    pub const fn bytes(limits: &Limits) -> usize {
        let seen = limits.points;
        let points = far_side::max_points(seen);
        let model = PointTree::bytes(points)
            .saturating_add(method::supporter_bytes())
            .saturating_add(Room::bytes(points));
        let before_far_side = larger(
            larger(cleaning::scratch_bytes(seen), normals::scratch_bytes(seen)),
            // Places found with working memory are on a cloud that is taken as it is.
            method::supporter_scratch_bytes(seen),
        );
        let with_far_side = far_side::bytes(seen)
            .saturating_add(larger(far_side::scratch_bytes(seen), Support::scratch_bytes(points)));
        let scratch = array_bytes::<Vector>(seen)
            .saturating_add(cleaning::bytes(seen))
            .saturating_add(larger(before_far_side, with_far_side));
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
        let mut arena = Arena::new(memory, Self::bytes(&Limits::of_points(points.len())))?;
        let mut meter = Meter::new(monitor);

        let most = far_side::max_points(points.len());
        let mut tree = PointTreeSlots::new(most, &mut arena)?;
        let room = Room::new(most, &mut arena)?;
        let slots = SupporterSlots::new(params, &mut arena)?;
        let mut scratch = arena.scratch();
        let given = scratch.slice::<Vector>(points.len())?;
        let frame = upright_frame(|| points.iter(), &params.up(), &meter)?;
        let renormalised = read_normals(cloud, &frame, given, &meter)?;
        let estimated = given.iter().filter(|normal| **normal == Vector::zeros()).count();
        let is_taken_as_it_is = method::takes_cloud_as_it_is(params);
        let mut seen =
            cleaning::clean((points, &frame), given, is_taken_as_it_is, &mut tree, &mut scratch, &meter)?;
        for (flag, &point) in seen.is_excluded.iter_mut().zip(tree.tree().order()) {
            *flag |= u8::from(!cloud.may_hang_on(point as usize));
        }
        let views = Viewpoints::new(cloud.viewpoints(), &frame);
        if is_taken_as_it_is && (params.uses_mechanics() || !views.is_empty()) {
            spacing::measure(&tree.tree(), seen.spacings, &meter)?;
        }
        let changed = normals::complete(
            &tree.tree(),
            seen.normals,
            seen.spacings,
            views,
            params.up(),
            scratch.scratch(),
            &meter,
        )?;
        let (estimated, reversed) = match changed {
            Changed::Reversed(reversed) => (estimated, reversed),
            Changed::Replaced => (points.len(), 0),
        };
        let normals = NormalCounts { estimated, renormalised, reversed };
        meter.check_cancelled()?;

        if !is_taken_as_it_is
            && visibility::explain(&tree.tree(), seen.normals, seen.spacings, views, &meter)?
        {
            seen = far_side::add(seen, views, &mut tree, &mut scratch, &meter)?;
        }
        let Cleaned { normals: in_tree_order, spacings, is_excluded, is_guessed, counts: cleaning } = seen;
        let guessed = is_guessed.iter().filter(|flag| **flag > 0).count();
        let tree = tree.into_tree();
        let support = match params.uses_mechanics() {
            true => Support::fit(
                tree,
                (in_tree_order, spacings, is_guessed, is_excluded),
                room,
                scratch.scratch(),
                &meter,
            )?,
            false => Support::bare(tree),
        };
        let support = support.in_frame(frame);
        let seen = SupporterCloud { tree: &tree, normals: in_tree_order, is_excluded, params };
        let (places, stopped) = slots.find(&seen, &mut meter, scratch)?;
        if stopped == Some(Stop::Cancelled) {
            return Err(AnalysisError::Cancelled);
        }
        Ok(Self {
            support,
            places,
            cleaning,
            given: points.len(),
            guessed,
            normals,
            work: meter.work,
            stopped,
        })
    }

    /// The supporter as mechanics sees it.
    pub(crate) fn support(&self) -> &Support<'m> {
        &self.support
    }

    /// The frame of the supporter: maps supporter coordinates to those of [`points`](Self::points).
    pub fn frame(&self) -> &Pose {
        &self.support.frame
    }

    /// The points, for neighbour queries, in the supporter's [`frame`](Self::frame).
    pub fn points(&self) -> &PointTree<'m> {
        &self.support.tree
    }

    /// The box around the points, in supporter coordinates.
    pub fn aabb(&self) -> Aabb {
        let back = self.support.frame.inverse();
        self.points().points().iter().fold(Aabb::EMPTY, |aabb, point| aabb.grow(&(back * point)))
    }

    /// The limits that this supporter requires: the number of points of its cloud, and zero for the rest.
    pub fn limits(&self) -> Limits {
        Limits::of_points(self.given)
    }

    /// The support sites, the thinnest first; none by the contact method.
    pub fn sites(&self) -> impl ExactSizeIterator<Item = SupportSite> + use<'m> {
        let back = self.support.frame.inverse();
        self.places.sites().iter().map(move |site| site.moved(&back))
    }

    /// The contact candidates; none by the published method.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = SupportContact> + use<'m> {
        let back = self.support.frame.inverse();
        self.places.contacts().iter().map(move |contact| contact.moved(&back))
    }

    /// How much was left after each step of the search for places, by the method that it was analysed with.
    pub fn counts(&self) -> SupporterCounts {
        self.places.counts()
    }

    /// The places, in the supporter's frame.
    pub(super) fn places(&self) -> &SupporterPlaces<'m> {
        &self.places
    }

    /// Points that were merged and dropped.
    pub fn cleaning(&self) -> CleaningCounts {
        self.cleaning
    }

    /// Points that no viewpoint saw and that were guessed: the far sides of bars and plates.
    pub fn guessed(&self) -> usize {
        self.guessed
    }

    /// Positions of a representative part of the points that were [guessed](Self::guessed), supporter coordinates, metres.
    pub fn guessed_points(&self) -> impl Iterator<Item = Point> + 'm {
        let back = self.support.frame.inverse();
        self.support.guessed().map(move |point| back * point)
    }

    /// What had to be done to the normals that were given.
    pub fn normals(&self) -> NormalCounts {
        self.normals
    }

    /// Rays and distance queries spent.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Why the search for places ended early, if it did; then some may be missing.
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }
}

/// Writes the normals of a cloud in a frame at unit length, zero where they are not known, and returns how many were not of unit
/// length.
fn read_normals(cloud: &Cloud, frame: &Pose, normals: &mut [Vector], meter: &Meter) -> Result<usize, Stop> {
    let mut renormalised = 0;
    let given = cloud.normals().unwrap_or_default();
    for (step, (normal, given)) in normals.iter_mut().zip(given).enumerate() {
        meter.check_at(step)?;
        let given = Vector::from(*given);
        let length = given.norm();
        if length > NO_DIRECTION {
            *normal = frame * (given / length);
            renormalised += usize::from((length - 1.0).abs() > UNIT_LENGTH);
        }
    }
    Ok(renormalised)
}
