//! Plans a path for one pose: of the object to it, and of the gripper away.

use super::certify::certify;
use super::clearance::{body_of, hand_of, space_of};
use super::enclosed;
use super::end::End;
use super::error::PlanError;
use super::exits::{box_around, outside};
use super::failure::PlanFailure;
use super::gripper::Hand;
use super::leave::{open, straight};
use super::lower::until_near;
use super::path::{MAX_CLEARANCE, Outline, Plan, PlanCounts, Shape, Waypoint};
use super::permit::Permit;
use super::placement::Placement;
use super::pull::Ends;
use super::route::Route;
use super::search::{GOAL, Outcome, START, Search};
use super::shorten::shorten;
use super::space::{Moving, Obstacles, Space};
use super::task::Task;
use super::timing::set_times;
use super::tree::{Metric, Tree};
use super::widen::widen;
use super::written::Written;
use crate::geometry::{Aabb, Pose, is_rigid};
use crate::hanging::HangingPose;
use crate::mechanics::{Body, Frames};
use crate::memory::{Arena, Limits, OutOfMemory, larger, model_bytes};
use crate::monitor::{Meter, Monitor};
use crate::random::Random;

/// Distance from obstacles, metres, below which a release pose or a start is in collision: less than the least gap of a release
/// pose that is predicted, 0.1 mm.
const LEAST_DISTANCE: f32 = 0.00005;
/// Samples after which a proof is sought that there is no way.
const SAMPLES_BEFORE_PROOF: usize = 100;
/// Distance from obstacles, metres, that is kept if no way is found with more: that of a release pose.
const NARROW: f32 = 0.0005;
/// Share of the distance at the release pose and at the start that is kept on the way.
const KEPT: f32 = 0.5;
/// What a radian counts against a metre, as a share of the reach of what moves: the radius of gyration of a ball is 0.63 of
/// its radius.
const METRIC_RADIUS: f32 = 0.5;
/// Margin of the box in which positions are sampled around supporter, goal and start, in multiples of the object's reach.
const MARGIN: f32 = 1.5;

/// Bytes of working memory for [`plan`]: a supporter within `limits`, `scene` points of a scene and trees of `nodes`.
pub const fn plan_bytes(limits: &Limits, scene: usize, nodes: usize) -> usize {
    let search = Space::bytes(limits.points)
        .saturating_add(Room::bytes(nodes))
        .saturating_add(enclosed::bytes(limits.points));
    let scratch = larger(Obstacles::scratch_bytes(scene), search);
    model_bytes(Obstacles::bytes(scene).saturating_add(scratch))
}

/// Plans a path of the object to `goal`, and of the gripper away from it; or, to take it off, the other way.
///
/// `accepts` is asked whether the object may be at a pose, object to supporter coordinates: the caller's inverse kinematics
/// decides what can be reached. It is asked as late and as seldom as possible: first about the goal and the start, then about
/// the waypoints of paths without collisions. It must always give the same answer for the same pose.
///
/// `memory` is working memory, [`plan_bytes`] of it. A path of more waypoints than `waypoints` holds is an error.
pub fn plan<'w>(
    task: &Task,
    goal: &HangingPose,
    waypoints: &'w mut [Waypoint],
    accepts: &mut dyn FnMut(&Pose) -> bool,
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Plan<'w>, PlanError> {
    Ok(outline(task, goal, waypoints, accepts, memory, monitor)?.on(waypoints))
}

