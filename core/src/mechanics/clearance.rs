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
        let distance = body.field.distance(&(to_object * aabb.centre()));
        queries += 1;
        if distance - radius > clearance {
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

/// The same, exactly, for shapes finer than the field's voxels, such as the strings of a racquet.
pub(crate) fn is_off_surface(
    body: &Body,
    support: &Support,
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let to_object = pose.inverse();
    let (mut clear, mut queries) = (true, 0);
    support.tree.bvh().descend(|_, node| {
        if !clear {
            return false;
        }
        let aabb = node.aabb();
        let centre = to_object * aabb.centre();
        queries += 1;
        if !body.surface.is_within(&centre, 0.5 * aabb.diagonal() + clearance) {
            return false;
        }
        if let Some(items) = node.items() {
            queries += items.len();
            let is_off = |point| !body.surface.is_within(&(to_object * point), clearance);
            clear = support.tree.points()[items].iter().all(is_off);
        }
        clear
    });
    meter.distance_queries(queries)?;
    Ok(clear)
}
