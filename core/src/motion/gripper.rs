//! The hand that holds the object.

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