/// Plans, and leaves the waypoints in `waypoints`.
pub(super) fn outline(
    task: &Task,
    goal: &HangingPose,
    waypoints: &mut [Waypoint],
    accepts: &mut dyn FnMut(&Pose) -> bool,
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Outline, PlanError> {
    task.params.validate()?;
    task.request.validate()?;
    task.motion.validate()?;
    if !is_rigid(&goal.pose) || goal.rest.is_some_and(|rest| !is_rigid(&rest.pose)) {
        return Err(PlanError::Goal);
    }
    let needed = plan_bytes(&task.supporter.limits(), task.request.scene.len(), task.motion.nodes);
    let arena = Arena::new(memory, needed)?;
    let body = body_of(task)?;
    let mut meter = Meter::new(monitor);
    let (frames, hand) = (task.object.frames_with(task.supporter), hand_of(task));
    let start = task.motion.start.map(|start| frames.inwards(&start));
    let rest = goal.rest.map_or(goal.pose, |rest| rest.pose);
    let goal = [&goal.pose, &rest].map(|pose| frames.inwards(pose));
    let mut planner = Planner { task, frames, hand, body, counts: PlanCounts::default(), meter: &mut meter };
    let mut permit = Permit::new(accepts, frames, body.centre);
    let path = match planner.run(start, goal, arena, waypoints, &mut permit) {
        Ok(shape) => Ok(shape),
        Err(End::Failure(failure)) => Err(failure.outwards(&frames)),
        Err(End::Error(error)) => return Err(error),
    };
    let written = path.as_ref().map_or(0, |shape| shape.object + shape.gripper);
    for waypoint in waypoints.iter_mut().take(written) {
        waypoint.pose = frames.outwards(&waypoint.pose);
    }
    let counts = PlanCounts { asked: permit.asked, poses: planner.meter.poses, ..planner.counts };
    meter.progress(1.0);
    Ok(Outline { path, counts, work: meter.work })
}

/// Memory of the search.
struct Room<'s> {
    trees: [Tree<'s>; 2],
    /// As the search finds it.
    found: Route<'s>,
    /// Shortened.
    short: Route<'s>,
}

impl<'s> Room<'s> {
    const fn bytes(nodes: usize) -> usize {
        Tree::bytes(nodes).saturating_add(Route::bytes(nodes.saturating_mul(2))).saturating_mul(2)
    }

    /// Empty, and with another metric.
    fn clear(&mut self, metric: Metric) {
        self.trees.iter_mut().for_each(|tree| tree.clear(metric));
    }

    fn new(nodes: usize, arena: &mut Arena<'s>) -> Result<Self, OutOfMemory> {
        let trees = [Tree::new(nodes, arena)?, Tree::new(nodes, arena)?];
        Ok(Self { trees, found: Route::new(2 * nodes, arena)?, short: Route::new(2 * nodes, arena)? })
    }
}

struct Planner<'q, 'a, 'm> {
    task: &'q Task<'a>,
    frames: Frames,
    hand: Option<Hand<'a>>,
    body: Body<'a>,
    counts: PlanCounts,
    meter: &'q mut Meter<'m>,
}

impl<'a> Planner<'_, 'a, '_> {
    /// Plans from `start`, or from anywhere outside, to the release and rest poses, all of them from frame to frame.
    fn run(
        &mut self,
        start: Option<Pose>,
        [goal, rest]: [Pose; 2],
        arena: Arena<'a>,
        waypoints: &mut [Waypoint],
        permit: &mut Permit,
    ) -> Result<Shape, End> {
        let (motion, body) = (&self.task.motion, self.body);
        let [release, resting] = [&goal, &rest].map(|pose| Placement::of(pose, &body.centre));
        let free = [goal, start.unwrap_or(goal)];
        let start = start.map(|start| Placement::of(&start, &body.centre));
        let reach = Moving::held(body, self.hand).reach;
        let supporter = self.task.supporter.points().aabb();
        let retreat = self.hand.map(|hand| release.centre() + rest.rotation * hand.retreat);
        let ends = start.iter().chain([&release]).map(Placement::centre).chain(retreat);
        let region = box_around(&supporter, ends, MARGIN * reach);

        let mut arena = arena;
        let mut space = space_of(self.task, &region, free, &mut arena, self.meter)?;
        let mut room = Room::new(motion.nodes, &mut arena)?;

        let clearance = self.way_of_object(
            &mut space,
            &region,
            (&release, start, &resting),
            (&mut room, &mut arena),
            permit,
        )?;
        let mut written = Written { waypoints, count: 0, step: motion.step };
        written.route(&room.short, &body.centre);
        let release_index = written.count - 1;
        let lowering = until_near(&mut space, &release, release.leg_to(&resting), self.meter)?;
        written.leg(&release, &lowering, &body.centre);
        let lowered = release.after(&lowering, 1.0).pose(&body.centre);
        let object = written.count;
        if let Some(hand) = self.hand {
            self.way_of_gripper(&space, &hand, (&region, &lowered), &mut room)?;
            written.route(&room.short, &hand.centre());
        }
        let (needed, given) = (written.count, waypoints.len());
        let gripper = needed - object;
        if needed > given {
            return Err(PlanError::TooManyWaypoints { needed, given }.into());
        }
        let path = Shape { object, release: release_index, gripper, clearance };
        Ok(self.timed(path, waypoints))
    }

