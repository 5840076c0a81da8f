//! Notes and warnings on standard error, and the treatment of unusual normals and sizes.

use super::shapes::without_normals;
use super::*;

/// Standard error of a prediction of the ring on `supporter`, which must succeed.
fn said(scene: &Scene, supporter: &Path, options: &[&str]) -> String {
    let mut command = command();
    command.args(["predict", "--top", "1", "--json", "-", "--object"]).arg(&scene.ring);
    let run = finish(command.arg("--supporter").arg(supporter).args(options));
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    shapes::assert_hangs_by_the_ring(&run.json()["poses"][0]);
    run.stderr
}

#[test]
fn clean_input_gives_no_messages() {
    let scene = Scene::new();
    assert_eq!(said(&scene, &scene.peg, &[]), "");
    let mesh = scene.write("peg.obj", shapes::obj(&shapes::peg_mesh()));
    assert_eq!(said(&scene, &mesh, &["--supporter-points", "4000"]), "");
}

#[test]
fn missing_normals_are_estimated() {
    let scene = Scene::new();
    let points = shapes::peg();
    let bare = scene.write("bare.xyz", shapes::xyz(&without_normals(&points)));
    let all = format!("note: {}: {n} of {n} normals were estimated", bare.display(), n = points.len());
    let text = said(&scene, &bare, &[]);
    assert!(text.starts_with(&all) && text.contains("pass --viewpoint"), "{text}");

    // The upper half, as a camera above sees it.
    let upper: Vec<_> = points.iter().copied().filter(|p| p[5] > -0.1).collect();
    let upper = scene.write("upper.xyz", shapes::xyz(&without_normals(&upper)));
    let text = said(&scene, &upper, &["--viewpoint", "0,0,1"]);
    assert!(text.contains("face the viewpoint") && text.lines().count() == 2, "{text}");
    assert!(text.contains("no camera saw the far side"), "{text}");

    // Seen from below, no normal points up, and the ring hangs on a top that is guessed.
    let predict = ["predict", "--viewpoint", "0,0,-1", "--json", "-", "--object"];
    let run = finish(command().args(predict).arg(&scene.ring).arg("--supporter").arg(&upper));
    assert!(run.stderr.contains("face the viewpoint"), "{}", run.stderr);
    assert_eq!(run.status, Some(0), "{}", run.stdout);
    let unseen = &run.json()["poses"][0]["unseen"];
    assert!(unseen["supporter"].as_f64() > Some(0.3), "{}", run.stdout);
    assert!(unseen["supporter_view"][2].as_f64() > Some(0.7), "a camera above would see it: {}", run.stdout);
}

#[test]
fn normals_that_point_inwards_or_at_random_are_mended() {
    let scene = Scene::new();
    let hangs = |cloud: &Path| {
        let run = run!("predict", "--object", scene.ring, "--supporter", cloud, "--json", "-");
        assert_eq!(run.status, Some(0), "{}", run.stderr);
        // The ring's wire of 4 mm lies on the peg of 4 mm radius: its centre is as far below as its inner radius allows.
        let z = run.json()["poses"][0]["rest_pose"][11].as_f64().unwrap();
        assert!((z + shapes::RING_RADIUS - shapes::WIRE_RADIUS - shapes::PEG_RADIUS).abs() < 0.002, "{z}");
        run.stderr
    };
    let reverse = |points: &mut [[f64; 6]], every: usize| {
        points.iter_mut().step_by(every).for_each(|p| p[3..].iter_mut().for_each(|x| *x = -*x));
    };
    let mut points = shapes::peg();
    reverse(&mut points, 1);
    let text = hangs(&scene.write("inward.xyz", shapes::xyz(&points)));
    assert!(text.contains("pointed into the solid, so all were reversed"), "{text}");

    let mut points = shapes::peg();
    reverse(&mut points, 2);
    let text = hangs(&scene.write("random.xyz", shapes::xyz(&points)));
    let part = format!("so {} of {} were reversed by the shape", points.len().div_ceil(2), points.len());
    assert!(text.contains(&part), "{part} in {text}");

    // All the same, which is no surface's.
    let mut points = shapes::peg();
    points.iter_mut().for_each(|p| p[3..].copy_from_slice(&[0.0, 0.0, 1.0]));
    let text = hangs(&scene.write("up.xyz", shapes::xyz(&points)));
    assert!(text.contains("not those of the surface"), "{text}");
    assert!(text.contains(&format!("{0} of {0} normals were estimated", points.len())), "{text}");
}

