//! The options that say how and where the object hangs, and what it must not touch.

use super::*;
use hangpose::{files, parry};
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion};
use parry3d::{math, query, shape::TriMesh};

/// Middle of the top of a peg of the mug tree, metres: of peg 1, which slopes up along x.
const ON_PEG: [f64; 3] = [0.05, 0.0, 0.16];

/// Runs `predict` of the sample mug on a sample supporter with further options, and the JSON on standard output.
fn hang_mug(supporter: &str, options: &[&str]) -> Run {
    let mut command = command();
    command.args(["predict", "--json", "-", "--object"]).arg(sample("mug.obj"));
    finish(command.arg("--supporter").arg(sample(supporter)).args(options))
}

/// Asserts that the object hangs, and returns the poses.
#[track_caller]
fn poses(run: &Run) -> Vec<Value> {
    assert_eq!(run.status, Some(0), "{}{}", run.stdout, run.stderr);
    let document = run.json();
    assert!(document["poses"].as_array().is_some_and(|poses| !poses.is_empty()));
    document["poses"].as_array().unwrap().clone()
}

/// Asserts that nothing hangs because of a wish, and that the counts agree.
#[track_caller]
fn assert_rejected(run: &Run, stage: &str) {
    assert_eq!(run.status, Some(3), "{}{}", run.stdout, run.stderr);
    let document = run.json();
    assert_eq!(document["rejection"]["stage"], stage, "{}", document["rejection"]);
    assert!(document["poses"].as_array().unwrap().is_empty());
}

/// Number of candidates or poses that were dropped for a wish.
fn dropped(run: &Run, wish: &str) -> u64 {
    run.json()["stats"]["counts"]["settling"][wish].as_u64().unwrap()
}

/// Places of the contacts of a pose, metres.
fn contacts(pose: &Value) -> Vec<[f64; 3]> {
    pose["contacts"].as_array().unwrap().iter().map(|contact| numbers(&contact["position"])).collect()
}

/// Runs `predict` of the ring on the peg, whose messages are compared.
fn hang_ring(scene: &Scene, options: &[&str]) -> Run {
    let mut command = command();
    command.args(["predict", "--json", "-", "--object"]).arg(&scene.ring);
    finish(command.arg("--supporter").arg(&scene.peg).args(options))
}

#[test]
fn poses_say_how_they_hang_and_how_far_they_may_be_off() {
    for pose in poses(&hang_mug("hook.ply", &["--top", "3"])) {
        assert!(["threaded", "hooked", "capped", "balanced"].iter().any(|kind| pose["kind"] == *kind));
        let tolerance = &pose["tolerance"];
        let [position, rotation] = ["position", "rotation"].map(|name| number(&tolerance[name]));
        assert!(position > 0.0 && position <= number(&pose["clearance"]) + 1e-6, "{tolerance}");
        assert!(rotation > 0.0 && rotation < 0.5, "{tolerance}");
    }
    let paper = Scene::new().predict(&PAPER);
    assert!(paper["poses"][0]["kind"].is_null() && paper["poses"][0]["tolerance"].is_null());
}

#[test]
fn contacts_are_where_they_were_asked_for() {
    let here = "0.05,0,0.16,0.03";
    for pose in poses(&hang_mug("mug_tree.obj", &["--here", here, "--top", "3"])) {
        // At least half of the weight rests there, and the mug touches one peg only.
        assert!(contacts(&pose).iter().any(|place| distance(*place, ON_PEG) < 0.031), "{pose}");
    }
    let in_the_air = hang_mug("mug_tree.obj", &["--here=-0.3,-0.3,0.5"]);
    assert_rejected(&in_the_air, "outside_region");
    assert!(dropped(&in_the_air, "outside") > 0);
}

#[test]
fn the_object_hangs_by_the_part_that_was_asked_for() {
    // By the handle, around x = 0.06; the cup ends at x = 0.041.
    for options in [["--by", "0.06,0,0.05,0.035"], ["--by-box", "0.042,-0.02,0,0.08,0.02,0.1"]] {
        for pose in poses(&hang_mug("hook.ply", &[options[0], options[1], "--top", "2"])) {
            let rest = numbers::<16>(&pose["rest_pose"]);
            let in_object = contacts(&pose).into_iter().map(|place| {
                let offset: [f64; 3] = core::array::from_fn(|i| place[i] - rest[4 * i + 3]);
                (0..3).map(|i| rest[4 * i] * offset[i]).sum::<f64>()
            });
            assert!(in_object.into_iter().any(|x| x > 0.03), "by the handle: {pose}");
        }
    }
}

