//! From depth images to poses.

use super::images::{depth_png, matrix, png};
use super::*;
use hangpose::files::{MeshFile, read_mesh};
use hangpose::geometry::{Point, Pose, Vector};
use hangpose::parry::pose_to_parry;
use parry3d::math;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;
use png::{BitDepth, ColorType};

const SIZE: [u32; 2] = [200, 150];
/// fx and fy, pixels.
const FOCAL: f32 = 220.0;
/// Where the origin of the mug is in the world, whose origin is that of the hook.
const MUG: [f32; 3] = [0.12, 0.18, 0.0];
/// Labels in the masks.
const MUG_LABEL: u8 = 7;
const HOOK_LABEL: u8 = 2;
/// Directions to the cameras from the middle between both.
const EYES: [[f32; 3]; 7] = [
    [1.0, 0.1, 0.5],
    [0.6, 0.8, 0.5],
    [-0.5, 0.9, 0.4],
    [-0.9, -0.4, 0.6],
    [0.5, -0.8, 0.5],
    [0.1, 0.1, 1.0],
    [0.3, 0.3, -1.0],
];

/// A folder with images of the sample mug beside the sample hook.
struct Images {
    folder: TempDir,
}

impl Images {
    fn new() -> Self {
        let images = Self { folder: tempfile::tempdir().unwrap() };
        let [cx, cy] = SIZE.map(|size| (size as f32 - 1.0) / 2.0);
        images.write("camera.txt", format!("{FOCAL} 0 {cx}\n0 {FOCAL} {cy}\n0 0 1\n"));
        let meshes = [trimesh("mug.obj", MUG.into()), trimesh("hook.obj", Vector::zeros())];
        let middle = Point::new(0.08, 0.1, 0.0);
        for (i, eye) in EYES.iter().enumerate() {
            let eye = middle + Vector::from(*eye).normalize() * 0.42;
            let pose = Pose::face_towards(&eye, &middle, &Vector::new(0.01, 0.0, -1.0));
            let (depths, labels) = render(&meshes, &pose);
            images.write(&format!("depth-{i}.png"), depth_png(SIZE, &depths));
            images.write(&format!("mask-{i}.png"), png(SIZE, ColorType::Grayscale, BitDepth::Eight, &labels));
            images.write(&format!("pose-{i}.txt"), matrix(&pose));
            images.write(&format!("inverse-{i}.txt"), matrix(&pose.inverse()));
        }
        images
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.folder.path().join(name), content).unwrap();
    }

    /// Runs the command in the folder.
    fn run(&self, arguments: &str) -> Run {
        finish(command().current_dir(self.folder.path()).args(arguments.split_whitespace()))
    }
}

fn trimesh(name: &str, shift: Vector) -> TriMesh {
    let MeshFile { vertices, triangles, .. } = read_mesh(&sample(name)).unwrap();
    let moved = |vertex: [f32; 3]| <[f32; 3]>::from(Vector::from(vertex) + shift).into();
    TriMesh::new(vertices.into_iter().map(moved).collect(), triangles).unwrap()
}

/// Depths in tenths of a millimetre, and labels.
fn render(meshes: &[TriMesh; 2], pose: &Pose) -> (Vec<u16>, Vec<u8>) {
    let to_world = pose_to_parry(pose);
    let [cx, cy] = SIZE.map(|size| (size as f32 - 1.0) / 2.0);
    let pixels = (0..SIZE[1]).flat_map(|v| (0..SIZE[0]).map(move |u| (u as f32, v as f32)));
    let pixel = |(u, v): (f32, f32)| {
        let direction = math::Vector::new((u - cx) / FOCAL, (v - cy) / FOCAL, 1.0);
        let ray = Ray::new(to_world.translation, to_world.transform_vector(direction));
        let [mug, hook] = meshes.each_ref().map(|mesh| mesh.cast_local_ray(&ray, 2.0, false).unwrap_or(2.0));
        let depth = mug.min(hook);
        if depth < 2.0 {
            ((depth * 10_000.0) as u16, if mug < hook { MUG_LABEL } else { HOOK_LABEL })
        } else {
            (0, 0)
        }
    };
    pixels.map(pixel).unzip()
}

const BOTH: &str = "predict --depth depth-*.png --camera camera.txt --depth-scale 0.0001 --poses pose-*.txt";
const MASKS: &str = "--mask mask-*.png --object-label 7 --supporter-label 2";

/// Asserts that the mug hangs on the hook: its origin is as far from the hook as a mug's is that hangs by its handle.
#[track_caller]
fn assert_hangs(run: &Run) {
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    let pose = numbers::<16>(&run.json()["poses"][0]["rest_pose"]);
    let origin = transform(&pose, MUG.map(f64::from));
    assert!(origin[2] < -0.01 && distance(origin, [0.05, 0.0, 0.0]) < 0.12, "{origin:?}");
}

