//! A problem of motion: planned, and its path replayed.

use super::ompl;
use super::row::{Outcome, Peer, Planned};
use crate::judge::replay::replay;
use crate::judge::{Bullet, Judge, Mass, Scene};
use crate::shapes::Random;
use crate::shapes::vector::{V, Z, cross};
use crate::solid::Solid;
use hangpose::Monitor;
use hangpose::geometry::{Aabb, Point, Pose, Vector};
use hangpose::hanging::HangingPose;
use hangpose::motion::{Clearance, Gripper, PlanError, Task, Waypoint, plan, plan_bytes};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use std::time::Instant;

/// Room for waypoints.
const WAYPOINTS: usize = 20_000;
/// Largest angle by which the object is turned at the start, rad.
const TURNED: f64 = 0.8;
/// Distance at which a pose is free for the peer, m, if the ends have more: that of the planner in narrow places.
const FREE: f32 = 0.0005;
/// Share of the distance at the ends at which it is free otherwise.
const KEPT: f32 = 0.5;
/// Free distance of the start from everything, m.
const CLEAR: f64 = 0.03;
/// How far the start is moved to the sides, up or down at most, m.
const ASIDE: f64 = 0.1;

/// An object that moves, what stands still, and where it moves.
pub struct Problem<'a> {
    /// The object's shape.
    pub solid: &'a Solid,
    /// Everything that stands still: the supporter, its surroundings and what hangs already.
    pub obstacles: &'a Solid,
    /// What is planned.
    pub task: Task<'a>,
    /// Where to.
    pub goal: HangingPose,
}

impl Problem<'_> {
    /// Plans, and replays the path.
    pub fn planned(&self) -> Result<Planned, PlanError> {
        let Task { supporter, request, motion, object, .. } = self.task;
        let bytes =
            [request.scene.len(), 0].map(|scene| plan_bytes(&supporter.limits(), scene, motion.nodes));
        let mut memory = vec![0; bytes[0]];
        let mut waypoints = vec![Waypoint::default(); WAYPOINTS];
        let start = Instant::now();
        let found =
            plan(&self.task, &self.goal, &mut waypoints, &mut |_| true, &mut memory, &Monitor::new())?;
        let seconds = start.elapsed().as_secs_f64();
        let answer = found.path.map(|_| ());
        let scene = Scene { tilt: false, ..Scene::new(self.solid, self.obstacles) };
        let mut planned = Planned::new(&answer, &found.counts, seconds, [bytes[0], bytes[0] - bytes[1]]);
        let mut world = Bullet::default().world(&scene);
        planned.ends = [motion.start.as_ref(), Some(&self.goal.pose)].map(|end| {
            world.release(&end?.cast());
            Some(world.penetration())
        });
        if let Ok(path) = found.path {
            let centre = object.centre_of_mass().into();
            let replayed = replay(&scene, &path, motion.gripper.as_ref(), centre);
            planned.waypoints = path.object.len();
            planned.clearance = path.clearance;
            planned.replay = Some(Outcome::from(&replayed));
        }
        Ok(planned)
    }

    /// What OMPL finds from the same start; `None` if none is given.
    pub fn peer(&self) -> Option<Peer> {
        let start = self.task.motion.start?;
        let object = self.task.object;
        let centre = object.centre_of_mass();
        let reach = self.solid.vertices.iter().map(|&vertex| (Point::from(vertex) - centre).norm());
        let reach = reach.fold(0.0, f32::max);
        // The object may pass on all sides of what stands still.
        let ends = [start, self.goal.pose].map(|pose| pose * centre);
        let points = || self.obstacles.vertices.iter().map(|&vertex| Point::from(vertex)).chain(ends);
        let low = points().reduce(|a, b| a.inf(&b))? - Vector::repeat(reach);
        let high = points().reduce(|a, b| a.sup(&b))? + Vector::repeat(reach);
        let free = [start, self.goal.pose];
        let region = Aabb { min: low, max: high };
        let scene = self.task.request.scene.len();
        let mut memory = vec![0; Clearance::bytes(&self.task.supporter.limits(), scene)];
        let mut clearance = Clearance::new(&self.task, &region, &free, &mut memory, &Monitor::new()).ok()?;
        // As the planner: half of what the ends have.
        let required = free.map(|pose| KEPT * clearance.at(&pose)).into_iter().fold(FREE, f32::min);
        let bounds = [low.into(), high.into()];
        let is_free = &mut |pose: &Pose| clearance.at(pose) >= required;
        Some(ompl::peer([&start, &self.goal.pose], bounds, (centre, reach), is_free))
    }
}

/// A pose at which the object, and the gripper that holds it, are in front of everything: turned by up to 46° from `goal`.
pub fn start(
    solid: &Solid,
    obstacles: &Solid,
    goal: &Pose,
    front: V,
    gripper: Option<&Gripper>,
    random: &mut Random,
) -> Pose {
    let centre = Mass::of(solid, 1.0).frame.translation.vector.cast::<f32>();
    let away = |v: [f32; 3]| f64::from((Vector::from(v) - centre).norm());
    let parts = gripper.map_or(&[][..], |gripper| gripper.parts);
    let fingers =
        parts.iter().flat_map(|part| [part.from, part.to].map(|end| away(end) + f64::from(part.radius)));
    let reach = solid.vertices.iter().map(|&vertex| away(vertex)).chain(fingers).fold(0.0, f64::max);
    let ahead = Vector::from(front.map(|x| x as f32));
    let farthest = obstacles.vertices.iter().map(|&vertex| ahead.dot(&Vector::from(vertex)));
    let farthest = f64::from(farthest.fold(f32::NEG_INFINITY, f32::max));
    let at = goal * Point::from(centre);
    let out = farthest + reach + CLEAR - f64::from(ahead.dot(&at.coords));
    let aside = Vector::from(cross(Z, front).map(|x| x as f32));
    let mut shift = |most: f64| random.range(-most, most) as f32;
    let at = at + ahead * out.max(0.0) as f32 + aside * shift(ASIDE) + Vector::z() * shift(ASIDE);
    let axis = Vector::from([0; 3].map(|_| random.gaussian() as f32)).normalize();
    let turn = UnitQuaternion::new(axis * random.range(0.0, TURNED) as f32) * goal.rotation;
    Isometry3::from_parts(Translation3::from(at - turn * Point::from(centre)), turn)
}
