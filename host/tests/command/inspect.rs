//! `hangpose inspect`, as text and as JSON.

use super::shapes::{
    PEG_LENGTH, PEG_RADIUS, RING_RADIUS, WEIGHT, WEIGHT_Z, WIRE_RADIUS, weighted_ring_centre_z,
};
use super::*;

#[test]
fn an_object_is_measured() {
    let scene = Scene::new();
    let run = run!("inspect", scene.ring, "--profile", "paper", "--json");
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let seen = run.json();
    assert_eq!((&seen["schema"], &seen["as"]), (&2.into(), &"object".into()));
    let (vertices, triangles) = shapes::weighted_ring();
    assert_eq!(seen["vertices"], vertices.len());
    assert_eq!(seen["triangles"], triangles.len());
    let outer = RING_RADIUS + WIRE_RADIUS;
    let extents = [2.0 * outer, 2.0 * WIRE_RADIUS, outer - (WEIGHT_Z - WEIGHT[2])];
    assert!(distance(numbers(&seen["extents"]), extents) < 1e-6);
    assert_eq!(seen["mass"]["is_closed"], true);
    assert_eq!(seen["mass"]["is_inside_out"], false);
    let ring = 2.0 * std::f64::consts::PI.powi(2) * RING_RADIUS * WIRE_RADIUS.powi(2);
    let volume = ring + 8.0 * WEIGHT.iter().product::<f64>();
    // Flat facets make the ring slightly smaller.
    assert!((number(&seen["mass"]["volume"]) / volume - 1.0).abs() < 0.01);
    let centre = [0.0, 0.0, weighted_ring_centre_z()];
    let of_the_volume = &run!("inspect", scene.ring, "--json").json()["centre_of_mass"];
    assert!(distance(numbers(of_the_volume), centre) < 5e-4);
    assert!(seen["scale_warning"].is_null());
    assert!(number(&seen["seconds"]) > 0.0);
    let sites = seen["sites"].as_array().unwrap();
    assert_eq!(seen["counts"]["sites"], sites.len());
    for (index, site) in sites.iter().enumerate() {
        assert_eq!(site["index"], index);
        for share in ["encircled", "encircled_above", "encircled_below"] {
            assert!((0.0..=1.0).contains(&number(&site[share])));
        }
        let direction = numbers::<3>(&site["hanging_direction"]);
        assert!((distance(direction, [0.0; 3]) - 1.0).abs() < 1e-5);
    }
}

#[test]
fn a_supporter_is_measured_as_cloud_and_as_mesh() {
    let scene = Scene::new();
    let mesh = scene.write("peg.stl", stl(&shapes::peg_mesh()));
    let extents = [PEG_LENGTH, 2.0 * PEG_RADIUS, 2.0 * PEG_RADIUS];
    let as_mesh = ["--as", "supporter", "--supporter-points", "3000"].as_slice();
    for (file, options, points, tolerance) in
        [(&scene.peg, [].as_slice(), shapes::peg().len(), 1e-6), (&mesh, as_mesh, 3000, 1e-3)]
    {
        let seen = finish(command().arg("inspect").arg(file).arg("--json").args(PAPER).args(options)).json();
        assert_eq!(
            (&seen["schema"], &seen["as"], &seen["points"]),
            (&2.into(), &"supporter".into(), &points.into())
        );
        assert!(distance(numbers(&seen["extents"]), extents) < tolerance, "{seen}");
        assert_eq!((&seen["normals_estimated"], &seen["normals_renormalised"]), (&0.into(), &0.into()));
        let sites = seen["sites"].as_array().unwrap();
        assert_eq!(seen["counts"]["sites"], sites.len());
        assert!(!sites.is_empty());
        for site in sites {
            let [x, y, z] = numbers(&site["position"]);
            assert!(x.abs() < PEG_LENGTH / 2.0 && y.hypot(z) < PEG_RADIUS, "{site}");
            let [along, across, up] = numbers::<3>(&site["hanging_direction"]);
            assert!(along.abs() > 0.9 && across.abs() < 0.4 && up.abs() < 1e-5, "{site}");
            // Distances from the middle of the slice to the two ends of the peg.
            let [d1, d2] = numbers(&site["boundary_distances"]);
            assert!((d1 + d2 - PEG_LENGTH).abs() < 0.1 * PEG_LENGTH, "{site}");
        }
    }
}

