//! Distances of the moving thing from everything that stands still.

mod capsule;
mod object;
mod touch;
mod track;
mod travel;
mod workspace;

pub(super) use touch::{Nearest, Touch, Touches};
pub(super) use travel::{Distances, Travels};
pub(super) use workspace::Workspace;

use capsule::CapsuleQuery;
use object::{ObjectQuery, SMALLEST_PIECE};
use touch::Collector;
use track::Track;

use super::exits::box_around;
use super::failure::Obstacle;
use super::gripper::{Finger, Hand};
use super::path::MAX_CLEARANCE;
use super::placement::{Leg, Placement};
use super::task::Task;
use crate::geometry::{Aabb, Neighbour, Point, PointTree, PointTreeSlots, Pose};
use crate::hanging::Hung;
use crate::mechanics::{Body, Frames, Support};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};

/// What moves: an object, a gripper, or an object in a gripper.
#[derive(Clone, Copy)]
pub(super) struct Moving<'a> {
    pub(super) body: Option<Body<'a>>,
    pub(super) gripper: Option<Hand<'a>>,
    /// How far the gripper is open, 0 to 1.
    pub(super) opening: f32,
    /// A point in the frame of the object, about which `reach` is taken.
    pub(super) centre: Point,
    /// Distance from the centre to the farthest point, metres.
    pub(super) reach: f32,
}

/// Everything that stands still, in the frame of the supporter.
#[derive(Clone, Copy)]
pub(super) struct Obstacles<'a> {
    pub(super) support: &'a Support<'a>,
    scene: Option<PointTree<'a>>,
    /// Radius of the points of the scene, metres, so that nothing slips through between them.
    scene_radius: f32,
    /// With poses in the caller's coordinates: see [`pose_of`](Self::pose_of).
    hung: &'a [Hung<'a>],
    /// The object at its rest pose, an obstacle for the gripper that has let it go.
    rested: Option<(Body<'a>, Pose)>,
    /// The box around all of the supporter.
    aabb: Aabb,
}

/// What moves among what.
pub(super) struct Space<'a> {
    pub(super) moving: Moving<'a>,
    pub(super) obstacles: Obstacles<'a>,
    /// The box that the object stays in, if there is one.
    workspace: Option<Workspace>,
    track: Track<'a>,
    /// Where the last [`way`](Self::way) ended, and the distances there: the next one often starts there.
    last: Option<(Placement, Distances)>,
}

/// Distance from a patch of the supporter, metres, up to which its nearest point is looked for; beyond it a bound will do.
const PATCH_RANGE: f32 = 0.003;
/// Distance beyond which a lower bound is as good as the distance, metres: a step of this length is long.
const EXACT_UP_TO: f32 = 0.008;
/// How much nearer an obstacle may come between two poses that are tested at least, metres: less than what a bar is thick. What this misses,
/// the certificate of the whole route finds. With 1, 2 and 3 mm 244, 243 and 244 of 246 paths are found, by 2753, 2394 and 2036 tests of
/// poses in the mean (`reach --pairs 44 --trees 0 --enclosed 0` with `--seed 53 --scene nothing,wall` and `--seed 55 --scene nothing,shelf`).
const LEAST_STEP: f32 = 0.002;
/// Most poses at which one leg of a path is tested: 5 m of it at [`LEAST_STEP`], 100 m where nothing is near. A longer leg counts
/// as blocked. Without this limit a start a thousand kilometres away would never be reached: its steps are below the rounding of the
/// way to it.
pub(super) const MAX_STEPS: usize = 5_000;
/// Points of a scene at which its spacing is measured.
const SPACING_PROBES: usize = 64;
/// Radius of the points of a scene, in multiples of the median distance between neighbours: balls of this radius around the points
/// of a square grid overlap without gaps.
const SPACING_RATIO: f32 = 0.75;
/// Largest radius of the points of a scene, metres. Sparser scenes have gaps.
const MAX_SCENE_RADIUS: f32 = 0.01;

impl<'a> Moving<'a> {
    /// The object, in the gripper if there is one.
    pub(super) fn held(body: Body<'a>, gripper: Option<Hand<'a>>) -> Self {
        let of_gripper = gripper.map_or(0.0, |gripper| gripper.reach(&body.centre, 0.0));
        let (centre, reach) = (body.centre, body.reach.max(of_gripper));
        Self { body: Some(body), gripper, opening: 0.0, centre, reach }
    }

    /// The opened gripper alone.
    pub(super) fn gripper(gripper: Hand<'a>) -> Self {
        let centre = gripper.centre();
        let reach = gripper.reach(&centre, 0.0).max(gripper.reach(&centre, 1.0));
        Self { body: None, gripper: Some(gripper), opening: 1.0, centre, reach }
    }

