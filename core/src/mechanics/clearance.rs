//! Whether a pose keeps the object off the supporter.

use super::touch::nearest_on_patch;
use super::{Body, Support};
use crate::geometry::{Point, Pose};
use crate::monitor::{Meter, Stop};

/// A place of the supporter that is not farther than `clearance` metres from the object at `pose`, or that is deep in it, if there is one.
pub(crate) fn first_within(
    scene: (&Body, &Support),
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<Option<Point>, Stop> {
    let field = scene.0.field;
    // Beyond the band the field may say no more than that a point is there.
    let clearance = clearance.min(0.9 * field.band());
    let is_off = |point: &Point, radius: f32| field.distance(point) - radius > clearance;
    first(scene, pose, clearance, is_off, |point| is_off(point, 0.0), |_, _| false, meter)
}

/// Whether every point of the supporter is farther than `clearance` metres from the object's surface, exactly, and no bar of it passes
/// through that between its points, be it of something without an inside. It is not clear either where the field overlooks something
/// thin, such as the strings of a racquet, that passes closer to a point of the supporter than the points are apart: it may run through
/// between them.
pub(crate) fn is_off_surface(
    scene: (&Body, &Support),
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let (field, surface, thin) = (scene.0.field, scene.0.surface, 0.5 * scene.1.reach);
    let greatest = clearance.max(scene.1.reach);
    let is_off = |point: &Point, radius: f32| !surface.is_within(point, radius + greatest);
    let is_point_off = |point: &Point| {
        let is_overlooked = || {
            field.distance(point) > thin + OVERLOOKED * field.voxel_size() && surface.is_within(point, thin)
        };
        !surface.is_within(point, clearance) && !is_overlooked()
    };
    let crosses = |from: &Point, to: &Point| {
        let way = to - from;
        let length = way.norm();
        length > 0.0 && surface.closest_hit(from, &(way / length)).is_some_and(|hit| hit < length)
    };
    Ok(first(scene, pose, greatest, is_off, is_point_off, crosses, meter)?.is_none())
}

/// The field is farther off than its error, in voxels, only where it overlooks something.
const OVERLOOKED: f32 = 0.3;

/// A patch that is deeper in the body than this, metres, is seen to run through it; less may be what patches are off the surface.
const DEEP: f32 = 0.001;

/// The first point of the supporter of which `is_point_off`, asked in object coordinates, is not true, or the deepest place of a patch
/// that is deep in the body, or the point of one on a bar between whose line's ends `crosses` is true. Points that are farther than
/// `distance` from a ball around the body are off, and so is everything within a radius of a point of which `is_off` says so.
fn first(
    (body, support): (&Body, &Support),
    pose: &Pose,
    distance: f32,
    is_off: impl Fn(&Point, f32) -> bool,
    is_point_off: impl Fn(&Point) -> bool,
    crosses: impl Fn(&Point, &Point) -> bool,
    meter: &mut Meter,
) -> Result<Option<Point>, Stop> {
    let to_object = pose.inverse();
    let rotation = pose.rotation.to_rotation_matrix();
    let points = support.tree.points();
    let deepest = |patch: usize| {
        let (place, patch) = (support.place(patch), &support.patches[patch]);
        let at = to_object * place;
        if let Ok(nearest) = nearest_on_patch(body, patch, &rotation, &at, -DEEP)
            && nearest.gap < -DEEP
        {
            return Some(pose * nearest.at);
        }
        let [from, to] = patch.line().map(|step| at + rotation.inverse_transform_vector(&step));
        crosses(&from, &to).then_some(place)
    };
    let (mut found, mut queries) = (None, 0);
    support.tree.bvh().descend(|_, node| {
        if found.is_some() {
            return false;
        }
        let aabb = node.aabb();
        let (centre, radius) = (to_object * aabb.centre(), 0.5 * aabb.diagonal());
        queries += 1;
        if body.is_beyond(&centre, radius + distance) || is_off(&centre, radius) {
            return false;
        }
        if let Some(items) = node.items() {
            queries += items.len();
            let is_near = |index: &usize| !is_point_off(&(to_object * points[*index]));
            let near = items.clone().find(is_near).map(|index| points[index]);
            found = near.or_else(|| support.patches_of(&items).find_map(deepest));
        }
        found.is_none()
    });
    meter.distance_queries(queries)?;
    Ok(found)
}