#[test]
fn people_read_the_same_as_programs() {
    let scene = Scene::new();
    let text = run!("inspect", scene.ring).stdout;
    let (_, triangles) = shapes::weighted_ring();
    assert!(text.starts_with(&format!("object, {} triangles, closed\n", triangles.len())), "{text}");
    for line in [
        "size                68.0      8.0    154.0 mm",
        "centroid of the volume",
        "scale           plausible",
    ] {
        assert!(text.contains(line), "{text}");
    }
    let sites =
        run!("inspect", scene.ring, "--profile", "paper", "--json").json()["sites"].as_array().unwrap().len();
    let rows = run!("inspect", scene.ring, "--profile", "paper").stdout;
    let rows = rows.lines().skip_while(|line| !line.starts_with("site ")).skip(1).count();
    assert_eq!(rows, sites);
    let text = run!("inspect", scene.peg).stdout;
    assert!(text.starts_with(&format!("supporter, {} points", shapes::peg().len())), "{text}");
    // The peg has two points a square millimetre: merged ones are less than half a millimetre from its ends.
    let size = text.lines().find_map(|line| line.strip_prefix("size ")).unwrap_or_default();
    let size: Vec<f32> = size.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!((99.0..=100.0).contains(&size[0]) && size[1..] == [8.0, 8.0], "{text}");
}

#[test]
fn symmetries_are_told() {
    let scene = Scene::new();
    // The ring with its weight may make half a turn about the line from one to the other.
    for (object, axes) in [(scene.ring.clone(), vec![Some(2)]), (sample("mug.obj"), vec![])] {
        let seen = run!("inspect", object, "--json").json();
        let symmetries = seen["symmetries"].as_array().unwrap();
        let folds: Vec<_> = symmetries.iter().map(|symmetry| symmetry["fold"].as_u64()).collect();
        assert_eq!(folds, axes);
        for symmetry in symmetries {
            assert!((distance(numbers(&symmetry["axis"]), [0.0; 3]) - 1.0).abs() < 1e-5);
            assert_eq!(symmetry["point"], seen["centre_of_mass"]);
        }
        let text = run!("inspect", object).stdout;
        assert_eq!(text.matches("\nsymmetry        ").count(), symmetries.len(), "{text}");
        let document = scene.predict_with(&object, &scene.peg, &[]);
        assert_eq!(document["symmetries"], seen["symmetries"]);
    }
}

#[test]
fn open_and_inverted_meshes_are_reported() {
    let scene = Scene::new();
    let (vertices, mut triangles) = shapes::weighted_ring();
    triangles.pop();
    let nearly = scene.write("nearly.obj", shapes::obj(&(vertices.clone(), triangles.clone())));
    let text = run!("inspect", nearly).stdout;
    assert!(text.lines().next().unwrap().ends_with("triangles, open"), "{text}");
    assert!(text.contains("centroid of the volume with its holes closed"), "{text}");

    let triangles: Vec<_> = triangles.into_iter().step_by(2).collect();
    let open = scene.write("open.obj", shapes::obj(&(vertices.clone(), triangles)));
    let text = run!("inspect", open).stdout;
    assert!(text.lines().next().unwrap().ends_with("triangles, open"), "{text}");
    assert!(text.contains("mean of the surface samples") && text.contains("volume          none"), "{text}");
    assert!(run!("inspect", open, "--json").json()["mass"]["volume"].is_null());

    let (_, mut triangles) = shapes::weighted_ring();
    triangles.iter_mut().for_each(|t| t.reverse());
    let inverted = scene.write("inverted.obj", shapes::obj(&(vertices, triangles)));
    let text = run!("inspect", inverted).stdout;
    assert!(text.lines().next().unwrap().contains("inside out"), "{text}");
    assert!(number(&run!("inspect", inverted, "--json").json()["mass"]["volume"]) > 0.0);
}

#[test]
fn no_candidates_are_no_error() {
    let run = run!("inspect", Scene::new().ball);
    assert_eq!(run.status, Some(0));
    assert!(run.stdout.contains(" 0 of them contact candidates"), "{}", run.stdout);
    assert!(!run.stdout.contains("\nindex "));
}

#[test]
fn the_scale_is_judged_in_text_and_json() {
    let scene = Scene::new();
    let warned = run!("inspect", scene.ring, "--scale", "1000");
    assert!(warned.stdout.contains("scale           the object is 154 m large"), "{}", warned.stdout);
    assert!(warned.stdout.contains("try --scale 1\n"));
    assert!(warned.stderr.starts_with("warning: ") && warned.stderr.contains("ring.obj"));
    let warning = run!("inspect", scene.ring, "--scale", "1000", "--json").json()["scale_warning"].clone();
    assert!(warned.stderr.contains(warning.as_str().unwrap()));
    let warned = run!("inspect", scene.peg, "--scale", "0.001").stdout;
    assert!(warned.contains("scale           the supporter is 0.0001 m large"), "{warned}");
}

/// The mesh as binary STL with zero normals.
fn stl((vertices, triangles): &shapes::Mesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for x in triangle.iter().flat_map(|&i| vertices[i]) {
            bytes.extend((x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}
