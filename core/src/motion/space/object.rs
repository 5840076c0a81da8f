//! Distances of the object from what stands still, by its signed distance field.

use super::touch::{Collector, Touch};
use super::{Obstacles, PATCH_RANGE};
use crate::geometry::{Point, PointTree, Pose, Surface, Vector};
use crate::mechanics::{Body, Gap, gap_to_patch};
use crate::motion::failure::{Mover, Obstacle};

/// Most halvings of a triangle until it is as small as distances are told.
const MAX_HALVINGS: usize = 24;
/// Radius of a piece of a triangle that is not halved any more, metres: its corners tell its distance.
const SMALLEST_PIECE: f32 = 0.001;

/// The object at a pose.
pub(super) struct ObjectQuery<'q, 'a, C> {
    pub(super) body: &'q Body<'a>,
    pub(super) pose: &'q Pose,
    pub(super) to_object: Pose,
    pub(super) found: &'q mut C,
    /// Distance queries made.
    pub(super) queries: usize,
}

impl<'q, 'a, C: Collector> ObjectQuery<'q, 'a, C> {
    pub(super) fn new(body: &'q Body<'a>, pose: &'q Pose, found: &'q mut C) -> Self {
        Self { body, pose, to_object: pose.inverse(), found, queries: 0 }
    }

    /// Whether a ball, by its centre in object coordinates, is farther away than matters.
    fn is_beyond(&mut self, centre: &Point, radius: f32) -> bool {
        let limit = radius + self.found.limit();
        if self.body.is_beyond(centre, limit) {
            return true;
        }
        self.queries += 1;
        self.body.field.distance(centre) > limit
    }

    fn offer(&mut self, distance: f32, at: &Point, gradient: Vector, obstacle: Obstacle) {
        if distance < self.found.limit() {
            let normal = -(self.pose.rotation * gradient);
            let touch = Touch { distance, at: self.pose * at, normal, mover: Mover::Object, obstacle };
            self.found.offer(touch);
        }
    }

    pub(super) fn supporter(&mut self, obstacles: &Obstacles) {
        let support = obstacles.support;
        let rotation = self.pose.rotation.to_rotation_matrix();
        let Some(tree) = obstacles.groups else { return };
        tree.descend(|_, node| {
            let aabb = node.aabb();
            if self.is_beyond(&(self.to_object * aabb.centre()), 0.5 * aabb.diagonal()) {
                return false;
            }
            let Some(items) = node.items() else { return true };
            for &group in &obstacles.group_order[items] {
                let group = &support.groups[group as usize];
                if self.is_beyond(&(self.to_object * group.centre), group.radius) {
                    continue;
                }
                for patch in group.patches() {
                    let at = self.to_object * support.position(patch);
                    self.queries += 1;
                    let margin = self.found.limit().min(PATCH_RANGE);
                    match gap_to_patch(self.body, support, patch, (&rotation, &at), margin) {
                        Gap::Near { distance, at, gradient } => {
                            self.offer(distance, &at, gradient, Obstacle::Supporter);
                        }
                        Gap::Beyond(distance) => {
                            self.offer(distance, &at, Vector::zeros(), Obstacle::Supporter);
                        }
                    }
                }
            }
            true
        });
    }

    pub(super) fn scene(&mut self, scene: &PointTree, radius: f32) {
        scene.bvh().descend(|_, node| {
            let aabb = node.aabb();
            if self.is_beyond(&(self.to_object * aabb.centre()), 0.5 * aabb.diagonal() + radius) {
                return false;
            }
            for index in node.items().into_iter().flatten() {
                let at = self.to_object * scene.points()[index];
                self.queries += 1;
                let (distance, gradient) = self.body.field.sample(&at);
                let obstacle = Obstacle::Scene(scene.order()[index] as usize);
                self.offer(distance - radius, &at, gradient, obstacle);
            }
            true
        });
    }

    /// Another object, by its surface and its pose.
    pub(super) fn surface(&mut self, surface: &Surface, pose: &Pose, obstacle: Obstacle) {
        let between = self.to_object * pose;
        surface.bvh().descend(|_, node| {
            let aabb = node.aabb();
            if self.is_beyond(&(between * aabb.centre()), 0.5 * aabb.diagonal()) {
                return false;
            }
            for triangle in node.items().into_iter().flat_map(|items| &surface.triangles()[items]) {
                self.triangle(triangle.map(|corner| between * corner), obstacle);
            }
            true
        });
    }

    /// A triangle in object coordinates. It is halved where its bounding ball alone does not tell.
    fn triangle(&mut self, triangle: [Point; 3], obstacle: Obstacle) {
        let mut waiting = heapless::Vec::<[Point; 3], { MAX_HALVINGS + 1 }>::new();
        let _ = waiting.push(triangle);
        while let Some([a, b, c]) = waiting.pop() {
            let centre = Point::from((a.coords + b.coords + c.coords) / 3.0);
            let radius = [a, b, c].iter().map(|corner| (corner - centre).norm()).fold(0.0, f32::max);
            if self.is_beyond(&centre, radius) {
                continue;
            }
            if radius < SMALLEST_PIECE || waiting.len() + 2 > MAX_HALVINGS {
                for corner in [a, b, c, centre] {
                    self.queries += 1;
                    let (distance, gradient) = self.body.field.sample(&corner);
                    self.offer(distance, &corner, gradient, obstacle);
                }
                continue;
            }
            // Across the longest side.
            let sides = [(a - b).norm_squared(), (b - c).norm_squared(), (c - a).norm_squared()];
            let [a, b, c] = match sides {
                [ab, bc, ca] if ab >= bc && ab >= ca => [a, b, c],
                [_, bc, ca] if bc >= ca => [b, c, a],
                _ => [c, a, b],
            };
            let middle = nalgebra::center(&a, &b);
            let _ = waiting.push([a, middle, c]);
            let _ = waiting.push([middle, b, c]);
        }
    }
}