#[test]
fn only_kinds_that_were_allowed_are_given() {
    let scene = Scene::new();
    let balanced = hang_ring(&scene, &["--allow", "balanced"]);
    match balanced.status {
        Some(3) => {
            assert_rejected(&balanced, "other_kind");
            assert!(dropped(&balanced, "other_kind") > 0);
        }
        _ => assert!(poses(&balanced).iter().all(|pose| pose["kind"] == "balanced")),
    }
    for pose in poses(&hang_ring(&scene, &["--allow", "threaded,hooked", "--prefer", "threaded"])) {
        assert!(pose["kind"] == "threaded" || pose["kind"] == "hooked", "{}", pose["kind"]);
    }
}

/// Points of a level plane 4 mm apart, x and y up to 0.2 m.
fn floor(z: f64) -> String {
    let points = (0..101).flat_map(|i| (0..101).map(move |k| [0.004 * f64::from(i), 0.004 * f64::from(k)]));
    points.map(|[x, y]| format!("{} {} {z}\n", x - 0.2, y - 0.2)).collect()
}

#[test]
fn nothing_hangs_where_the_scene_is_in_the_way() {
    let scene = Scene::new();
    // The ring with its weight reaches 0.15 m below the peg.
    let (blocked, free) = (scene.write("near.xyz", floor(-0.08)), scene.write("far.xyz", floor(-0.25)));
    let blocked = hang_ring(&scene, &["--scene", blocked.to_str().unwrap()]);
    assert_rejected(&blocked, "in_scene");
    assert!(dropped(&blocked, "in_scene") > 0);
    poses(&hang_ring(&scene, &["--scene", free.to_str().unwrap()]));

    // As a mesh, in the units of the supporter.
    let plane = "v -200 -200 -80\nv 200 -200 -80\nv 200 200 -80\nv -200 200 -80\nf 1 2 3\nf 1 3 4\n";
    let plane = scene.write("plane.obj", plane);
    let points = shapes::peg().into_iter().map(|[x, y, z, a, b, c]| [1e3 * x, 1e3 * y, 1e3 * z, a, b, c]);
    let peg = scene.write("mm.xyz", shapes::xyz(&points.collect::<Vec<_>>()));
    let run = run!(
        "predict",
        "--object",
        scene.ring,
        "--supporter",
        peg,
        "--supporter-scale",
        "0.001",
        "--scene",
        plane,
        "--json",
        "-"
    );
    assert_rejected(&run, "in_scene");

    let missing = hang_ring(&scene, &["--scene", scene.path("none.xyz").to_str().unwrap()]);
    assert_eq!(missing.status, Some(1));
    assert!(missing.stderr.contains("none.xyz") && missing.stderr.contains("no such file"));
}

#[test]
fn the_scene_is_an_input_that_is_not_overwritten() {
    let scene = Scene::new();
    let near = scene.write("near.xyz", floor(-0.25));
    let run =
        run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--scene", near, "--json", near);
    assert_eq!(run.status, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("is also an input"), "{}", run.stderr);
    assert_eq!(std::fs::read_to_string(near).unwrap(), floor(-0.25));
}

#[test]
fn a_free_way_leads_to_each_pose() {
    // The plate of the hook is at x = 0, and its tip points along x.
    poses(&hang_mug("hook.ply", &["--approach", "-1,0,0", "--approach-angle", "40", "--top", "1"]));
    let options = ["--approach", "1,0,0", "--approach-angle", "10", "--approach-length", "0.2"];
    let through_the_wall = hang_mug("hook.ply", &options);
    assert_rejected(&through_the_wall, "no_approach");
    assert!(dropped(&through_the_wall, "no_approach") > 0);
}

#[test]
fn distinct_poses_are_fewer() {
    let scene = Scene::new();
    let count = |options: &[&str]| poses(&hang_ring(&scene, options)).len();
    let (many, few) = (count(&["--distinct", "0.005,5"]), count(&["--distinct", "1,180"]));
    assert!(few < many, "{few} of {many}");
}

#[test]
fn several_copies_hang_at_once() {
    let run = hang_mug("mug_tree.obj", &["--count", "3"]);
    let poses = poses(&run);
    let document = run.json();
    assert_eq!((document["count"].as_u64(), poses.len()), (Some(3), 3));
    let mug = files::read_mesh(&sample("mug.obj")).unwrap();
    let vertices = mug.vertices.iter().map(|vertex| math::Vector::from_array(*vertex)).collect();
    let mug = TriMesh::new(vertices, mug.triangles).unwrap();
    assert!(document["rejection"].is_null() && document["stats"]["counts"].is_null());
    for (index, pose) in poses.iter().enumerate() {
        assert_eq!(pose["rank"], index + 1, "the number of the copy");
        for other in &poses[..index] {
            assert_apart(&mug, pose, other);
        }
    }
    let table =
        run!("predict", "--object", sample("mug.obj"), "--supporter", sample("mug_tree.obj"), "--count", "3");
    assert_eq!((table.status, table.stdout.lines().count()), (Some(0), 4), "{}", table.stdout);
}

