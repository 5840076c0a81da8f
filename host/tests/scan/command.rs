//! Runs of `hangpose scan`.

use crate::scene::{IMAGES, RADIUS, Scene, poses};
use hangpose::files::{MeshFile, read_mesh};
use hangpose::geometry::Vector;
use std::collections::HashSet;
use std::process::{Command, Output};

/// Exit status, standard output and standard error of a scan of the scene with further options.
fn run(scene: &Scene, options: &[&str]) -> (Option<i32>, Vec<u8>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hangpose"));
    command.args(["scan", "--depth", &scene.text("depth-*.png"), "--camera", &scene.text("camera.txt")]);
    command.args(["--poses", &scene.text("pose-*.txt"), "--voxel", "0.005"]).args(options);
    let Output { status, stdout, stderr } = command.output().unwrap();
    (status.code(), stdout, String::from_utf8(stderr).unwrap())
}

#[test]
fn the_mesh_is_the_closed_ball() {
    let scene = Scene::new();
    let (out, eyes) = (scene.text("out.ply"), scene.text("eyes.json"));
    let (status, stdout, stderr) = run(&scene, &["-o", &out, "--viewpoints", &eyes]);
    assert_eq!((status, stderr.as_str()), (Some(0), ""));
    let file = read_mesh(out.as_ref()).unwrap();
    let summary = format!("8 images, {} pixels fused", seen_pixels());
    let stdout = String::from_utf8(stdout).unwrap();
    assert!(stdout.starts_with(&summary), "{stdout}");
    assert!(stdout.contains(&format!("mesh of {} vertices", file.vertices.len())), "{stdout}");
    for vertex in &file.vertices {
        assert!((Vector::from(*vertex).norm() - RADIUS).abs() < 0.0025, "{vertex:?}");
    }
    assert_eq!(open_edges(&file), 0);
    let viewpoints: Vec<[f32; 3]> = serde_json::from_slice(&std::fs::read(eyes).unwrap()).unwrap();
    assert_eq!(viewpoints.len(), IMAGES);
    for (viewpoint, pose) in viewpoints.iter().zip(poses()) {
        assert!((Vector::from(*viewpoint) - pose.translation.vector).norm() < 1e-5);
    }
}

/// Number of edges with a triangle on one side only.
fn open_edges(mesh: &MeshFile) -> usize {
    let edges = mesh.triangles.iter().flat_map(|t| [0, 1, 2].map(|i| (t[i], t[(i + 1) % 3])));
    let edges: HashSet<(u32, u32)> = edges.collect();
    edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).count()
}

fn seen_pixels() -> usize {
    poses().iter().flat_map(crate::scene::depths).filter(|depth| *depth > 0).count()
}

#[test]
fn a_dash_gives_nothing_but_the_mesh_and_a_mask_and_a_box_cut_it() {
    let scene = Scene::new();
    let out = scene.text("out.ply");
    run(&scene, &["-o", &out]);
    let (status, stdout, stderr) =
        run(&scene, &["-o", "-", "--mask", &scene.text("mask-*.png"), "--label", "3"]);
    assert_eq!((status, stderr.as_str()), (Some(0), ""));
    assert!(stdout == std::fs::read(&out).unwrap(), "the mask holds all of the ball");
    assert_eq!(run(&scene, &["-o", &out, "--crop", "-1,-1,0,1,1,1"]).0, Some(0));
    let half = read_mesh(out.as_ref()).unwrap();
    assert!(half.vertices.iter().all(|v| v[2] >= 0.0));
    assert!(open_edges(&half) > 50);
}

#[test]
fn mistakes_are_named_with_the_option_and_no_file_is_written() {
    let scene = Scene::new();
    let out = scene.text("out.ply");
    for (options, status, parts) in [
        (&["--depth-scale", "1"][..], 1, &["depth-0.png", "--depth-scale 0.001"][..]),
        (&["--crop", "1,1,1,2,2,2"], 1, &["no image shows a surface within the crop box"]),
        (&["--crop", "1,1,1,0,0,0"], 1, &["crop box", "least coordinates first"]),
        (&["--crop", "1,1,1"], 2, &["--crop", "six comma-separated numbers"]),
        (&["--mask", "mask.png"], 2, &["--label"]),
        (&["--max-depth", "0"], 2, &["--max-depth"]),
    ] {
        let (found, stdout, stderr) = run(&scene, &[&["-o", &out], options].concat());
        assert_eq!((found, stdout.len()), (Some(status), 0), "{options:?} {stderr}");
        assert!(parts.iter().all(|part| stderr.contains(part)), "{stderr}");
        assert!(!scene.path("out.ply").exists());
    }
}
