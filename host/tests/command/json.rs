//! Presence, type and meaning of every JSON field.

use super::shapes::{PEG_LENGTH, PEG_RADIUS, assert_hangs_by_the_ring, weighted_ring_centre_z};
use super::*;

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn the_document_has_the_fields_that_programs_read() {
    let document = Scene::new().predict(&[]);
    assert_eq!(document["schema"], 2);
    assert!(document["rejection"].is_null());
    let mut found = keys(&document);
    found.sort_unstable();
    assert_eq!(document["count"], 1);
    assert_eq!(found, ["count", "params", "poses", "rejection", "schema", "stats", "symmetries"]);

    let stats = &document["stats"];
    for stage in ["read", "object", "supporter", "matching", "total"] {
        assert!(number(&stats["seconds"][stage]) >= 0.0, "{stage}");
    }
    for part in ["object", "supporter"] {
        assert!(stats["memory_bytes"][part].as_u64().unwrap() > 10_000);
        assert!(stats["contacts"][part].as_u64().unwrap() > 0);
        assert_eq!(stats["sites"][part], 0, "the default profile has no sites");
    }
    assert!(stats["memory_bytes"]["prediction"].as_u64().unwrap() > 10_000);
    assert_eq!(stats["contacts"]["object"], stats["counts"]["hangability"]["contacts"]);
    assert_eq!(stats["contacts"]["supporter"], stats["counts"]["supportability"]["contacts"]);
    let settling = |name: &str| stats["counts"]["settling"][name].as_u64().unwrap();
    let fates = ["rotated_off", "slid_off", "moving", "at_rest"].map(settling);
    assert_eq!(settling("released"), fates.iter().sum::<u64>(), "every release has one fate");
    assert!(settling("candidates") >= settling("clear") && settling("at_rest") >= settling("firm"));
    // Of poses that hardly differ the document has one.
    assert!(settling("probable") >= document["poses"].as_array().unwrap().len() as u64);

    assert_eq!(document["params"]["samples"], 10_000);
    assert_eq!(document["params"]["seed"], 0);
}

#[test]
fn the_papers_document_has_sites() {
    let document = Scene::new().predict(&PAPER);
    let stats = &document["stats"];
    for part in ["object", "supporter"] {
        assert!(stats["sites"][part].as_u64().unwrap() > 0);
        assert_eq!(stats["contacts"][part], 0);
    }
    assert_eq!(stats["sites"]["object"], stats["counts"]["hangability"]["sites"]);
    assert_eq!(stats["sites"]["supporter"], stats["counts"]["supportability"]["sites"]);
    let pairs = number(&stats["sites"]["object"]) * number(&stats["sites"]["supporter"]);
    assert_eq!(number(&stats["counts"]["matching"]["pairs"]), pairs);
}

/// The row-major pose under this key.
fn pose(entry: &Value, name: &str) -> [f64; 16] {
    let pose = numbers::<16>(&entry[name]);
    assert_is_rigid(&pose);
    pose
}

