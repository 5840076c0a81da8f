//! Between the coordinates of the caller and those of the analyses.

use super::{Body, Support};
use crate::geometry::{Point, Pose};

/// The frames in which an object and a supporter are analysed, each as the motion to it from the caller's coordinates. Poses are turned
/// from the one to the other where they come in and where they go out.
#[derive(Clone, Copy)]
pub(crate) struct Frames {
    /// From object coordinates.
    pub(crate) object: Pose,
    /// From supporter coordinates.
    pub(crate) supporter: Pose,
}

impl Frames {
    pub(crate) fn of((body, support): (&Body, &Support)) -> Self {
        Self { object: *body.frame, supporter: support.frame }
    }

    /// A pose that maps object to supporter coordinates, from frame to frame.
    pub(crate) fn inwards(&self, pose: &Pose) -> Pose {
        unit(self.supporter * pose * self.object.inverse())
    }

    /// A pose from frame to frame, as one that maps object to supporter coordinates.
    pub(crate) fn outwards(&self, pose: &Pose) -> Pose {
        unit(self.supporter.inverse() * pose * self.object)
    }

    /// A point in the frame of the supporter, in supporter coordinates.
    pub(crate) fn on_supporter(&self, point: &Point) -> Point {
        self.supporter.inverse_transform_point(point)
    }

    /// A point in the frame of the object, in object coordinates.
    pub(crate) fn on_object(&self, point: &Point) -> Point {
        self.object.inverse_transform_point(point)
    }
}

/// The pose without the rounding of a product of rotations.
fn unit(mut pose: Pose) -> Pose {
    pose.rotation.renormalize_fast();
    pose
}
