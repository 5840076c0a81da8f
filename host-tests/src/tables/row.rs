//! What became of one pair under one profile: a line of the record that a run writes and resumes from.

use crate::judge::Verdict;
use hangpose::hanging::Rest;
use serde::{Deserialize, Serialize};

/// One pair under one profile.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Row {
    /// Names the pair; the same in every run with the same seed.
    pub pair: String,
    /// `paper` or `default`.
    pub profile: String,
    /// Kind of the object.
    pub object: String,
    /// Kind of the supporter.
    pub supporter: String,
    /// Whether the pair can hang, by geometry or because a search found a pose.
    pub fits: bool,
    /// Whether it may yet hang though the search found no pose.
    #[serde(default)]
    pub doubtful: bool,
    /// Why nothing was predicted, if nothing was.
    pub rejection: Option<String>,
    /// Seconds from the models' inputs to the poses, one thread.
    pub seconds: f64,
    /// What the judge says of the best poses, best first, up to the first that succeeds.
    pub outcomes: Vec<Outcome>,
    /// What a second judge says of the best pose, if it was asked.
    pub second: Option<Outcome>,
}

/// What a judge says of one pose.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Outcome {
    /// Nothing deeper than 2 mm inside at the release.
    pub clear: bool,
    /// It stays.
    pub holds: bool,
    /// It falls when gravity is reversed.
    pub honest: bool,
    /// It stays when gravity is tilted.
    pub robust: bool,
    /// Deepest penetration at the release, metres.
    pub penetration: f32,
    /// How far the centre of mass sank, metres.
    pub sank: f32,
    /// How far the object turned, radians.
    pub turned: f32,
    /// How long the judge took, seconds; 0 if the pose was not let go.
    pub seconds: f64,
    /// What the predictor said of it, if it let gravity act.
    #[serde(default)]
    pub said: Option<Said>,
}

/// What the predictor says of a pose.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Said {
    /// That it hangs.
    pub probability: f32,
    /// Radians, in each direction.
    pub tilts: [f32; 8],
    /// Seconds that it stays when jolted.
    pub jolt_time: f32,
    /// While gravity tilts, metres.
    pub tilted_sinking: f32,
    /// Metres per second.
    pub knock_speed: f32,
    /// The rise of an escape over the lever.
    pub escape_ratio: f32,
    /// At release, metres.
    pub clearance: f32,
    /// From release to rest, metres.
    pub sinking: f32,
    /// How many.
    pub contacts: usize,
}

impl From<&Rest> for Said {
    fn from(rest: &Rest) -> Self {
        Self {
            probability: rest.probability,
            tilts: rest.margin.tilts,
            jolt_time: rest.margin.jolt_time,
            tilted_sinking: rest.margin.tilted_sinking,
            knock_speed: rest.margin.knock_speed,
            escape_ratio: rest.margin.escape_ratio,
            clearance: rest.clearance,
            sinking: rest.sinking,
            contacts: rest.contacts().len(),
        }
    }
}

impl Outcome {
    /// Of a pose that is not clear and was not let go.
    pub fn unclear(penetration: f64) -> Self {
        Self {
            clear: false,
            holds: false,
            honest: false,
            robust: false,
            penetration: penetration as f32,
            sank: 0.0,
            turned: 0.0,
            seconds: 0.0,
            said: None,
        }
    }

    /// Of a verdict that took so many seconds.
    pub fn new(verdict: &Verdict, seconds: f64) -> Self {
        let Verdict { clear, holds, honest, robust, ref figures } = *verdict;
        Self {
            clear,
            holds,
            honest,
            robust,
            penetration: figures.penetration as f32,
            sank: figures.sank as f32,
            turned: figures.turned as f32,
            seconds,
            said: None,
        }
    }

    /// DESIGN's success: clear, holds and honest.
    pub fn success(&self) -> bool {
        self.clear && self.holds && self.honest
    }

    /// Why it failed, if it did.
    pub fn failure(&self) -> Option<Failure> {
        if !self.clear {
            Some(Failure::Penetration)
        } else if !self.holds && self.turned > ROTATED_OFF {
            Some(Failure::RotatedOff)
        } else if !self.holds {
            Some(Failure::SlidOff)
        } else if !self.honest {
            Some(Failure::Wedged)
        } else {
            None
        }
    }
}

/// An object that falls and has turned by more than this, radians, is said to have rotated off.
const ROTATED_OFF: f32 = 0.7;

/// Why the best pose of a pair that fits does not hang.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub enum Failure {
    /// The object or the supporter has no place to hang by or on.
    NoSite,
    /// There are places to hang by and on, but nothing stays of what was tried.
    NoMatch,
    /// The pose runs through the supporter.
    Penetration,
    /// It fell and kept its orientation.
    SlidOff,
    /// It fell and turned.
    RotatedOff,
    /// It is stuck in the supporter.
    Wedged,
}

impl Failure {
    /// As the tables name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::NoSite => "no site",
            Self::NoMatch => "no match",
            Self::Penetration => "penetration",
            Self::SlidOff => "slid off",
            Self::RotatedOff => "rotated off",
            Self::Wedged => "wedged",
        }
    }

    /// What would mend it.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::NoSite => "more candidates: smaller clusters of sites, contacts closer together, more yaws",
            Self::NoMatch => "test the real section against the hole; more yaws; let more poses go",
            Self::Penetration => "surface between the cloud's points: thin bars are seen at few of them",
            Self::SlidOff => "a margin that sees how far a body slides before it leaves",
            Self::RotatedOff => "a probability that weighs balances on one contact less",
            Self::Wedged => "prefer openings with more play",
        }
    }
}

impl Row {
    /// What the judge says of the best pose.
    pub fn first(&self) -> Option<&Outcome> {
        self.outcomes.first()
    }

    /// Whether one of the best `count` poses succeeds.
    pub fn succeeds_within(&self, count: usize) -> bool {
        self.outcomes.iter().take(count).any(Outcome::success)
    }

    /// Why the best pose failed, if it did.
    pub fn failure(&self) -> Option<Failure> {
        match (self.first(), self.rejection.as_deref()) {
            (Some(outcome), _) => outcome.failure(),
            (None, Some("NoContactPoints" | "NoFreeSpace" | "NotEncircled" | "NoSupport")) => {
                Some(Failure::NoSite)
            }
            (None, _) => Some(Failure::NoMatch),
        }
    }
}
