//! The page and the picture of a prediction.

use super::*;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// The scene in a page, and the rest of the page.
fn parts(page: &str) -> (Value, String) {
    let (before, after) = page.split_once("id=\"scene\">").expect("the page has a scene");
    let (scene, after) = after.split_once("</script>").expect("the scene ends");
    (serde_json::from_str(scene).unwrap(), format!("{before}{after}"))
}

fn scene_of(path: &Path) -> Value {
    parts(&std::fs::read_to_string(path).unwrap()).0
}

fn floats<const N: usize>(value: &Value) -> Vec<[f32; N]> {
    let bytes = STANDARD.decode(value.as_str().unwrap()).unwrap();
    let numbers: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
    assert_eq!((bytes.len() % 4, numbers.len() % N), (0, 0));
    numbers.as_chunks().0.to_vec()
}

#[test]
fn the_page_shows_the_poses_of_the_json_and_how_they_settle() {
    let scene = Scene::new();
    let (page, json) = (scene.path("page.html"), scene.path("poses.json"));
    let run = run!(
        "predict",
        "--object",
        scene.ring,
        "--supporter",
        scene.peg,
        "--view",
        page,
        "--json",
        json,
        "--plan"
    );
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    assert!(run.stdout.contains("can be reached"), "the table is printed as ever");
    let (shown, rest) = parts(&std::fs::read_to_string(&page).unwrap());
    assert!(rest.contains("<title>ring.obj on peg.xyz</title>"));
    let document: Value = serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
    let (poses, expected) = (shown["poses"].as_array().unwrap(), document["poses"].as_array().unwrap());
    assert!(!poses.is_empty() && poses.len() == expected.len());
    for (pose, expected) in poses.iter().zip(expected) {
        for name in ["rank", "kind", "contacts", "margin", "path", "unseen", "tolerance"] {
            assert_eq!(pose[name].to_string().len() > 4, expected[name].to_string().len() > 4, "{name}");
        }
        let close = |a: &Value, b: &Value| (number(a) - number(b)).abs() < 1e-6;
        assert!(close(&pose["probability"], &expected["probability"]));
        for axis in 0..3 {
            assert!(close(&pose["release"]["position"][axis], &expected["position"][axis]));
            assert!(close(&pose["rest"]["position"][axis], &expected["rest_pose"][4 * axis + 3]));
        }
        let (seconds, track) =
            (floats::<1>(&pose["motion"]["seconds"]), floats::<7>(&pose["motion"]["poses"]));
        assert!(
            seconds.len() == track.len() && track.len() > 2 && seconds.is_sorted() && seconds[0] == [0.0]
        );
        for (at, name) in [(track[0], "release"), (track[track.len() - 1], "rest")] {
            let [x, y, z]: [f64; 3] = numbers(&pose[name]["position"]);
            assert!(distance([x, y, z], [0, 1, 2].map(|i| at[i].into())) < 1e-6, "{name}");
        }
    }
    // What fell is what the counts say, and it fell.
    let counts = &document["stats"]["counts"]["settling"];
    let fell = ["rotated_off", "slid_off", "moving"].map(|fate| number(&counts[fate]));
    let fallen = shown["fallen"].as_array().unwrap();
    assert_eq!(fallen.len() as f64, fell.iter().sum::<f64>().min(40.0));
    for candidate in fallen {
        let track = floats::<7>(&candidate["motion"]["poses"]);
        let [_, _, z]: [f64; 3] = numbers(&candidate["release"]["position"]);
        assert_eq!(f64::from(track[0][2]), z);
        if candidate["fate"] != "moves" {
            assert!(f64::from(track[track.len() - 1][2]) < z - 0.02, "{}", candidate["fate"]);
        }
    }
    // Shapes as they are: few enough to be shown whole.
    let corners = floats::<3>(&shown["object"]["positions"]);
    assert_eq!(
        (shown["object"]["triangle_count"].as_u64(), corners.len()),
        (Some(96 * 24 * 2 + 12), 96 * 24 + 8)
    );
    assert!(floats::<3>(&shown["supporter"]["points"]).len() > 100);
}

