//! What a caller wants of the poses: how and where the object hangs, and what it must not touch.

use super::Object;
use super::region::{Region, RegionError};
use super::watch::Watch;
use crate::geometry::{MAX_COORDINATE, MAX_FOLD, Pose, Symmetry, Vector, is_rigid};
use crate::mechanics::{Kind, Kinds};
use core::fmt;

/// What a caller wants of the poses of one prediction. The default is anything anywhere.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The kinds that are given at all.
    pub allow: Kinds,
    /// The kinds that come first. Of the others, [`Kind::Capped`] comes before [`Kind::Balanced`]. A pose of a kind that
    /// comes later is ranked before one that comes first only if it is much more probable: see `docs/KINDS.md`.
    pub prefer: Kinds,
    /// The part of the supporter that carries the object, in supporter coordinates.
    pub on: Region<'a>,
    /// The part of the object by which it hangs, in object coordinates.
    pub by: Region<'a>,
    /// From where the object comes to its release pose.
    pub approach: Option<Approach>,
    /// Points of things near the supporter, in supporter coordinates, metres. The object does
    /// not touch them and never hangs on them. They are not simulated.
    pub scene: &'a [[f32; 3]],
    /// Objects that hang on the supporter already. As the scene, with their exact shapes.
    pub hung: &'a [Hung<'a>],
    /// How much two poses of the same kind differ at least, whichever way the object is turned by its symmetries.
    pub distinct: Distance,
    /// Turns after which the object is the same, so that poses that differ by one are one pose; `None` for those that were
    /// detected, [`Object::symmetries`]. One after another, two of them about different axes may be made.
    pub symmetries: Option<&'a [Symmetry]>,
    /// Called for each candidate that is released. It changes nothing in the prediction.
    pub watch: Option<Watch<'a>>,
}

/// A straight way of the object to its release pose, free of collisions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Direction in which the object moves, in supporter coordinates; any length but zero.
    pub direction: [f32; 3],
    /// Largest angle between the way and this direction, radians, 0 to π.
    pub angle: f32,
    /// Length of the way that is free, metres, 0 to 10.
    pub length: f32,
}

/// An object that hangs already.
#[derive(Clone, Copy)]
pub struct Hung<'a> {
    /// The object.
    pub object: &'a Object<'a>,
    /// Its pose: object to supporter coordinates.
    pub pose: Pose,
}

/// A distance between poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Between the centres of mass, metres.
    pub position: f32,
    /// Angle of the rotation from one to the other, radians.
    pub rotation: f32,
}

impl fmt::Debug for Hung<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hung").field("pose", &self.pose).finish_non_exhaustive()
    }
}

impl<'a> Request<'a> {
    /// Anything anywhere; threaded and hooked poses first.
    pub const ANY: Self = Self {
        allow: Kinds::ALL,
        prefer: Kinds::of(&[Kind::Threaded, Kind::Hooked]),
        on: Region::Everywhere,
        by: Region::Everywhere,
        approach: None,
        scene: &[],
        hung: &[],
        distinct: Distance { position: 0.02, rotation: 0.35 },
        symmetries: None,
        watch: None,
    };

