//! How far an object is from everything at a pose, as the planner sees it.

use super::error::PlanError;
use super::exits::box_around;
use super::gripper::Hand;
use super::path::MAX_CLEARANCE;
use super::placement::Placement;
use super::space::{Moving, Obstacles, Space, Workspace};
use super::task::Task;
use crate::geometry::{Aabb, Pose};
use crate::hanging::Hung;
use crate::mechanics::{Body, Frames};
use crate::memory::{Arena, Limits, model_bytes};
use crate::monitor::{Meter, Monitor};

/// Distances of an object, with the gripper that holds it, from the supporter, the scene and what hangs already.
///
/// It is what [`plan`](super::plan) tests poses with, for planners of one's own.
pub struct Clearance<'m> {
    space: Space<'m>,
    frames: Frames,
}

impl<'m> Clearance<'m> {
    /// Bytes of memory: a supporter within `limits` and `scene` points of a scene.
    pub const fn bytes(limits: &Limits, scene: usize) -> usize {
        model_bytes(
            Obstacles::bytes(scene)
                .saturating_add(Obstacles::scratch_bytes(scene))
                .saturating_add(Space::bytes(limits.points)),
        )
    }

    /// Arranges the obstacles of a task in `memory`, of [`bytes`](Self::bytes), for poses at which the centre of mass is in `region`:
    /// points of the scene that are out of reach from there are left out. At `free` poses the scene is out of the way: its points are
    /// taken to be so wide that nothing slips through between them, but no wider than these poses leave room for.
    pub fn new(
        task: &Task<'m>,
        region: &Aabb,
        free: &[Pose],
        memory: &'m mut [u8],
        monitor: &Monitor,
    ) -> Result<Self, PlanError> {
        task.params.validate()?;
        task.request.validate()?;
        task.motion.validate()?;
        let needed = Self::bytes(&task.supporter.limits(), task.request.scene.len());
        let mut arena = Arena::new(memory, needed)?;
        let frames = task.object.frames_with(task.supporter);
        let region = Aabb::of(&region.corners().map(|corner| frames.supporter * corner));
        let free = free.iter().map(|pose| frames.inwards(pose));
        Ok(Self { space: space_of(task, &region, free, &mut arena, &Meter::new(monitor))?, frames })
    }

    /// The least distance at a pose, object to supporter coordinates, in metres; capped at [`MAX_CLEARANCE`], negative in a
    /// collision or outside of the workspace, and a lower bound beyond a few millimetres.
    pub fn at(&mut self, pose: &Pose) -> f32 {
        let place = Placement::of(&self.frames.inwards(pose), &self.space.moving.centre);
        let room = self.space.room_at(&place);
        // Nothing stops it.
        let monitor = Monitor::new();
        let mut meter = Meter::new(&monitor);
        let nearest = self.space.nearest(&place, MAX_CLEARANCE, &mut meter);
        let distance = nearest.map_or(f32::NEG_INFINITY, |nearest| nearest.distance);
        if room < 0.0 { distance.min(room) } else { distance }
    }
}

/// The hand of a task.
pub(super) fn hand_of<'a>(task: &Task<'a>) -> Option<Hand<'a>> {
    task.motion.gripper.map(|gripper| Hand::new(&gripper, task.object.frame()))
}

/// The object of a task among its obstacles, in what is left of `arena`, with its centre in `region`, which like the poses is in the
/// frames.
pub(super) fn space_of<'a>(
    task: &Task<'a>,
    region: &Aabb,
    free: impl IntoIterator<Item = Pose>,
    arena: &mut Arena<'a>,
    meter: &Meter,
) -> Result<Space<'a>, PlanError> {
    let body = body_of(task)?;
    let hand = hand_of(task);
    let moving = Moving::held(body, hand);
    // The gripper that leaves turns about its own centre, which moves in a box that is wider by its reach.
    let of_gripper = hand.map_or(0.0, |hand| 2.0 * Moving::gripper(hand).reach);
    let within_reach = box_around(region, [], moving.reach + of_gripper);
    let obstacles = Obstacles::build(task, &within_reach, arena, meter)?;
    let of_object = task.object.surface().aabb();
    let workspace = task.motion.workspace.map(|aabb| Workspace::new(aabb, of_object));
    let mut space = Space::of_object(moving, obstacles, workspace, arena)?;
    space.make_room(free);
    Ok(space)
}

/// The object of a task, if it and what hangs already have distance fields.
pub(super) fn body_of<'a>(task: &Task<'a>) -> Result<Body<'a>, PlanError> {
    let is_without_field = |hung: &Hung| hung.object.distance_field().is_none();
    match task.request.hung.iter().position(is_without_field) {
        None => task.object.body().ok_or(PlanError::NoDistanceField { hung: None }),
        hung => Err(PlanError::NoDistanceField { hung }),
    }
}
