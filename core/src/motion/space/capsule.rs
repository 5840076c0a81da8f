//! Distances of the parts of a gripper from what stands still.

use super::touch::{Collector, Touch};
use crate::geometry::{DistanceField, Point, PointTree, Pose, Vector, unit_or};
use crate::mechanics::Support;
use crate::motion::failure::{Mover, Obstacle};
use crate::motion::gripper::Finger;

/// Most halvings of a segment against a distance field.
const MAX_HALVINGS: usize = 16;
/// Half length of a piece of a segment that is not halved any more, metres.
const SMALLEST_PIECE: f32 = 0.001;

/// One part of a gripper at a pose, in supporter coordinates.
pub(super) struct CapsuleQuery<'q, C> {
    from: Point,
    to: Point,
    radius: f32,
    mover: Mover,
    found: &'q mut C,
    /// Distance queries made.
    pub(super) queries: usize,
}

impl<'q, C: Collector> CapsuleQuery<'q, C> {
    pub(super) fn new((index, finger): (usize, Finger), pose: &Pose, found: &'q mut C) -> Self {
        let [from, to] = finger.ends.map(|end| pose * end);
        Self { from, to, radius: finger.radius, mover: Mover::Gripper(index), found, queries: 0 }
    }

    /// Vector from a point to the nearest point of the segment.
    fn to_segment(&self, point: &Point) -> Vector {
        let (axis, arm) = (self.to - self.from, point - self.from);
        let square = axis.norm_squared();
        let share = if square > 0.0 { (arm.dot(&axis) / square).clamp(0.0, 1.0) } else { 0.0 };
        axis * share - arm
    }

    fn is_beyond(&self, centre: &Point, radius: f32) -> bool {
        let limit = radius + self.radius + self.found.limit();
        self.to_segment(centre).norm_squared() > limit * limit
    }

    /// Offers a ball.
    fn ball(&mut self, centre: &Point, radius: f32, obstacle: Obstacle) {
        let way = self.to_segment(centre);
        self.queries += 1;
        self.offer(way.norm() - radius - self.radius, *centre, unit_or(way, Vector::zeros()), obstacle);
    }

    fn offer(&mut self, distance: f32, at: Point, normal: Vector, obstacle: Obstacle) {
        if distance < self.found.limit() {
            self.found.offer(Touch { distance, at, normal, mover: self.mover, obstacle });
        }
    }

    /// The supporter, each patch as a ball: a gripper needs no better.
    pub(super) fn supporter(&mut self, support: &Support) {
        let middle = nalgebra::center(&self.from, &self.to);
        let half = 0.5 * (self.to - self.from).norm();
        for group in support.groups {
            // Most are beyond the ball around the segment, which costs less to tell.
            let limit = half + group.radius + self.radius + self.found.limit();
            if (group.centre - middle).norm_squared() > limit * limit
                || self.is_beyond(&group.centre, group.radius)
            {
                continue;
            }
            for (patch, shape) in
                group.patches().zip(support.patches.get(group.patches()).unwrap_or_default())
            {
                self.ball(&support.position(patch), shape.reach(), Obstacle::Supporter);
            }
        }
    }

    pub(super) fn scene(&mut self, scene: &PointTree, radius: f32) {
        scene.bvh().descend(|_, node| {
            let aabb = node.aabb();
            if self.is_beyond(&aabb.centre(), 0.5 * aabb.diagonal() + radius) {
                return false;
            }
            for index in node.items().into_iter().flatten() {
                self.ball(&scene.points()[index], radius, Obstacle::Scene(scene.order()[index] as usize));
            }
            true
        });
    }

    /// Another object, by its distance field and its pose. The segment is halved where the ball around a piece does not tell.
    pub(super) fn field(&mut self, field: &DistanceField, pose: &Pose, obstacle: Obstacle) {
        let to_other = pose.inverse();
        let (from, to) = (to_other * self.from, to_other * self.to);
        let mut waiting = heapless::Vec::<(Point, Point), { MAX_HALVINGS + 1 }>::new();
        let _ = waiting.push((from, to));
        while let Some((from, to)) = waiting.pop() {
            let middle = nalgebra::center(&from, &to);
            let half = 0.5 * (to - from).norm();
            self.queries += 1;
            let (distance, gradient) = field.sample(&middle);
            if distance - half - self.radius >= self.found.limit() {
                continue;
            }
            if half < SMALLEST_PIECE || waiting.len() + 2 > MAX_HALVINGS {
                let normal = pose.rotation * gradient;
                self.offer(distance - half - self.radius, pose * middle, normal, obstacle);
                continue;
            }
            let _ = waiting.push((from, middle));
            let _ = waiting.push((middle, to));
        }
    }
}
