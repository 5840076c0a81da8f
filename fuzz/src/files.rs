//! Files of every format that the command reads: a reader returns an error that names the file, or what the core can take;
//! without a panic, and without memory out of proportion to the length of the file.

use crate::draw::Draw;
use crate::memory::peak_of;
use crate::{gripper, pose_file};
use hangpose::Params;
use hangpose::files::depth::{ScanSources, read_depth, read_mask, read_scan};
use hangpose::files::{CloudFile, MeshFile, SupporterFile, read_cloud, read_mesh, read_supporter};
use std::cell::OnceCell;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The kinds of files, by the first byte of an input. New ones go to the end, or the seeds change their meaning.
pub const KINDS: [&str; 20] = [
    "a.obj",
    "a.stl",
    "a.ply",
    "a.gltf",
    "a.glb",
    "a.urdf",
    "a.pcd",
    "a.xyz",
    "depth.png",
    "mask.png",
    "camera.txt",
    "camera.json",
    "pose.txt",
    "poses.txt",
    "poses.log",
    "poses.tum",
    "list.txt",
    "pose.json",
    "gripper.toml",
    "params.toml",
];

/// Memory that a reader may hold, bytes for each byte of the file and in any case. A row of text PLY of two bytes becomes
/// about 200 bytes, and vertices are held twice while equal ones are merged.
const EACH_BYTE: usize = 600;
const ANYWAY: usize = 4 << 20;
/// The same for PNG, of which a byte may stand for 1032, which are held twice.
const EACH_BYTE_OF_PNG: usize = 2200;

/// A folder of files that belong to a scan of one image, one of which is replaced.
struct Folder {
    folder: TempDir,
    depth: Vec<u8>,
    mask: Vec<u8>,
}

const CAMERA: &str = "60 0 8\n0 60 6\n0 0 1\n";

thread_local! {
    static FOLDER: OnceCell<Folder> = const { OnceCell::new() };
}

impl Folder {
    fn new() -> Self {
        // In memory where that is possible: a hundred thousand files are written there.
        let shared = Path::new("/dev/shm");
        let folder = if shared.is_dir() { tempfile::tempdir_in(shared) } else { tempfile::tempdir() };
        let folder = folder.expect("a folder for files");
        let read = |name| crate::seeds::file(name).expect("a sample of every kind");
        let (depth, mask) = (read("depth.png"), read("mask.png"));
        Self { folder, depth, mask }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a file in memory");
        path
    }

    /// Reads a scan of one image after the file `name` has been written.
    fn scan(&self, name: &str) {
        let missing = |other: &str| !self.path(other).exists();
        if name != "depth.png" && missing("depth.png") {
            self.write("depth.png", &self.depth);
        }
        if name != "mask.png" && missing("mask.png") {
            self.write("mask.png", &self.mask);
        }
        let camera = match name {
            "camera.txt" | "camera.json" => self.path(name),
            _ => self.write("fine_camera.txt", CAMERA.as_bytes()),
        };
        let poses = match name {
            "pose.txt" | "poses.txt" | "poses.log" | "poses.tum" => Some(self.path(name)),
            _ => None,
        };
        let depth = if matches!(name, "list.txt" | "poses.tum") && !missing("list.txt") {
            self.path("list.txt")
        } else {
            self.path("depth.png")
        };
        let text = |path: PathBuf| path.to_str().expect("a name without other characters").to_string();
        let sources = ScanSources {
            depth: text(depth),
            camera,
            poses: poses.map(text),
            masks: (name == "mask.png").then(|| (text(self.path("mask.png")), 1)),
            depth_scale: None,
            world_to_camera: false,
        };
        match read_scan(&sources) {
            Ok(scan) => {
                assert!(!scan.frames.is_empty());
                for frame in &scan.frames {
                    let image = frame.image().expect("a frame of a scan is an image");
                    assert!((image.pose().rotation.coords.norm() - 1.0).abs() < 1e-4);
                }
            }
            Err(error) => said(&error),
        }
    }
}

fn is_finite(points: &[[f32; 3]]) -> bool {
    points.as_flattened().iter().all(|x| x.is_finite())
}

