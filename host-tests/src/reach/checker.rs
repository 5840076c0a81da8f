//! A collision checker for OMPL: samples of all that stands still, in the object's distance field.

use super::surroundings::samples;
use crate::solid::Solid;
use hangpose::geometry::{Point, Pose};
use hangpose::hanging::Object;

/// Spacing of the samples, m.
const SPACING: f64 = 0.003;
/// Distance that is free, m, unless the goal has less room.
const FREE: f32 = 0.0005;

/// Distance by which the goal counts as free, m.
const GOAL: f32 = 0.0002;

/// Distances of an object from what stands still.
pub struct Checker<'a> {
    object: &'a Object<'a>,
    reach: f32,
    points: Vec<Point>,
    free: f32,
}

impl<'a> Checker<'a> {
    /// A checker for a way to `goal`, where the object may be as near as it is.
    pub fn new(object: &'a Object<'a>, reach: f32, obstacles: &Solid, goal: &Pose) -> Self {
        let points = samples(obstacles, SPACING, None).into_iter().map(Point::from).collect();
        let mut checker = Self { object, reach, points, free: 0.0 };
        checker.free = FREE.min(checker.distance(goal) - GOAL);
        checker
    }

    /// Whether the object is free at a pose.
    pub fn is_free(&self, pose: &Pose) -> bool {
        self.distance(pose) > self.free
    }

    /// Distance of the object from the samples, m, up to where it may touch them at all.
    fn distance(&self, pose: &Pose) -> f32 {
        let field = self.object.distance_field().expect("objects are analysed with voxels");
        let centre = pose * self.object.centre_of_mass();
        let near = (self.reach + FREE).powi(2);
        let to_object = pose.inverse();
        let near = self.points.iter().filter(|point| (**point - centre).norm_squared() < near);
        near.map(|point| field.distance(&(to_object * point))).fold(f32::INFINITY, f32::min)
    }
}
