//! Makes problems from pairs, trees and enclosures, and has them planned and replayed.

use super::enclosed::{Enclosure, enclosed};
use super::grip::Grip;
use super::problem::{Problem, start};
use super::row::{Peer, Planned, Row};
use super::surroundings::{Around, Surroundings, extent, front, sampled, surroundings};
use super::tree::Tree;
use crate::judge::replay::{DEEPEST, STEP};
use crate::judge::{Bullet, Judge, Scene};
use crate::shapes::vector::{V, Z, double, scale, single, unit};
use crate::shapes::{Insertion, Random, insertion, joints};
use crate::solid::Solid;
use crate::tables::case::Case;
use hangpose::geometry::Pose;
use hangpose::hanging::{HangingPose, Hung, Object, Request, Supporter, predict_bytes, predict_many};
use hangpose::motion::{Motion, PlanError, Task};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses, sample_supporter};
use nalgebra::Translation3;

/// Number of poses that are looked through for one that hangs.
const TOP: usize = 10;
/// Number of points of the cloud of a tree.
const TREE_POINTS: usize = 10_000;
/// Spacing of the samples of a supporter that encloses, m.
const SPACING: f64 = 0.003;

/// What is asked of the planner.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// How the object moves. The start and the gripper are set for each problem.
    pub motion: Motion<'a>,
    /// Whether a gripper holds the object.
    pub gripper: bool,
    /// Whether OMPL plans the same problems, those without a gripper.
    pub peer: bool,
}

/// What the planner finds, and what OMPL finds, if it is asked.
fn answers(problem: &Problem, options: &Options) -> Result<(Planned, Option<Peer>), PlanError> {
    let is_asked = options.peer && problem.task.motion.gripper.is_none();
    Ok((problem.planned()?, if is_asked { problem.peer() } else { None }))
}

/// The rest pose, or the release pose if there is none.
fn rest(pose: &HangingPose) -> Pose {
    pose.rest.map_or(pose.pose, |rest| rest.pose)
}

/// The best of ten poses that hangs in Bullet among these obstacles.
fn hanging(
    (object, supporter): (&Object, &Supporter),
    (solid, obstacles): (&Solid, &Solid),
    request: &Request,
    params: &Params,
) -> Option<HangingPose> {
    let mut poses = [HangingPose::default(); TOP];
    let found = predict_poses(object, supporter, request, params, &mut poses, &Monitor::new())
        .expect("the request and the params are valid");
    let scene = Scene { tilt: false, ..Scene::new(solid, obstacles) };
    let mut world = Bullet::default().world(&scene);
    found.poses.iter().find(|pose| world.judge(&scene, &pose.pose).success()).copied()
}

