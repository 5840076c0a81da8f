//! Releases poses under gravity: which of them come to rest, and how firmly. Serves any method.

mod probability;
pub(super) mod rest;
mod tolerance;
pub(super) mod wishes;

pub use rest::{Rest, Tolerance};

use self::probability::Given;
use super::error::PredictError;
use super::opening;
use super::pose::HangingPose;
use super::request::{Distance, Request};
use super::scene::Scene;
use super::watch::Watch;
use crate::best::Best;
use crate::geometry::{Pose, Symmetry};
use crate::mechanics::{
    Body, Contact, Fate, Frames, Settings, Settled, Sleep, Support, carrying_contacts, kind_of, lever,
    margin, play, push_off_surface, release_pose, settle, unseen,
};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop};
use crate::params::Params;
use crate::perception::far_side;
use wishes::is_clear_of_scene;

/// What became of the poses that were released.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SettlingCounts {
    /// Poses that were released.
    pub released: usize,
    /// Released poses that rotated off the supporter.
    pub rotated_off: usize,
    /// Released poses that slid off, or fell through.
    pub slid_off: usize,
    /// Released poses that had not come to rest in time.
    pub moving: usize,
    /// Released poses that came to rest.
    pub at_rest: usize,
    /// Poses at rest that do not come free when gravity is reversed.
    pub wedged: usize,
    /// Releases that came to rest in a pose that would be probable enough if what no camera has seen were known to be as it is
    /// guessed.
    pub unseen: usize,
    /// Releases that came to rest in a pose that would be probable enough if the supporter's points were closer together.
    pub sparse: usize,
    /// Distinct rest poses with a probability of at least [`Params::min_probability`], with those that gave way to a better one that
    /// hardly differs.
    pub probable: usize,
    /// Releases that came to rest in a firm pose: [`Params::firm_enough`].
    pub firm: usize,
    /// Those of them that hang in a way that is preferred ([`Request::prefer`]).
    pub firm_as_preferred: usize,
    /// Poses that touch the scene or an object that hangs already.
    pub in_scene: usize,
    /// Poses at rest that hang on or by another region than was asked for, and 1 if the regions have no place for any.
    pub outside: usize,
    /// Poses at rest that hang in a way that is not allowed.
    pub other_kind: usize,
    /// Poses that would stay, but have no way in the direction that was asked for.
    pub no_approach: usize,
}

/// Releases poses, one at a time.
pub(super) struct Settling<'a> {
    pub(super) body: &'a Body<'a>,
    pub(super) support: &'a Support<'a>,
    /// Turns of the object that make no other pose, about axes in the caller's object coordinates.
    pub(super) symmetries: &'a [Symmetry],
    pub(super) request: &'a Request<'a>,
    pub(super) params: &'a Params,
    /// Working memory, of [`Support::sleepers`].
    pub(super) sleeps: &'a mut [Sleep],
    /// As much again, for what runs at the same time.
    other_sleeps: &'a mut [Sleep],
    pub(super) counts: SettlingCounts,
    /// Greatest merit of a pose so far, and `probability::with_room` of that pose.
    best: (f32, f32),
    /// Number of releases that came to rest since then and were no better.
    no_better: usize,
    /// Whether a pose so far is reliable, as far as what is unseen allows.
    pub(super) has_reliable: bool,
}

// Tolerances: a cloud is no more exact than these.

/// Distance from the supporter below which a candidate is not released, metres: it may penetrate.
pub(super) const CLEARANCE: f32 = 0.0005;
/// Distance from the supporter below which a pose is no release pose, metres.
const MIN_RELEASE_GAP: f32 = 0.0001;

// Physics.

/// Largest distance by which the centre of mass may sink from the release pose to the rest pose, metres. Farther down
/// it is another place than the one that was chosen.
const MAX_RELEASE_SINKING: f32 = 0.01;

/// Share of the merit of a pose that a centre of mass close to the contacts takes away. Things are made to hang by their ends; of
/// poses that hold equally well, the one with the longer lever is what people mean.
const LEVER_SHARE: f32 = 0.1;
/// Share of the merit of a pose that an opening as high as the object reaches takes away, less in proportion: of two openings people use
/// the one that is made for bars. On seeds 43 to 46 and 49 to 52 (`tables --summary --engine bullet --profile default --pairs 240`) 97 %
/// of the daily things that hang do so as is meant with it and with `OPENING_PENALTY` of the candidates, and 84 % without. A share of
/// 0.3 makes 2 % of the pairs less robust.
const OPENING_SHARE: f32 = 0.1;
/// Share of the merit of a pose that its fall under tilted gravity takes away. On seed 100 (`tables --all`) the best pose of 94 instead
/// of 93 % of the pairs is robust with it; shares of 0.1 to 0.5 do not differ.
const ROBUST_SHARE: f32 = 0.2;
/// Distance below which two rest poses are the same: a robot's accuracy.
const SAME: Distance = Distance { position: 0.005, rotation: 0.1 };