    /// Finds a route of the object from the start to the release pose, leaves it in `room.short`, and returns its clearance.
    fn way_of_object(
        &mut self,
        space: &mut Space<'a>,
        region: &Aabb,
        (release, start, resting): (&Placement, Option<Placement>, &Placement),
        (room, scratch): (&mut Room, &mut Arena),
        permit: &mut Permit,
    ) -> Result<f32, End> {
        let motion = &self.task.motion;
        let at_goal = space.nearest(release, MAX_CLEARANCE, self.meter)?;
        if let Some(touch) = at_goal.touch.filter(|touch| touch.distance < LEAST_DISTANCE) {
            return Err(PlanFailure::GoalInCollision(touch.collision()).into());
        }
        if [release, resting].iter().any(|at| space.room_at(at) < 0.0 || !permit.accepts(at)) {
            return Err(PlanFailure::GoalOutsideWorkspace.into());
        }
        let mut kept = at_goal.distance;
        room.clear(Metric { radius: METRIC_RADIUS * space.moving.reach });
        if let Some(start) = start {
            let at_start = space.nearest(&start, MAX_CLEARANCE, self.meter)?;
            if let Some(touch) = at_start.touch.filter(|touch| touch.distance < LEAST_DISTANCE) {
                return Err(PlanFailure::StartInCollision(touch.collision()).into());
            }
            if space.room_at(&start) < 0.0 || !permit.accepts(&start) {
                return Err(PlanFailure::StartOutsideWorkspace.into());
            }
            kept = kept.min(at_start.distance);
            room.trees[START].add(start, None, MAX_CLEARANCE);
        } else {
            let supporter = self.task.supporter.points().aabb();
            self.add_starts(space, &supporter, release, room)?;
        }
        room.trees[GOAL].add(*release, None, MAX_CLEARANCE);
        let required = (KEPT * kept).min(motion.clearance);
        self.search(space, required, (region, release), (room, Some(scratch)), permit)
    }

    /// Adds places outside of a box as starts.
    fn add_starts(
        &mut self,
        space: &mut Space,
        aabb: &Aabb,
        goal: &Placement,
        room: &mut Room,
    ) -> Result<(), End> {
        let clearance = self.task.motion.clearance;
        for place in outside(aabb, goal, space.moving.reach, self.task.params.up()) {
            if space.room_at(&place) >= 0.0
                && space.nearest(&place, MAX_CLEARANCE, self.meter)?.distance >= clearance
            {
                room.trees[START].add(place, None, MAX_CLEARANCE);
            }
        }
        if room.trees[START].nodes().is_empty() {
            return Err(PlanFailure::StartOutsideWorkspace.into());
        }
        Ok(())
    }

    /// Finds a route between the roots of the trees, shortens it into `room.short`, and returns its clearance.
    fn search(
        &mut self,
        space: &mut Space,
        required: f32,
        (region, goal): (&Aabb, &Placement),
        (room, scratch): (&mut Room, Option<&mut Arena>),
        permit: &mut Permit,
    ) -> Result<f32, End> {
        let (motion, nodes) = (&self.task.motion, self.counts.nodes);
        let Room { trees, found, short } = room;
        let (mut may_prove, mut has_failed) = (scratch.is_some(), false);
        let mut search = Search {
            space,
            required,
            trees,
            region: *region,
            goal: *goal,
            random: Random::new(motion.seed),
            params: self.task.params,
            scratch: scratch.map(Arena::scratch),
            met: [0; 2],
            ends: Ends::new(),
            sampled: 0,
            budget: motion.samples,
            tried: 0,
            step: motion.step,
        };
        loop {
            // The proof that there is no way costs as much as many samples, and most ways are found with few.
            let most = if may_prove { SAMPLES_BEFORE_PROOF } else { usize::MAX };
            let before = search.sampled;
            let outcome = search.run((motion.samples - before).min(most), found, permit, self.meter);
            self.counts.samples += search.sampled - before;
            self.counts.nodes = nodes + search.trees.iter().map(|tree| tree.nodes().len()).sum::<usize>();
            match outcome? {
                Outcome::Found => {}
                Outcome::Full => return Err(PlanFailure::TreesFull { nodes: motion.nodes }.into()),
                Outcome::UsedUp => {
                    if core::mem::take(&mut may_prove)
                        && let Some(scratch) = &mut search.scratch
                        && let Some(resolution) = enclosed::link(search.space, goal, scratch, self.meter)?
                    {
                        return Err(PlanFailure::Enclosed { resolution }.into());
                    }
                    // A narrow place on the way has less room than the ends have.
                    search.required = search.required.min(NARROW);
                    if search.sampled == motion.samples {
                        return Err(PlanFailure::BudgetUsedUp { samples: motion.samples }.into());
                    }
                    continue;
                }
            }
            // Once a route was not free, the next one is tested before it is shortened, which costs more.
            let tested = if has_failed { Some(certify(search.space, found, self.meter)?) } else { None };
            if let Some(Err(leg)) = tested {
                search.cut_off(leg);
                continue;
            }
            short.copy_from(found);
            let kept = (search.required, motion.clearance);
            shorten(search.space, short, kept, &mut search.random, self.meter)?;
            let radius = search.trees[GOAL].metric().radius;
            widen(search.space, short, (motion.clearance, radius), self.meter)?;
            let is_accepted = permit.refused_leg(short, &motion.step, self.meter)?.is_none();
            if is_accepted && let Ok(clearance) = certify(search.space, short, self.meter)? {
                return Ok(clearance);
            }
            // What the search found has been accepted.
            let of_found = match tested {
                Some(tested) => tested,
                None => certify(search.space, found, self.meter)?,
            };
            match of_found {
                Ok(clearance) => {
                    short.copy_from(found);
                    return Ok(clearance);
                }
                Err(leg) => {
                    search.cut_off(leg);
                    has_failed = true;
                }
            }
        }
    }