    /// The parts of the gripper, if there is one.
    fn fingers(&self) -> impl Iterator<Item = Finger> + use<'a> {
        let opening = self.opening;
        self.gripper.into_iter().flat_map(move |hand| hand.fingers(opening))
    }
}

impl<'a> Obstacles<'a> {
    /// Bytes for at most `scene` points.
    pub(super) const fn bytes(scene: usize) -> usize {
        PointTree::bytes(scene)
    }

    /// Bytes of working memory for [`build`](Self::build).
    pub(super) const fn scratch_bytes(scene: usize) -> usize {
        array_bytes::<Point>(scene).saturating_add(array_bytes::<u32>(scene))
    }

    /// Arranges the obstacles of a task for queries. Of the scene, only points in `region` matter.
    pub(super) fn build(
        task: &Task<'a>,
        region: &Aabb,
        arena: &mut Arena<'a>,
        meter: &Meter,
    ) -> Result<Self, Unfinished> {
        let (support, scene) = (task.supporter.support(), task.request.scene);
        let mut tree = PointTreeSlots::new(scene.len(), arena)?;
        let mut scratch = arena.scratch();
        let (points, names) = (scratch.unset::<Point>(scene.len())?, scratch.unset::<u32>(scene.len())?);
        let mut count = 0;
        for (point, name) in scene.iter().zip(0..) {
            meter.check_at(name as usize)?;
            let point = support.frame * Point::from(*point);
            if region.contains(&point) {
                (points[count], names[count]) = (point, name);
                count += 1;
            }
        }
        let scene = match count {
            0 => None,
            _ => {
                tree.fill(&points[..count], meter)?;
                tree.rename(names);
                Some(tree.into_tree())
            }
        };
        let scene_radius =
            scene.as_ref().map_or(0.0, |scene| (SPACING_RATIO * spacing_of(scene)).min(MAX_SCENE_RADIUS));
        let aabb = box_around(&task.supporter.points().aabb(), [], support.reach);
        Ok(Self { support, scene, scene_radius, hung: task.request.hung, rested: None, aabb })
    }

    /// Pose of an object that hangs already, from its frame to that of the supporter.
    fn pose_of(&self, hung: &Hung) -> Pose {
        Frames { object: *hung.object.frame(), supporter: self.support.frame }.inwards(&hung.pose)
    }

    /// The same with the object at its rest pose.
    pub(super) fn with_object(self, body: Body<'a>, rest: Pose) -> Self {
        Self { rested: Some((body, rest)), ..self }
    }

    /// The same without the object.
    pub(super) fn without_object(self) -> Self {
        Self { rested: None, ..self }
    }
}

/// Median distance between neighbours, metres.
pub(super) fn spacing_of(tree: &PointTree) -> f32 {
    let points = tree.points();
    let mut spacings: [f32; SPACING_PROBES] = core::array::from_fn(|k| {
        let mut found = [Neighbour::default(); 2];
        let nearest = tree.k_nearest(&points[k * points.len() / SPACING_PROBES], &mut found);
        libm::sqrtf(nearest.last().map_or(0.0, |neighbour| neighbour.distance_squared))
    });
    spacings.sort_unstable_by(f32::total_cmp);
    spacings[SPACING_PROBES / 2]
}

/// How far a motion is free.
pub(super) struct Way {
    /// Share of the motion that is free: 1 for all of it.
    pub(super) share: f32,
    /// Least distance on the free part, metres: a lower bound, capped at [`MAX_CLEARANCE`].
    pub(super) clearance: f32,
}

impl Way {
    pub(super) fn is_free(&self) -> bool {
        self.share >= 1.0
    }
}

impl<'a> Space<'a> {
    /// Bytes of what it keeps beside the obstacles, for a supporter of at most `points`.
    pub(super) const fn bytes(points: usize) -> usize {
        Track::bytes(points)
    }

    /// An object among obstacles.
    pub(super) fn of_object(
        moving: Moving<'a>,
        obstacles: Obstacles<'a>,
        workspace: Option<Workspace>,
        arena: &mut Arena<'a>,
    ) -> Result<Self, OutOfMemory> {
        let track = Track::new(obstacles.support, arena)?;
        Ok(Self { moving, obstacles, workspace, track, last: None })
    }

    /// A gripper without an object among obstacles.
    pub(super) fn of_gripper(moving: Moving<'a>, obstacles: Obstacles<'a>) -> Self {
        Self { moving, obstacles, workspace: None, track: Track::none(), last: None }
    }

