//! Which candidates come to rest, and how firmly.

use super::candidates::{self, CandidateSearch};
use super::pose::Rest;
use super::{HangingPose, probability};
use crate::best::Best;
use crate::geometry::Pose;
use crate::mechanics::{
    Body, Fate, Near, Settings, Settled, Support, comes_free, firmness, is_off_surface, release_pose, settle,
};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// What became of the poses that were let go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SettlingCounts {
    /// Poses that were made: that lay a contact of the object on one of the supporter.
    pub candidates: usize,
    /// Those that are clear of the supporter, or could be pushed off it.
    pub clear: usize,
    /// Those that were let go.
    pub released: usize,
    /// Of these, those that rotated off,
    pub rotated_off: usize,
    /// slid off or fell through,
    pub slid_off: usize,
    /// or still moved after three seconds.
    pub moving: usize,
    /// Those that came to rest.
    pub at_rest: usize,
    /// Of these, those that would not come off again.
    pub wedged: usize,
    /// Different rests that are probable enough to be given.
    pub probable: usize,
    /// Those among them that need no better ones beside them.
    pub firm: usize,
}

/// Lets poses go, one at a time.
pub(super) struct Settling<'a> {
    pub(super) body: &'a Body<'a>,
    pub(super) support: &'a Support<'a>,
    pub(super) params: &'a Params,
    /// Working memory, an entry a point of the supporter.
    pub(super) near: &'a mut [Near],
    pub(super) counts: SettlingCounts,
}

/// So many times more poses are let go while none stays than once one does.
const MORE_WHILE_NONE_STAYS: usize = 4;
/// Tilts below this, radians, are not worth the time for the others.
const WORTHLESS_TILT: f32 = 0.15;
/// A release that comes closer to the supporter than this, metres, is as good as none: clouds are no more exact.
const LEAST_GAP: f32 = 0.0001;
/// What sinks by more than this, metres, from where it is let go to its rest, did not rest where it was let go.
const MOST_SINKING: f32 = 0.01;
/// So many places to let it go from are tried at most.
const RELEASES: usize = 3;

/// What was tried promises less; a rest takes off this share of it.
const REST_SHARE: f32 = 0.6;

/// Where to let the object go.
struct Release {
    /// Object to supporter.
    pose: Pose,
    /// How far it is off the supporter there, metres.
    gap: f32,
    /// From there to the rest, metres.
    sinking: f32,
}