#[test]
fn a_prediction_of_before_is_shown_as_it_was() {
    let scene = Scene::new();
    let (first, json, second) =
        (scene.path("first.html"), scene.path("poses.json"), scene.path("second.html"));
    let run =
        run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--view", first, "--json", json);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    let run = run!("view", json, "--object", scene.ring, "--supporter", scene.peg, "--view", second);
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let (first, second) = (scene_of(&first), scene_of(&second));
    assert_eq!(first["object"], second["object"]);
    let pairs = first["poses"].as_array().unwrap().iter().zip(second["poses"].as_array().unwrap());
    for (a, b) in pairs {
        let ends = |pose: &Value| [&pose["motion"]["poses"]].map(|track| floats::<7>(track).len());
        assert_eq!((&a["rank"], &a["kind"], ends(a)), (&b["rank"], &b["kind"], ends(b)));
    }

    // What is no prediction is said to be none, and a page of before is kept.
    let page = scene.write("kept.html", "kept");
    for (content, words) in [
        ("{\"poses\": []}", "has no params"),
        ("[", "is no JSON"),
        ("{\"params\": 3}", "its params are not those of this version"),
    ] {
        let bad = scene.write("bad.json", content);
        let run = run!("view", bad, "--object", scene.ring, "--supporter", scene.peg, "--view", page);
        assert_eq!(run.status, Some(1));
        assert!(run.stderr.contains("bad.json: ") && run.stderr.contains(words), "{}", run.stderr);
    }
    assert_eq!(std::fs::read_to_string(page).unwrap(), "kept");
    let run = run!("view", json, "--object", scene.ring, "--supporter", scene.peg);
    assert_eq!(run.status, Some(2), "neither a page nor a picture: {}", run.stderr);
}

#[test]
fn a_large_mesh_gives_a_page_of_moderate_size() {
    let scene = Scene::new();
    let large = scene.write("large.obj", shapes::obj(&shapes::torus(500, 200)));
    let page = scene.path("page.html");
    let run = run!("predict", "--object", large, "--supporter", scene.peg, "--view", page);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    assert!(std::fs::metadata(&page).unwrap().len() < 5_000_000);
    let object = &scene_of(&page)["object"];
    assert_eq!(object["triangle_count"], 200_000);
    // The shown mesh is still the torus, to a tenth of its wire.
    let corners = floats::<3>(&object["positions"]);
    assert!((5_000..20_000).contains(&corners.len()), "{}", corners.len());
    for [x, y, z] in corners {
        let off = (x.hypot(z) - shapes::RING_RADIUS as f32).hypot(y) - shapes::WIRE_RADIUS as f32;
        assert!(off.abs() < 0.1 * shapes::WIRE_RADIUS as f32, "{off}");
    }
}

#[test]
fn a_page_says_why_nothing_hangs_and_names_are_no_markup() {
    let scene = Scene::new();
    let ball = scene.write("<b>&.obj", std::fs::read(&scene.ball).unwrap());
    let (page, picture) = (scene.path("page.html"), scene.path("picture.png"));
    let run = run!("predict", "--object", ball, "--supporter", scene.peg, "--view", page, "--png", picture);
    assert_eq!(run.status, Some(3));
    let (shown, rest) = parts(&std::fs::read_to_string(&page).unwrap());
    assert_eq!((&shown["poses"], &shown["object"]["name"]), (&serde_json::json!([]), &"<b>&.obj".into()));
    assert_eq!(shown["rejection"]["stage"], "no_contact_points");
    assert!(rest.contains("<title>&lt;b&gt;&amp;.obj on peg.xyz</title>"));
    assert!(colours(&picture).iter().any(|[r, _, b]| b > r), "the supporter alone");
}

#[test]
fn poses_of_the_published_method_are_shown_without_a_rest() {
    let scene = Scene::new();
    let page = scene.path("page.html");
    let options = [&PAPER[..], &["--view", page.to_str().unwrap()]].concat();
    scene.predict(&options);
    let shown = scene_of(&page);
    let poses = shown["poses"].as_array().unwrap();
    assert!(!poses.is_empty());
    for pose in poses {
        assert!(pose["rest"].is_null() && pose["kind"].is_null() && pose["motion"]["poses"] == "");
    }
    assert!(!floats::<3>(&shown["object"]["contacts"]["positions"]).is_empty(), "its sites");
}

/// The colours of the pixels of a picture.
fn colours(path: &Path) -> Vec<[u8; 3]> {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes.as_chunks().0.to_vec()
}

#[test]
fn a_single_point_and_a_tall_pole_have_a_picture() {
    let scene = Scene::new();
    let pole: String = (0..2000).map(|k| format!("0 0 {}\n", 0.001 * f64::from(k))).collect();
    for points in ["0 0 0\n", &pole] {
        let (cloud, picture) = (scene.write("points.xyz", points), scene.path("picture.png"));
        let run = run!("predict", "--object", scene.ball, "--supporter", cloud, "--png", picture);
        assert_eq!(run.status, Some(3), "{}", run.stderr);
        assert!(colours(&picture).iter().any(|colour| *colour != [255; 3]));
    }
}

#[test]
fn the_picture_shows_object_and_supporter() {
    let scene = Scene::new();
    let picture = scene.path("picture.png");
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--png", picture);
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let colours = colours(&picture);
    let share =
        |is: fn(&[u8; 3]) -> bool| colours.iter().filter(|c| is(c)).count() as f64 / colours.len() as f64;
    let (object, supporter) =
        (share(|[r, _, b]| *r > b.saturating_add(40)), share(|[r, _, b]| *b > r.saturating_add(8)));
    let background = share(|c| *c == [255; 3]);
    assert!(object > 0.02 && supporter > 0.01 && background > 0.2, "{object} {supporter} {background}");
}