/// Asserts that two copies do not touch where they hang.
#[track_caller]
fn assert_apart(object: &TriMesh, one: &Value, other: &Value) {
    let [one, other] = [one, other].map(|pose| {
        let rows = numbers::<16>(&pose["rest_pose"]).map(|x| x as f32);
        let rotation = Matrix3::from_fn(|i, k| rows[4 * i + k]);
        let position = Translation3::new(rows[3], rows[7], rows[11]);
        parry::pose_to_parry(&Isometry3::from_parts(position, UnitQuaternion::from_matrix(&rotation)))
    });
    let gap = query::distance(&one, object, &other, object).unwrap().distance;
    assert!(gap > 1e-4, "the copies are {gap} m apart");
}

#[test]
fn copies_without_room_are_counted() {
    let scene = Scene::new();
    // The peg is 0.1 m long, and a ring is 8 mm thick.
    let run = hang_ring(&scene, &["--count", "32"]);
    let found = poses(&run).len();
    assert!((2..32).contains(&found), "{found}");
    assert!(!run.json()["rejection"]["stage"].is_null());
    let table = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--count", "32");
    assert_eq!((table.status, table.stdout.lines().count()), (Some(0), 33), "{}", table.stdout);
    assert_eq!(table.stdout.matches("no room beside the others").count(), 32 - found);
    let none = run!("predict", "--object", scene.ball, "--supporter", scene.peg, "--count", "2");
    assert_eq!(none.status, Some(3), "{}", none.stdout);
    assert!(none.stdout.contains("nothing hangs"), "{}", none.stdout);
}

#[test]
fn broken_values_are_named_with_the_remedy() {
    let scene = Scene::new();
    for (option, value, remedy) in [
        ("--here", "1,2", "x,y,z or x,y,z,radius in metres"),
        ("--here", "0,0,0,-0.1", "the radius is negative: use 0 or more metres"),
        ("--here", "0,0,0,nan", "x,y,z or x,y,z,radius in metres"),
        ("--by", "0,0,handle", "x,y,z or x,y,z,radius in metres"),
        ("--by-box", "0,0,0", "6 comma-separated numbers"),
        ("--allow", "glued", "threaded, hooked, capped, balanced"),
        ("--prefer", "best", "threaded, hooked, capped, balanced"),
        ("--approach", "0,0,0", "not all 0"),
        ("--approach", "down", "3 comma-separated numbers"),
        ("--approach-angle", "181", "0 to 180 degrees"),
        ("--approach-length", "-1", "0 to 10 metres"),
        ("--approach-length", "nan", "0 to 10 metres"),
        ("--distinct", "0.02", "as in 0.05,30"),
        ("--distinct", "-1,30", "0 to 10 metres and 0 to 180 degrees"),
        ("--count", "0", "1..=32"),
        ("--count", "33", "1..=32"),
    ] {
        let run = hang_ring(&scene, &[option, value]);
        assert_eq!((run.status, run.stdout.as_str()), (Some(2), ""), "{option} {value}: {}", run.stderr);
        assert!(
            run.stderr.contains(option) && run.stderr.contains(remedy),
            "{option} {value}: {}",
            run.stderr
        );
    }
    for (options, parts) in [
        (&["--here", "1e9,0,0"][..], ["--here", "no length in metres within"]),
        (&["--by-box", "0,0,1,1,1,0"], ["--by-box", "lower corner of a box first"]),
        (&["--approach", "1e-9,0,0"], ["--approach", "a direction that is not zero"]),
        (&["--profile", "paper", "--count", "2"], ["--count", "--profile default"]),
        (&["--profile", "paper", "--allow", "hooked"], ["--allow has no effect", "--profile default"]),
        (&["--profile", "paper", "--here", "0,0,0"], ["--here has no effect", "--profile default"]),
    ] {
        let run = hang_ring(&scene, options);
        assert_eq!((run.status, run.stdout.as_str()), (Some(1), ""), "{options:?}: {}", run.stderr);
        assert!(parts.iter().all(|part| run.stderr.contains(part)), "{options:?}: {}", run.stderr);
    }
    for options in [
        &["--approach-angle", "20"][..],
        &["--by", "0,0,0", "--by-box", "0,0,0,1,1,1"],
        &["--count", "2", "--top", "3"],
    ] {
        let run = hang_ring(&scene, options);
        assert_eq!(run.status, Some(2), "{options:?}: {}", run.stderr);
        assert!(run.stderr.contains("--"), "{}", run.stderr);
    }
}