/// One point in so many is left of the peg's cloud.
#[test]
fn sparse_clouds_are_named() {
    let scene = Scene::new();
    let points: Vec<_> = shapes::peg().into_iter().step_by(400).collect();
    let cloud = scene.write("sparse.xyz", shapes::xyz(&points));
    let params = scene.write("sure.toml", "min_probability = 0.9");
    let run = run!("predict", "--object", scene.ring, "--supporter", cloud, "--params", params);
    assert_eq!(run.status, Some(3), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("too far apart"), "{}", run.stdout);
}

#[test]
fn zero_and_long_normals_are_mended() {
    let scene = Scene::new();
    let mut points = shapes::peg();
    points.iter_mut().step_by(10).for_each(|p| p[3..].fill(0.0));
    points.iter_mut().skip(1).step_by(10).for_each(|p| p[3..].iter_mut().for_each(|x| *x *= 3.0));
    let zero = points.len().div_ceil(10);
    let long = (points.len() - 1).div_ceil(10);
    let odd = scene.write("odd.xyz", shapes::xyz(&points));
    let text = said(&scene, &odd, &[]);
    for part in [
        format!("{zero} of {} normals are zero", points.len()),
        format!("{long} of {} normals were not of unit length and were renormalised", points.len()),
        format!("{zero} of {} normals were estimated", points.len()),
    ] {
        assert!(text.contains(&part), "{part} in {text}");
    }
    assert!(text.lines().all(|line| line.starts_with("note: ") && line.contains("odd.xyz")), "{text}");
}

#[test]
fn implausible_sizes_name_the_likely_unit() {
    let scene = Scene::new();
    let scaled = |factor: f64| {
        let (mut vertices, triangles) = shapes::weighted_ring();
        vertices.iter_mut().flatten().for_each(|x| *x *= factor);
        scene.write("scaled.obj", shapes::obj(&(vertices, triangles)))
    };
    for (factor, unit, scale) in [
        (1000.0, "millimetres", "0.001"),
        (100.0, "centimetres or inches", "0.01 or 0.0254"),
        (0.001, "kilometres", "1000"),
    ] {
        let path = scaled(factor);
        let text = run!("predict", "--object", path, "--supporter", scene.peg).stderr;
        let end = format!("if its unit is {unit}, pass --object-scale {scale}\n");
        assert!(
            text.starts_with("warning: ") && text.contains("scaled.obj") && text.ends_with(&end),
            "{text}"
        );
        assert!(run!("inspect", path).stderr.ends_with(&format!("pass --scale {scale}\n")));
    }
    let text =
        run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--supporter-scale", "2000").stderr;
    assert!(
        text.contains("peg.xyz: the supporter is 200 m large") && text.ends_with("try --supporter-scale 2\n")
    );
}

#[test]
fn a_centre_of_mass_outside_the_object_is_odd() {
    let scene = Scene::new();
    let with =
        |com: &str| run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--com", com).stderr;
    assert_eq!(with("0,0,-0.07"), "");
    let text = with("0,0,-70");
    assert!(
        text.contains("warning: ") && text.contains("--com is outside the object's bounding box"),
        "{text}"
    );
}

#[test]
fn changes_to_a_mesh_are_reported() {
    let scene = Scene::new();
    let text = shapes::obj(&shapes::weighted_ring()) + "v 9 9 9\nf 1 1 1\n";
    let odd = scene.write("odd.obj", text);
    let run = run!("inspect", odd);
    assert_eq!(run.status, Some(0));
    assert!(run.stderr.contains("1 of 2313 vertices belong to no face"), "{}", run.stderr);
    assert!(run.stderr.contains("1 of 4621 faces had repeated vertices"), "{}", run.stderr);
}
