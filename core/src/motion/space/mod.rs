//! Distances of the moving thing from everything that stands still.

mod capsule;
mod object;
mod touch;
mod track;
mod workspace;

pub(super) use touch::{Nearest, Touch, Touches};
pub(super) use workspace::Workspace;

use capsule::CapsuleQuery;
use object::ObjectQuery;
use touch::Collector;
use track::Track;

use super::failure::Obstacle;
use super::gripper::Gripper;
use super::path::MAX_CLEARANCE;
use super::placement::{Leg, Placement};
use super::task::Task;
use crate::geometry::{Aabb, Neighbour, Point, PointTree, PointTreeSlots, Pose};
use crate::hanging::Hung;
use crate::mechanics::{Body, Support};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};

/// What moves: an object, a gripper, or an object in a gripper.
#[derive(Clone, Copy)]
pub(super) struct Moving<'a> {
    pub(super) body: Option<Body<'a>>,
    pub(super) gripper: Option<Gripper<'a>>,
    /// How far the gripper is open, 0 to 1.
    pub(super) opening: f32,
    /// A point in object coordinates, about which `reach` is taken.
    pub(super) centre: Point,
    /// Distance from the centre to the farthest point, metres.
    pub(super) reach: f32,
}

/// Everything that stands still, in supporter coordinates.
#[derive(Clone, Copy)]
pub(super) struct Obstacles<'a> {
    pub(super) support: &'a Support<'a>,
    scene: Option<PointTree<'a>>,
    /// Radius of the points of the scene, metres, so that nothing slips through between them.
    scene_radius: f32,
    hung: &'a [Hung<'a>],
    /// The object at its rest pose, an obstacle for the gripper that has let it go.
    rested: Option<(Body<'a>, Pose)>,
}

/// What moves among what.
pub(super) struct Space<'a> {
    pub(super) moving: Moving<'a>,
    pub(super) obstacles: Obstacles<'a>,
    /// The box that the object stays in, if there is one.
    workspace: Option<Workspace>,
    track: Track<'a>,
    /// Where the last [`way`](Self::way) ended, and the distance from the nearest obstacle there, metres: the next one often starts
    /// there.
    last: Option<(Placement, f32)>,
}