    /// Makes the points of the scene smaller where they would be in the way at poses at which they are not.
    pub(super) fn make_room(&mut self, free: impl IntoIterator<Item = Pose>) {
        let (Some(body), Some(scene)) = (&self.moving.body, &self.obstacles.scene) else { return };
        for pose in free {
            let mut nearest = Nearest::within(2.0 * self.obstacles.scene_radius);
            ObjectQuery::new(body, &pose, &mut nearest, None).scene(scene, 0.0);
            self.obstacles.scene_radius = (0.5 * nearest.distance).max(0.0);
        }
    }

    /// Memory for other use, a slot for each patch of the supporter: what was known of the poses before is forgotten.
    pub(super) fn lend(&mut self) -> &mut [u32] {
        self.track.lend()
    }

    /// The nearest obstacle within `limit` metres.
    pub(super) fn nearest(&mut self, at: &Placement, limit: f32, meter: &mut Meter) -> Result<Nearest, Stop> {
        let mut nearest = Nearest::within(limit);
        self.collect(at, &mut nearest, meter)?;
        Ok(nearest)
    }

    /// Distance from the nearest obstacle, metres, at most [`MAX_CLEARANCE`]; `None` if it is less than `required`.
    pub(super) fn distance_if_free(
        &mut self,
        at: &Placement,
        required: f32,
        meter: &mut Meter,
    ) -> Result<Option<f32>, Stop> {
        let distance = self.distances(at, required, meter)?.least();
        Ok(Some(distance).filter(|distance| *distance >= required))
    }

    /// Distances from obstacles; below `enough` metres, only that they are.
    pub(super) fn distances(
        &mut self,
        at: &Placement,
        enough: f32,
        meter: &mut Meter,
    ) -> Result<Distances, Stop> {
        self.move_to(at, meter);
        let mut nearest = Nearest { enough, ..Nearest::within(MAX_CLEARANCE) };
        self.collect_supporter(at, &mut nearest, meter)?;
        let supporter = nearest.distance;
        if supporter >= enough {
            self.collect_others(at, &mut nearest, meter)?;
        }
        let others = if self.is_bare() {
            f32::INFINITY
        } else if nearest.distance < supporter || self.moving.gripper.is_some() {
            nearest.distance
        } else {
            self.bound_of_others().max(supporter)
        };
        Ok(Distances { supporter, others })
    }

    /// Lower bound of the distance of an object from the scene and from what hangs already, metres: what sleeps, and what was looked at, is
    /// known to be farther away than the nearest.
    fn bound_of_others(&self) -> f32 {
        let scene = self.obstacles.scene.iter().map(|_| 0);
        let hung = (0..self.obstacles.hung.len()).map(|index| 1 + index);
        scene.chain(hung).map(|other| self.track.bound(other)).fold(f32::INFINITY, f32::min)
    }

    /// Upper bounds of how much nearer a motion from a place brings what moves.
    pub(super) fn travels(&self, from: &Placement, leg: &Leg) -> Travels {
        Travels::of(self.moving.reach, &self.obstacles.aabb, from, leg)
    }

    /// Whether the mesh of the object crosses that of one that hangs, at the placement that was looked at last: both have details that the
    /// distance field lacks.
    pub(super) fn crosses_hung(&self, at: &Placement, meter: &mut Meter) -> Result<bool, Stop> {
        let Some(body) = &self.moving.body else { return Ok(false) };
        let to_object = at.pose(&self.moving.centre).inverse();
        let mut queries = 0;
        let errors = SMALLEST_PIECE + body.field.excess();
        let crosses = self.obstacles.hung.iter().enumerate().any(|(index, hung)| {
            if !self.track.is_awake(1 + index, errors) {
                return false;
            }
            let (between, other) = (to_object * self.obstacles.pose_of(hung), hung.object.surface());
            body.surface.is_crossed_by(other, &between, &mut queries)
                || other.is_crossed_by(body.surface, &between.inverse(), &mut queries)
        });
        meter.distance_queries(queries)?;
        Ok(crosses)
    }

    /// How far the object is inside the workspace, metres; negative if a part of it is outside, infinite without a workspace.
    pub(super) fn room_at(&self, at: &Placement) -> f32 {
        let Some(workspace) = &self.workspace else { return f32::INFINITY };
        let to_caller = self.obstacles.support.frame.inverse();
        workspace.room_at(&(to_caller * at.pose(&self.moving.centre)))
    }

    /// Whether there is nothing but the supporter.
    fn is_bare(&self) -> bool {
        let Obstacles { scene, hung, rested, .. } = &self.obstacles;
        scene.is_none() && hung.is_empty() && rested.is_none()
    }