    /// Finds a route of the opened gripper from outside to where it is when the object rests, and leaves it in `room.short`
    /// turned around.
    fn way_of_gripper(
        &mut self,
        space: &Space<'a>,
        hand: &Hand<'a>,
        (region, rest): (&Aabb, &Pose),
        room: &mut Room,
    ) -> Result<(), End> {
        let moving = Moving::gripper(*hand);
        let obstacles = space.obstacles.with_object(self.body, *rest);
        let mut space = Space::of_gripper(moving, obstacles);
        let at = Placement::of(rest, &moving.centre);
        open(&space, &at, self.meter)?;
        let kept = space.nearest(&at, MAX_CLEARANCE, self.meter)?.distance;
        let required = (KEPT * kept).min(self.task.motion.clearance);
        if let Some(leg) = straight(hand, rest)
            && space.way(&at, &leg, required, self.meter)?.is_free()
        {
            room.short.clear();
            room.short.push(at, 0.0);
            room.short.push(at.after(&leg, 1.0), 0.0);
            return Ok(());
        }
        room.clear(Metric { radius: METRIC_RADIUS * moving.reach });
        let rested = Placement::of(rest, &self.body.centre).centre();
        let supporter = self.task.supporter.points().aabb();
        let everything = box_around(&supporter, [rested], self.body.reach);
        let region = box_around(region, [rested], moving.reach);
        let anywhere = &mut |_: &Pose| true;
        room.trees[GOAL].add(at, None, MAX_CLEARANCE);
        let permit = &mut Permit::new(anywhere, self.frames, moving.centre);
        let found = match self.add_starts(&mut space, &everything, &at, room) {
            Ok(()) => self.search(&mut space, required, (&region, &at), (&mut *room, None), permit),
            Err(end) => Err(end),
        };
        match found {
            Err(End::Failure(
                PlanFailure::BudgetUsedUp { .. }
                | PlanFailure::TreesFull { .. }
                | PlanFailure::StartOutsideWorkspace,
            )) => Err(PlanFailure::GripperCannotLeave.into()),
            found => {
                room.short.reverse();
                found.map(|_| ())
            }
        }
    }

    /// Sets the times, and turns the path around if the object is taken off.
    fn timed(&self, path: Shape, waypoints: &mut [Waypoint]) -> Shape {
        let (motion, mut path) = (&self.task.motion, path);
        let (object, rest) = waypoints.split_at_mut_checked(path.object).unwrap_or_default();
        let gripper = rest.get_mut(..path.gripper).unwrap_or_default();
        let centre = self.hand.map_or(self.body.centre, |hand| hand.centre());
        if motion.take_off {
            object.reverse();
            gripper.reverse();
            path.release = path.object - 1 - path.release;
            set_times(gripper, 0.0, &motion.speed, &centre);
            let ready = gripper.last().map_or(0.0, |last| last.seconds);
            set_times(object, ready, &motion.speed, &self.body.centre);
        } else {
            set_times(object, 0.0, &motion.speed, &self.body.centre);
            let hung = object.last().map_or(0.0, |last| last.seconds);
            set_times(gripper, hung, &motion.speed, &centre);
        }
        path
    }
}
