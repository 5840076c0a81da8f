//! Things that the object must not touch: points of a scene, and other objects.

use super::Body;
use crate::geometry::{Point, Pose, Surface, halves, longest_side_first};
use crate::monitor::{Meter, Stop};

/// Most halvings of a triangle until it is as small as the clearance is tested.
const MAX_HALVINGS: usize = 24;
/// Width, metres, of a piece of a triangle that is tested as one point.
const SMALLEST_PIECE: f32 = 0.001;

/// Whether the object at `pose` is at least `clearance` metres away from every point, in supporter coordinates.
pub(crate) fn is_clear_of_points(
    body: &Body,
    pose: &Pose,
    points: &[[f32; 3]],
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let to_object = pose.inverse();
    let (centre, reach) = (pose * body.centre, body.reach + clearance);
    let mut queries = 0;
    let is_clear = points.iter().all(|point| {
        let point = Point::from(*point);
        if (point - centre).norm_squared() > reach * reach {
            return true;
        }
        queries += 1;
        body.field.distance(&(to_object * point)) > clearance
    });
    meter.distance_queries(queries)?;
    Ok(is_clear)
}

/// Whether the object at `pose` is at least `clearance` metres away from the surface of another at `other_pose`, both in
/// supporter coordinates.
pub(crate) fn is_clear_of_surface(
    body: &Body,
    pose: &Pose,
    (other, other_pose): (&Surface, &Pose),
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let between = pose.inverse() * other_pose;
    let (mut is_clear, mut queries) = (true, 0);
    other.bvh().descend(|_, node| {
        if !is_clear {
            return false;
        }
        let aabb = node.aabb();
        let (centre, radius) = (between * aabb.centre(), 0.5 * aabb.diagonal() + clearance);
        queries += 1;
        if body.is_beyond(&centre, radius) || body.field.distance(&centre) > radius {
            return false;
        }
        if let Some(items) = node.items() {
            for triangle in &other.triangles()[items] {
                let corners = triangle.map(|corner| between * corner);
                is_clear = is_clear && is_clear_of_triangle(body, corners, clearance, &mut queries);
            }
        }
        is_clear
    });
    meter.distance_queries(queries)?;
    Ok(is_clear)
}

/// Whether a triangle in object coordinates is clear. It is halved where its bounding ball alone does not tell.
fn is_clear_of_triangle(body: &Body, triangle: [Point; 3], clearance: f32, queries: &mut usize) -> bool {
    let mut waiting = heapless::Vec::<[Point; 3], { MAX_HALVINGS + 1 }>::new();
    let _ = waiting.push(triangle);
    while let Some([a, b, c]) = waiting.pop() {
        let centre = Point::from((a.coords + b.coords + c.coords) / 3.0);
        let radius = [a, b, c].iter().map(|corner| (corner - centre).norm()).fold(0.0, f32::max);
        *queries += 1;
        let distance = body.field.distance(&centre);
        if distance > radius + clearance {
            continue;
        }
        if distance < clearance {
            return false;
        }
        if radius < SMALLEST_PIECE || waiting.len() + 2 > MAX_HALVINGS {
            continue;
        }
        for half in halves(longest_side_first([a, b, c])) {
            let _ = waiting.push(half);
        }
    }
    true
}
