//! Which object site fits on which support site, and how: section II-D.

use super::site_match::SiteMatch;
use super::{Cost, HangingSite, SupportSite};
use crate::best::Best;
use crate::geometry::{Point, PointTree, Pose, Surface, Vector, any_perpendicular, unit_or};
use crate::hanging::pose::HangingPose;
use crate::hanging::scene::Scene;
use crate::monitor::{Meter, Stop};
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};

/// How much was left of the pairs after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MatchingCounts {
    /// Pairs of an object site and a support site.
    pub pairs: usize,
    /// Pairs where the support fits into the free space.
    pub fitting: usize,
    /// Poses, two for each fitting pair, with no more collisions than allowed. Poses that cannot get into the list any more
    /// are not evaluated to the end and not counted.
    pub clear: usize,
}

/// Tries all pairs of sites and offers their poses to `poses`.
pub(super) fn match_sites(
    scene: &Scene,
    (hanging_sites, support_sites): (&[HangingSite], &[SupportSite]),
    poses: &mut Best<HangingPose>,
    meter: &mut Meter,
) -> (MatchingCounts, Option<Stop>) {
    let Scene { surface, centre_of_mass, params, .. } = *scene;
    let points = &scene.support.tree;
    let mut counts =
        MatchingCounts { pairs: hanging_sites.len() * support_sites.len(), ..Default::default() };
    let most_contact_points = hanging_sites.iter().map(|site| site.contact_points).max().unwrap_or(0);
    // No more than every point, and past `u32` there are none: see `mesh::MAX_COUNT`.
    let allowed = (params.max_collision * points.points().len() as f32) as u32;
    for (j, support) in support_sites.iter().enumerate() {
        meter.progress(j as f32 / support_sites.len() as f32);
        for (i, site) in hanging_sites.iter().enumerate() {
            if site.free_space_radius < params.radius_ratio * support.support_radius {
                continue;
            }
            counts.fitting += 1;
            let cost = Cost::without_collision(site, most_contact_points, support, params);
            for is_reversed in [false, true] {
                let pose = align(site, centre_of_mass, support, params.up(), is_reversed);
                let worst = poses.next_to_go().and_then(|worst| worst.matched);
                let outranked =
                    worst.map_or(u32::MAX, |worst| cost.collisions_up_to(worst.cost.total, params));
                let most = allowed.min(outranked);
                match count_collisions(surface, points, &pose, most, meter) {
                    Ok(Some(collision)) => {
                        counts.clear += 1;
                        let cost = cost.with_collision(collision, params);
                        let (object_site, support_site) = (i as u32, j as u32);
                        let matched = SiteMatch { cost, object_site, support_site, is_reversed };
                        let is_better = |a: &HangingPose, b: &HangingPose| match (a.matched, b.matched) {
                            (Some(a), Some(b)) => a.is_better(&b),
                            _ => false,
                        };
                        poses.offer(HangingPose { pose, rest: None, matched: Some(matched) }, is_better);
                    }
                    Ok(None) => {}
                    Err(stop) => return (counts, Some(stop)),
                }
            }
        }
    }
    (counts, None)
}

/// Lays the object's hanging direction along the supporter's, its hanging position onto the supporter's, and its
/// centre of mass straight below.
fn align(
    object: &HangingSite,
    centre_of_mass: Point,
    support: &SupportSite,
    up: Vector,
    is_reversed: bool,
) -> Pose {
    // Where the hanging position is the centre of mass itself, the contact point still says what is up.
    let from_contact = centre_of_mass - object.contact_point;
    let below = centre_of_mass - object.position;
    let below = if below.norm() > 1e-3 * from_contact.norm() { below } else { from_contact };
    let down = unit_or(below, -up);
    // The hanging direction is perpendicular to down but for rounding.
    let along = object.hanging_direction - down * object.hanging_direction.dot(&down);
    let object_frame = frame(unit_or(along, any_perpendicular(down)), down);
    let sign = if is_reversed { -1.0 } else { 1.0 };
    let support_frame = frame(support.hanging_direction * sign, -up);
    let rotation = Rotation3::from_matrix_unchecked(support_frame * object_frame.transpose());
    let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
    let translation = support.position - rotation * object.position;
    Pose::from_parts(Translation3::from(translation), rotation)
}

/// The right-handed frame of two perpendicular unit vectors.
fn frame(along: Vector, down: Vector) -> Matrix3<f32> {
    Matrix3::from_columns(&[along, down, along.cross(&down)])
}

/// `S_c` of eq. (8): how many of the supporter's points lie inside the object at `pose`; `None` if more than
/// `most`.
///
/// Where a node of the tree of points is farther from the surface than it is wide, all its points are on the
/// same side. On an open mesh, where the winding number has no jump, they take the side of the node's centre.
fn count_collisions(
    surface: &Surface,
    points: &PointTree,
    pose: &Pose,
    most: u32,
    meter: &mut Meter,
) -> Result<Option<u32>, Stop> {
    let to_object = pose.inverse();
    let mut inside = 0;
    let mut stop = Ok(());
    points.bvh().descend(|index, node| {
        if stop.is_err() || inside > most {
            return false;
        }
        let aabb = node.aabb();
        let centre = to_object * aabb.centre();
        // Half the diagonal, and what the transformation rounds off.
        let rounding = 8.0 * f32::EPSILON * (aabb.max.coords.amax() + centre.coords.amax());
        let radius = 0.5 * aabb.diagonal() + rounding;
        stop = meter.distance_queries(1);
        if !surface.is_within(&centre, radius) {
            if surface.is_inside(&centre) {
                inside += points.bvh().count_items(index);
            }
            return false;
        }
        if let Some(items) = node.items() {
            stop = meter.distance_queries(items.len());
            let is_inside = |point: &&Point| surface.is_inside(&(to_object * **point));
            inside += points.points()[items].iter().filter(is_inside).count() as u32;
        }
        true
    });
    stop?;
    Ok((inside <= most).then_some(inside))
}
