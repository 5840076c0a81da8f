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
