//! The counted work of each call on inputs that are hard for it: never more than docs/TRUST.md says, and no more than a work limit
//! allows.

use hangpose::geometry::{Cloud, Mesh, Pose};
use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::motion::{Motion, Task, Waypoint, plan, plan_bytes};
use hangpose::{Candidates, Monitor, Params, Stop, Work};
use host_tests::performance::adversarial::{clouds, meshes};
use host_tests::performance::ordinary;
use host_tests::performance::refine::Triangles;

const TRIANGLES: usize = 1_500;
const POINTS: usize = 1_000;
/// The most that is booked at once before a call looks at its limit: the queries of one pose of the object or of one step of a
/// simulation, which are a few for each point of the supporter and for its groups.
const AT_ONCE: u64 = 4 * POINTS as u64;

fn profiles() -> [Params; 2] {
    [
        Params { samples: 5_000, voxels: 20_000, settle_attempts: 12, ..Params::default() },
        Params { samples: 5_000, ..Params::paper() },
    ]
}

fn sum(work: Work) -> u64 {
    work.rays + work.distance_queries
}

/// The rows of docs/TRUST.md, "Bounded work": the most rays and the most queries.
fn most_for_object(params: &Params) -> [usize; 2] {
    let Params { samples, free_space_steps, object_directions, rays_per_direction, voxels, .. } = *params;
    match params.candidates {
        Candidates::Sites => {
            [samples * (1 + object_directions * rays_per_direction), samples * (1 + free_space_steps)]
        }
        // At a contact: down, to both sides of 24 bars at 6 depths, along the bar, and around it.
        Candidates::Contacts => [192 * (1 + 24 * 6 * 2 + 2 + 12), 3 * voxels],
    }
}

fn most_for_supporter(params: &Params, points: usize) -> [usize; 2] {
    match params.candidates {
        Candidates::Sites => [0, points * (2 + params.supporter_directions)],
        Candidates::Contacts => [0, 96],
    }
}

/// The most queries of a prediction.
fn most_for_prediction(params: &Params, points: usize) -> usize {
    // Steps, and tests of clearance: as many candidates are refused as released, and a release has up to three release poses.
    let steps = (4.0 * params.settle_time + 6.0) / params.time_step + 5.0 * 9.0;
    match params.candidates {
        Candidates::Sites => 128 * 256 * 2 * 3 * points,
        Candidates::Contacts => {
            100_000 * 5 * (16 + 3 * points) + params.settle_attempts * steps.ceil() as usize * 3 * points
        }
    }
}

fn assert_at_most(name: &str, work: Work, [rays, queries]: [usize; 2]) {
    let is_within = work.rays <= rays as u64 && work.distance_queries <= queries as u64;
    assert!(is_within, "{name}: {work:?}, more than {rays} rays or {queries} queries");
}

/// Runs `call`, which returns its counted work and why it was stopped, under limits of a third and of two thirds of what it
/// needs without one.
fn check(name: &str, mut call: impl FnMut(&Monitor) -> Option<(Work, Option<Stop>)>) {
    let Some((all, stopped)) = call(&Monitor::new()) else { return };
    let all = sum(all);
    assert_eq!(stopped, None, "{name}");
    for limit in [all / 3, all * 2 / 3] {
        if limit == all {
            continue;
        }
        // An analysis that ends before it has a model is an error, and says nothing of its work.
        if let Some((work, stopped)) = call(&Monitor::with_work_limit(limit)) {
            assert_eq!(stopped, Some(Stop::WorkLimit), "{name} under {limit} of {all}");
            let work = sum(work);
            assert!(work <= limit + AT_ONCE, "{name}: {work} under {limit} of {all}");
        }
    }
}

