//! Whether a pose keeps the object off the supporter.

use super::{Body, Support};
use crate::geometry::{Aabb, Pose};

/// Whether every point of the supporter is farther than `clearance` metres from the object at `pose`.
pub fn is_clear(body: &Body, support: &Support, pose: &Pose, clearance: f32) -> bool {
    let to_object = pose.inverse();
    let clearance = clearance.min(0.9 * body.field.band());
    let mut clear = true;
    support.tree.bvh().descend(|_, node| {
        if !clear {
            return false;
        }
        let aabb: Aabb = node.aabb();
        let centre = to_object * aabb.centre();
        let radius = 0.5 * aabb.diagonal();
        let distance = body.field.distance(&centre);
        if distance - radius > clearance {
            return false;
        }
        if distance < clearance - radius {
            clear = false;
            return false;
        }
        if let Some(items) = node.items() {
            clear = support.tree.points()[items].iter().all(|p| body.field.distance(&(to_object * p)) > clearance);
        }
        true
    });
    clear
}
