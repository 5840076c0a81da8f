//! Paths to poses: `predict --plan` and `plan`.

use super::*;

/// The pose with rank 1 of the ring on the peg, and a file with the prediction.
fn predicted(scene: &Scene, options: &[&str]) -> (Value, PathBuf) {
    let document = scene.predict(options);
    let file = scene.write("prediction.json", document.to_string());
    (document["poses"][0].clone(), file)
}

/// Runs `plan` of the ring on the peg to the pose in a file.
fn plan(scene: &Scene, pose: &Path, options: &[&str]) -> Run {
    let mut command = command();
    command.args(["plan", "--json", "-", "--object"]).arg(&scene.ring);
    finish(command.arg("--supporter").arg(&scene.peg).arg("--pose").arg(pose).args(options))
}

/// Runs `predict` of the ring on the peg, whatever comes out.
fn predict(scene: &Scene, options: &[&str]) -> Run {
    let mut command = command();
    command.args(["predict", "--json", "-", "--object"]).arg(&scene.ring);
    finish(command.arg("--supporter").arg(&scene.peg).args(options))
}

/// Position and quaternion of the rest pose of an entry.
fn rest_position(pose: &Value) -> [f64; 3] {
    let rest = numbers::<16>(&pose["rest_pose"]);
    [rest[3], rest[7], rest[11]]
}

/// Position of a waypoint.
fn at(path: &Value, index: usize) -> [f64; 3] {
    numbers(&path["waypoints"][index]["position"])
}

fn len(list: &Value) -> usize {
    list.as_array().unwrap().len()
}

/// Asserts that a path leads over the release pose to just before the rest pose, in small steps and forwards in time.
#[track_caller]
fn assert_leads_to(path: &Value, pose: &Value) {
    let (count, release) = (len(&path["waypoints"]), path["release"].as_u64().unwrap() as usize);
    assert!(release < count && number(&path["clearance"]) > 0.0, "{path}");
    assert!(distance(at(path, release), numbers(&pose["position"])) < 1e-5);
    let left = distance(at(path, count - 1), rest_position(pose));
    assert!((0.0001..0.0006).contains(&left), "{left}");
    for waypoints in path["waypoints"].as_array().unwrap().windows(2) {
        let [a, b] = [&waypoints[0], &waypoints[1]];
        assert!(number(&a["seconds"]) < number(&b["seconds"]));
        let norm = numbers::<4>(&b["quaternion_xyzw"]).iter().map(|x| x * x).sum::<f64>();
        assert!((norm - 1.0).abs() < 1e-5);
        // At most 1 cm for the centre of mass, and 0.1 rad, for an object of 15 cm.
        assert!(distance(numbers(&a["position"]), numbers(&b["position"])) < 0.03, "{a} {b}");
    }
}

const GRIPPER: &str = "retreat = [0, 0, -0.2]
[[part]]
from = [0, 0.014, -0.11]
to = [0, 0.014, -0.16]
radius = 0.008
opening = [0, 0.01, 0]
[[part]]
from = [0, -0.014, -0.11]
to = [0, -0.014, -0.16]
radius = 0.008
opening = [0, -0.01, 0]
";

#[test]
fn the_best_pose_that_can_be_reached_has_a_path() {
    let scene = Scene::new();
    let without = scene.predict(&[]);
    let file = scene.path("path.csv");
    let run = predict(&scene, &["--plan", "--path", file.to_str().unwrap()]);
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let document = run.json();
    let poses = document["poses"].as_array().unwrap();
    assert_eq!(poses.len(), len(&without["poses"]));
    let best = poses.iter().position(|pose| pose["path"].is_object()).expect("one can be reached");
    assert_leads_to(&poses[best]["path"], &poses[best]);
    assert_eq!(len(&poses[best]["path"]["gripper"]), 0);
    for (index, (pose, same)) in poses.iter().zip(without["poses"].as_array().unwrap()).enumerate() {
        let mut keys: Vec<&str> = pose.as_object().unwrap().keys().map(String::as_str).collect();
        keys.retain(|key| key.starts_with("path"));
        let expected: &[&str] = match index {
            _ if index < best => &["path", "path_failure"],
            _ if index == best => &["path"],
            _ => &[],
        };
        assert_eq!(keys, expected, "pose {index}");
        assert_eq!(pose["position"], same["position"], "planning changes no pose");
        assert!(same.get("path").is_none());
    }
    assert_csv_has(&std::fs::read_to_string(file).unwrap(), &poses[best]["path"]);

    let table = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--plan").stdout;
    let line = table.lines().find(|line| line.contains("can be reached: a path of ")).unwrap();
    assert!(line.starts_with(&format!("{:4}  ", best + 1)) && line.contains(" mm"), "{line}");
}

