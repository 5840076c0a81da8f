//! What is wrong with a scan is named, with its place and its remedy.

use crate::scene::{SIZE, Scene, depth_png, depths, matrix, png, poses};
use hangpose::files::depth::{ScanError, ScanSources, read_scan};
use hangpose::geometry::{Aabb, Pose};
use hangpose::perception::volume::VolumeSettings;
use hangpose::{FuseError, Monitor, scan};
use png::{BitDepth, ColorType};

/// The message of the error, which contains each of the parts.
#[track_caller]
fn assert_says(sources: &ScanSources, parts: &[&str]) -> ScanError {
    let error = read_scan(sources).expect_err("the scan is broken");
    let message = error.to_string();
    assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    error
}

#[test]
fn depth_of_eight_bits_colour_or_no_image_at_all() {
    let scene = Scene::new();
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    let (grey, colour) = (vec![9; pixels], vec![9; 3 * pixels]);
    for (content, reason) in [
        (png(SIZE, ColorType::Grayscale, BitDepth::Eight, &grey), "a greyscale PNG of 8 bits"),
        (png(SIZE, ColorType::Rgb, BitDepth::Eight, &colour), "a colour PNG of 8 bits"),
        (b"JFIF".to_vec(), "is not a readable PNG"),
        (depth_png(SIZE, &depths(&poses()[3]))[..400].to_vec(), "is not a readable PNG"),
    ] {
        scene.write("depth-3.png", content);
        assert_says(&scene.sources(), &["depth-3.png", reason, "16 bits"]);
    }
    scene.write("depth-3.png", "");
    assert_says(&scene.sources(), &["depth-3.png", "empty"]);
}

#[test]
fn nothing_seen_mixed_sizes_and_missing_files() {
    let scene = Scene::new();
    scene.write("depth-2.png", depth_png(SIZE, &vec![0; (SIZE[0] * SIZE[1]) as usize]));
    assert_says(&scene.sources(), &["depth-2.png", "no pixel has a depth"]);
    scene.write("depth-2.png", depth_png([80, 60], &[500; 4800]));
    assert_says(&scene.sources(), &["depth-2.png", "80 x 60", "160 x 120", "depth-0.png"]);
    let sources = ScanSources { depth: scene.text("none-*.png"), ..scene.sources() };
    assert_says(&sources, &["none-*.png", "no file matches", "in quotes"]);
    let sources = ScanSources { camera: scene.path("none.json"), ..scene.sources() };
    assert_says(&sources, &["none.json", "no such file"]);
}

#[test]
fn intrinsics_of_another_resolution() {
    let scene = Scene::new();
    scene.write("camera.txt", "400 0 161\n0 396 120.5\n0 0 1\n");
    assert_says(&scene.sources(), &["camera.txt", "principal point at 161, 120.5", "160 x 120", "scale fx"]);
    scene.write("camera.txt", "100 0 40.2\n0 99 30.1\n0 0 1\n");
    assert_says(&scene.sources(), &["camera.txt", "principal point at 40.2, 30.1"]);
    let json = r#"{"width": 320, "height": 240, "intrinsic_matrix": [400, 0, 0, 0, 400, 0, 160, 120, 1]}"#;
    let camera = scene.write("camera.json", json);
    let sources = ScanSources { camera, ..scene.sources() };
    assert_says(&sources, &["camera.json", "320 x 240", "160 x 120"]);
}

#[test]
fn broken_camera_files() {
    let scene = Scene::new();
    for (content, reason) in [
        ("200 0 80\n0 200 60\n", "expected nine numbers, found 6"),
        ("200 0 80\n0 two 60\n0 0 1\n", "expected a number, not \"two\""),
        ("200 0 0\n0 200 0\n80 60 1\n", "is it transposed?"),
        ("200 3 80\n0 200 60\n0 0 1\n", "a skew of 3"),
        ("-200 0 80\n0 200 60\n0 0 1\n", "fx = -200"),
        ("{\"intrinsic_matrix\": [1, 2]}", "line 1: invalid length 2"),
        ("{\"0\": {\"cam_K\": [1]}}", "invalid length"),
        ("{", "EOF"),
    ] {
        scene.write("camera.txt", content);
        assert_says(&scene.sources(), &["camera.txt", reason]);
    }
}

