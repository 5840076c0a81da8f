//! Bad input gives exit status 1, one error that names file, item and remedy, and nothing on standard output.

use super::*;

const TRIANGLE: &str = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\n";

/// Asserts that `run` failed with an error message that contains all of `parts`.
#[track_caller]
fn assert_error(run: &Run, parts: &[&str]) {
    assert_eq!((run.status, run.stdout.as_str()), (Some(1), ""), "{}", run.stderr);
    let error = run.stderr.lines().find(|line| line.starts_with("error: ")).unwrap_or("");
    assert!(parts.iter().all(|part| error.contains(part)), "{parts:?} in {}", run.stderr);
    assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
}

#[test]
fn of_an_object() {
    let scene = Scene::new();
    let half = shapes::obj(&shapes::ball());
    let faces = |list: &str| format!("{TRIANGLE}{list}");
    for (name, content, parts) in [
        ("empty.obj", String::new(), ["the file is empty", "export or copy it again"]),
        ("mug.step", "ISO-10303".into(), ["\".step\" is not a supported format", "obj, stl, ply"]),
        ("mug", half.clone(), ["no extension", "rename the file"]),
        ("lines.obj", "# nothing\n".into(), ["no triangles", "check that the exporter"]),
        ("points.obj", TRIANGLE.into(), ["is a point cloud", "reconstruct its surface"]),
        ("nan.obj", format!("v 0 nan 0\n{}", faces("f 1 2 3\n")), ["vertex 0", "not finite"]),
        ("infinite.obj", format!("{}v 0 0 inf\nf 1 2 4\n", TRIANGLE), ["vertex 3", "check the exporter"]),
        ("index.obj", faces("f 1 2 3\nf 1 2 9\n"), ["uses vertex 9", "export it again"]),
        ("flat.obj", faces("f 1 2 2\nf 1 1 1\n"), ["none of its 2 faces", "check the scale"]),
        ("far.obj", format!("v 1e30 0 0\n{}", faces("f 1 2 4\n")), ["vertex 0", "within"]),
        ("words.obj", "v one two three\n".into(), ["line 1", "re-export"]),
        ("words.stl", "no mesh at all\n".into(), ["the file", "export"]),
    ] {
        let path = scene.write(name, content);
        let parts = [name, parts[0], parts[1]];
        assert_error(&run!("predict", "--object", path, "--supporter", scene.peg), &parts);
        assert_error(&run!("inspect", path, "--as", "object"), &parts);
    }
    for (path, part) in [(scene.path("none.obj"), "no such file"), (scene.folder.path().into(), "directory")]
    {
        let parts = [path.to_str().unwrap(), part];
        assert_error(&run!("predict", "--object", path, "--supporter", scene.peg), &parts);
        assert_error(&run!("inspect", path), &parts);
    }
}

#[test]
fn of_a_supporter() {
    let scene = Scene::new();
    let header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (name, content, parts) in [
        ("empty.xyz", String::new(), ["the file is empty", "again"]),
        ("none.xyz", "# x y z\n".into(), ["no points", "check that the camera"]),
        ("nan.xyz", "0 0 0\n0 0 nan\n".into(), ["not finite", "point 1"]),
        ("infinite.xyz", "0 0 0 0 0 1\n0 0 0 0 inf 1\n".into(), ["normal of point 1", "not finite"]),
        ("far.xyz", "0 0 0\n0 0 1e30\n".into(), ["point 1", "drop the points"]),
        ("cut.ply", format!("{header}0 0 0\n"), ["cut off", "again"]),
        ("words.xyz", "zero zero zero\n".into(), ["line 1", "write x y z"]),
        ("cloud.las", "LASF".into(), ["\".las\" is not a supported format", "pcd"]),
    ] {
        let path = scene.write(name, content);
        let parts = [name, parts[0], parts[1]];
        assert_error(&run!("predict", "--object", scene.ring, "--supporter", path), &parts);
        assert_error(&run!("inspect", path, "--as", "supporter"), &parts);
    }
}

#[test]
fn of_a_binary_file_that_is_cut_off() {
    let scene = Scene::new();
    let mut bytes = std::fs::read(sample("mug_tree.ply")).unwrap();
    bytes.truncate(bytes.len() / 2);
    let path = scene.write("half.ply", bytes);
    assert_error(
        &run!("predict", "--object", scene.ring, "--supporter", path),
        &["half.ply", "cut off", "copy"],
    );
}

#[test]
fn beyond_the_limits() {
    let scene = Scene::new();
    let cloud = scene.write("huge.xyz", "0 0 0\n".repeat(1_000_003));
    let parts = ["huge.xyz", "1000003 points are 3 more than the limit of 1000000", "downsample the cloud"];
    assert_error(&run!("predict", "--object", scene.ring, "--supporter", cloud), &parts);
    let mesh = scene.write("huge.obj", format!("{TRIANGLE}{}", "f 1 2 3\n".repeat(2_000_005)));
    let parts = ["huge.obj", "2000005 triangles are 5 more than the limit of 2000000", "decimate the mesh"];
    assert_error(&run!("inspect", mesh), &parts);
}

#[test]
fn of_constants() {
    let scene = Scene::new();
    for (name, content, parts) in [
        ("key.toml", "samples = 500\nradius_ration = 1\n", ["line 2", "radius_ration"]),
        ("value.toml", "radius_ratio = 7\n", ["radius_ratio = 7", "0 to 1"]),
        ("type.toml", "samples = \"many\"\n", ["line 1", "samples"]),
        ("syntax.toml", "samples 500\n", ["line 1", "TOML"]),
        ("gravity.toml", "gravity = [0, 0, 0]\n", ["gravity", "no direction"]),
    ] {
        let path = scene.write(name, content);
        for run in [
            run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--params", path),
            run!("inspect", scene.ring, "--params", path),
        ] {
            assert_eq!((run.status, run.stdout.as_str()), (Some(1), ""), "{}", run.stderr);
            // The message of the TOML parser continues on the lines below.
            assert!(
                [name, parts[0], parts[1]].iter().all(|part| run.stderr.contains(part)),
                "{}",
                run.stderr
            );
        }
    }
    let missing = scene.path("none.toml");
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--params", missing);
    assert_error(&run, &["none.toml", "cannot be read", "TOML"]);
}

#[test]
fn of_points_that_are_too_far_to_be_points() {
    let scene = Scene::new();
    let with =
        |option: &str| run!("predict", "--object", scene.ring, "--supporter", scene.peg, option, "1e9,0,0");
    assert_error(&with("--com"), &["--com", "not a point in metres"]);
    assert_error(&with("--viewpoint"), &["--viewpoint", "not a point in metres"]);
    let run = run!("inspect", scene.ring, "--scale", "1e-30");
    assert_error(&run, &["ring.obj", "degenerate"]);
}

#[test]
fn the_first_error_is_always_the_same() {
    let scene = Scene::new();
    let nowhere = scene.path("none/out.json");
    let (object, supporter) = (scene.path("no.obj"), scene.path("no.xyz"));
    let params = scene.path("no.toml");
    let predict =
        ["predict", "--object", object.to_str().unwrap(), "--supporter", supporter.to_str().unwrap()];
    for (options, name) in [
        (vec!["--json", nowhere.to_str().unwrap(), "--params", params.to_str().unwrap()], "no.toml"),
        (vec!["--json", nowhere.to_str().unwrap()], "out.json"),
        (vec![], "no.obj"),
    ] {
        assert_error(&finish(command().args(predict).args(options)), &[name]);
    }
}
