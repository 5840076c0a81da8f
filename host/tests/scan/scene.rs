//! A ball seen by a camera from several sides, written to files.

pub(crate) use crate::images::{depth_png, matrix, png, rows};
use hangpose::geometry::{Point, Pose, Vector};
use png::{BitDepth, ColorType};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

pub(crate) const SIZE: [u32; 2] = [160, 120];
/// fx, fy, cx, cy.
pub(crate) const INTRINSICS: [f64; 4] = [200.0, 198.0, 80.5, 60.25];
/// Radius of the ball around the origin, metres.
pub(crate) const RADIUS: f32 = 0.1;
/// Distance of the cameras from the origin, metres.
const AWAY: f32 = 0.5;
/// Number of images.
pub(crate) const IMAGES: usize = 8;

/// A folder of files.
pub(crate) struct Scene {
    folder: TempDir,
}

/// The poses of the cameras, camera to world: two circles around the ball, and from above and below.
pub(crate) fn poses() -> Vec<Pose> {
    let eye = |i: usize| {
        let turn = i as f32 * std::f32::consts::TAU / (IMAGES - 2) as f32;
        match IMAGES - 1 - i {
            0 => Vector::z(),
            1 => -Vector::z(),
            _ => {
                Vector::new(turn.cos(), turn.sin(), if i.is_multiple_of(2) { 0.4 } else { -0.4 }).normalize()
            }
        }
    };
    let pose =
        |i| Pose::face_towards(&Point::from(eye(i) * AWAY), &Point::origin(), &Vector::new(0.3, 0.2, -1.0));
    (0..IMAGES).map(pose).collect()
}

/// Depths in millimetres.
pub(crate) fn depths(pose: &Pose) -> Vec<u16> {
    let [fx, fy, cx, cy] = INTRINSICS.map(|x| x as f32);
    let centre = pose.inverse() * Point::origin();
    let pixels = (0..SIZE[1]).flat_map(|v| (0..SIZE[0]).map(move |u| (u as f32, v as f32)));
    let depth = |(u, v): (f32, f32)| {
        let ray = Vector::new((u - cx) / fx, (v - cy) / fy, 1.0);
        let (along, square) = (ray.dot(&centre.coords), ray.norm_squared());
        let root = along * along - square * (centre.coords.norm_squared() - RADIUS * RADIUS);
        if root < 0.0 { 0 } else { ((along - root.sqrt()) / square * 1000.0).round() as u16 }
    };
    pixels.map(depth).collect()
}

impl Scene {
    /// Images `depth-0.png` and so on, masks `mask-0.png` of label 3, poses `pose-0.txt`, and `camera.txt`.
    pub(crate) fn new() -> Self {
        let scene = Self { folder: tempfile::tempdir().unwrap() };
        let [fx, fy, cx, cy] = INTRINSICS;
        scene.write("camera.txt", format!("{fx} 0 {cx}\n0 {fy} {cy}\n0 0 1\n"));
        for (i, pose) in poses().iter().enumerate() {
            let depths = depths(pose);
            scene.write(&format!("depth-{i}.png"), depth_png(SIZE, &depths));
            scene.write(&format!("pose-{i}.txt"), matrix(pose));
            let labels: Vec<u8> = depths.iter().map(|depth| if *depth > 0 { 3 } else { 0 }).collect();
            scene.write(&format!("mask-{i}.png"), png(SIZE, ColorType::Grayscale, BitDepth::Eight, &labels));
        }
        scene
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The path as text, for patterns.
    pub(crate) fn text(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().into()
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new(""))).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Where the files are that every scene has.
    pub(crate) fn sources(&self) -> hangpose::files::depth::ScanSources {
        hangpose::files::depth::ScanSources {
            depth: self.text("depth-*.png"),
            camera: self.path("camera.txt"),
            poses: Some(self.text("pose-*.txt")),
            masks: None,
            depth_scale: None,
            world_to_camera: false,
        }
    }
}