    /// Counts a pose, at which what was known before may hold.
    fn move_to(&mut self, at: &Placement, meter: &mut Meter) {
        let Self { moving, obstacles, track, .. } = self;
        meter.poses += 1;
        track.move_to(at, |before, leg| Travels::of(moving.reach, &obstacles.aabb, before, leg));
    }

    /// Collects touches of whatever moves with whatever stands still.
    pub(super) fn collect(
        &mut self,
        at: &Placement,
        found: &mut impl Collector,
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        self.collect_on_supporter(at, found, meter)?;
        self.collect_others(at, found, meter)
    }

    /// The same with the supporter alone.
    pub(super) fn collect_on_supporter(
        &mut self,
        at: &Placement,
        found: &mut impl Collector,
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        self.move_to(at, meter);
        self.collect_supporter(at, found, meter)
    }

    /// The same at the placement that was moved to.
    fn collect_supporter(
        &mut self,
        at: &Placement,
        found: &mut impl Collector,
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        let Self { moving, obstacles, track, .. } = self;
        let pose = &at.pose(&moving.centre);
        if let Some(body) = &moving.body {
            let mut query = ObjectQuery::new(body, pose, found, Some(meter));
            query.supporter(obstacles.support, track);
            // What is far from everything counts as well, here and below, so that a work limit ends the longest way.
            let queries = query.queries.max(1);
            meter.distance_queries(queries)?;
        }
        for part in moving.fingers().enumerate() {
            let mut query = CapsuleQuery::new(part, pose, found);
            query.supporter(obstacles.support);
            meter.distance_queries(query.queries.max(1))?;
        }
        Ok(())
    }

    /// Collects touches with everything else.
    fn collect_others(
        &mut self,
        at: &Placement,
        found: &mut impl Collector,
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        if self.is_bare() {
            return Ok(());
        }
        let Self { moving, obstacles, track, .. } = self;
        let pose = &at.pose(&moving.centre);
        if let Some(body) = &moving.body {
            let mut query = ObjectQuery::new(body, pose, found, Some(meter));
            if let Some(scene) = &obstacles.scene {
                query.unless_asleep(track, 0, |query| query.scene(scene, obstacles.scene_radius));
            }
            for (index, hung) in obstacles.hung.iter().enumerate() {
                query.unless_asleep(track, 1 + index, |query| {
                    query.surface(hung.object.surface(), &obstacles.pose_of(hung), Obstacle::Hung(index));
                });
            }
            let queries = query.queries;
            meter.distance_queries(queries)?;
        }
        for part in moving.fingers().enumerate() {
            let mut query = CapsuleQuery::new(part, pose, found);
            if let Some(scene) = &obstacles.scene {
                query.scene(scene, obstacles.scene_radius);
            }
            for (index, hung) in obstacles.hung.iter().enumerate() {
                if let Some(field) = hung.object.distance_field() {
                    query.field(field, &obstacles.pose_of(hung), Obstacle::Hung(index));
                }
            }
            if let Some((body, pose)) = &obstacles.rested {
                query.field(body.field, pose, Obstacle::Object);
            }
            meter.distance_queries(query.queries)?;
        }
        Ok(())
    }

    /// How far a motion from a place keeps at least `required` metres from everything, at the poses that are tested. No step between
    /// them brings an obstacle nearer than half of that, or by more than [`LEAST_STEP`]: certain is only what
    /// [`certify`](super::certify) has tested.
    pub(super) fn way(
        &mut self,
        from: &Placement,
        leg: &Leg,
        required: f32,
        meter: &mut Meter,
    ) -> Result<Way, Stop> {
        let travels = self.travels(from, leg);
        let mut way = Way { share: 0.0, clearance: MAX_CLEARANCE };
        let (mut place, mut share) = (*from, 0.0);
        for _ in 0..MAX_STEPS {
            let room = self.room_at(&place);
            if room < 0.0 {
                return Ok(way);
            }
            let known = self.last.filter(|(last, distances)| *last == place && distances.least() >= required);
            let distances = match known {
                Some((_, distances)) => distances,
                None => self.distances(&place, required, meter)?,
            };
            if distances.least() < required {
                return Ok(way);
            }
            self.last = Some((place, distances));
            way = Way { share, clearance: way.clearance.min(distances.least()) };
            if share >= 1.0 {
                return Ok(way);
            }
            let in_room = Distances { others: distances.others.min(room), ..distances };
            share =
                (share + travels.share(&in_room, |distance| distance - 0.5 * required, LEAST_STEP)).min(1.0);
            place = from.after(leg, share);
        }
        Ok(way)
    }
}
