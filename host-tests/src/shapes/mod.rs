//! Objects and supporters of many kinds, each made anew from a seed, with sizes as they vary in life.
//!
//! All are closed surfaces with the convex parts that fill them, in metres. An object's frame is its own. A supporter
//! stands with z up; one on a wall has its plate's front at x = 0 and points towards +x.
//!
//! What fits on what is marked from how the shapes were made, not by anything that predicts: see [`fits`].

mod builder;
mod fits;
mod objects;
mod openings;
mod random;
mod sections;
mod supporters;
pub mod vector;

pub use fits::fits;
pub use objects::OBJECTS;
pub use random::Random;
pub use supporters::SUPPORTERS;

use crate::solid::Solid;

/// A kind of object.
pub struct ObjectKind {
    /// What it is called.
    pub name: &'static str,
    /// Whether it has anything to hang by.
    pub is_hangable: bool,
    make: fn(&mut Random) -> HangObject,
}

impl ObjectKind {
    /// The one that this seed names: the same on every machine.
    pub fn make(&self, seed: u64) -> HangObject {
        (self.make)(&mut Random::named(self.name, seed))
    }
}

/// A kind of supporter.
pub struct SupporterKind {
    /// What it is called.
    pub name: &'static str,
    make: fn(&mut Random) -> Support,
}

impl SupporterKind {
    /// The one that this seed names: the same on every machine.
    pub fn make(&self, seed: u64) -> Support {
        (self.make)(&mut Random::named(self.name, seed))
    }
}

/// An object, and by what it can hang.
#[derive(Clone, Debug)]
pub struct HangObject {
    /// Its shape.
    pub solid: Solid,
    /// Every way to hang it that it was made with; none if it is unhangable.
    pub openings: Vec<Opening>,
}

/// How an opening holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OpeningKind {
    /// Closed all around: a bar's free end must go through.
    Hole,
    /// Open on one side: it also goes over a bar that has no free end.
    Hook,
    /// A hollow, open below, that goes over the end of a bar that points up. The axis points out of the hollow.
    Rim,
    /// A stem that hangs between two bars by the wider head above it. The axis points from the stem to the head.
    Neck {
        /// The head's radius.
        head_radius: f32,
    },
}

/// A place to hang an object by, in object coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Opening {
    /// How it holds.
    pub kind: OpeningKind,
    /// The middle of the widest bar that it passes.
    pub centre: [f32; 3],
    /// Unit vector along that bar.
    pub axis: [f32; 3],
    /// The radius of that bar, which is straight and reaches at least 5 mm to both sides; for a
    /// [`OpeningKind::Neck`] the stem's radius. Metres.
    pub clear_radius: f32,
}

/// A supporter, and what it offers to hang on.
#[derive(Clone, Debug)]
pub struct Support {
    /// Its shape, with its plate or stand.
    pub solid: Solid,
    /// Every part that something can hang on.
    pub bars: Vec<Bar>,
}

/// A part of a supporter that something can hang on, in its coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// Where its usable part begins, on its centre line.
    pub position: [f32; 3],
    /// Unit vector along it, towards its free end if it has one.
    pub direction: [f32; 3],
    /// Length of its usable part, metres.
    pub length: f32,
    /// Its own radius, metres.
    pub radius: f32,
    /// The radius that an opening must pass on the way to it, as of a ball at its end; at least `radius`,
    /// and infinite where nothing goes around it, but it holds a [`OpeningKind::Neck`].
    pub pass_radius: f32,
    /// How far `direction` points above the horizon, radians.
    pub tilt: f32,
    /// Whether a hole can be put over its end.
    pub has_free_end: bool,
    /// Horizontal unit vector away from the wall or post that it is fixed to, and how far `position` is from there
    /// in metres. None where nothing is in the way.
    pub wall: Option<([f32; 3], f32)>,
    /// Free height below `position`, metres; infinite on a wall.
    pub drop: f32,
    /// Width of the free gap to the bar beside it at the same height, metres; 0 if there is none.
    pub gap: f32,
}