/// Analyses both sides, predicts, and plans a path to the best pose.
fn check_pair(name: &str, mesh: &Triangles, points: &[[f32; 3]]) {
    let Ok(mesh) = Mesh::new(&mesh.0, &mesh.1) else { return };
    let cloud = Cloud::new(points, None).unwrap();
    for params in profiles() {
        let limits = Limits { points: points.len(), ..Object::limits(&mesh, &params) };
        let (mut a, mut b) = (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
        check(&format!("object, {name}"), |monitor| {
            let object = Object::analyze(&mesh, &params, &mut a, monitor).ok()?;
            Some((object.work(), object.stopped()))
        });
        check(&format!("supporter, {name}"), |monitor| {
            let supporter = Supporter::analyze(&cloud, &params, &mut b, monitor).ok()?;
            Some((supporter.work(), supporter.stopped()))
        });
        let unlimited = Monitor::new();
        let Ok(object) = Object::analyze(&mesh, &params, &mut a, &unlimited) else { continue };
        let Ok(supporter) = Supporter::analyze(&cloud, &params, &mut b, &unlimited) else { continue };
        assert_at_most(name, object.work(), most_for_object(&params));
        assert_at_most(name, supporter.work(), most_for_supporter(&params, points.len()));

        let mut memory = vec![0; predict_bytes(&limits)];
        let mut poses = [HangingPose::default(); 10];
        check(&format!("predict, {name}"), |monitor| {
            let predicted =
                predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, monitor)
                    .unwrap();
            Some((predicted.work, predicted.stopped))
        });
        let predicted =
            predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &unlimited)
                .unwrap();
        assert_at_most(name, predicted.work, [usize::MAX, most_for_prediction(&params, points.len())]);
        let Some(goal) = predicted.poses.first().copied().filter(|goal| goal.rest.is_some()) else {
            continue;
        };
        let motion = Motion { samples: 200, ..Motion::default() };
        let task =
            Task { object: &object, supporter: &supporter, request: &Request::ANY, params: &params, motion };
        let mut memory = vec![0; plan_bytes(&limits, 0, motion.nodes)];
        let mut waypoints = vec![Waypoint::default(); 2_000];
        check(&format!("plan, {name}"), |monitor| {
            let plan = plan(&task, &goal, &mut waypoints, &mut |_| true, &mut memory, monitor).unwrap();
            assert_at_most(name, plan.work, [0, plan.counts.poses * 3 * points.len()]);
            Some((plan.work, plan.stopped()))
        });
    }
}

fn ordinary() -> (Triangles, Vec<[f32; 3]>) {
    let case = ordinary::ordinary();
    (ordinary::object(&case, TRIANGLES), ordinary::supporter(&case, POINTS).0)
}

#[test]
fn no_mesh_takes_more_work_than_the_limits_say() {
    let (mug, hook) = ordinary();
    check_pair("ordinary", &mug, &hook);
    for (name, mesh) in meshes(TRIANGLES) {
        check_pair(name, &mesh, &hook);
    }
}

#[test]
fn no_cloud_takes_more_work_than_the_limits_say() {
    let (mug, _) = ordinary();
    for (name, cloud) in clouds(POINTS) {
        check_pair(name, &mug, &cloud);
    }
}

/// From a start so far away that hardly a pose on the way is near anything: each that is tested counts.
#[test]
fn a_work_limit_ends_a_path_of_a_thousand_kilometres() {
    let (mug, hook) = ordinary();
    let [params, _] = profiles();
    let (mesh, cloud) = (Mesh::new(&mug.0, &mug.1).unwrap(), Cloud::new(&hook, None).unwrap());
    let limits = Limits { points: hook.len(), ..Object::limits(&mesh, &params) };
    let (mut a, mut b) = (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
    let monitor = Monitor::new();
    let object = Object::analyze(&mesh, &params, &mut a, &monitor).unwrap();
    let supporter = Supporter::analyze(&cloud, &params, &mut b, &monitor).unwrap();
    let (mut memory, mut poses) = (vec![0; predict_bytes(&limits)], [HangingPose::default()]);
    let found =
        predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &monitor).unwrap();
    let goal = found.poses[0];
    let motion = Motion { start: Some(Pose::translation(1e6, 0.0, 0.0)), ..Motion::default() };
    let task =
        Task { object: &object, supporter: &supporter, request: &Request::ANY, params: &params, motion };
    let mut memory = vec![0; plan_bytes(&limits, 0, motion.nodes)];
    let mut waypoints = vec![Waypoint::default(); 2_000];
    let limited = Monitor::with_work_limit(100_000);
    let plan = plan(&task, &goal, &mut waypoints, &mut |_| true, &mut memory, &limited).unwrap();
    assert_eq!(plan.stopped(), Some(Stop::WorkLimit));
    assert!(plan.counts.poses as u64 <= plan.work.distance_queries, "{plan:?}");
}