/// Distance from a patch of the supporter, metres, up to which its nearest point is looked for; beyond it a bound will do.
const PATCH_RANGE: f32 = 0.003;
/// Distance beyond which a lower bound is as good as the distance, metres: a step of this length is long.
const EXACT_UP_TO: f32 = 0.008;
/// Travel between two poses that are tested at least, metres: less than what a bar is thick. What this misses, the certificate of the
/// whole route finds. With 1, 2 and 3 mm 243, 249 and 245 of 253 paths are found, in 24, 21 and 17 ms in the median
/// (`reach --pairs 44 --trees 0 --enclosed 0` with `--seed 53 --scene nothing,wall` and `--seed 55 --scene nothing,shelf`).
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
    pub(super) fn held(body: Body<'a>, gripper: Option<Gripper<'a>>) -> Self {
        let of_gripper = gripper.map_or(0.0, |gripper| gripper.reach(&body.centre, 0.0));
        let (centre, reach) = (body.centre, body.reach.max(of_gripper));
        Self { body: Some(body), gripper, opening: 0.0, centre, reach }
    }

    /// The opened gripper alone.
    pub(super) fn gripper(gripper: Gripper<'a>) -> Self {
        let centre = gripper.centre();
        let reach = gripper.reach(&centre, 0.0).max(gripper.reach(&centre, 1.0));
        Self { body: None, gripper: Some(gripper), opening: 1.0, centre, reach }
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
            let point = Point::from(*point);
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
        let hung = task.request.hung;
        Ok(Self { support, scene, scene_radius, hung, rested: None })
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
    pub(super) fn make_room(&mut self, free: &[Pose]) {
        let (Some(body), Some(scene)) = (&self.moving.body, &self.obstacles.scene) else { return };
        for pose in free {
            let mut nearest = Nearest::within(2.0 * self.obstacles.scene_radius);
            ObjectQuery::new(body, pose, &mut nearest, None).scene(scene, 0.0);
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
        let mut nearest = Nearest { enough: required, ..Nearest::within(MAX_CLEARANCE) };
        self.collect(at, &mut nearest, meter)?;
        Ok(Some(nearest.distance).filter(|distance| *distance >= required))
    }

    /// Whether the mesh of the object crosses that of one that hangs: both have details that the distance field lacks.
    pub(super) fn crosses_hung(&self, at: &Placement, meter: &mut Meter) -> Result<bool, Stop> {
        let Some(body) = &self.moving.body else { return Ok(false) };
        let to_object = at.pose(&self.moving.centre).inverse();
        let mut queries = 0;
        let crosses = self.obstacles.hung.iter().any(|hung| {
            let (between, other) = (to_object * hung.pose, hung.object.surface());
            body.surface.is_crossed_by(other, &between, &mut queries)
                || other.is_crossed_by(body.surface, &between.inverse(), &mut queries)
        });
        meter.distance_queries(queries)?;
        Ok(crosses)
    }

    /// How far the object is inside the workspace, metres; negative if a part of it is outside, infinite without a workspace.
    pub(super) fn room_at(&self, at: &Placement) -> f32 {
        self.workspace.map_or(f32::INFINITY, |workspace| workspace.room_at(&at.pose(&self.moving.centre)))
    }

    /// Collects touches of whatever moves with whatever stands still.
    pub(super) fn collect(
        &mut self,
        at: &Placement,
        found: &mut impl Collector,
        meter: &mut Meter,
    ) -> Result<(), Stop> {
        let Self { moving, obstacles, track, .. } = self;
        meter.poses += 1;
        let pose = &at.pose(&moving.centre);
        if let Some(body) = &moving.body {
            let mut query = ObjectQuery::new(body, pose, found, Some(meter));
            track.move_to(at, moving.reach);
            query.supporter(obstacles.support, track);
            if let Some(scene) = &obstacles.scene {
                query.unless_asleep(track, 0, |query| query.scene(scene, obstacles.scene_radius));
            }
            for (index, hung) in obstacles.hung.iter().enumerate() {
                query.unless_asleep(track, 1 + index, |query| {
                    query.surface(hung.object.surface(), &hung.pose, Obstacle::Hung(index));
                });
            }
            // What is far from everything counts as well, here and below, so that a work limit ends the longest way.
            let queries = query.queries.max(1);
            meter.distance_queries(queries)?;
        }
        for part in moving.gripper.iter().flat_map(|gripper| gripper.parts).enumerate() {
            let mut query = CapsuleQuery::new(part, moving.opening, pose, found);
            query.supporter(obstacles.support);
            if let Some(scene) = &obstacles.scene {
                query.scene(scene, obstacles.scene_radius);
            }
            for (index, hung) in obstacles.hung.iter().enumerate() {
                if let Some(field) = hung.object.distance_field() {
                    query.field(field, &hung.pose, Obstacle::Hung(index));
                }
            }
            if let Some((body, pose)) = &obstacles.rested {
                query.field(body.field, pose, Obstacle::Object);
            }
            meter.distance_queries(query.queries.max(1))?;
        }
        Ok(())
    }

    /// How far a motion from a place keeps at least `required` metres from everything, at the poses that are tested. No step between
    /// them moves any point farther than half of that would be left, or than [`LEAST_STEP`]: certain is only what
    /// [`certify`](super::certify) has tested.
    pub(super) fn way(
        &mut self,
        from: &Placement,
        leg: &Leg,
        required: f32,
        meter: &mut Meter,
    ) -> Result<Way, Stop> {
        let travel = leg.travel(self.moving.reach).max(1e-9);
        let mut way = Way { share: 0.0, clearance: MAX_CLEARANCE };
        let (mut place, mut share) = (*from, 0.0);
        for _ in 0..MAX_STEPS {
            let room = self.room_at(&place);
            if room < 0.0 {
                return Ok(way);
            }
            let known = self.last.filter(|(last, distance)| *last == place && *distance >= required);
            let distance = match known {
                Some((_, distance)) => distance,
                None => match self.distance_if_free(&place, required, meter)? {
                    Some(distance) => distance,
                    None => return Ok(way),
                },
            };
            self.last = Some((place, distance));
            way = Way { share, clearance: way.clearance.min(distance) };
            if share >= 1.0 {
                return Ok(way);
            }
            let step = (distance - 0.5 * required).min(room).max(LEAST_STEP);
            share = (share + step / travel).min(1.0);
            place = from.after(leg, share);
        }
        Ok(way)
    }
}