#[test]
fn poses_come_to_rest_with_margins() {
    let scene = Scene::new();
    for (object, supporter) in [
        (scene.ring.clone(), scene.peg.clone()),
        (sample("mug.obj"), sample("hook.ply")),
        (sample("scissors.obj"), sample("mug_tree.ply")),
    ] {
        let document = scene.predict_with(&object, &supporter, &[]);
        let centre_of_mass = numbers::<3>(&run!("inspect", object, "--json").json()["centre_of_mass"]);
        let poses = document["poses"].as_array().unwrap();
        assert!(!poses.is_empty() && poses.len() <= 10);
        for (rank, entry) in (1..).zip(poses) {
            assert_eq!(entry["rank"], rank);
            assert_eq!(entry["release_pose"], entry["pose"]);
            let [release, rest] = ["pose", "rest_pose"].map(|name| pose(entry, name));
            assert_agrees(&release, numbers(&entry["position"]), numbers(&entry["quaternion_xyzw"]));
            for absent in ["cost", "object_site", "supporter_site"] {
                assert!(entry[absent].is_null(), "{absent} belongs to the published method");
            }

            let [from, to] = [release, rest].map(|pose| transform(&pose, centre_of_mass));
            let sinking = number(&entry["sinking"]);
            assert!((from[2] - to[2] - sinking).abs() < 1e-5, "rank {rank}: {from:?} {to:?} {sinking}");
            assert!(distance(from, to) < 0.02, "release and rest differ by less than 20 mm: {from:?} {to:?}");
            let clearance = number(&entry["clearance"]);
            assert!(clearance > 0.0 && clearance <= 0.0010001, "{clearance}");

            let probability = number(&entry["probability"]);
            let least = number(&document["params"]["min_probability"]);
            // The rank depends on the kind, too.
            assert!((least..=1.0).contains(&probability), "rank {rank}: {probability}");

            let margin = &entry["margin"];
            let tilts = numbers::<8>(&margin["tilts"]);
            assert!(tilts.iter().all(|tilt| (0.0..=1.20001).contains(tilt)), "{tilts:?}");
            let [rise, knock] = ["escape_rise", "knock_speed"].map(|name| number(&margin[name]));
            assert!(rise >= 0.0 && (knock - (2.0 * 9.81 * rise).sqrt()).abs() < 1e-4, "{rise} {knock}");
            for name in ["escape_ratio", "centre_of_mass_radius"] {
                assert!(number(&margin[name]) >= 0.0, "{name}");
            }

            // The vertical components of the normal forces balance the weight, up to what friction can contribute.
            let contacts = entry["contacts"].as_array().unwrap();
            assert!((1..=8).contains(&contacts.len()));
            let (mut borne, mut pressed) = (0.0, 0.0);
            for contact in contacts {
                let normal = numbers::<3>(&contact["normal"]);
                assert!((distance(normal, [0.0; 3]) - 1.0).abs() < 1e-4, "{contact}");
                borne += number(&contact["force"]) * normal[2];
                pressed += number(&contact["force"]);
            }
            let rubbed = number(&document["params"]["friction"]) * pressed;
            assert!(
                borne + rubbed > 0.95 && borne - rubbed < 1.05,
                "rank {rank}: contacts carry {borne} of the weight"
            );
            let [x, y, _] = to;
            let is_beside = |c: &Value| {
                let [u, v, _] = numbers::<3>(&c["position"]);
                (x - u).hypot(y - v)
            };
            let nearest = contacts.iter().map(is_beside).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.05, "the nearest contact is {nearest} m beside the centre of mass");
        }
    }
}

#[test]
fn the_ring_hangs_on_the_peg_with_the_weight_below() {
    let document = Scene::new().predict(&["--top", "1"]);
    let [best] = &document["poses"].as_array().unwrap()[..] else { panic!("--top 1") };
    let rest = pose(best, "rest_pose");
    assert_hangs_by_the_ring(best);
    // It rests on one contact. The normal force is the component of the weight along the normal; friction carries the
    // rest.
    let [contact] = &best["contacts"].as_array().unwrap()[..] else { panic!("{}", best["contacts"]) };
    let (force, [_, _, up]) = (number(&contact["force"]), numbers::<3>(&contact["normal"]));
    assert!((force - up).abs() < 0.01, "the normal force is not the weight along the normal: {contact}");
    assert!(up > 1.0_f64.hypot(0.4).recip(), "outside the friction cone: {contact}");
    let [origin, tip, weight] =
        [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, weighted_ring_centre_z()]].map(|p| transform(&rest, p));
    // The peg goes through the ring, whose axis is y in the object frame, and the weight hangs straight below.
    assert!((tip[0] - origin[0]).abs() > 0.8, "{tip:?}");
    assert!(weight[2] < -0.05 && weight[1].abs() < 0.01, "{weight:?}");
}

#[test]
fn without_gravity_poses_are_where_contacts_meet() {
    let scene = Scene::new();
    let file = scene.write("geometry.toml", "settle = false\n");
    let document = scene.predict(&["--params", file.to_str().unwrap(), "--top", "3"]);
    assert_eq!(document["poses"].as_array().unwrap().len(), 3);
    for entry in document["poses"].as_array().unwrap() {
        pose(entry, "pose");
        for absent in ["rest_pose", "sinking", "clearance", "probability", "margin", "contacts", "cost"] {
            assert!(entry[absent].is_null(), "{absent}");
        }
    }
    assert_eq!(document["stats"]["counts"]["settling"]["released"], 0);
}

