//! How the gripper lets go: it opens, and leaves.

use super::end::End;
use super::failure::PlanFailure;
use super::gripper::Hand;
use super::path::MAX_CLEARANCE;
use super::placement::{Leg, Placement};
use super::space::{Moving, Space};
use crate::geometry::{Pose, Vector};
use crate::monitor::Meter;

/// Steps in which the gripper opens.
const OPENING_STEPS: u8 = 8;

/// Whether the gripper can open at a place; `space` has it alone. While it opens it may touch the object, which it still holds;
/// once open it must be off.
pub(super) fn open(space: &Space, at: &Placement, meter: &mut Meter) -> Result<(), End> {
    for step in 0..=OPENING_STEPS {
        let opening = f32::from(step) / f32::from(OPENING_STEPS);
        let moving = Moving { opening, ..space.moving };
        let obstacles = if step < OPENING_STEPS { space.obstacles.without_object() } else { space.obstacles };
        let mut space = Space::of_gripper(moving, obstacles);
        let nearest = space.nearest(at, MAX_CLEARANCE, meter)?;
        if let Some(touch) = nearest.touch.filter(|touch| touch.distance <= 0.0) {
            return Err(PlanFailure::GripperCannotOpen(touch.collision()).into());
        }
    }
    Ok(())
}

/// The straight way that the gripper is meant to leave by, from the rest pose of the object; `None` if there is none.
pub(super) fn straight(hand: &Hand, rest: &Pose) -> Option<Leg> {
    let shift = rest.rotation * hand.retreat;
    (shift.norm_squared() > 0.0).then_some(Leg { shift, turn: Vector::zeros() })
}
