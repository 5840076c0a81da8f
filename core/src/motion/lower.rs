//! The last millimetres of a path: from the release pose down to the rest pose, or to where the object is in contact before.

use super::placement::{Leg, Placement};
use super::space::Space;
use crate::mechanics::is_deeper;
use crate::monitor::{Meter, Stop};

/// Depth to which the supporter may be inside the mesh of the object at the end of a path, metres. Rest poses are found with the
/// distance field, whose error in thin walls is that of a voxel; a robot that goes on to such a pose presses. More than the depth at
/// which the mechanics corrects no penetration, 0.1 mm; less than the millimetre that a path may be off.
const DEEPEST: f32 = 0.0003;
/// Distance that strings and other thin parts of the object keep from the points of the supporter, metres: between the points its
/// surface bulges by a few tenths of a millimetre, and what is pressed into a string throws it off.
const THIN_GAP: f32 = 0.0001;
/// Largest travel between two poses that are tested, metres, as long as [`MAX_STEPS`] allow it: as on the way. A wire that is thicker
/// than this is not missed between a pose above the surface and one that is below it altogether.
const STEP: f32 = 0.001;
/// Most steps of the way down, which bound its cost.
const MAX_STEPS: usize = 16;
/// Halvings of the last step: to a hundredth of a millimetre.
const HALVINGS: usize = 5;

/// The part of `lowering`, the way from the release pose to the rest pose, at the end of which the object is in contact.
pub(super) fn until_contact(
    space: &Space,
    release: &Placement,
    lowering: Leg,
    meter: &mut Meter,
) -> Result<Leg, Stop> {
    let Some(body) = &space.moving.body else { return Ok(lowering) };
    let mut is_deep = |share: f32| {
        let pose = release.after(&lowering, share).pose(&space.moving.centre);
        is_deeper((body, space.obstacles.support), &pose, (DEEPEST, THIN_GAP), meter)
    };
    let steps = (libm::ceilf(lowering.travel(space.moving.reach) / STEP) as usize).clamp(1, MAX_STEPS);
    for step in 1..=steps {
        let (mut free, mut deep) = ((step - 1) as f32 / steps as f32, step as f32 / steps as f32);
        if !is_deep(deep)? {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (free + deep);
            if is_deep(middle)? { deep = middle } else { free = middle }
        }
        return Ok(lowering.scaled(free));
    }
    Ok(lowering)
}