#[test]
fn poses_are_rigid_ranked_and_bring_the_sites_together() {
    let scene = Scene::new();
    for (object, supporter) in [
        (scene.ring.clone(), scene.peg.clone()),
        (sample("mug.obj"), sample("hook.ply")),
        (sample("scissors.obj"), sample("mug_tree.ply")),
    ] {
        let document = scene.predict_with(&object, &supporter, &[&PAPER[..], &["--top", "40"]].concat());
        let inspected = run!("inspect", object, "--profile", "paper", "--json").json();
        let centre_of_mass = numbers::<3>(&inspected["centre_of_mass"]);
        let poses = document["poses"].as_array().unwrap();
        assert!(!poses.is_empty() && poses.len() <= 40);
        let mut last = f64::NEG_INFINITY;
        for (rank, entry) in (1..).zip(poses) {
            assert_eq!(entry["rank"], rank);
            let pose = numbers::<16>(&entry["pose"]);
            assert_is_rigid(&pose);
            assert_agrees(&pose, numbers(&entry["position"]), numbers(&entry["quaternion_xyzw"]));

            for absent in ["rest_pose", "sinking", "clearance", "probability", "margin", "contacts"] {
                assert!(entry[absent].is_null(), "{absent}: the published method does not simulate");
            }

            let cost = &entry["cost"];
            let sum: f64 = ["collision", "boundary", "contact_area"].iter().map(|c| number(&cost[c])).sum();
            assert!((number(&cost["total"]) - sum).abs() < 1e-4, "all weights are one");
            assert!((0.5..=1.0).contains(&number(&cost["boundary"])));
            assert!((0.0..=1.0).contains(&number(&cost["contact_area"])));
            assert!(number(&cost["total"]) >= last, "rank {rank}");
            last = number(&cost["total"]);

            let (site, support) = (&entry["object_site"], &entry["supporter_site"]);
            let [position, target] = [numbers(&site["position"]), numbers(&support["position"])];
            assert!(distance(transform(&pose, position), target) < 1e-5, "rank {rank}");
            let index = site["index"].as_u64().unwrap() as usize;
            assert_eq!(inspected["sites"][index], *site, "as inspect says");

            // The centre of mass is straight below the hanging position, or in it.
            let [x, y, z] = transform(&pose, centre_of_mass);
            assert!((x - target[0]).hypot(y - target[1]) < 1e-5 && z < target[2] + 1e-5, "rank {rank}");
        }
    }
}

#[test]
fn the_papers_best_is_the_middle_of_the_peg() {
    let document = Scene::new().predict(&[&PAPER[..], &["--top", "1"]].concat());
    let [best] = &document["poses"].as_array().unwrap()[..] else { panic!("--top 1") };
    let pose = numbers::<16>(&best["pose"]);

    let site = &best["object_site"];
    shapes::assert_is_in_the_ring(site);
    let support = &best["supporter_site"];
    let [x, y, z] = numbers(&support["position"]);
    assert!(x.abs() < PEG_LENGTH / 4.0 && y.hypot(z) < 0.001, "not near the middle of the peg");
    let radius = number(&support["support_radius"]);
    assert!((PEG_RADIUS..1.5 * PEG_RADIUS).contains(&radius), "{radius}");
    assert_eq!(best["cost"]["collision"], 0);

    // The peg goes through the ring, whose axis is y in the object frame, and the weight hangs below.
    let [origin, tip, weight] =
        [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, weighted_ring_centre_z()]].map(|p| transform(&pose, p));
    assert!((tip[0] - origin[0]).abs() > 0.9, "{tip:?}");
    assert!(weight[2] < -0.03, "{weight:?}");
}

fn assert_is_rigid(m: &[f64; 16]) {
    assert_eq!(m[12..], [0.0, 0.0, 0.0, 1.0]);
    let row = |i: usize| [m[4 * i], m[4 * i + 1], m[4 * i + 2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for i in 0..3 {
        for j in 0..3 {
            let expected = if i == j { 1.0 } else { 0.0 };
            assert!((dot(row(i), row(j)) - expected).abs() < 1e-5, "{m:?}");
        }
    }
    let [a, b] = [row(0), row(1)];
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    assert!((dot(cross, row(2)) - 1.0).abs() < 1e-5, "a reflection: {m:?}");
}

fn assert_agrees(m: &[f64; 16], position: [f64; 3], [x, y, z, w]: [f64; 4]) {
    assert_eq!([m[3], m[7], m[11]], position);
    assert!((x * x + y * y + z * z + w * w - 1.0).abs() < 1e-5);
    let rotation = [
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - z * w),
        2.0 * (x * z + y * w),
        2.0 * (x * y + z * w),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - x * w),
        2.0 * (x * z - y * w),
        2.0 * (y * z + x * w),
        1.0 - 2.0 * (x * x + y * y),
    ];
    for (k, expected) in rotation.iter().enumerate() {
        assert!((m[k / 3 * 4 + k % 3] - expected).abs() < 1e-5, "{m:?}");
    }
}

