//! Outcome of one pair under one profile, which is a line of the record that a run writes and resumes from.

use super::loss::Loss;
use crate::judge::Verdict;
use hangpose::hanging::Rest;
use hangpose::mechanics::Kind;
use serde::{Deserialize, Serialize};

/// Outcome of one pair under one profile.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Row {
    /// Name of the pair, the same in every run with the same seed.
    pub pair: String,
    /// Name of the profile, such as `paper` or `default`.
    pub profile: String,
    /// Numbers of images of the object and of the supporter, such as `24+3`; `None` with the exact shapes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scan: Option<String>,
    /// Kind of the object.
    pub object: String,
    /// Kind of the supporter.
    pub supporter: String,
    /// Whether the pair can hang, by geometry or because a search found a pose.
    pub fits: bool,
    /// Whether the pair may hang although the search found no pose.
    #[serde(default)]
    pub doubtful: bool,
    /// How a person would hang a generated pair that fits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meant: Option<Kind>,
    /// By how much the object's centre of mass may be wrong, m.
    #[serde(default)]
    pub centre_error: f32,
    /// Stage at which the prediction was rejected, if it was.
    pub rejection: Option<String>,
    /// Duration of analysis and prediction on one thread, s.
    pub seconds: f64,
    /// Outcomes of the best poses, best first, by default up to the first success.
    pub outcomes: Vec<Outcome>,
    /// Outcome of the best pose in the second engine, if there is one.
    pub second: Option<Outcome>,
    /// Cause for which the best pose of a scan fails on the true shapes, if the pair fits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss: Option<Loss>,
}

/// Outcome of one pose.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Outcome {
    /// The penetration depth at release is at most 2 mm.
    pub clear: bool,
    /// The object stays on the supporter.
    pub holds: bool,
    /// The object comes free under reversed gravity.
    pub honest: bool,
    /// The object stays under tilted gravity.
    pub robust: bool,
    /// Largest penetration depth at release, m.
    pub penetration: f32,
    /// Sinking of the centre of mass, m.
    pub sank: f32,
    /// Rotation angle of the object, rad.
    pub turned: f32,
    /// Duration of the judgement, s; 0 if the pose was not released.
    pub seconds: f64,
    /// Statements of the predictor about the pose, if it simulated the release.
    #[serde(default)]
    pub said: Option<Said>,
    /// How the object hangs at the rest pose of the judgement by the construction of the shapes; `None` for real meshes and
    /// if it does not hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joined: Option<Kind>,
    /// The same by the motions that free the object; only of best poses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freed: Option<Kind>,
}

/// Statements of the predictor about a pose.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Said {
    /// How the object hangs.
    pub kind: Kind,
    /// Error of the position at release that is tolerated, m, and of the rotation, rad.
    pub tolerance: [f32; 2],
    /// Probability that the object hangs.
    pub probability: f32,
    /// Probability that it is robust.
    pub robustness: f32,
    /// Tolerated tilt in each direction, rad.
    pub tilts: [f32; 8],
    /// Duration for which it survives the jolt test, s.
    pub jolt_time: f32,
    /// Sinking while gravity tilts, m.
    pub tilted_sinking: f32,
    /// Speed of a tolerated knock, m/s.
    pub knock_speed: f32,
    /// Rise of an escape divided by the lever.
    pub escape_ratio: f32,
    /// Clearance at release, m.
    pub clearance: f32,
    /// Sinking from release to rest, m.
    pub sinking: f32,
    /// Travel without contact as the object is lifted off, m.
    #[serde(default)]
    pub play: f32,
    /// Error of the centre of mass that is tolerated, m.
    #[serde(default)]
    pub centre_of_mass_radius: f32,
    /// Number of contacts at rest.
    pub contacts: usize,
    /// Shares that no camera has seen: of the directions to the object, of the supporter in the object's shadow, and of the
    /// supporter close to the object.
    #[serde(default)]
    pub unseen: [f32; 3],
}

impl From<&Rest> for Said {
    fn from(rest: &Rest) -> Self {
        Self {
            kind: rest.kind,
            tolerance: [rest.tolerance.position, rest.tolerance.rotation],
            probability: rest.probability,
            robustness: rest.robustness,
            tilts: rest.margin.tilts,
            jolt_time: rest.margin.jolt_time,
            tilted_sinking: rest.margin.tilted_sinking,
            knock_speed: rest.margin.knock_speed,
            escape_ratio: rest.margin.escape_ratio,
            clearance: rest.clearance,
            sinking: rest.sinking,
            play: rest.play(),
            centre_of_mass_radius: rest.margin.centre_of_mass_radius,
            contacts: rest.contacts().len(),
            unseen: [rest.unseen.object, rest.unseen.shadow, rest.unseen.supporter],
        }
    }
}

impl Outcome {
    /// Outcome of a pose that is not clear and was not released.
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
            joined: None,
            freed: None,
        }
    }

    /// Outcome of a verdict and the duration of its judgement in seconds.
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
            joined: None,
            freed: None,
        }
    }

    /// Whether the pose is clear, holds and is honest, as in [`Verdict::success`].
    pub fn success(&self) -> bool {
        self.clear && self.holds && self.honest
    }

    /// Cause of the failure, if the pose failed.
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

/// Rotation above which an object that falls counts as rotated off, rad.
const ROTATED_OFF: f32 = 0.7;

/// Cause of the failure of a pair that fits.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub enum Failure {
    /// The object or the supporter has no contact candidate or site.
    NoSite,
    /// There are candidates, but no pose of them stays.
    NoMatch,
    /// The object penetrates the supporter at the pose.
    Penetration,
    /// The object fell and kept its orientation.
    SlidOff,
    /// The object fell and rotated.
    RotatedOff,
    /// The object is stuck in the supporter.
    Wedged,
}

impl Failure {
    /// Name in the tables.
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

    /// Possible remedy.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::NoSite => "more candidates: smaller clusters of sites, denser contacts, more yaw angles",
            Self::NoMatch => "compare the hole with the true cross-section; more yaw angles; more releases",
            Self::Penetration => {
                "reconstruct the surface between the cloud's points, which are sparse on thin bars"
            }
            Self::SlidOff => "a margin that includes the sliding distance to an escape",
            Self::RotatedOff => "a lower probability for balances on one contact",
            Self::Wedged => "prefer openings with more play",
        }
    }
}

impl Row {
    /// Outcome of the best pose.
    pub fn first(&self) -> Option<&Outcome> {
        self.outcomes.first()
    }

    /// Whether one of the best `count` poses succeeds.
    pub fn succeeds_within(&self, count: usize) -> bool {
        self.outcomes.iter().take(count).any(Outcome::success)
    }

    /// Cause of the failure of the best pose, if it failed.
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