#[test]
fn poses_that_are_too_few_or_not_rigid() {
    let scene = Scene::new();
    std::fs::remove_file(scene.path("pose-7.txt")).unwrap();
    assert_says(&scene.sources(), &["pose-*.txt", "7 poses and 8 images"]);
    assert_says(&ScanSources { poses: None, ..scene.sources() }, &["8 images and no poses"]);
    scene.write("pose-7.txt", "2 0 0 1\n0 2 0 1\n0 0 2 1\n0 0 0 1\n");
    assert_says(&scene.sources(), &["pose-7.txt", "line 1", "not rigid", "2.000, 2.000, 2.000"]);
    scene.write("pose-7.txt", "1 0 0 1\n0 1 0 1\n0 0 -1 1\n0 0 0 1\n");
    assert_says(&scene.sources(), &["pose-7.txt", "mirrors"]);
    scene.write("pose-7.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n");
    assert_says(&scene.sources(), &["pose-7.txt", "last row"]);
    scene.write("pose-7.txt", "nan nan nan nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    assert_says(&scene.sources(), &["pose-7.txt", "not finite"]);
    scene.write("pose-7.txt", "1 0 0\n0 1 0\n0 0 1\n");
    assert_says(&scene.sources(), &["pose-7.txt", "four lines of four numbers"]);
    scene.write("one.txt", "0 0 0 0 0 0 0 2\n");
    assert_says(
        &ScanSources { poses: Some(scene.text("one.txt")), ..scene.sources() },
        &["one.txt", "length 2"],
    );
    scene.write("one.txt", "100 0 0 0 0 0 0 1\n");
    let one = ScanSources { poses: Some(scene.text("one.txt")), ..scene.sources() };
    assert_says(&one, &["depth-0.png", "has no time", "depth.txt"]);
    scene.write("depth.txt", "103.5 depth-0.png\n");
    let list = ScanSources { depth: scene.text("depth.txt"), ..one };
    assert_says(&list, &["one.txt", "no image has a pose", "3.5 s away"]);
}

#[test]
fn depths_in_another_unit_name_the_scale() {
    let scene = Scene::new();
    for (scale, suggested) in [(1.0, 0.001), (1e-6, 0.001), (0.2, 0.0002)] {
        let error = assert_says(
            &ScanSources { depth_scale: Some(scale), ..scene.sources() },
            &["depth-0.png", "half of the depths", "give a depth scale of"],
        );
        assert!(
            matches!(error, ScanError::DepthScale { suggested: found, .. } if found == suggested),
            "{error}"
        );
    }
}

#[test]
fn masks_that_do_not_fit() {
    let scene = Scene::new();
    let sources = |label| ScanSources { masks: Some((scene.text("mask-*.png"), label)), ..scene.sources() };
    assert_says(&sources(4), &["label 4", "there are [3]"]);
    scene.write("mask-1.png", png([8, 8], ColorType::Grayscale, BitDepth::Eight, &[3; 64]));
    assert_says(&sources(3), &["mask-1.png", "8 x 8", "160 x 120"]);
    scene.write("mask-1.png", png([8, 8], ColorType::Rgb, BitDepth::Eight, &[3; 192]));
    assert_says(&sources(3), &["mask-1.png", "one channel"]);
    std::fs::remove_file(scene.path("mask-1.png")).unwrap();
    assert_says(&sources(3), &["mask-*.png", "7 masks and 8 images"]);
}

/// Neighbouring images overlap enough to tell one convention from the other.
#[test]
fn inverted_poses_are_recognised() {
    let scene = Scene::new();
    let near: Vec<Pose> = (0..4)
        .map(|i| {
            let eye = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.1 * i as f32, 0.3)
                * nalgebra::Vector3::x();
            Pose::face_towards(&(eye * 0.5).into(), &nalgebra::Point3::origin(), &-nalgebra::Vector3::z())
        })
        .collect();
    for (i, pose) in near.iter().enumerate() {
        scene.write(&format!("near/depth-{i}.png"), depth_png(SIZE, &depths(pose)));
        scene.write(&format!("near/pose-{i}.txt"), matrix(&pose.inverse()));
    }
    let sources = ScanSources {
        depth: scene.text("near/depth-*.png"),
        poses: Some(scene.text("near/pose-*.txt")),
        ..scene.sources()
    };
    let settings = VolumeSettings::new(0.005);
    let fuse = |world_to_camera| {
        let files = read_scan(&ScanSources { world_to_camera, ..sources.clone() }).unwrap();
        scan(&files.frames, &settings, &Monitor::new())
    };
    let error = fuse(false).unwrap_err();
    assert!(
        matches!(error, FuseError::Convention { given, inverted } if given < 0.4 && inverted > 0.7),
        "{error}"
    );
    assert!(fuse(true).unwrap().agreement.unwrap() > 0.7);
}

#[test]
fn an_object_outside_of_the_box_and_bad_settings() {
    let files = read_scan(&Scene::new().sources()).unwrap();
    let crop = Some(Aabb { min: [1.0; 3].into(), max: [2.0; 3].into() });
    let settings = VolumeSettings { crop, ..VolumeSettings::new(0.005) };
    let error = scan(&files.frames, &settings, &Monitor::new()).unwrap_err();
    let FuseError::Outside { seen, .. } = error else { panic!("{error}") };
    assert!(seen.extents().iter().all(|x| (*x - 0.2).abs() < 0.02), "{seen:?}");
    let fine = VolumeSettings::new(0.005);
    assert_eq!(scan(&[], &fine, &Monitor::new()).unwrap_err(), FuseError::Empty);
    let monitor = Monitor::new();
    monitor.cancel();
    assert!(scan(&files.frames, &fine, &monitor).unwrap_err().to_string().contains("cancelled"));
    let error = scan(&files.frames, &VolumeSettings { voxel: -1.0, ..fine }, &Monitor::new()).unwrap_err();
    assert!(error.to_string().contains("voxel size"), "{error}");
}
