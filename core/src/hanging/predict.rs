//! From two models to ranked poses, or the reason why there are none.

use super::candidates::CandidateSearch;
use super::matching::{MatchingCounts, match_sites};
use super::settling::{Settling, SettlingCounts};
use super::{HangabilityCounts, HangingPose, Object, SupportabilityCounts, Supporter};
use crate::best::Best;
use crate::mechanics::{Sleep, Support};
use crate::memory::{Arena, Limits, OutOfMemory, array_bytes, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::{Candidates, Params, ParamsError};

/// What [`predict`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction<'p> {
    /// The poses, best first.
    pub poses: &'p [HangingPose],
    /// Why there are none, if there are none and the search was not stopped.
    pub rejection: Option<Rejection>,
    /// Why the search ended early, if it did, here or in the analysis of the object or the supporter. The poses
    /// are the best until then.
    pub stopped: Option<Stop>,
    /// What was left after each step.
    pub counts: Counts,
    /// Rays and distance queries spent on matching.
    pub work: Work,
}

/// Nothing hangs, and this is why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rejection {
    /// The step that left nothing.
    pub stage: Stage,
    /// What was left after each step.
    pub counts: Counts,
}

/// What was left after each step of the method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Counts {
    /// Of the object, section II-B.
    pub hangability: HangabilityCounts,
    /// Of the supporter, section II-C.
    pub supportability: SupportabilityCounts,
    /// Of their matches, section II-D.
    pub matching: MatchingCounts,
    /// Of what was let go.
    pub settling: SettlingCounts,
}

/// The step of the method that left nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Stage {
    /// Nowhere does the object's surface face its centre of mass, or only in specks: eqs. (3) and (4).
    NoContactPoints,
    /// There is no room beside the object's contact points for a supporter.
    NoFreeSpace,
    /// The free spaces are open to the side, so that a supporter would slip out: eq. (6).
    NotEncircled,
    /// Nothing on the supporter faces up and holds together: section II-C.
    NoSupport,
    /// The supporter is too thick for every free space of the object.
    TooThick,
    /// Every pose runs the supporter through the object.
    AllCollide,
    /// Let go, the object turns and falls off, or most often does.
    RotatesOff,
    /// Let go, the object slides off or falls through, or most often does.
    SlidesOff,
    /// Let go, the object does not come to rest.
    NeverRests,
    /// The object comes to rest, but a nudge would bring it down, it would not come off again, or there is no room to put it
    /// there.
    TooLoose,
}

impl core::fmt::Display for Stage {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NoContactPoints => {
                "the object has no surface that faces its centre of mass and could rest on a support"
            }
            Self::NoFreeSpace => "the object has no free space for a supporter beside its contact points",
            Self::NotEncircled => {
                "the object does not enclose any of its free spaces, a supporter would slip out"
            }
            Self::NoSupport => "the supporter has no part that faces up",
            Self::TooThick => {
                "every part of the supporter that faces up is too thick for the object's free spaces"
            }
            Self::AllCollide => "in every pose the supporter runs through the object",
            Self::RotatesOff => "wherever it is let go, the object rotates off",
            Self::SlidesOff => "wherever it is let go, the object slides off",
            Self::NeverRests => "wherever it is let go, the object does not come to rest",
            Self::TooLoose => "where the object comes to rest it is stuck, or a nudge would bring it down",
        })
    }
}

/// Why nothing can be predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PredictError {
    /// A constant is out of range.
    Params(ParamsError),
    /// The memory is too small.
    OutOfMemory(OutOfMemory),
    /// The params ask to let the object go, but it was analysed without [`voxels`](Params::voxels).
    NoDistanceField,
}

impl From<ParamsError> for PredictError {
    fn from(error: ParamsError) -> Self {
        Self::Params(error)
    }
}

impl From<OutOfMemory> for PredictError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl core::fmt::Display for PredictError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Params(error) => error.fmt(f),
            Self::OutOfMemory(error) => error.fmt(f),
            Self::NoDistanceField => f.write_str(
                "the object was analysed with voxels = 0: analyse it and the supporter with the params of the prediction",
            ),
        }
    }
}

impl core::error::Error for PredictError {}

/// Bytes of working memory for [`predict`], for a supporter within `limits`.
pub const fn predict_bytes(limits: &Limits) -> usize {
    let sleeps = array_bytes::<Sleep>(Support::sleepers(limits.points));
    model_bytes(CandidateSearch::bytes().saturating_add(sleeps))
}