    /// Checks every value.
    pub fn validate(&self) -> Result<(), RequestError> {
        if self.allow == Kinds::NONE {
            return Err(RequestError::NothingAllowed);
        }
        self.on.validate().map_err(RequestError::On)?;
        self.by.validate().map_err(RequestError::By)?;
        if let Some(Approach { direction, angle, length }) = self.approach {
            let squared = Vector::from(direction).norm_squared();
            let is_valid = squared.is_finite()
                && squared > 1e-12
                && (0.0..=core::f32::consts::PI).contains(&angle)
                && (0.0..=10.0).contains(&length);
            if !is_valid {
                return Err(RequestError::Approach);
            }
        }
        let is_usable = |point: &[f32; 3]| point.iter().all(|x| x.abs() <= MAX_COORDINATE);
        if let Some(point) = self.scene.iter().position(|point| !is_usable(point)) {
            return Err(RequestError::Scene { point, position: self.scene[point] });
        }
        if let Some(index) = self.hung.iter().position(|hung| !is_rigid(&hung.pose)) {
            return Err(RequestError::Hung { index });
        }
        let Distance { position, rotation } = self.distinct;
        if !((0.0..=10.0).contains(&position) && (0.0..=core::f32::consts::PI).contains(&rotation)) {
            return Err(RequestError::Distinct);
        }
        let given = self.symmetries.unwrap_or_default();
        if let Some(index) = given.iter().position(|symmetry| !symmetry.is_valid()) {
            return Err(RequestError::Symmetry { index });
        }
        Ok(())
    }

    /// The symmetries that poses are compared by: those that are given, or else those of the object.
    pub fn symmetries_of<'o>(&self, object: &'o Object) -> &'o [Symmetry]
    where
        'a: 'o,
    {
        self.symmetries.unwrap_or_else(|| object.symmetries())
    }

    /// How much the rank of a pose of a kind counts, 0 to 1: a pose that holds with probability p is ranked by p times this.
    pub(super) fn weight(&self, kind: Kind) -> f32 {
        match kind {
            _ if self.prefer.contains(kind) => 1.0,
            Kind::Balanced => BALANCED_WEIGHT,
            _ => LATER_WEIGHT,
        }
    }
}

impl Default for Request<'_> {
    fn default() -> Self {
        Self::ANY
    }
}

/// Share of its probability with which a pose of a kind that is not preferred is ranked. A preferred pose that holds in three of
/// four cases comes before another kind that is certain: what is asked for is tried first, and the next one remains.
const LATER_WEIGHT: f32 = 0.75;
/// The same for balanced poses: they come last unless hardly anything else holds.
const BALANCED_WEIGHT: f32 = 0.5;

/// Why a request cannot be met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RequestError {
    /// No kind is allowed.
    NothingAllowed,
    /// [`Request::on`] is invalid.
    On(RegionError),
    /// [`Request::by`] is invalid.
    By(RegionError),
    /// The approach has no direction, or its angle or length is out of range.
    Approach,
    /// A coordinate of the scene is infinite, not a number, or too large.
    Scene {
        /// Index of the point.
        point: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// The pose of an object that hangs already is too far away or not a number, or its rotation is not a unit quaternion.
    Hung {
        /// Index of the object.
        index: usize,
    },
    /// A distance between poses is negative, too large, or not a number.
    Distinct,
    /// A symmetry has no axis, or a fold that is 1 or too large.
    Symmetry {
        /// Index of the symmetry.
        index: usize,
    },
}

impl fmt::Display for RequestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingAllowed => f.write_str("no kind of pose is allowed: allow at least one"),
            Self::On(error) => write!(f, "the region of the supporter {error}"),
            Self::By(error) => write!(f, "the region of the object {error}"),
            Self::Approach => f.write_str(
                "the approach needs a direction that is not zero, an angle of 0 to π radians and a length of 0 to 10 metres",
            ),
            Self::Scene { point, position } => write!(
                f,
                "point {point} of the scene is at {position:?}: every coordinate must be a number of metres within ±{MAX_COORDINATE}"
            ),
            Self::Hung { index } => write!(
                f,
                "object {index} that hangs already needs a position within ±{MAX_COORDINATE} metres and a unit quaternion"
            ),
            Self::Distinct => f.write_str(
                "the distance between poses must be 0 to 10 metres and 0 to π radians",
            ),
            Self::Symmetry { index } => write!(
                f,
                "symmetry {index} of the object needs an axis that is not zero and a fold of 2 to {MAX_FOLD}, or 0 for any angle"
            ),
        }
    }
}

impl core::error::Error for RequestError {}