#[test]
fn a_mug_and_a_hook_in_the_same_images_give_poses_from_world_to_world() {
    let images = Images::new();
    let run = images.run(&format!("{BOTH} {MASKS} --json -"));
    assert!(run.stderr.contains("--depth, object: the images show "), "{}", run.stderr);
    assert_hangs(&run);
}

#[test]
fn either_side_may_be_images() {
    let images = Images::new();
    let (mug, hook) = (sample("mug.obj"), sample("hook.ply"));
    let how = "--camera camera.txt --depth-scale 0.0001";
    let seen_hook =
        "depth depth-*.png --supporter-poses pose-*.txt --supporter-mask mask-*.png --supporter-label 2";
    let run = images.run(&format!("predict --object {} --supporter-{seen_hook} {how}", mug.display()));
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    let seen_mug = "depth depth-*.png --object-poses pose-*.txt --object-mask mask-*.png --object-label 7";
    let run =
        images.run(&format!("predict --supporter {} --object-{seen_mug} {how} --json -", hook.display()));
    assert_hangs(&run);

    let cloud = "--poses pose-*.txt --mask mask-*.png --label 2 --cloud -o hook.ply --viewpoints eyes.json";
    let run = images.run(&format!("scan --depth depth-*.png {how} {cloud}"));
    assert!(run.status == Some(0) && run.stdout.contains("; cloud of "), "{}", run.stderr);
    let run = images.run(&format!("predict --object {} --supporter hook.ply", mug.display()));
    assert_eq!(run.status, Some(0), "{}", run.stderr);

    // The mesh keeps its viewpoints, and others may be given.
    let mesh = "--poses pose-*.txt --mask mask-*.png --label 7 --complete -o mug.ply";
    let run = images.run(&format!("scan --depth depth-*.png {how} {mesh}"));
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    let unseen = |more: &str| {
        let run = images
            .run(&format!("predict --object mug.ply --supporter {} --top 1 --json - {more}", hook.display()));
        run.json()["poses"][0]["unseen"]["object"].as_f64().unwrap()
    };
    let mesh = read_mesh(&images.folder.path().join("mug.ply")).unwrap();
    assert_eq!(mesh.viewpoints.len(), EYES.len());
    assert!(unseen("") < 0.2, "the images look from all sides");
    assert!((unseen("--object-viewpoint 0,0,1") - 0.75).abs() < 0.02);
}

#[test]
fn mistakes_are_named_with_the_option() {
    let images = Images::new();
    let one = "predict --object-depth depth-*.png --supporter hook.ply";
    for (arguments, status, parts) in [
        (BOTH.to_string(), 2, &["--mask", "--object-crop"][..]),
        (format!("{BOTH} --mask mask-*.png --object-label 7"), 2, &["--supporter-label"]),
        (format!("{BOTH} {MASKS} --object mug.obj"), 2, &["--object", "--depth"]),
        (format!("{one} --object-poses pose-*.txt"), 2, &["--object-depth", "--object-camera"]),
        (format!("{one} --camera camera.txt --poses pose-*.txt"), 2, &["--object-depth: ", "--object-poses"]),
        (format!("{BOTH} {MASKS} --object-poses pose-*.txt"), 2, &["--depth, object: ", "--poses"]),
        (format!("{one} --object-scale 0.001 --camera camera.txt"), 2, &["--object-scale"]),
        (format!("{one} --object-label 7 --camera camera.txt"), 2, &["--object-mask"]),
        ("predict --object mug.obj --supporter hook.ply --camera camera.txt".into(), 2, &["--camera"]),
        (format!("{one} --camera camera.txt"), 1, &["error: --object-depth: ", "(--object-poses)"]),
        (format!("{BOTH} {MASKS} --depth-scale 1"), 2, &["--depth-scale"]),
        (
            format!("{BOTH} {MASKS}").replace("0.0001", "1"),
            1,
            &["--depth, object: ", "(--depth-scale 0.001)"],
        ),
        (format!("{BOTH} {MASKS}").replace("label 7", "label 9"), 1, &["label 9", "[2, 7]"]),
        (
            format!("{BOTH} {MASKS} --supporter-crop 3,3,3,4,4,4"),
            1,
            &["--depth, supporter: ", "--supporter-crop"],
        ),
        (
            format!("{BOTH} {MASKS}").replace("pose-", "inverse-"),
            1,
            &["--depth, object: ", "--world-to-camera"],
        ),
    ] {
        let run = images.run(&arguments);
        assert_eq!((run.status, run.stdout.as_str()), (Some(status), ""), "{arguments}\n{}", run.stderr);
        assert!(parts.iter().all(|part| run.stderr.contains(part)), "{arguments}\n{}", run.stderr);
    }
}
