//! On any content the readers return an error or a usable scan, without a panic.

use crate::formats::{bop, open3d, tum};
use crate::random::Random;
use crate::scene::{Scene, matrix, poses};
use hangpose::files::depth::{ScanSources, read_scan};
use std::time::{Duration, Instant};

/// Corruptions of each file.
const ROUNDS: usize = 150;

/// A corrupted copy: some bytes changed, removed or repeated, or the end cut off.
fn corrupt(content: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = content.to_vec();
    for _ in 0..1 + random.next() % 4 {
        let at = (random.next() % bytes.len().max(1) as u64) as usize;
        match random.next() % 5 {
            _ if bytes.is_empty() => {}
            0 => bytes[at] = random.next() as u8,
            1 => bytes[at] = b"0-.eE,[]{}\n 9"[(random.next() % 13) as usize],
            2 => drop(bytes.remove(at)),
            3 => bytes.truncate(at),
            _ => bytes.insert(at, bytes[at]),
        }
    }
    bytes
}

#[test]
fn corrupted_files_do_no_harm() {
    let scene = Scene::new();
    let log: String = poses().iter().map(|pose| format!("0 0 1\n{}", matrix(pose))).collect();
    let list: String = (0..8).map(|i| format!("{} depth-{i}.png\n", 1_305_031_453 + i)).collect();
    let read = |name: &str| std::fs::read(scene.path(name)).unwrap();
    let files = [
        ("depth-0.png", read("depth-0.png")),
        ("mask-0.png", read("mask-0.png")),
        ("camera.txt", read("camera.txt")),
        ("pose-0.txt", read("pose-0.txt")),
        ("camera.json", open3d().to_string().into_bytes()),
        ("scene_camera.json", bop().to_string().into_bytes()),
        ("trajectory.log", log.into_bytes()),
        ("groundtruth.tum", tum().into_bytes()),
        ("list.txt", list.into_bytes()),
    ];
    for (name, content) in &files {
        scene.write(name, content);
    }
    let fine = ScanSources { masks: Some((scene.text("mask-*.png"), 3)), ..scene.sources() };
    let of = |name: &str| match name {
        "camera.json" => ScanSources { camera: scene.path(name), ..fine.clone() },
        "scene_camera.json" => ScanSources { camera: scene.path(name), poses: None, ..fine.clone() },
        "trajectory.log" => ScanSources { poses: Some(scene.text(name)), ..fine.clone() },
        "groundtruth.tum" | "list.txt" => ScanSources {
            depth: scene.text("list.txt"),
            poses: Some(scene.text("groundtruth.tum")),
            ..fine.clone()
        },
        _ => fine.clone(),
    };
    let mut random = Random(1);
    let start = Instant::now();
    for (name, content) in &files {
        let sources = of(name);
        read_scan(&sources).unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut broken = 0;
        for _ in 0..ROUNDS {
            scene.write(name, corrupt(content, &mut random));
            match read_scan(&sources) {
                Ok(scan) => assert!(scan.frames.iter().all(|frame| frame.image().is_ok())),
                Err(error) => {
                    broken += 1;
                    assert!(!error.to_string().is_empty());
                }
            }
        }
        scene.write(name, content);
        assert!(broken > ROUNDS / 10, "{name}: {broken} of {ROUNDS} were found");
    }
    assert!(start.elapsed() < Duration::from_secs(60));
}