#[test]
fn the_same_bytes_twice_and_on_any_number_of_threads() {
    let scene = Scene::new();
    let first = timeless(scene.predict(&[]));
    assert_eq!(first, timeless(scene.predict(&[])));
    for threads in ["1", "2", "7"] {
        assert_eq!(first, timeless(scene.predict(&["--threads", threads])));
    }
}

#[test]
fn a_seed_changes_the_samples_and_nothing_else() {
    let scene = Scene::new();
    let rest = |seed: &str| {
        let document = scene.predict(&["--seed", seed]);
        assert_eq!(document["params"]["seed"].to_string(), seed);
        document["poses"][0]["rest_pose"].to_string()
    };
    assert_eq!(rest("7"), rest("7"));
    assert_ne!(rest("7"), rest("18446744073709551615"));
    let mesh = scene.write("peg.obj", shapes::obj(&shapes::peg_mesh()));
    let points = |seed: &str| {
        run!("inspect", mesh, "--as", "supporter", "--profile", "paper", "--seed", seed, "--json").json()
    };
    assert_ne!(
        points("1")["sites"],
        points("2")["sites"],
        "the samples of a supporter mesh depend on the seed"
    );
}

#[test]
fn a_given_centre_of_mass_hangs_below() {
    let given = [0.012, 0.0, -0.06];
    let options = ["--com", "0.012,0,-0.06", "--top", "1"];
    let best = &Scene::new().predict(&options)["poses"][0];
    let rest = pose(best, "rest_pose");
    let contact = numbers::<3>(&best["contacts"][0]["position"]);
    // Across the peg only: along the peg friction can hold the object askew.
    let [beside, true_beside] =
        [given, [0.0, 0.0, weighted_ring_centre_z()]].map(|p| transform(&rest, p)).map(|p| p[1] - contact[1]);
    assert!(beside.abs() < 0.006 && true_beside.abs() > 0.006, "{beside} {true_beside}");

    let document = Scene::new().predict(&[&PAPER[..], &options].concat());
    let in_params = numbers::<3>(&document["params"]["centre_of_mass"]["given"]);
    assert!(distance(in_params, given) < 1e-6);
    let best = &document["poses"][0];
    let pose = numbers::<16>(&best["pose"]);
    let hanging = numbers::<3>(&best["supporter_site"]["position"]);
    let below = |p| transform(&pose, p);
    let [x, y, z] = below(given);
    assert!((x - hanging[0]).hypot(y - hanging[1]) < 1e-5 && z < hanging[2] - 0.03);
    let [x, y, _] = below([0.0, 0.0, weighted_ring_centre_z()]);
    assert!((x - hanging[0]).hypot(y - hanging[1]) > 0.005, "the true centre of mass is not below");
}

#[test]
fn the_document_has_the_effective_params() {
    let scene = Scene::new();
    let file = scene.write("few.toml", "samples = 3000\nseed = 5\ncollision_weight = 0.5\n");
    let document = scene.predict(&["--profile", "paper", "--params", file.to_str().unwrap(), "--seed", "6"]);
    let params = &document["params"];
    assert_eq!((&params["samples"], &params["seed"]), (&Value::from(3000), &Value::from(6)));
    assert_eq!(params["collision_weight"], 0.5);
    assert_eq!((&params["max_collision"], &params["centre_of_mass"]), (&1.0.into(), &"sample_mean".into()));
}

#[test]
fn what_cannot_hang_is_rejected_with_a_reason() {
    let scene = Scene::new();
    let run = run!("predict", "--object", scene.ball, "--supporter", scene.peg, "--json", "-");
    assert_eq!(run.status, Some(3), "{}", run.stderr);
    let document = run.json();
    assert_eq!(document["poses"], Value::Array(vec![]));
    assert_eq!(document["rejection"]["stage"], "no_contact_points");
    assert!(document["rejection"]["reason"].as_str().unwrap().contains("the object"));
    assert_eq!(document["rejection"]["counts"], document["stats"]["counts"]);

    let run = run!("predict", "--object", scene.ball, "--supporter", scene.peg);
    assert_eq!(run.status, Some(3));
    let reason = document["rejection"]["reason"].as_str().unwrap();
    assert_eq!(run.stdout.lines().nth(1).unwrap(), format!("nothing hangs: {reason}"));
}
