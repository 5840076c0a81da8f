//! Every format gives the same cameras, poses and masks.

use crate::scene::{IMAGES, INTRINSICS, SIZE, Scene, depths, matrix, png, poses, rows};
use hangpose::files::depth::{ScanFiles, ScanSources, read_scan};
use hangpose::geometry::Pose;
use png::{BitDepth, ColorType};
use serde_json::{Value, json};
use std::fmt::Write;

#[track_caller]
fn assert_is_the_scene(sources: &ScanSources) -> ScanFiles {
    let files = read_scan(sources).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(files.frames.len(), IMAGES);
    for (frame, pose) in files.frames.iter().zip(poses()) {
        assert_eq!((frame.depth.size, frame.scale), (SIZE, 0.001));
        assert_eq!(frame.depth.depths, depths(&pose));
        let [fx, fy, cx, cy] = INTRINSICS.map(|x| x as f32);
        assert_eq!((frame.camera.focal(), frame.camera.centre()), ([fx, fy], [cx, cy]));
        assert!(is_near(&frame.pose, &pose), "{} {pose}", frame.pose);
    }
    files
}

fn is_near(a: &Pose, b: &Pose) -> bool {
    (a.to_homogeneous() - b.to_homogeneous()).amax() < 1e-5
}

pub(crate) fn open3d() -> Value {
    let [fx, fy, cx, cy] = INTRINSICS;
    json!({ "width": SIZE[0], "height": SIZE[1], "intrinsic_matrix": [fx, 0.0, 0.0, 0.0, fy, 0.0, cx, cy, 1.0] })
}