// Budget.

/// Least tilt below which the other directions are not tested, radians: such a pose is never firm. Set by hand.
const MIN_USEFUL_TILT: f32 = 0.15;
/// Share by which a pose must be better than the best one to count as progress: about the error of the probability.
const CLEARLY_BETTER: f32 = 0.01;
/// What must remain of the probability with room (`probability::with_room`) for the search to end without enough firm poses. Larger: where
/// no pose is firm, all attempts are made. Smaller: better poses are missed. Chosen by hand: 96 % of the best poses of `tables --pairs 165 --seed 7`
/// hang with this rule and without it.
const GOOD: f32 = 0.95;
/// Releases in a row that come to rest without progress before the search ends, for each firm pose that is wanted
/// ([`Params::firm_enough`]). Larger: the best pose is stable under tilt more often, at more time. Smaller: the reverse. Chosen by
/// hand together with [`GOOD`]: 91 % of these poses are robust, and 92 % without the rule.
const PATIENCE: usize = 4;
/// Release poses tried for one rest pose.
const MAX_RELEASES: usize = 3;

/// A release pose.
struct Release {
    /// Object to supporter.
    pose: Pose,
    /// Distance from the supporter, metres.
    gap: f32,
    /// How far the centre of mass sinks from there to the rest pose, metres.
    sinking: f32,
}

impl<'a> Settling<'a> {
    /// Takes working memory, of [`bytes`](Self::bytes), from `arena`.
    pub(super) fn new(scene: &Scene<'a>, arena: &mut Arena<'a>) -> Result<Self, PredictError> {
        let Scene { support, symmetries, request, params, .. } = *scene;
        let body = scene.body.ok_or(PredictError::NoDistanceField)?;
        let sleepers = Support::sleepers(support.patches.len());
        let (sleeps, other_sleeps) = (arena.slice::<Sleep>(sleepers)?, arena.slice::<Sleep>(sleepers)?);
        Ok(Self {
            body,
            support,
            symmetries,
            request,
            params,
            sleeps,
            other_sleeps,
            counts: SettlingCounts::default(),
            best: (0.0, 0.0),
            no_better: 0,
            has_reliable: false,
        })
    }

    /// Bytes of working memory, for a supporter of `points`, whose far side has patches as well.
    pub(super) const fn bytes(points: usize) -> usize {
        array_bytes::<Sleep>(Support::sleepers(far_side::max_points(points))).saturating_mul(2)
    }