/// Asserts that the CSV has the waypoints of the object.
#[track_caller]
fn assert_csv_has(text: &str, path: &Value) {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("seconds,x,y,z,qx,qy,qz,qw"));
    for (line, waypoint) in lines.by_ref().zip(path["waypoints"].as_array().unwrap()) {
        let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let mut expected = vec![number(&waypoint["seconds"])];
        expected.extend(numbers::<3>(&waypoint["position"]));
        expected.extend(numbers::<4>(&waypoint["quaternion_xyzw"]));
        assert!(row.len() == 8 && row.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{line}");
    }
    assert_eq!(text.lines().count(), 1 + len(&path["waypoints"]));
}

#[test]
fn poses_out_of_the_workspace_say_so() {
    let scene = Scene::new();
    let run = predict(&scene, &["--plan", "--workspace", "1,1,1,2,2,2"]);
    assert_eq!(run.status, Some(3), "{}", run.stderr);
    for pose in run.json()["poses"].as_array().unwrap() {
        assert!(pose["path"].is_null() && pose.get("path").is_some());
        assert_eq!(pose["path_failure"]["reason"], "goal_outside_workspace");
        assert!(pose["path_failure"]["message"].as_str().unwrap().contains("outside of the workspace"));
    }
    let options = ["--plan", "--workspace", "1,1,1,2,2,2", "--path"];
    let file = scene.path("none.csv");
    let mut command = command();
    command.args(["predict", "--object"]).arg(&scene.ring).arg("--supporter").arg(&scene.peg);
    let run = finish(command.args(options).arg(&file));
    assert_eq!(run.status, Some(3));
    assert!(run.stdout.contains("1  has no path: the hanging pose is outside of the workspace"));
    assert!(run.stderr.contains("no file was written") && !file.exists(), "{}", run.stderr);
}