pub(crate) fn bop() -> Value {
    let [fx, fy, cx, cy] = INTRINSICS;
    let entry = |pose: &Pose| {
        let r = rows(&pose.inverse());
        let rotation = [0, 1, 2].map(|i| [0, 1, 2].map(|j| r[i][j])).concat();
        let translation = [0, 1, 2].map(|i| 1000.0 * r[i][3]);
        json!({
            "cam_K": [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
            "depth_scale": 1.0,
            "cam_R_w2c": rotation,
            "cam_t_w2c": translation,
        })
    };
    poses()
        .iter()
        .enumerate()
        .map(|(i, pose)| (i.to_string(), entry(pose)))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

#[test]
fn matrices_in_a_file_each() {
    let scene = Scene::new();
    assert_is_the_scene(&scene.sources());
}

#[test]
fn matrices_below_each_other() {
    let scene = Scene::new();
    let text: String = poses().iter().map(|pose| matrix(pose) + "\n").collect();
    scene.write("all.txt", text);
    assert_is_the_scene(&ScanSources { poses: Some(scene.text("all.txt")), ..scene.sources() });
}

#[test]
fn matrices_from_world_to_camera() {
    let scene = Scene::new();
    for (i, pose) in poses().iter().enumerate() {
        scene.write(&format!("pose-{i}.txt"), matrix(&pose.inverse()));
    }
    assert_is_the_scene(&ScanSources { world_to_camera: true, ..scene.sources() });
}

#[test]
fn an_open3d_trajectory() {
    let scene = Scene::new();
    let text: String =
        poses().iter().enumerate().map(|(i, pose)| format!("{i} {i} {}\n{}", i + 1, matrix(pose))).collect();
    scene.write("trajectory.log", text);
    assert_is_the_scene(&ScanSources { poses: Some(scene.text("trajectory.log")), ..scene.sources() });
}

/// A trajectory at 100 Hz in which the poses of the images are those at their times.
pub(crate) fn tum() -> String {
    let mut text = String::from("# timestamp tx ty tz qx qy qz qw\n");
    for (i, pose) in poses().iter().enumerate() {
        let (t, q) = (pose.translation.vector, pose.rotation.coords);
        let time = 1_305_031_453.0 + i as f64;
        writeln!(text, "{:.4} 9 9 9 0 0 0 1", time - 0.012).unwrap();
        let [x, y, z] = [t.x, t.y, t.z];
        writeln!(text, "{time:.4} {x:.9} {y:.9} {z:.9} {:.9} {:.9} {:.9} {:.9}", q.x, q.y, q.z, q.w).unwrap();
        writeln!(text, "{:.4} 8 8 8 0 0 0 1", time + 0.013).unwrap();
    }
    text
}

#[test]
fn a_tum_trajectory_with_a_list_of_images() {
    let scene = Scene::new();
    scene.write("groundtruth.txt", tum());
    let list: String =
        (0..IMAGES).map(|i| format!("{:.4} depth-{i}.png\n", 1_305_031_453.003 + i as f64)).collect();
    scene.write("depth.txt", format!("# depth maps\n{list}"));
    let sources = ScanSources {
        depth: scene.text("depth.txt"),
        poses: Some(scene.text("groundtruth.txt")),
        ..scene.sources()
    };
    assert!(assert_is_the_scene(&sources).notes.is_empty());
    // An image that the tracker missed is left out, and the note says so.
    scene.write("depth.txt", format!("1305031400.0 depth-0.png\n{list}"));
    let files = assert_is_the_scene(&sources);
    assert!(files.notes[0].contains("1 of 9 images have no pose"), "{:?}", files.notes);
}

#[test]
fn a_tum_trajectory_with_times_as_names() {
    let scene = Scene::new();
    scene.write("groundtruth.txt", tum());
    for i in 0..IMAGES {
        let name = format!("times/{:.4}.png", 1_305_031_452.998 + i as f64);
        scene.write(&name, std::fs::read(scene.path(&format!("depth-{i}.png"))).unwrap());
    }
    assert_is_the_scene(&ScanSources {
        depth: scene.text("times/*.png"),
        poses: Some(scene.text("groundtruth.txt")),
        ..scene.sources()
    });
}

#[test]
fn open3d_intrinsics_alone_and_with_a_pose() {
    let scene = Scene::new();
    let camera = scene.write("camera.json", open3d().to_string());
    assert_is_the_scene(&ScanSources { camera: camera.clone(), ..scene.sources() });
    let pose = poses()[2];
    let columns: Vec<f64> =
        (0..4).flat_map(|j| (0..4).map(move |i| (i, j))).map(|(i, j)| rows(&pose.inverse())[i][j]).collect();
    let parameters =
        json!({ "class_name": "PinholeCameraParameters", "extrinsic": columns, "intrinsic": open3d() });
    scene.write("camera.json", parameters.to_string());
    let one = ScanSources { depth: scene.text("depth-2.png"), camera, poses: None, ..scene.sources() };
    assert!(is_near(&read_scan(&one).unwrap().frames[0].pose, &pose));
}

#[test]
fn bop_cameras_have_intrinsics_scale_and_poses() {
    let scene = Scene::new();
    let camera = scene.write("scene_camera.json", bop().to_string());
    for i in 0..IMAGES {
        let bytes = std::fs::read(scene.path(&format!("depth-{i}.png"))).unwrap();
        scene.write(&format!("bop/{i:06}.png"), bytes);
    }
    let depth = scene.text("bop/*.png");
    assert_is_the_scene(&ScanSources {
        depth: depth.clone(),
        camera: camera.clone(),
        poses: None,
        ..scene.sources()
    });
    // The poses alone, with other intrinsics.
    assert_is_the_scene(&ScanSources {
        depth,
        poses: Some(scene.text("scene_camera.json")),
        ..scene.sources()
    });
    let mut coarse = bop();
    coarse.as_object_mut().unwrap().values_mut().for_each(|entry| entry["depth_scale"] = json!(0.5));
    scene.write("scene_camera.json", coarse.to_string());
    let sources = ScanSources { depth: scene.text("bop/*.png"), camera, poses: None, ..scene.sources() };
    assert_eq!(read_scan(&sources).unwrap().frames[0].scale, 0.0005);
}

#[test]
fn a_single_image_needs_no_pose() {
    let scene = Scene::new();
    let files =
        read_scan(&ScanSources { depth: scene.text("depth-0.png"), poses: None, ..scene.sources() }).unwrap();
    assert_eq!(files.frames[0].pose, Pose::identity());
}

#[test]
fn masks_of_eight_sixteen_and_one_bit_and_with_a_palette() {
    let scene = Scene::new();
    let truth: Vec<bool> = depths(&poses()[0]).iter().map(|depth| *depth > 0).collect();
    let bytes: Vec<u8> = truth.iter().map(|is_ball| u8::from(*is_ball)).collect();
    let wide: Vec<u8> = bytes.iter().flat_map(|label| [0, *label]).collect();
    let packed: Vec<u8> =
        bytes.chunks(8).map(|bits| bits.iter().fold(0, |byte, bit| byte << 1 | bit)).collect();
    for (colour, bits, content) in [
        (ColorType::Grayscale, BitDepth::Eight, &bytes),
        (ColorType::Indexed, BitDepth::Eight, &bytes),
        (ColorType::Grayscale, BitDepth::Sixteen, &wide),
        (ColorType::Grayscale, BitDepth::One, &packed),
    ] {
        let mask = scene.write("mask.png", png(SIZE, colour, bits, content));
        let files = read_scan(&ScanSources {
            depth: scene.text("depth-0.png"),
            poses: Some(scene.text("pose-0.txt")),
            masks: Some((mask.to_str().unwrap().into(), 1)),
            ..scene.sources()
        });
        let files = files.unwrap_or_else(|error| panic!("{error}"));
        let (labels, label) = files.frames[0].labels.as_ref().unwrap();
        assert_eq!((labels, *label), (&bytes, 1), "{colour:?} {bits:?}");
    }
}
