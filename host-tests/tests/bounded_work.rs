//! The counted work of each call on inputs that are hard for it: never more than docs/TRUST.md says, and no more than a work limit
//! allows.

use hangpose::geometry::{Cloud, Mesh, Pose};
use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::motion::{Motion, Task, Waypoint, plan, plan_bytes};
use hangpose::{Candidates, Monitor, Params, Stop, Work};
use host_tests::performance::adversarial::{clouds, meshes};
use host_tests::performance::refine::{Triangles, refine, weld};
use host_tests::performance::room::scatter;
use host_tests::tables::case::made;

const TRIANGLES: usize = 1_500;
const POINTS: usize = 1_000;
/// The most that is booked at once before a call looks at its limit: the queries of one pose of the object or of one step of a
/// simulation, which are a few for each point of the supporter and for its groups.
const AT_ONCE: u64 = 4 * POINTS as u64;

fn profiles() -> [Params; 2] {
    [
        Params { samples: 1_000, voxels: 20_000, settle_attempts: 12, ..Params::default() },
        Params { samples: 1_000, ..Params::paper() },
    ]
}

fn sum(work: Work) -> u64 {
    work.rays + work.distance_queries
}

/// The rows of docs/TRUST.md, "Bounded work".
fn most_for_object(params: &Params) -> u64 {
    let places = match params.candidates {
        Candidates::Sites => {
            params.samples
                * (2 + params.free_space_steps + params.object_directions * params.rays_per_direction)
        }
        Candidates::Contacts => 192 * 87,
    };
    (places + 3 * params.voxels) as u64
}

fn most_for_supporter(params: &Params, points: usize) -> u64 {
    let places = match params.candidates {
        Candidates::Sites => points * (2 + params.supporter_directions),
        Candidates::Contacts => 96,
    };
    places as u64
}

/// Runs `call`, which returns its counted work and why it was stopped, under limits of a third and of two thirds of what it
/// needs without one, and returns what it needs.
fn check(name: &str, mut call: impl FnMut(&Monitor) -> Option<(u64, Option<Stop>)>) -> Option<u64> {
    let (all, stopped) = call(&Monitor::new())?;
    assert_eq!(stopped, None, "{name}");
    for limit in [all / 3, all * 2 / 3] {
        if limit == all {
            continue;
        }
        // An analysis that ends before it has a model is an error, and says nothing of its work.
        if let Some((work, stopped)) = call(&Monitor::with_work_limit(limit)) {
            assert_eq!(stopped, Some(Stop::WorkLimit), "{name} under {limit} of {all}");
            assert!(work <= limit + AT_ONCE, "{name}: {work} under {limit} of {all}");
        }
    }
    Some(all)
}

/// Analyses both sides, predicts, and plans a path to the best pose.
fn check_pair(name: &str, mesh: &Triangles, points: &[[f32; 3]]) {
    let Ok(mesh) = Mesh::new(&mesh.0, &mesh.1) else { return };
    let cloud = Cloud::new(points, None).unwrap();
    for params in profiles() {
        let limits = Limits { points: points.len(), ..Object::limits(&mesh, &params) };
        let (mut a, mut b) = (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
        let needed = check(&format!("object, {name}"), |monitor| {
            let object = Object::analyze(&mesh, &params, &mut a, monitor).ok()?;
            Some((sum(object.work()), object.stopped()))
        });
        let most = most_for_object(&params);
        assert!(needed.is_none_or(|needed| needed <= most), "object, {name}: {needed:?} of {most}");
        let needed = check(&format!("supporter, {name}"), |monitor| {
            let supporter = Supporter::analyze(&cloud, &params, &mut b, monitor).ok()?;
            Some((sum(supporter.work()), supporter.stopped()))
        });
        let most = most_for_supporter(&params, points.len());
        assert!(needed.is_none_or(|needed| needed <= most), "supporter, {name}: {needed:?} of {most}");

        let unlimited = Monitor::new();
        let Ok(object) = Object::analyze(&mesh, &params, &mut a, &unlimited) else { continue };
        let Ok(supporter) = Supporter::analyze(&cloud, &params, &mut b, &unlimited) else { continue };
        let mut memory = vec![0; predict_bytes(&limits)];
        let mut poses = [HangingPose::default(); 10];
        let mut found = 0;
        check(&format!("predict, {name}"), |monitor| {
            let predicted =
                predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, monitor)
                    .unwrap();
            found = predicted.poses.len();
            Some((sum(predicted.work), predicted.stopped))
        });
        let predicted =
            predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &unlimited)
                .unwrap();
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
            Some((sum(plan.work), plan.stopped()))
        });
    }
}

fn ordinary() -> (Triangles, Vec<[f32; 3]>) {
    let case = made(22, 61).into_iter().find(|case| case.object_kind == "mug").unwrap();
    let mug = refine(weld(&case.object.vertices, &case.object.triangles), TRIANGLES);
    (mug, scatter(&case.supporter.vertices, &case.supporter.triangles, POINTS).0)
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

/// A start so far away that no pose on the way is near anything.
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
}