/// The problems of a pair of generated shapes: one with any start, and one for each of `arounds`.
pub fn pair(case: &Case, arounds: &[Around], options: &Options) -> Result<Vec<Row>, PlanError> {
    let params = Params { seed: case.seed, ..Params::default() };
    let cloud = case.supporter_cloud();
    let (monitor, mut memory, mut more_memory) = (Monitor::new(), Vec::new(), Vec::new());
    let object =
        analyze_object(&case.object.mesh(), &params, &mut memory, &monitor).expect("memory is enough");
    let cloud = cloud.cloud().expect("samples are valid");
    let supporter = analyze_supporter(&cloud, &params, &mut more_memory, &monitor).expect("memory is enough");
    let models = (&object, &supporter);
    let row = |scene: &str| Row {
        pair: case.name.clone(),
        object: case.object_kind.clone(),
        supporter: case.supporter_kind.clone(),
        scene: scene.into(),
        gripper: options.gripper,
        insertion: None,
        plan: None,
        peer: None,
    };
    let bare = hanging(models, (&case.object, &case.supporter), &Request::ANY, &params);
    let Some(bare) = bare else { return Ok(vec![row(Around::Nothing.name())]) };
    let mut rows = Vec::new();
    for around in arounds {
        let Some(front) = front(case, &rest(&bare)) else { continue };
        let Some(surroundings) = surroundings(case, &rest(&bare), *around) else { continue };
        let Surroundings { solid, points, hung, height } = surroundings;
        let others: Vec<Hung> = hung.iter().map(|&pose| Hung { object: &object, pose }).collect();
        let request = Request { scene: &points, hung: &others, ..Request::ANY };
        let fixed = hung.iter().map(|&pose| (&*case.object, pose));
        let obstacles = case.supporter.with([(&solid, Pose::identity())]).with(fixed);
        let goal = match around {
            Around::Nothing => Some(bare),
            _ => hanging(models, (&case.object, &obstacles), &request, &params),
        };
        let mut row = row(around.name());
        let Some(goal) = goal else {
            rows.push(row);
            continue;
        };
        let grip = Grip::of(&case.object, &rest(&goal), &obstacles);
        if options.gripper && grip.is_none() {
            continue;
        }
        let gripper = grip.as_ref().filter(|_| options.gripper).map(Grip::gripper);
        let joints = case.joints(&rest(&goal));
        let parts = (&*case.supporter, &case.bars[..]);
        let [low, high] = extent(&case.object, &rest(&goal), Z);
        // A wall closes the loop of a rail.
        let is_possible = insertion(&joints, &case.openings, parts, *around == Around::Wall);
        row.insertion = Some(match is_possible {
            Insertion::Possible if high - low > height => Insertion::Unknown,
            other => other,
        });
        let mut random = Random::named(&case.name, 5);
        let start = start(&case.object, &obstacles, &goal.pose, front, gripper.as_ref(), &mut random);
        let plan = |start: Option<Pose>| -> Result<(Planned, Option<Peer>), PlanError> {
            let motion = Motion { start, gripper, ..options.motion };
            let task =
                Task { object: &object, supporter: &supporter, request: &request, params: &params, motion };
            answers(&Problem { solid: &case.object, obstacles: &obstacles, task, goal }, options)
        };
        if *around == Around::Nothing {
            let any = format!("{}, any start", around.name());
            let (plan, peer) = plan(None)?;
            rows.push(Row { scene: any, plan: Some(plan), peer, ..row.clone() });
        }
        let (plan, peer) = plan(Some(start))?;
        rows.push(Row { plan: Some(plan), peer, ..row });
    }
    Ok(rows)
}

/// Whether an object among obstacles can be moved straight from a pose until it is beyond all of them: no deeper than a replay allows.
/// Mugs on the branches beside that of another one may bar its way.
fn comes_straight(solid: &Solid, obstacles: &Solid, from: &Pose, direction: V) -> bool {
    let [_, end] = extent(obstacles, &Pose::identity(), direction);
    let [begin, _] = extent(solid, from, direction);
    let scene = Scene { tilt: false, ..Scene::new(solid, obstacles) };
    let mut world = Bullet::default().world(&scene);
    (0..=((end - begin) / STEP).ceil() as u32).all(|step| {
        let away = scale(direction, STEP * f64::from(step));
        world.release(&(Translation3::from(single(away)) * from).cast());
        world.penetration() <= DEEPEST
    })
}