/// Finds poses in which the object hangs and writes the best to `poses`, best first, as many as it holds.
///
/// With [`Candidates::Sites`] every hanging site is matched with every support site; those that would be written behind the
/// last pose are not looked at to the end: more room costs more time. With [`Params::settle`] poses are let go, and
/// only those that stay are given. `memory` is working memory, [`predict_bytes`] of it; its contents do not matter.
///
/// The object and the supporter must have been analysed with the same `params`.
pub fn predict<'p>(
    object: &Object,
    supporter: &Supporter,
    params: &Params,
    poses: &'p mut [HangingPose],
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Prediction<'p>, PredictError> {
    params.validate()?;
    let points = supporter.points().points().len();
    let limits = Limits { points, ..Limits::NONE };
    let mut arena = Arena::new(memory, predict_bytes(&limits))?;
    let mut meter = Meter::new(monitor);
    let mut counts = Counts {
        hangability: object.counts(),
        supportability: supporter.counts(),
        matching: MatchingCounts::default(),
        settling: SettlingCounts::default(),
    };
    let body = object.body();
    let support = supporter.support();
    let needs_body = params.settle || params.candidates == Candidates::Contacts;
    if needs_body && body.is_none() {
        return Err(PredictError::NoDistanceField);
    }
    let mut best = Best::new(poses);
    let mut stop = None;
    if params.candidates == Candidates::Sites {
        (counts.matching, stop) = match_sites(object, supporter, params, &mut best, &mut meter);
    }
    if let Some(body) = &body
        && needs_body
    {
        let sleeps = arena.slice::<Sleep>(Support::sleepers(points))?;
        let mut settling = Settling { body, support, params, sleeps, counts: counts.settling };
        let result = match params.candidates {
            Candidates::Sites => {
                let matched = best.into_slice();
                let (left, result) = settling.sieve(matched, &mut meter);
                best = Best::filled(matched, left);
                result
            }
            Candidates::Contacts => {
                let scene = (body, support);
                let mut candidates = CandidateSearch::new(
                    scene,
                    object.contacts(),
                    supporter.contacts(),
                    params.up(),
                    &mut arena,
                )?;
                let result = settling.search(&mut candidates, &mut best, &mut meter);
                (settling.counts.candidates, settling.counts.clear) = (candidates.made, candidates.clear);
                result
            }
        };
        stop = stop.or(result.err());
        counts.settling = settling.counts;
    }
    meter.progress(1.0);
    let stopped = object.stopped().or(supporter.stopped()).or(stop);
    let poses = best.into_slice();
    let rejection = if stopped.is_some() { None } else { empty_stage(&counts, params) };
    Ok(Prediction {
        poses,
        rejection: rejection.map(|stage| Rejection { stage, counts }),
        stopped,
        counts,
        work: meter.work,
    })
}

/// The first step that left nothing.
fn empty_stage(counts: &Counts, params: &Params) -> Option<Stage> {
    let Counts { hangability, supportability, matching, settling } = counts;
    let by_sites = [
        (hangability.clusters, Stage::NoContactPoints),
        (hangability.with_free_space, Stage::NoFreeSpace),
        (hangability.encircled, Stage::NotEncircled),
        (supportability.sites, Stage::NoSupport),
        (matching.fitting, Stage::TooThick),
        (matching.clear, Stage::AllCollide),
    ];
    let by_contacts = [
        (hangability.contacts, Stage::NoContactPoints),
        (supportability.contacts, Stage::NoSupport),
        (settling.clear, Stage::AllCollide),
    ];
    let steps = match params.candidates {
        Candidates::Sites => &by_sites[..],
        Candidates::Contacts => &by_contacts[..],
    };
    let empty = steps.iter().find(|(left, _)| *left == 0).map(|(_, stage)| *stage);
    if empty.is_some() || !params.settle || settling.probable > 0 {
        return empty;
    }
    // Nothing stayed of what was let go: what befell most.
    let fates = [
        (settling.at_rest, Stage::TooLoose),
        (settling.rotated_off, Stage::RotatesOff),
        (settling.slid_off, Stage::SlidesOff),
        (settling.moving, Stage::NeverRests),
    ];
    let befell_most = fates.iter().rev().max_by_key(|(count, _)| *count).filter(|(count, _)| *count > 0);
    Some(befell_most.map_or(Stage::AllCollide, |(_, stage)| *stage))
}
