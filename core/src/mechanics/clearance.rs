//! Whether a pose keeps the object off the supporter.

use super::{Body, Support};
use crate::geometry::Pose;
use crate::monitor::{Meter, Stop};

/// Whether every point of the supporter is farther than `clearance` metres from the object at `pose`.
pub(crate) fn is_clear(
    body: &Body,
    support: &Support,
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let to_object = pose.inverse();
    // Beyond the band the field may say no more than that a point is there.
    let clearance = clearance.min(0.9 * body.field.band());
    let (mut clear, mut queries) = (true, 0);
    support.tree.bvh().descend(|_, node| {
        if !clear {
            return false;
        }
        let aabb = node.aabb();
        let radius = 0.5 * aabb.diagonal();
        let centre = to_object * aabb.centre();
        queries += 1;
        if body.is_beyond(&centre, radius + clearance) || body.field.distance(&centre) - radius > clearance {
            return false;
        }
        if let Some(items) = node.items() {
            queries += items.len();
            let is_off = |point| body.field.distance(&(to_object * point)) > clearance;
            clear = support.tree.points()[items].iter().all(is_off);
        }
        clear
    });
    meter.distance_queries(queries)?;
    Ok(clear)
}

/// The same, exactly. And it is not clear either where the field overlooks something thin, such as the strings of a racquet, that
/// passes closer to a point of the supporter than the points are apart: it may run through between them.
pub(crate) fn is_off_surface(
    body: &Body,
    support: &Support,
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let to_object = pose.inverse();
    let thin = 0.5 * support.disc;
    let (mut clear, mut queries) = (true, 0);
    support.tree.bvh().descend(|_, node| {
        if !clear {
            return false;
        }
        let aabb = node.aabb();
        let centre = to_object * aabb.centre();
        queries += 1;
        let radius = 0.5 * aabb.diagonal() + clearance.max(thin);
        if body.is_beyond(&centre, radius) || !body.surface.is_within(&centre, radius) {
            return false;
        }
        if let Some(items) = node.items() {
            queries += items.len();
            let is_off = |point| {
                let point = to_object * point;
                let is_overlooked = || {
                    body.field.distance(&point) > thin + OVERLOOKED * body.field.voxel_size()
                        && body.surface.is_within(&point, thin)
                };
                !body.surface.is_within(&point, clearance) && !is_overlooked()
            };
            clear = support.tree.points()[items].iter().all(is_off);
        }
        clear
    });
    meter.distance_queries(queries)?;
    Ok(clear)
}

/// The field is farther off than its error, in voxels, only where it overlooks something.
const OVERLOOKED: f32 = 0.3;
