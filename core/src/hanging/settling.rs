//! Which candidates come to rest, and how firmly.

use super::candidates::{self, CandidateSearch};
use super::pose::Rest;
use super::{HangingPose, probability};
use crate::best::Best;
use crate::geometry::Pose;
use crate::mechanics::{
    Body, Fate, Settings, Settled, Sleep, Support, comes_free, firmness, is_off_surface, release_pose, settle,
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
    /// Releases that came to one of them that needs no better ones beside it.
    pub firm: usize,
}

/// Lets poses go, one at a time.
pub(super) struct Settling<'a> {
    pub(super) body: &'a Body<'a>,
    pub(super) support: &'a Support<'a>,
    pub(super) params: &'a Params,
    /// Working memory, of [`Support::sleepers`].
    pub(super) sleeps: &'a mut [Sleep],
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
            let pose = HangingPose { pose: candidate.pose, ..HangingPose::default() };
            let stays = self.release(&pose, poses, meter)?;
            candidates.discount(&candidate, if stays { REST_SHARE } else { 1.0 });
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
            let pose = poses[index];
            let mut firm = Best::filled(&mut poses[..=index], left);
            if let Err(stop) = self.release(&pose, &mut firm, meter) {
                return (left, Err(stop));
            }
            left = firm.len();
        }
        (left, Ok(()))
    }

    /// Lets the object go, offers what is probable enough to `poses`, and returns whether it stays.
    fn release(
        &mut self,
        start: &HangingPose,
        poses: &mut Best<HangingPose>,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let scene = (self.body, self.support);
        // What is finer than the field's voxels shows only here.
        if !is_off_surface(scene, &start.pose, candidates::CLEARANCE, meter)? {
            return Ok(false);
        }
        self.counts.released += 1;
        let settled = self.settle(&start.pose, meter)?;
        match settled.fate {
            Fate::Rests => self.counts.at_rest += 1,
            Fate::RotatesOff => self.counts.rotated_off += 1,
            Fate::SlidesOff => self.counts.slid_off += 1,
            Fate::Moves => self.counts.moving += 1,
        }
        if settled.fate != Fate::Rests {
            return Ok(false);
        }
        if let Some(known) = self.known(&settled.pose, poses) {
            self.counts.firm += usize::from(known.probability >= probability::FIRM);
            return Ok(true);
        }
        let Some((Release { pose, gap, sinking }, settled)) = self.find_release(settled, meter)? else {
            return Ok(false);
        };
        let (down, params) = (-self.params.up(), self.params);
        if !comes_free(scene, &settled.pose, &down, Settings::damped(params), self.sleeps, meter)? {
            self.counts.wedged += 1;
            return Ok(false);
        }
        // What cannot become better than the last of a full list need not be looked at to the end.
        let last = poses.next_to_go().and_then(|pose| pose.rest).map_or(0.0, |rest| rest.probability);
        let least = probability::least_tilt(last, gap).max(WORTHLESS_TILT);
        let firm = firmness(scene, &settled.pose, &down, params, least, self.sleeps, meter)?;
        let rest = Rest::new(settled.pose, sinking, gap, &firm);
        if rest.probability >= self.params.min_probability && self.known(&rest.pose, poses).is_none() {
            self.counts.probable += 1;
            self.counts.firm += usize::from(rest.probability >= probability::FIRM);
            poses.offer(HangingPose { pose, rest: Some(rest), matched: start.matched }, is_more_probable);
        }
        Ok(true)
    }

    /// The rest among `poses` that is at `pose` as far as a robot cares.
    fn known(&self, pose: &Pose, poses: &Best<HangingPose>) -> Option<Rest> {
        poses.iter().filter_map(|other| other.rest).find(|rest| rest.is_like(pose, &self.body.centre))
    }

    fn settle(&mut self, start: &Pose, meter: &mut Meter) -> Result<Settled, Stop> {
        let settings = Settings::damped(self.params);
        settle((self.body, self.support), start, &-self.params.up(), settings, self.sleeps, meter)
    }

    /// Where to let the object go, off the supporter but close to where it rests, and where it rests then. What does not come to rest close
    /// by from there is not told to be let go there, but tried from where it comes to then.
    fn find_release(
        &mut self,
        rests: Settled,
        meter: &mut Meter,
    ) -> Result<Option<(Release, Settled)>, Stop> {
        let scene = (self.body, self.support);
        let (up, clearance) = (self.params.up(), self.params.clearance);
        let mut settled = rests;
        for _ in 0..RELEASES {
            if settled.fate != Fate::Rests {
                break;
            }
            let (pose, gap) = release_pose(scene, &settled.pose, clearance, &up, self.sleeps, meter)?;
            if gap < LEAST_GAP || !is_off_surface(scene, &pose, LEAST_GAP, meter)? {
                break;
            }
            settled = self.settle(&pose, meter)?;
            let centre = &self.body.centre;
            let sinking = up.dot(&(pose * centre - settled.pose * centre));
            if settled.fate == Fate::Rests && sinking < MOST_SINKING {
                return Ok(Some((Release { pose, gap, sinking }, settled)));
            }
        }
        Ok(None)
    }
}

/// The order of the ranking.
fn is_more_probable(a: &HangingPose, b: &HangingPose) -> bool {
    let probability = |pose: &HangingPose| pose.rest.map_or(0.0, |rest| rest.probability);
    probability(a) > probability(b)
}
