//! Units and axes of the files do not change the poses.

use super::*;

/// Rotates a point from the frame with z up to a frame with another up axis, by the smallest angle.
type Turn = fn([f64; 3]) -> [f64; 3];

const TURNED: [(&str, Turn); 7] = [
    ("z", |p| p),
    ("x", |[x, y, z]| [z, y, -x]),
    ("y", |[x, y, z]| [x, z, -y]),
    ("+y", |[x, y, z]| [x, z, -y]),
    ("-x", |[x, y, z]| [-z, y, x]),
    ("-y", |[x, y, z]| [x, -z, y]),
    ("-z", |[x, y, z]| [x, -y, -z]),
];

#[test]
fn turned_files_give_the_same_poses() {
    let scene = Scene::new();
    let upright = timeless(scene.predict(&[]));
    let (vertices, triangles) = shapes::weighted_ring();
    for (axis, turn) in TURNED {
        let turned = (vertices.iter().map(|&p| turn(p)).collect(), triangles.clone());
        let object = scene.write("turned.obj", shapes::obj(&turned));
        assert_eq!(
            upright,
            timeless(scene.predict_with(&object, &scene.peg, &["--object-up", axis])),
            "{axis}"
        );

        let points = shapes::peg().into_iter().map(|[x, y, z, a, b, c]| {
            let ([x, y, z], [a, b, c]) = (turn([x, y, z]), turn([a, b, c]));
            [x, y, z, a, b, c]
        });
        let supporter = scene.write("turned.xyz", shapes::xyz(&points.collect::<Vec<_>>()));
        let turned = scene.predict_with(&scene.ring, &supporter, &["--supporter-up", axis]);
        assert_eq!(upright, timeless(turned), "{axis}");

        let seen = run!("inspect", object, "--up", axis, "--json").json();
        assert!(seen["extents"][2] == run!("inspect", scene.ring, "--json").json()["extents"][2], "{axis}");
    }
}

#[test]
fn millimetres_give_the_same_poses() {
    let scene = Scene::new();
    let (mut vertices, triangles) = shapes::weighted_ring();
    vertices.iter_mut().flatten().for_each(|x| *x *= 1000.0);
    let object = scene.write("mm.obj", shapes::obj(&(vertices, triangles)));
    let points = shapes::peg().into_iter().map(|[x, y, z, a, b, c]| [1e3 * x, 1e3 * y, 1e3 * z, a, b, c]);
    let supporter = scene.write("mm.xyz", shapes::xyz(&points.collect::<Vec<_>>()));

    let metres = scene.predict(&[&PAPER[..], &["--top", "1"]].concat())["poses"][0].clone();
    let options =
        ["--profile", "paper", "--top", "1", "--object-scale", "0.001", "--supporter-scale", "0.001"];
    let millimetres = scene.predict_with(&object, &supporter, &options)["poses"][0].clone();
    // The last bit of a coordinate may differ, and with it the choice among equal candidates. The site must be the
    // same.
    for site in ["object_site", "supporter_site"] {
        let [a, b] = [&metres, &millimetres].map(|pose| numbers(&pose[site]["position"]));
        assert!(distance(a, b) < 0.002, "{site}: {a:?}, {b:?}");
    }
    assert!((number(&metres["cost"]["total"]) - number(&millimetres["cost"]["total"])).abs() < 0.02);

    let in_millimetres = scene.predict_with(&object, &supporter, &options[2..]);
    shapes::assert_hangs_by_the_ring(&in_millimetres["poses"][0]);

    // A scale by a power of two is exact.
    let (mut vertices, triangles) = shapes::weighted_ring();
    vertices.iter_mut().flatten().for_each(|x| *x *= 1024.0);
    let object = scene.write("binary.obj", shapes::obj(&(vertices, triangles)));
    let scaled = scene.predict_with(&object, &scene.peg, &["--object-scale", "0.0009765625"]);
    assert_eq!(timeless(scene.predict(&[])), timeless(scaled));
}

#[test]
fn a_map_frame_gets_its_poses_back() {
    let scene = Scene::new();
    let offset = [500_000.0, 5_400_000.0, 300.0];
    let points = shapes::peg().into_iter().map(|[x, y, z, a, b, c]| {
        // To 1/8192 m, so that the sums are exact.
        let [x, y, z] = [x, y, z].map(|x| (x * 8192.0).round() / 8192.0);
        [x, y, z, a, b, c]
    });
    let points: Vec<_> = points.collect();
    let near = scene.write("near.xyz", shapes::xyz(&points));
    let moved =
        points.iter().map(|[x, y, z, a, b, c]| [x + offset[0], y + offset[1], z + offset[2], *a, *b, *c]);
    let far = scene.write("far.xyz", shapes::xyz(&moved.collect::<Vec<_>>()));
    let [near, far] =
        [near, far].map(|file| scene.predict_with(&scene.ring, &file, &["--top", "1"])["poses"][0].clone());
    shapes::assert_hangs_by_the_ring(&near);
    for (i, offset) in offset.into_iter().enumerate() {
        // The two clouds begin at different offsets, so that their last bits differ, and the poses by a little: more along the peg, where
        // the ring may rest anywhere.
        let tolerance = if i == 0 { 0.006 } else { 0.002 };
        for (name, at) in [("position", i), ("pose", 4 * i + 3), ("rest_pose", 4 * i + 3)] {
            let [near, far] = [&near, &far].map(|pose| number(&pose[name][at]));
            assert!((far - offset - near).abs() < tolerance, "{name}: {near} and {far}");
        }
        let [near, far] = [&near, &far].map(|pose| number(&pose["contacts"][0]["position"][i]));
        assert!((far - offset - near).abs() < tolerance, "{near} and {far}");
    }
}

#[test]
fn a_region_limits_where_it_hangs() {
    let scene = Scene::new();
    for region in [["-0.05,-1,-1,-0.02,1,1", "left"], ["0.02,-1,-1,0.05,1,1", "right"]] {
        let document = scene.predict(&["--region", region[0], "--top", "1"]);
        let x = number(&document["poses"][0]["position"][0]);
        assert_eq!(x > 0.0, region[1] == "right", "{x} with {region:?}");
    }
    let [run] =
        [run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--region", "5,5,5,6,6,6")];
    assert!(run.stderr.contains("--region: no point of the supporter is in the box"), "{}", run.stderr);
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--region", "1,0,0,0,1,1");
    assert!(run.stderr.contains("--region") && run.stderr.contains("lower corner first"), "{}", run.stderr);
}

#[test]
fn gravity_points_where_it_is_told() {
    let scene = Scene::new();
    // In the frame of a camera that looks ahead, y is down.
    let camera = shapes::peg().into_iter().map(|[x, y, z, a, b, c]| [x, -z, y, a, -c, b]);
    let camera = scene.write("camera.xyz", shapes::xyz(&camera.collect::<Vec<_>>()));
    let document = scene.predict_with(&scene.ring, &camera, &["--gravity", "0,1,0", "--top", "1"]);
    let pose = &document["poses"][0]["pose"];
    // The ring hangs by its hole at the top of its frame: its z axis points up, along -y.
    assert!(number(&pose[6]) < -0.9, "{pose}");
    let run = run!("predict", "--object", scene.ring, "--supporter", camera, "--gravity", "0,0,0");
    assert!(run.stderr.contains("--gravity"), "{}", run.stderr);
}