/// A mug on the last free branch of a tree. The construction tells that it comes there if it comes straight along the branch.
pub fn tree(seed: u64, options: &Options) -> Result<Option<Row>, PlanError> {
    let Tree { tree, mugs, last } = Tree::new(seed);
    let params = Params { seed, ..Params::default() };
    let cloud = sample_supporter(&tree.solid.mesh(), TREE_POINTS, seed);
    let (monitor, mut memory) = (Monitor::new(), Vec::new());
    let cloud = cloud.cloud().expect("samples are valid");
    let supporter = analyze_supporter(&cloud, &params, &mut memory, &monitor).expect("memory is enough");
    let mut memories = vec![Vec::new(); mugs.len()];
    let objects: Vec<Object> = (mugs.iter().zip(&mut memories))
        .map(|(mug, memory)| {
            analyze_object(&mug.solid.mesh(), &params, memory, &monitor).expect("memory is enough")
        })
        .collect();
    let all: Vec<&Object> = objects.iter().collect();
    let mut poses = vec![None; mugs.len()];
    let mut memory = vec![0; predict_bytes(&supporter.limits())];
    predict_many(&all, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &monitor)
        .expect("the params are valid");
    let others = || (0..mugs.len()).filter(|index| *index != last);
    let placed: Vec<(usize, Pose)> =
        others().filter_map(|index| Some((index, rest(poses[index].as_ref()?)))).collect();
    let hung: Vec<Hung> =
        placed.iter().map(|&(index, pose)| Hung { object: &objects[index], pose }).collect();
    let obstacles = tree.solid.with(placed.iter().map(|&(index, pose)| (&mugs[index].solid, pose)));
    let solid = &mugs[last].solid;
    let request = Request { hung: &hung, ..Request::ANY };
    // It comes when all others hang, whatever their order was.
    let goal = hanging((&objects[last], &supporter), (solid, &obstacles), &request, &params);
    let Some(goal) = goal else { return Ok(None) };
    let parts = (&tree.solid, &tree.bars[..]);
    let joints = joints((solid, &mugs[last].openings), parts, &rest(&goal));
    let Some(joint) = joints.first() else { return Ok(None) };
    let bar = &tree.bars[joint.bar];
    let grip = Grip::of(solid, &rest(&goal), &obstacles);
    if options.gripper && grip.is_none() {
        return Ok(None);
    }
    let gripper = grip.as_ref().filter(|_| options.gripper).map(Grip::gripper);
    let [x, y, _] = double(bar.direction);
    let mut random = Random::named("mug on a tree", seed);
    let start = start(solid, &obstacles, &goal.pose, unit([x, y, 0.0]), gripper.as_ref(), &mut random);
    let motion = Motion { start: Some(start), gripper, ..options.motion };
    let task =
        Task { object: &objects[last], supporter: &supporter, request: &request, params: &params, motion };
    let (plan, peer) = answers(&Problem { solid, obstacles: &obstacles, task, goal }, options)?;
    Ok(Some(Row {
        pair: format!("mug on tree {seed}"),
        object: "mug".into(),
        supporter: "mug tree".into(),
        scene: "mug tree, one branch free".into(),
        gripper: options.gripper,
        insertion: Some(match insertion(&joints, &mugs[last].openings, parts, false) {
            Insertion::Possible if !comes_straight(solid, &obstacles, &goal.pose, double(bar.direction)) => {
                Insertion::Unknown
            }
            other => other,
        }),
        plan: Some(plan),
        peer,
    }))
}

/// An object and a supporter that enclose each other, or the same with the way open; `None` if no shapes of this seed fit.
pub fn enclosure(
    enclosure: Enclosure,
    seed: u64,
    is_closed: bool,
    options: &Options,
) -> Result<Option<Row>, PlanError> {
    let Some(made) = enclosed(enclosure, seed, is_closed) else { return Ok(None) };
    let params = Params { seed, ..Params::default() };
    let (monitor, mut memory, mut more_memory) = (Monitor::new(), Vec::new(), Vec::new());
    let object =
        analyze_object(&made.object.mesh(), &params, &mut memory, &monitor).expect("memory is enough");
    let cloud = sampled(&made.supporter, SPACING);
    let cloud = cloud.cloud().expect("samples are valid");
    let supporter = analyze_supporter(&cloud, &params, &mut more_memory, &monitor).expect("memory is enough");
    let goal = HangingPose { pose: made.pose, ..HangingPose::default() };
    let mut random = Random::named("start", seed);
    let start = start(&made.object, &made.supporter, &made.pose, made.out, None, &mut random);
    let motion = Motion { start: Some(start), ..options.motion };
    let task =
        Task { object: &object, supporter: &supporter, request: &Request::ANY, params: &params, motion };
    let problem = Problem { solid: &made.object, obstacles: &made.supporter, task, goal };
    let (mut plan, peer) = answers(&problem, options)?;
    // The pose is free, but need not be one that hangs.
    if let Some(replay) = &mut plan.replay {
        (replay.hangs, replay.passes) = (None, replay.is_free());
    }
    let scene = enclosure.name();
    Ok(Some(Row {
        pair: format!("{}-{scene}-{seed}", made.object_kind),
        object: made.object_kind.into(),
        supporter: scene.into(),
        scene: if is_closed { scene.into() } else { format!("{scene}, opened") },
        gripper: false,
        insertion: Some(if is_closed { Insertion::Impossible } else { Insertion::Possible }),
        plan: Some(plan),
        peer,
    }))
}
