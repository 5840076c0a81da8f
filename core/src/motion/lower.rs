//! The last millimetres of a path: from the release pose down to the rest pose, or to where the object nearly touches before.

use super::placement::{Leg, Placement};
use super::space::Space;
use crate::mechanics::is_closer;
use crate::monitor::{Meter, Stop};

/// Distance that the object keeps from the supporter at the end of a path, metres, both by the distance field and by the mesh and the
/// points of the supporter. Rest poses are found with the field, whose error in thin walls is that of a voxel: a robot that went on would
/// press, and what is pressed may jump off when it is let go.
const GAP: f32 = 0.0003;
/// Largest travel between two poses that are tested, metres, as long as [`MAX_STEPS`] allow it: as on the way. A wire that is thicker
/// than this is not missed between a pose above the surface and one that is below it altogether.
const STEP: f32 = 0.001;
/// Most steps of the way down, which bound its cost.
const MAX_STEPS: usize = 16;
/// Halvings of the last step: to a hundredth of a millimetre.
const HALVINGS: usize = 5;

/// The part of `lowering`, the way from the release pose to the rest pose, at the end of which the object nearly touches.
pub(super) fn until_near(
    space: &mut Space,
    release: &Placement,
    lowering: Leg,
    meter: &mut Meter,
) -> Result<Leg, Stop> {
    let Some(body) = space.moving.body else { return Ok(lowering) };
    let travel = lowering.travel(space.moving.reach);
    let mut is_close = |share: f32| {
        let place = release.after(&lowering, share);
        let pose = place.pose(&space.moving.centre);
        Ok(space.distance_if_free(&place, GAP, meter)?.is_none()
            || is_closer((&body, space.obstacles.support), &pose, GAP, meter)?)
    };
    let steps = (libm::ceilf(travel / STEP) as usize).clamp(1, MAX_STEPS);
    for step in 1..=steps {
        let (mut free, mut close) = ((step - 1) as f32 / steps as f32, step as f32 / steps as f32);
        if !is_close(close)? {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (free + close);
            if is_close(middle)? { close = middle } else { free = middle }
        }
        return Ok(lowering.scaled(free));
    }
    Ok(lowering)
}
