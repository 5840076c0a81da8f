//! Tests whether an object is clear of the supporter.

use super::constants::{
    BAR_TO_SURFACE, FIELD_BAND_RATIO, FIELD_ERROR, MAX_PUSHES_OFF, PATCH_PENETRATION, PUSH_OFF_EXCESS,
};
use super::patch::Patch;
use super::touch::nearest_on_patch;
use super::{Body, Support};
use crate::geometry::{Node, Point, Pose, Vector, unit_or};
use crate::monitor::{Meter, Stop};
use core::cell::Cell;

/// Returns a point of the supporter that is within `clearance` metres of the object at `pose` or deep inside
/// it, if there is one.
///
/// It queries the distance field, not the mesh, and limits `clearance` to the field's band.
pub(crate) fn first_within(
    scene: (&Body, &Support),
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<Option<Point>, Stop> {
    let field = scene.0.field;
    // Beyond the band the field is only a lower bound of the distance.
    let clearance = clearance.min(FIELD_BAND_RATIO * field.band());
    let ball_gap = |point: &Point, radius: f32| {
        let gap = field.distance(point) - radius;
        (gap <= clearance).then_some(gap)
    };
    let leaf_distance = |_: &Point, _: f32| Some(f32::NEG_INFINITY);
    let is_point_clear = |point: &Point, _: f32| field.distance(point) > clearance;
    first_hit(scene, pose, clearance, (ball_gap, leaf_distance), is_point_clear, |_, _| false, meter)
}

/// Whether the supporter is clear of the object's surface at `pose`. Three conditions must hold:
///
/// - Every point of the supporter is farther than `clearance` metres from the mesh, exactly.
/// - No bar and no plane of the supporter passes through the mesh between its points, nor between the end of a bar and a surface that it
///   leads to, nor between the points of a plane that was thinned. This covers meshes without an inside, and blades that are thinner than
///   the spacing of the points.
/// - No part of the mesh that the field misses, such as the strings of a racquet, is closer to a point than
///   half the reach of the largest patch. Such a part may pass between the points.
pub(crate) fn is_off_surface(
    scene: (&Body, &Support),
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    Ok(first_on_surface(scene, pose, (clearance, BAR_TO_SURFACE), meter)?.is_none())
}

/// The pose itself if [`is_off_surface`] holds of it; otherwise the pose after shifts off the parts of the supporter that it is too
/// close to, if those are as small as the field's errors. `None` if that does not help.
pub(crate) fn push_off_surface(
    scene: (&Body, &Support),
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<Option<Pose>, Stop> {
    let (field, surface) = (scene.0.field, scene.0.surface);
    let most = clearance + field.voxel_size();
    let mut pushed = *pose;
    for _ in 0..=MAX_PUSHES_OFF {
        let Some(hit) = first_on_surface(scene, &pushed, (clearance, 0.0), meter)? else {
            return Ok(Some(pushed));
        };
        let at = pushed.inverse_transform_point(&hit);
        meter.distance_queries(2)?;
        let off = at - surface.closest_point(&at);
        let distance = off.norm();
        // Out of the object, which is towards its surface from a point within it.
        let inside = if surface.is_inside(&at) { -1.0 } else { 1.0 };
        let way = unit_or(off * inside, field.sample(&at).1);
        // Beyond the clearance, it is a patch or a thin part that is too close.
        let wanted = if distance < clearance { clearance } else { 0.5 * scene.1.reach };
        let missing = (wanted - inside * distance).max(0.0) + PUSH_OFF_EXCESS;
        pushed.translation.vector -= pushed.rotation * way * missing;
        if (pushed.translation.vector - pose.translation.vector).norm() > most {
            break;
        }
    }
    Ok(None)
}

/// Whether a point of the supporter is closer than `gap` metres to the mesh at `pose`, or inside it, exactly. Points half way between
/// those of the cloud are tested as well.
pub(crate) fn is_closer(
    (body, support): (&Body, &Support),
    pose: &Pose,
    gap: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let (field, surface) = (body.field, body.surface);
    // In walls that are thinner than a voxel the field is off by as much.
    let near = field.voxel_size();
    let to_object = pose.inverse();
    let (mut found, mut queries) = (false, 0);
    support.tree.bvh().descend(|_, node| {
        let aabb = node.aabb();
        let (centre, radius) = (to_object * aabb.centre(), 0.5 * aabb.diagonal());
        queries += 1;
        if found || body.is_beyond(&centre, radius + gap) {
            return false;
        }
        let (by_field, range) = (field.distance(&centre), radius + gap);
        if by_field > range + field.excess() {
            return false;
        }
        let Some(items) = node.items() else { return true };
        // The field may miss thin parts.
        if by_field > radius + near && !surface.is_within(&centre, range) {
            return false;
        }
        let mut is_close = |point: &Point| {
            queries += 1;
            let at = to_object * point;
            surface.is_within(&at, gap) || field.distance(&at) < near && surface.is_inside(&at)
        };
        found = support.tree.points().get(items.clone()).unwrap_or_default().iter().any(&mut is_close)
            || support.patches_of(&items).any(|patch| {
                let position = support.position(patch);
                support
                    .patches
                    .get(patch)
                    .is_some_and(|of_it| of_it.half_way_out().any(|offset| is_close(&(position + offset))))
            });
        true
    });
    meter.distance_queries(queries)?;
    Ok(found)
}

/// Rounding of distances between points within a few metres of the origin, metres: twenty times the spacing of numbers there. Where it is
/// more, the distance of a leaf is looked for a second time.
const ROUNDING: f32 = 1e-5;

/// A point of the supporter that contradicts [`is_off_surface`], where bars are taken to reach surfaces that are `beyond` metres from
/// them at most.
fn first_on_surface(
    scene: (&Body, &Support),
    pose: &Pose,
    (clearance, beyond): (f32, f32),
    meter: &mut Meter,
) -> Result<Option<Point>, Stop> {
    let (field, surface, support) = (scene.0.field, scene.0.surface, scene.1);
    let (thin, greatest) = (0.5 * support.reach, clearance.max(support.reach));
    // A bound that the field gives will do for what is looked at more closely.
    let ball_gap = |point: &Point, radius: f32| {
        (field.distance(point) <= radius + greatest + field.excess()).then_some(0.0)
    };
    // The mesh is no farther from the next leaf than from the one before, and the way from the one to the other.
    let before = Cell::new((Point::origin(), f32::INFINITY));
    let leaf_distance = |point: &Point, radius: f32| {
        let ((other, of_other), range) = (before.get(), radius + greatest);
        let expected = of_other + (other - point).norm() + ROUNDING;
        let nearest = if expected < range { surface.closest_point_within(point, expected) } else { None };
        let distance = (nearest.or_else(|| surface.closest_point_within(point, range))? - point).norm();
        before.set((*point, distance));
        Some(distance)
    };
    let is_point_clear = |point: &Point, at_least: f32| {
        if at_least > clearance.max(thin) {
            return true;
        }
        let is_far_by_field = field.distance(point) > thin + FIELD_ERROR * field.voxel_size();
        !surface.is_within(point, if is_far_by_field { clearance.max(thin) } else { clearance })
    };
    let inverse = pose.inverse();
    let crosses = |from: &Point, to: &Point| from != to && surface.is_crossed(from, to);
    let is_crossed_beyond = |bar: &Patch, from: &Point, to: &Point| {
        let way = unit_or(to - from, Vector::zeros()) * beyond;
        crosses(to, &(to + way))
            && support
                .fixed_at(bar, &(pose * to), &(pose * (to + way)))
                .is_some_and(|share| crosses(to, &(to + way * share)))
    };
    let rotation = pose.rotation.to_rotation_matrix();
    let is_crossed = |index: usize, at: &Point| {
        let Some(patch) = support.patches.get(index) else { return false };
        let bar = (beyond > 0.0 && patch.bar_direction().is_some()).then_some(patch);
        let place = |offset: Vector| at + rotation.inverse_transform_vector(&offset);
        let is_segment_crossed = |ends: [Vector; 2]| {
            let [from, to] = ends.map(place);
            crosses(&from, &to)
                || bar.is_some_and(|bar| {
                    is_crossed_beyond(bar, &from, &to) || is_crossed_beyond(bar, &to, &from)
                })
        };
        patch.filled_segments().any(is_segment_crossed)
            || beyond > 0.0
                && support.is_crossed_between(index, |from, to| crosses(&(inverse * from), &(inverse * to)))
    };
    first_hit(scene, pose, greatest, (ball_gap, leaf_distance), is_point_clear, is_crossed, meter)
}

/// Returns the first part of the supporter that is not clear of the object: a point for which
/// `is_point_clear` is false, the deepest point of a patch that penetrates the object by more than
/// [`PATCH_PENETRATION`], or the centre of a patch of a bar or plane that `is_crossed` by the object, by its index and its centre.
///
/// The closures take object coordinates. `ball_gap` is `None` if every point within a radius of a point is clear, otherwise how
/// close such a ball may come to the object, metres; where that is least is looked first, since most poses that are tested
/// collide. It prunes the tree, as does the distance to the bounding sphere: everything farther than `distance` metres from it is
/// clear. `leaf_distance` takes the ball of a leaf, and is `None` likewise, otherwise a lower bound of the distance of its centre from the
/// object; from that follows the one that `is_point_clear` is told of each point of the leaf.
fn first_hit(
    (body, support): (&Body, &Support),
    pose: &Pose,
    distance: f32,
    (ball_gap, leaf_distance): (impl Fn(&Point, f32) -> Option<f32>, impl Fn(&Point, f32) -> Option<f32>),
    is_point_clear: impl Fn(&Point, f32) -> bool,
    is_crossed: impl Fn(usize, &Point) -> bool,
    meter: &mut Meter,
) -> Result<Option<Point>, Stop> {
    // A matrix rotates faster than the quaternion of the pose.
    let rotation = pose.rotation.to_rotation_matrix();
    let to_object = |point: &Point| {
        Point::from(rotation.inverse_transform_vector(&(point.coords - pose.translation.vector)))
    };
    let points = support.tree.points();
    let hit_of_patch = |patch: usize| {
        let (index, position, patch) = (patch, support.position(patch), &support.patches[patch]);
        let at = to_object(&position);
        if let Ok(nearest) = nearest_on_patch(body, patch, &rotation, &at, |_| -PATCH_PENETRATION)
            && nearest.gap < -PATCH_PENETRATION
        {
            return Some(pose * nearest.at);
        }
        is_crossed(index, &at).then_some(position)
    };
    let (mut found, queries) = (None::<Point>, Cell::new(0));
    let count = |some: usize| queries.set(queries.get() + some);
    let ball = |node: &Node| {
        let aabb = node.aabb();
        (to_object(&aabb.centre()), 0.5 * aabb.diagonal())
    };
    support.tree.bvh().visit_ordered(
        &mut found,
        |_, node| {
            let (centre, radius) = ball(node);
            count(1);
            if body.is_beyond(&centre, radius + distance) { None } else { ball_gap(&centre, radius) }
        },
        |found| if found.is_some() { f32::NEG_INFINITY } else { f32::INFINITY },
        |found, items, leaf| {
            let (centre, radius) = ball(leaf);
            count(1);
            let Some(of_centre) = leaf_distance(&centre, radius) else { return };
            count(items.len());
            let is_hit = |index: &usize| {
                let at = to_object(&points[*index]);
                !is_point_clear(&at, of_centre - (at - centre).norm())
            };
            let hit = items.clone().find(is_hit).map(|index| points[index]);
            *found = hit.or_else(|| support.patches_of(&items).find_map(hit_of_patch));
        },
    );
    meter.distance_queries(queries.get())?;
    Ok(found)
}
