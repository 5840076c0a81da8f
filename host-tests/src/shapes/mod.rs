//! Objects and supporters of many kinds, generated from a seed with realistic sizes.
//!
//! All are closed surfaces with convex parts that fill them, in metres. An object has its own frame. A supporter has z
//! up; on a wall, the front of its plate is at x = 0 and it points towards +x.
//!
//! Whether an object fits on a supporter, how a person would hang it, and how it hangs at a rest pose follow from their
//! construction, independent of any predictor: see [`fits`], [`meant`], [`joined`] and [`insertion`].

mod builder;
mod fits;
mod insertion;
mod meant;
mod objects;
mod openings;
mod random;
mod sections;
mod supporters;
pub mod vector;

pub use builder::Builder;
pub use insertion::{Insertion, insertion};
pub use meant::{Joint, fits, is_daily, joined, joints, meant};
pub use objects::OBJECTS;
pub use random::Random;
pub use supporters::SUPPORTERS;

use crate::solid::Solid;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

/// A kind of object.
pub struct ObjectKind {
    /// Name in the tables.
    pub name: &'static str,
    /// Whether objects of this kind can hang on some supporter.
    pub is_hangable: bool,
    make: fn(&mut Random) -> HangObject,
}

impl ObjectKind {
    /// Generates the shape of this seed, with the same bits on every machine.
    pub fn make(&self, seed: u64) -> HangObject {
        (self.make)(&mut Random::named(self.name, seed))
    }
}

/// A kind of supporter.
pub struct SupporterKind {
    /// Name in the tables.
    pub name: &'static str,
    make: fn(&mut Random) -> Support,
}

impl SupporterKind {
    /// Generates the shape of this seed, with the same bits on every machine.
    pub fn make(&self, seed: u64) -> Support {
        (self.make)(&mut Random::named(self.name, seed))
    }
}

/// An object and the openings by which it can hang.
#[derive(Clone, Debug)]
pub struct HangObject {
    /// Its shape.
    pub solid: Solid,
    /// All openings by construction; empty if the object is unhangable.
    pub openings: Vec<Opening>,
}

impl HangObject {
    /// The same object in another size.
    pub fn scaled(&self, factor: f32) -> Self {
        let scale = |point: [f32; 3]| point.map(|x| x * factor);
        let openings = self.openings.iter().map(|opening| Opening {
            kind: match opening.kind {
                OpeningKind::Neck { head_radius } => OpeningKind::Neck { head_radius: head_radius * factor },
                other => other,
            },
            centre: scale(opening.centre),
            clear_radius: opening.clear_radius * factor,
            ..*opening
        });
        Self { solid: self.solid.scaled(factor), openings: openings.collect() }
    }

    /// The same object in another frame, turned about the origin.
    pub fn turned(&self, rotation: UnitQuaternion<f32>) -> Self {
        let pose = Isometry3::from_parts(Translation3::identity(), rotation);
        let openings = self.openings.iter().map(|opening| Opening {
            centre: (rotation * Point3::from(opening.centre)).into(),
            axis: (rotation * Vector3::from(opening.axis)).into(),
            ..*opening
        });
        Self { solid: Solid::default().with([(&self.solid, pose)]), openings: openings.collect() }
    }
}

/// How an opening holds the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OpeningKind {
    /// Closed all around, so that the free end of a bar must go through.
    Hole,
    /// Open on one side, so that it also goes over a bar without a free end.
    Hook,
    /// A hollow, open below, that goes over the end of a bar that points up. The axis points out of the hollow.
    Rim,
    /// A stem between two bars, held by the wider head above it. The axis points from the stem to the head.
    Neck {
        /// Radius of the head, m.
        head_radius: f32,
    },
}

/// An opening by which an object can hang, in object coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Opening {
    /// How it holds the object.
    pub kind: OpeningKind,
    /// Whether people hang the object by it. An object may come to hang by others, such as a mug by its hollow.
    pub is_meant: bool,
    /// Centre of the widest bar that passes the opening.
    pub centre: [f32; 3],
    /// Unit vector along that bar.
    pub axis: [f32; 3],
    /// Radius of that bar, m. The bar is straight and extends at least 5 mm to both sides. For a [`OpeningKind::Neck`],
    /// the radius of the stem. An estimate if people do not hang the object by it.
    pub clear_radius: f32,
}

/// A supporter and its bars.
#[derive(Clone, Debug)]
pub struct Support {
    /// Its shape, including the plate or stand.
    pub solid: Solid,
    /// All parts on which an object can hang.
    pub bars: Vec<Bar>,
}

/// A part of a supporter on which an object can hang, in supporter coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// Start of the usable part on the centre line.
    pub position: [f32; 3],
    /// Unit vector along the bar, towards the free end if there is one.
    pub direction: [f32; 3],
    /// Length of the usable part, m.
    pub length: f32,
    /// Radius of the bar, m.
    pub radius: f32,
    /// Radius that an opening must pass on the way to the bar, such as that of a ball at its end, m. At least `radius`;
    /// infinite if no opening can enclose the bar, which can then only hold a [`OpeningKind::Neck`].
    pub pass_radius: f32,
    /// Elevation of `direction` above the horizontal, rad.
    pub tilt: f32,
    /// Whether a hole can pass over the end.
    pub has_free_end: bool,
    /// Horizontal unit vector away from the wall or post that holds the bar, and the distance of `position` from it, m.
    /// `None` if nothing is in the way.
    pub wall: Option<([f32; 3], f32)>,
    /// Free height below `position`, m; infinite on a wall.
    pub drop: f32,
    /// Width of the gap to a neighbouring bar at the same height, m; 0 without a neighbour.
    pub gap: f32,
}
