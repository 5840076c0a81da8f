//! From two models to ranked poses, or the reason why there are none.

use super::matching::{MatchingCounts, match_sites};
use super::{HangabilityCounts, HangingPose, Object, SupportabilityCounts, Supporter};
use crate::best::Best;
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::{Params, ParamsError};

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
        })
    }
}

/// Matches every hanging site with every support site and writes the best poses to `poses`, best first, as many
/// as it holds.
///
/// Poses that would be written behind the last one are not looked at to the end: more room costs more time.
pub fn predict<'p>(
    object: &Object,
    supporter: &Supporter,
    params: &Params,
    poses: &'p mut [HangingPose],
    monitor: &Monitor,
) -> Result<Prediction<'p>, ParamsError> {
    params.validate()?;
    let mut meter = Meter::new(monitor);
    let mut best = Best::new(poses);
    let (matching, stop) = match_sites(object, supporter, params, &mut best, &mut meter);
    meter.progress(1.0);
    let counts = Counts { hangability: object.counts(), supportability: supporter.counts(), matching };
    let stopped = object.stopped().or(supporter.stopped()).or(stop);
    let rejection = if stopped.is_some() { None } else { empty_stage(&counts) };
    Ok(Prediction {
        poses: best.into_slice(),
        rejection: rejection.map(|stage| Rejection { stage, counts }),
        stopped,
        counts,
        work: meter.work,
    })
}

/// The first step that left nothing, if there is one.
fn empty_stage(counts: &Counts) -> Option<Stage> {
    let Counts { hangability, supportability, matching } = counts;
    let steps = [
        (hangability.clusters, Stage::NoContactPoints),
        (hangability.with_free_space, Stage::NoFreeSpace),
        (hangability.encircled, Stage::NotEncircled),
        (supportability.sites, Stage::NoSupport),
        (matching.fitting, Stage::TooThick),
        (matching.clear, Stage::AllCollide),
    ];
    steps.into_iter().find(|(left, _)| *left == 0).map(|(_, stage)| stage)
}