#[test]
fn a_pose_of_ones_own_has_a_path() {
    let scene = Scene::new();
    let (best, file) = predicted(&scene, &["--top", "2"]);
    let run = plan(&scene, &file, &[]);
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let document = run.json();
    assert_leads_to(&document["path"], &best);
    assert!(document.get("path_failure").is_none() && document["schema"] == 2);
    for stage in ["read", "object", "supporter", "planning", "total"] {
        assert!(number(&document["stats"]["seconds"][stage]) >= 0.0, "{stage}");
    }
    assert!(number(&document["stats"]["memory_bytes"]["plan"]) > 10_000.0);

    // Position and quaternion alone: the path ends at the release pose.
    let (position, quaternion) = (&best["position"], &best["quaternion_xyzw"]);
    let own =
        scene.write("own.json", format!("{{\"position\": {position}, \"quaternion_xyzw\": {quaternion}}}"));
    let path = &plan(&scene, &own, &[]).json()["path"];
    let last = at(path, len(&path["waypoints"]) - 1);
    assert!(distance(last, numbers(position)) < 1e-5);

    let start = scene.write("start.json", r#"{"position": [0, 0.3, 0.1], "quaternion_xyzw": [0, 0, 0, 1]}"#);
    let start = ["--start", start.to_str().unwrap()];
    let path = &plan(&scene, &file, &start).json()["path"];
    assert!(distance(at(path, 0), [0.0, 0.3, 0.1]) < 1e-6);
    assert_leads_to(path, &best);
    let back = &plan(&scene, &file, &[start[0], start[1], "--take-off"]).json()["path"];
    assert!(distance(at(back, 0), at(path, len(&path["waypoints"]) - 1)) < 1e-6);
    assert!(distance(at(back, len(&back["waypoints"]) - 1), [0.0, 0.3, 0.1]) < 1e-6);
}

#[test]
fn the_gripper_leaves() {
    let scene = Scene::new();
    let (best, file) = predicted(&scene, &["--top", "1"]);
    let gripper = scene.write("gripper.toml", GRIPPER);
    let run = plan(&scene, &file, &["--gripper", gripper.to_str().unwrap()]);
    assert_eq!(run.status, Some(0), "{}{}", run.stdout, run.stderr);
    let path = &run.json()["path"];
    assert_leads_to(path, &best);
    let hand = path["gripper"].as_array().unwrap();
    let (first, last) = (&hand[0], hand.last().unwrap());
    let end = &path["waypoints"][len(&path["waypoints"]) - 1];
    assert!(distance(numbers(&first["position"]), numbers(&end["position"])) < 1e-6);
    let left = distance(numbers(&last["position"]), numbers(&first["position"]));
    assert!((left - 0.2).abs() < 1e-4, "the retreat is free: {left}");
    assert!(number(&first["seconds"]) >= number(&end["seconds"]));
}

#[test]
fn collisions_say_where_and_with_what() {
    let scene = Scene::new();
    // The ring around the middle of the peg, so that the wire is in it.
    let inside = r#"{"position": [0, 0, -0.03], "quaternion_xyzw": [0, 0, 0, 1]}"#;
    let (_, file) = predicted(&scene, &["--top", "1"]);
    let inside = scene.write("inside.json", inside);
    let run = plan(&scene, &inside, &[]);
    assert_eq!(run.status, Some(3), "{}", run.stderr);
    let document = run.json();
    let failure = &document["path_failure"];
    assert!(document["path"].is_null());
    assert_eq!((&failure["reason"], &failure["mover"]), (&"goal_in_collision".into(), &"object".into()));
    assert_eq!(failure["obstacle"], "supporter");
    assert!(number(&failure["distance"]) < 0.0001 && numbers::<3>(&failure["at"])[1].abs() < 0.02);
    let run = plan(&scene, &file, &["--start", inside.to_str().unwrap()]);
    assert_eq!(run.json()["path_failure"]["reason"], "start_in_collision");
}

#[test]
fn a_map_frame_gets_its_path_back() {
    let scene = Scene::new();
    let offset = [500_000.0, 5_400_000.0, 300.0];
    let points = shapes::peg().into_iter().map(|[x, y, z, a, b, c]| {
        let [x, y, z] = [x, y, z].map(|x| (x * 8192.0).round() / 8192.0);
        [x + offset[0], y + offset[1], z + offset[2], a, b, c]
    });
    let far = scene.write("far.xyz", shapes::xyz(&points.collect::<Vec<_>>()));
    let [x, y, z] = [0, 1, 2].map(|i| offset[i] + [0.0, 0.3, 0.1][i]);
    let start = scene
        .write("start.json", format!("{{\"position\": [{x}, {y}, {z}], \"quaternion_xyzw\": [0, 0, 0, 1]}}"));
    let [low, high] = [-1.0, 1.0].map(|by| offset.map(|x| (x + by).to_string()).join(","));
    let (workspace, csv) = (format!("{low},{high}"), scene.path("path.csv"));
    let options = ["--plan", "--workspace", &workspace, "--start", start.to_str().unwrap(), "--path"];
    let document = scene.predict_with(&scene.ring, &far, &[&options[..], &[csv.to_str().unwrap()]].concat());
    let poses = document["poses"].as_array().unwrap();
    let pose = poses.iter().find(|pose| pose["path"].is_object()).unwrap();
    assert!(distance(at(&pose["path"], 0), [x, y, z]) < 1e-3);
    let last = at(&pose["path"], len(&pose["path"]["waypoints"]) - 1);
    assert!(distance(last, rest_position(pose)) < 1e-3);
    assert_csv_has(&std::fs::read_to_string(csv).unwrap(), &pose["path"]);

    // The same pose from the file of the prediction, and a collision.
    let file = scene.write("far.json", document.to_string());
    let rank = pose["rank"].to_string();
    let mut command = command();
    command.args(["plan", "--json", "-", "--object"]).arg(&scene.ring).arg("--supporter").arg(&far);
    let run = finish(command.arg("--pose").arg(file).args(["--rank", &rank]));
    let path = &run.json()["path"];
    assert!(distance(at(path, len(&path["waypoints"]) - 1), rest_position(pose)) < 1e-3, "{}", run.stdout);
    let [x, y, z] = [offset[0], offset[1], offset[2] - 0.03];
    let inside = format!("{{\"position\": [{x}, {y}, {z}], \"quaternion_xyzw\": [0, 0, 0, 1]}}");
    let inside = scene.write("inside.json", inside);
    let run = run!("plan", "--json", "-", "--object", scene.ring, "--supporter", far, "--pose", inside);
    let failure = &run.json()["path_failure"];
    assert_eq!(failure["reason"], "goal_in_collision");
    assert!(distance(numbers(&failure["at"]), offset) < 0.1, "{failure}");
    assert!(
        failure["message"].as_str().unwrap().contains("(499")
            || failure["message"].as_str().unwrap().contains("(500"),
        "{failure}"
    );
}

#[test]
fn broken_input_is_named_with_the_remedy() {
    let scene = Scene::new();
    let (_, file) = predicted(&scene, &["--top", "1"]);
    let bad = |name: &str, text: &str| scene.write(name, text);
    let no_quaternion = bad("half.json", r#"{"position": [0, 0, 0]}"#);
    let no_rotation = bad("zero.json", r#"{"position": [0, 0, 0], "quaternion_xyzw": [0, 0, 0, 0]}"#);
    let text = bad("text.json", "here");
    let empty = bad("empty.json", r#"{"poses": []}"#);
    let skewed = format!(
        r#"{{"position": [0, 0, 0], "quaternion_xyzw": [0, 0, 0, 1], "rest_pose": [{}1]}}"#,
        "1,".repeat(15)
    );
    let skewed = bad("skewed.json", &skewed);
    for (pose, parts) in [
        (&no_quaternion, ["half.json", "quaternion_xyzw"]),
        (&no_rotation, ["zero.json", "not of unit length"]),
        (&text, ["text.json", "is no JSON"]),
        (&empty, ["empty.json", "has no pose"]),
        (&skewed, ["skewed.json", "rest_pose"]),
        (&scene.path("none.json"), ["none.json", "cannot be read"]),
    ] {
        let run = plan(&scene, pose, &[]);
        assert_eq!((run.status, run.stdout.as_str()), (Some(1), ""), "{}", run.stderr);
        assert!(parts.iter().all(|part| run.stderr.contains(part)), "{}", run.stderr);
    }
    let rank = plan(&scene, &file, &["--rank", "2"]);
    assert!(rank.status == Some(1) && rank.stderr.contains("--rank 1 to 1"), "{}", rank.stderr);

    let unknown = bad("unknown.toml", &GRIPPER.replace("radius", "radios"));
    let nothing = bad("nothing.toml", "");
    let negative = bad("negative.toml", &GRIPPER.replace("0.008", "-1"));
    for (gripper, parts) in [
        (&unknown, ["unknown.toml", "unknown field `radios`"]),
        (&nothing, ["nothing.toml", "no parts"]),
        (&negative, ["negative.toml", "radius"]),
        (&scene.path("none.toml"), ["none.toml", "cannot be read"]),
    ] {
        let run = plan(&scene, &file, &["--gripper", gripper.to_str().unwrap()]);
        assert_eq!((run.status, run.stdout.as_str()), (Some(1), ""), "{}", run.stderr);
        assert!(parts.iter().all(|part| run.stderr.contains(part)), "{}", run.stderr);
    }
    for (option, value, remedy) in [
        ("--workspace", "0,0,0", "6 comma-separated numbers"),
        ("--workspace", "0,0,1,1,1,0", "lower corner of the box first"),
        ("--plan-clearance", "0", "more than 0 and at most 0.1 metres"),
        ("--plan-samples", "0", "1..="),
    ] {
        let run = plan(&scene, &file, &[option, value]);
        assert_eq!(run.status, Some(2), "{option} {value}");
        assert!(run.stderr.contains(option) && run.stderr.contains(remedy), "{}", run.stderr);
    }
}

#[test]
fn options_of_planning_need_plan() {
    let scene = Scene::new();
    for options in [&["--take-off"][..], &["--workspace", "0,0,0,1,1,1"], &["--path", "path.csv"]] {
        let run = predict(&scene, options);
        assert_eq!(run.status, Some(2), "{}", run.stderr);
        assert!(run.stderr.contains(options[0]) && run.stderr.contains("--plan"), "{}", run.stderr);
    }
    assert_eq!(predict(&scene, &["--plan", "--count", "2"]).status, Some(2));
    let paper = predict(&scene, &["--plan", "--profile", "paper"]);
    assert!(paper.status == Some(1) && paper.stderr.contains("--plan: without a distance field"));
    assert_eq!(run!("plan", "--object", scene.ring, "--supporter", scene.peg).status, Some(2));
}