    /// Releases each of `poses`, moves those that stay to the front, the most probable first, and returns their number.
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
            let released = match is_clear_of_scene(
                (self.body, self.support),
                self.request,
                &pose.pose,
                CLEARANCE,
                meter,
            ) {
                Ok(true) => self.release(&pose, &mut firm, meter).map(|_| ()),
                Ok(false) => {
                    self.counts.in_scene += 1;
                    Ok(())
                }
                Err(stop) => Err(stop),
            };
            left = firm.len();
            if let Err(stop) = released {
                return (left, Err(stop));
            }
        }
        (left, Ok(()))
    }

    /// Releases the object at a pose that is clear of the scene, offers its rest pose to `poses` if it is as asked and probable
    /// enough, and returns whether it came to rest.
    pub(super) fn release(
        &mut self,
        start: &HangingPose,
        poses: &mut Best<HangingPose>,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let scene = (self.body, self.support);
        // Details finer than the distance field's voxels show only in this exact test.
        let Some(off_surface) = push_off_surface(scene, &start.pose, CLEARANCE, meter)? else {
            return Ok(false);
        };
        self.counts.released += 1;
        let settled = self.settle(&off_surface, meter)?;
        match settled.fate {
            Fate::Rests => self.counts.at_rest += 1,
            Fate::RotatesOff => self.counts.rotated_off += 1,
            Fate::SlidesOff => self.counts.slid_off += 1,
            Fate::Moves => self.counts.moving += 1,
        }
        if let Some(Watch(watch)) = self.request.watch {
            watch(&Frames::of(scene).outwards(&off_surface), settled.fate);
        }
        if settled.fate != Fate::Rests {
            return Ok(false);
        }
        self.no_better += 1;
        if let Some(known) = self.known(&settled.pose, poses) {
            self.count_firm(&known);
            return Ok(true);
        }
        let Some((Release { pose, gap, sinking }, settled)) = self.find_release(settled, meter)? else {
            return Ok(false);
        };
        let (down, params) = (-self.params.up(), self.params);
        let contacts = carrying_contacts(scene, &settled.pose, &down, params, self.sleeps, meter)?;
        let kind = kind_of(scene, &settled.pose, &contacts, &-down, meter)?;
        if self.has_enough_of_others() && !self.request.prefer.contains(kind) {
            return Ok(true);
        }
        if !self.is_as_asked((&settled.pose, &pose), &contacts, kind, meter)? {
            return Ok(true);
        }
        let settings = Settings::damped(params);
        let Some(play) = play(scene, &settled.pose, &down, settings, self.sleeps, meter)? else {
            self.counts.wedged += 1;
            return Ok(false);
        };
        // A pose that cannot beat the last one of a full list need not be tilted in every direction.
        let last = poses.next_to_go().map_or(0.0, |pose| self.merit(pose)) / self.request.weight(kind);
        let unseen = unseen(scene, &pose, meter)?;
        let spacing = self.spacing(&settled.pose, &contacts, meter)?;
        let centre_error = self.body.centre_error;
        let given = Given { kind, clearance: gap, play, centre_error, unseen, spacing };
        let least = probability::least_tilt(last, &given).max(MIN_USEFUL_TILT);
        let at = (&settled.pose, &contacts[..]);
        let sleeps = [&mut *self.sleeps, &mut *self.other_sleeps];
        let margin = margin(scene, at, &down, params, least, sleeps, meter)?;
        let tolerance = tolerance::of(self.body, &settled.pose, gap, &margin, &contacts);
        let opening = self.opening(&settled.pose, &contacts, meter)?;
        let rest = Rest::new(settled.pose, &given, (sinking, opening), tolerance, margin, &contacts);
        let least = self.params.min_probability;
        if rest.probability < least && probability::of(&margin, &given.as_if_seen()) >= least {
            self.counts.unseen += 1;
        } else if rest.probability < least && probability::of(&margin, &given.as_if_dense()) >= least {
            self.counts.sparse += 1;
        }
        if rest.probability < least || self.known(&rest.pose, poses).is_some() {
            return Ok(true);
        }
        if !self.has_approach(&pose, meter)? {
            self.counts.no_approach += 1;
            return Ok(true);
        }
        self.counts.probable += 1;
        self.count_firm(&rest);
        self.has_reliable |= rest.is_reliable();
        let pose = HangingPose { pose, rest: Some(rest), matched: start.matched };
        let merit = self.merit(&pose);
        if merit > (1.0 + CLEARLY_BETTER) * self.best.0 {
            let with_room = probability::with_room(&rest.margin, gap, &rest.unseen);
            (self.best, self.no_better) = ((merit, with_room), 0);
        }
        self.offer(pose, poses);
        Ok(true)
    }

    /// How far apart the points of the supporter are at the contact where they are farthest apart, metres; where none carries at that
    /// moment, at the point nearest to the centre of mass.
    fn spacing(&self, rest: &Pose, contacts: &[Contact], meter: &mut Meter) -> Result<f32, Stop> {
        meter.distance_queries(contacts.len().max(1))?;
        if contacts.is_empty() {
            return Ok(self.support.spacing_near(&(rest * self.body.centre)));
        }
        Ok(contacts.iter().map(|contact| self.support.spacing_at(&contact.position)).fold(0.0, f32::max))
    }

    /// Whether further releases are unlikely to find a clearly better pose.
    pub(super) fn is_saturated(&self) -> bool {
        self.best.1 >= GOOD && self.no_better >= PATIENCE * self.params.firm_enough
    }

    /// Whether enough firm poses are known that are not of the preferred kinds: more of them would change nothing.
    pub(super) fn has_enough_of_others(&self) -> bool {
        self.counts.firm - self.counts.firm_as_preferred >= self.params.firm_enough
    }

    /// Offers a pose, unless one that is hardly different is as good.
    fn offer(&self, pose: HangingPose, poses: &mut Best<HangingPose>) {
        let is_alike = |other: &HangingPose| match (&pose.rest, &other.rest) {
            (Some(rest), Some(other)) => {
                rest.kind == other.kind && self.is_like(rest, &other.pose, &self.request.distinct)
            }
            _ => false,
        };
        let is_better = |a: &HangingPose, b: &HangingPose| self.merit(a) > self.merit(b);
        if poses.iter().any(|other| is_alike(other) && !is_better(&pose, other)) {
            return;
        }
        poses.drop_where(is_alike);
        poses.offer(pose, is_better);
    }

    /// What a pose is ranked by: its probability, how much its kind is wanted, how far from the contacts the centre of mass hangs,
    /// how high the opening is by which it hangs, and how robust it is.
    fn merit(&self, pose: &HangingPose) -> f32 {
        let Some(rest) = &pose.rest else { return 0.0 };
        let lever = lever(&(rest.pose * self.body.centre), rest.contacts()) / self.body.reach;
        rest.cautious(self.body)
            * self.request.weight(rest.kind)
            * (1.0 - LEVER_SHARE * (1.0 - lever))
            * (1.0 - OPENING_SHARE * rest.opening)
            * (1.0 - ROBUST_SHARE * (1.0 - rest.robustness))
    }

    /// [`Rest::opening`] at the contact that carries most.
    fn opening(&self, rest: &Pose, contacts: &[Contact], meter: &mut Meter) -> Result<f32, Stop> {
        let Some(contact) = contacts.iter().max_by(|a, b| a.force.total_cmp(&b.force)) else {
            return Ok(1.0);
        };
        let (to_object, down) = (rest.inverse(), -self.params.up());
        let start = to_object * (contact.position + down * CLEARANCE);
        let bar = to_object * self.support.bar_or_spread(&contact.position, &contact.normal);
        let down = to_object * down;
        meter.rays(1)?;
        let room = self.body.surface.closest_hit(&start, &down).unwrap_or(f32::INFINITY);
        let capture = opening::capture(self.body.surface, &start, (&down, &bar), room, meter)?;
        Ok((opening::height(capture, room) / self.body.reach).min(1.0))
    }

    fn count_firm(&mut self, rest: &Rest) {
        let is_preferred = self.request.prefer.contains(rest.kind);
        let is_firm = rest.is_firm();
        self.counts.firm += usize::from(is_firm);
        self.counts.firm_as_preferred += usize::from(is_firm && is_preferred);
    }

    /// The rest pose among `poses` that equals `pose` to within a robot's accuracy, or that is firm, as preferred, and hardly
    /// different: there is little to gain from a closer look.
    fn known(&self, pose: &Pose, poses: &Best<HangingPose>) -> Option<Rest> {
        let is_known = |rest: &Rest| {
            let is_good = rest.is_firm() && self.request.prefer.contains(rest.kind);
            self.is_like(rest, pose, if is_good { &self.request.distinct } else { &SAME })
        };
        poses.iter().filter_map(|other| other.rest).find(is_known)
    }

    /// Whether a pose is closer to a rest pose than a distance, whichever way the object is turned by its symmetries.
    fn is_like(&self, rest: &Rest, pose: &Pose, distance: &Distance) -> bool {
        rest.is_like(pose, self.body, self.symmetries, distance)
    }

    fn settle(&mut self, start: &Pose, meter: &mut Meter) -> Result<Settled, Stop> {
        let settings = Settings::damped(self.params);
        settle((self.body, self.support), start, &-self.params.up(), settings, self.sleeps, meter)
    }

    /// A release pose off the supporter and close to a rest pose, and the rest pose that it leads to. The release is
    /// simulated again, because it may lead elsewhere; if it does, the search goes on from there.
    fn find_release(
        &mut self,
        rests: Settled,
        meter: &mut Meter,
    ) -> Result<Option<(Release, Settled)>, Stop> {
        let scene = (self.body, self.support);
        let (up, clearance) = (self.params.up(), self.params.clearance);
        let mut settled = rests;
        for _ in 0..MAX_RELEASES {
            if settled.fate != Fate::Rests {
                break;
            }
            let (pose, gap) = release_pose(scene, &settled.pose, clearance, &up, self.sleeps, meter)?;
            if gap < MIN_RELEASE_GAP {
                break;
            }
            let Some(pushed) = push_off_surface(scene, &pose, MIN_RELEASE_GAP, meter)? else { break };
            // Other parts of the supporter may be nearer by as much as the pose is shifted.
            let shift = (pushed.translation.vector - pose.translation.vector).norm();
            let (pose, gap) = (pushed, (gap - shift).max(MIN_RELEASE_GAP));
            settled = self.settle(&pose, meter)?;
            let centre = &self.body.centre;
            let sinking = up.dot(&(pose * centre - settled.pose * centre));
            if settled.fate == Fate::Rests && sinking < MAX_RELEASE_SINKING {
                return Ok(Some((Release { pose, gap, sinking }, settled)));
            }
        }
        Ok(None)
    }
}
