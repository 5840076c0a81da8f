//! The hand that holds the object.

use crate::geometry::{Point, Pose, Vector};

/// A gripper as capsules that are fixed to the object while it is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gripper<'a> {
    /// Its parts, closed on the object, in object coordinates. They may touch the object.
    pub parts: &'a [Capsule],
    /// Displacement with which the opened gripper leaves the object, in object coordinates, metres. If this straight way is
    /// blocked, another one is planned; zero leaves all of it to the planner.
    pub retreat: [f32; 3],
}

/// A part of a gripper: all points within `radius` of a segment; a ball if both ends are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Capsule {
    /// One end of the segment, metres.
    pub from: [f32; 3],
    /// The other end, metres.
    pub to: [f32; 3],
    /// Radius, metres.
    pub radius: f32,
    /// Displacement when the gripper opens, metres; zero for parts that do not move, such as the palm.
    pub opening: [f32; 3],
}

/// A gripper, with its parts told in the frame of the object.
#[derive(Clone, Copy)]
pub(super) struct Hand<'a> {
    /// In the caller's object coordinates.
    parts: &'a [Capsule],
    /// From these coordinates to the frame of the object.
    frame: &'a Pose,
    /// [`Gripper::retreat`], in the frame of the object.
    pub(super) retreat: Vector,
}

/// A part of a hand at a share of its opening, in the frame of the object.
#[derive(Clone, Copy)]
pub(super) struct Finger {
    /// The ends of the segment, metres.
    pub(super) ends: [Point; 2],
    /// Metres.
    pub(super) radius: f32,
}

impl<'a> Hand<'a> {
    pub(super) fn new(gripper: &Gripper<'a>, frame: &'a Pose) -> Self {
        Self { parts: gripper.parts, frame, retreat: frame * Vector::from(gripper.retreat) }
    }

    /// Its parts, open by a share of 0 to 1.
    pub(super) fn fingers(&self, opening: f32) -> impl Iterator<Item = Finger> + use<'a> {
        let frame = self.frame;
        self.parts.iter().map(move |part| {
            let shift = Vector::from(part.opening) * opening;
            let ends = [part.from, part.to].map(|end| frame * (Point::from(end) + shift));
            Finger { ends, radius: part.radius }
        })
    }

    /// Centre of its parts, closed.
    pub(super) fn centre(&self) -> Point {
        let ends = || self.fingers(0.0).flat_map(|finger| finger.ends);
        let sum: Vector = ends().map(|end| end.coords).sum();
        Point::from(sum / ends().count().max(1) as f32)
    }

    /// Distance from a point to the farthest point of it, metres.
    pub(super) fn reach(&self, from: &Point, opening: f32) -> f32 {
        let reach = |finger: Finger| {
            finger.ends.iter().map(|end| (end - from).norm()).fold(0.0, f32::max) + finger.radius
        };
        self.fingers(opening).map(reach).fold(0.0, f32::max)
    }
}