impl Settling<'_> {
    /// Lets the most promising candidates go until enough stay firmly, or offers them as they are if gravity is not to act.
    pub(super) fn search(
        &mut self,
        candidates: &mut CandidateSearch,
        poses: &mut Best<HangingPose>,
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        if !self.params.settle {
            while let Some(candidate) = candidates.next(meter)? {
                // They come in order.
                poses.offer(HangingPose { pose: candidate.pose, ..HangingPose::default() }, |_, _| false);
                if poses.is_full() {
                    break;
                }
                candidates.discount(&candidate, 1.0);
            }
            return Ok(());
        }
        let attempts = self.params.settle_attempts;
        for attempt in 0..attempts {
            meter.progress(attempt as f32 / attempts as f32);
            let Some(candidate) = candidates.next(meter)? else { break };
            match self.release(&candidate.pose, meter)? {
                Some(pose) => {
                    self.offer(pose, poses);
                    candidates.discount(&candidate, REST_SHARE);
                }
                None => candidates.discount(&candidate, 1.0),
            }
            let has_enough = self.counts.firm >= self.params.firm_enough;
            if has_enough || self.counts.probable > 0 && MORE_WHILE_NONE_STAYS * (attempt + 1) >= attempts {
                break;
            }
        }
        Ok(())
    }

    /// Lets each of `poses` go, moves those that stay to the front, the most probable first, and returns how many they are.
    pub(super) fn sieve(
        &mut self,
        poses: &mut [HangingPose],
        meter: &mut Meter,
    ) -> (usize, Result<(), Stop>) {
        let mut left = 0;
        for index in 0..poses.len() {
            meter.progress(index as f32 / poses.len() as f32);
            match self.release(&poses[index].pose, meter) {
                Ok(Some(pose)) => {
                    let pose = HangingPose { matched: poses[index].matched, ..pose };
                    let mut firm = Best::filled(&mut poses[..=index], left);
                    self.offer(pose, &mut firm);
                    left = firm.len();
                }
                Ok(None) => {}
                Err(stop) => return (left, Err(stop)),
            }
        }
        (left, Ok(()))
    }

    /// Offers a pose unless it is improbable or known.
    fn offer(&mut self, pose: HangingPose, poses: &mut Best<HangingPose>) {
        let Some(rest) = &pose.rest else { return };
        let is_known =
            |other: &HangingPose| other.rest.is_some_and(|other| other.is_like(rest, &self.body.centre));
        if rest.probability < self.params.min_probability || poses.iter().any(is_known) {
            return;
        }
        self.counts.probable += 1;
        self.counts.firm += usize::from(rest.probability >= probability::FIRM);
        poses.offer(pose, is_more_probable);
    }

    /// What becomes of the object at `release`; `None` if it does not stay.
    fn release(&mut self, release: &Pose, meter: &mut Meter) -> Result<Option<HangingPose>, Stop> {
        let scene = (self.body, self.support);
        // What is finer than the field's voxels shows only here.
        if !is_off_surface(scene, release, candidates::CLEARANCE, meter)? {
            return Ok(None);
        }
        self.counts.released += 1;
        let up = self.params.up();
        let friction = self.params.friction;
        let settings = Settings::damped(friction);
        let (settled, from) = self.find_release(release, settings, meter)?;
        match settled.fate {
            Fate::Rests => self.counts.at_rest += 1,
            Fate::RotatesOff => self.counts.rotated_off += 1,
            Fate::SlidesOff => self.counts.slid_off += 1,
            Fate::Moves => self.counts.moving += 1,
        }
        let Some(Release { pose, gap, sinking }) = from else { return Ok(None) };
        if !comes_free(scene, &settled.pose, &-up, settings, self.near, meter)? {
            self.counts.wedged += 1;
            return Ok(None);
        }
        let firm = firmness(scene, &settled.pose, &-up, friction, WORTHLESS_TILT, self.near, meter)?;
        let rest = Rest::new(settled.pose, sinking, gap, &firm);
        Ok(Some(HangingPose { pose, rest: Some(rest), matched: None }))
    }

    /// What becomes of the object at `start`, and, if it rests, where to let it go instead, off the supporter but close to that rest.
    /// What does not come to rest close by from there either is not told to be let go there, but tried from where it comes to then.
    fn find_release(
        &mut self,
        start: &Pose,
        settings: Settings,
        meter: &mut Meter,
    ) -> Result<(Settled, Option<Release>), Stop> {
        let scene = (self.body, self.support);
        let (up, clearance) = (self.params.up(), self.params.clearance);
        let mut settled = settle(scene, start, &-up, settings, self.near, meter)?;
        for _ in 0..RELEASES {
            if settled.fate != Fate::Rests {
                break;
            }
            let (pose, gap) = release_pose(scene, &settled.pose, clearance, &up, self.near, meter)?;
            if gap < LEAST_GAP || !is_off_surface(scene, &pose, LEAST_GAP, meter)? {
                break;
            }
            settled = settle(scene, &pose, &-up, settings, self.near, meter)?;
            let centre = &self.body.centre;
            let sinking = up.dot(&(pose * centre - settled.pose * centre));
            if settled.fate == Fate::Rests && sinking < MOST_SINKING {
                return Ok((settled, Some(Release { pose, gap, sinking })));
            }
        }
        Ok((settled, None))
    }
}

/// The order of the ranking.
fn is_more_probable(a: &HangingPose, b: &HangingPose) -> bool {
    let probability = |pose: &HangingPose| pose.rest.map_or(0.0, |rest| rest.probability);
    probability(a) > probability(b)
}