fn check_mesh(mesh: &MeshFile) {
    let count = mesh.vertices.len();
    assert!(is_finite(&mesh.vertices) && !mesh.triangles.is_empty());
    for [a, b, c] in &mesh.triangles {
        assert!(a != b && b != c && c != a && [a, b, c].iter().all(|index| (**index as usize) < count));
    }
    // The core may refuse coordinates that are too large.
    let _ = mesh.mesh();
}

fn check_cloud(cloud: &CloudFile) {
    assert!(is_finite(&cloud.points) && !cloud.points.is_empty());
    if let Some(normals) = &cloud.normals {
        assert!(is_finite(normals) && normals.len() == cloud.points.len());
        let is_unit = |n: &[f32; 3]| {
            let length = n.iter().map(|x| x * x).sum::<f32>().sqrt();
            length == 0.0 || (length - 1.0).abs() < 1e-5
        };
        assert!(normals.iter().all(is_unit));
    }
    let _ = cloud.cloud();
}

/// An error says something, in a few lines.
fn said(error: &dyn Display) {
    let text = error.to_string();
    assert!(!text.is_empty() && text.len() < 20_000, "{text}");
}

/// An error of a reader names the file.
fn named(path: &Path, error: &dyn Display) {
    said(error);
    assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
}

/// Reads one file: the first byte says of which kind, the others are its content.
pub fn run(data: &[u8]) {
    let mut draw = Draw::new(data);
    let name = draw.pick(&KINDS);
    let content = draw.rest();
    FOLDER.with(|folder| {
        let folder = folder.get_or_init(Folder::new);
        let path = folder.write(name, content);
        let ((), held) = peak_of(|| read(folder, name, &path));
        let each = if name.ends_with(".png") { EACH_BYTE_OF_PNG } else { EACH_BYTE };
        let most = ANYWAY + each * content.len();
        assert!(held <= most, "{name}: {held} bytes were held for a file of {}", content.len());
        std::fs::remove_file(&path).expect("the file exists");
    });
}

fn read(folder: &Folder, name: &str, path: &Path) {
    match name {
        "depth.png" => {
            if let Ok(image) = read_depth(path) {
                assert_eq!(image.depths.len(), image.size[0] as usize * image.size[1] as usize);
            }
            folder.scan(name);
        }
        "mask.png" => {
            if let Ok(mask) = read_mask(path) {
                assert_eq!(mask.labels.len(), mask.size[0] as usize * mask.size[1] as usize);
            }
            folder.scan(name);
        }
        "pose.json" => {
            if let Err(error) = pose_file::pose(path, [0.0; 3]) {
                said(&format!("{error:#}"));
            }
            match pose_file::hanging_pose(path, 1, [0.0; 3]) {
                Ok(pose) => assert!((pose.pose.rotation.coords.norm() - 1.0).abs() < 1e-4),
                Err(error) => said(&format!("{error:#}")),
            }
        }
        "gripper.toml" => match gripper::Hand::read(path) {
            Ok(hand) => drop(hand.gripper()),
            Err(error) => said(&format!("{error:#}")),
        },
        "params.toml" => {
            let text = String::from_utf8_lossy(&std::fs::read(path).expect("written just now")).into_owned();
            match toml::from_str::<Params>(&text) {
                Ok(params) => drop(params.validate()),
                Err(error) => said(&error),
            }
        }
        "a.pcd" | "a.xyz" => {
            match read_cloud(path) {
                Ok(cloud) => check_cloud(&cloud),
                Err(error) => named(path, &error),
            }
            assert!(read_mesh(path).is_err());
        }
        "a.obj" | "a.stl" | "a.ply" | "a.gltf" | "a.glb" | "a.urdf" => {
            // The mesh or the cloud, then the other, which it cannot be.
            match read_supporter(path) {
                Ok(SupporterFile::Mesh(mesh)) => {
                    check_mesh(&mesh);
                    assert!(read_cloud(path).is_err());
                }
                Ok(SupporterFile::Cloud(cloud)) => check_cloud(&cloud),
                Err(error) => named(path, &error),
            }
        }
        _ => folder.scan(name),
    }
}
