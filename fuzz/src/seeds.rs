//! Inputs to begin with: a small valid file of each kind, and cases that take most choices.

use crate::files::KINDS;
use crate::images_of_files::{depth_png, png};
use crate::mutate::Random;
use crate::samples::*;
use ::png::{BitDepth, ColorType};
use std::path::Path;

/// Width and height of the images of a scan, pixels.
const SIZE: [u32; 2] = [16, 12];

/// The content of a valid file with this name, one of [`KINDS`].
pub fn file(name: &str) -> Option<Vec<u8>> {
    let pixels = (SIZE[0] * SIZE[1]) as usize;
    let matrix = "1 0 0 0\n0 1 0 0\n0 0 1 0.1\n0 0 0 1\n";
    Some(match name {
        "a.obj" => obj_cube().into_bytes(),
        "a.stl" => stl_text_cube().into_bytes(),
        "a.ply" => ply_text_cube().into_bytes(),
        "a.gltf" => GLTF_TRIANGLE.into(),
        "a.glb" => glb_cube(r#"{"mesh":0,"scale":[1,-1,2]}"#),
        "a.urdf" => URDF.into(),
        "a.pcd" => pcd_text().into_bytes(),
        "a.xyz" => XYZ.into(),
        "depth.png" => depth_png(SIZE, &(0..pixels).map(|i| 500 + 3 * i as u16).collect::<Vec<_>>()),
        "mask.png" => {
            let labels: Vec<u8> = (0..pixels).map(|i| u8::from(i % 16 > 4)).collect();
            png(SIZE, ColorType::Grayscale, BitDepth::Eight, &labels)
        }
        "camera.txt" => "60 0 8\n0 60 6\n0 0 1\n".into(),
        "camera.json" => {
            r#"{"width":16,"height":12,"intrinsic_matrix":[60,0,0,0,60,0,8,6,1]}"#.into()
        }
        "pose.txt" | "poses.txt" => matrix.into(),
        "poses.log" => format!("0 0 1\n{matrix}").into_bytes(),
        "poses.tum" => "# time\n1305031453.0 0 0 0.1 0 0 0 1\n1305031454.0 0.5 0 0 0 0 1 0\n".into(),
        "list.txt" => "# depth\n1305031453.0 depth.png\n".into(),
        "pose.json" => {
            r#"{"poses":[{"position":[0.1,0,0.2],"quaternion_xyzw":[0,0,1,0],"rest_pose":[1,0,0,0,0,1,0,0,0,0,1,0.2,0,0,0,1]}]}"#
                .into()
        }
        "gripper.toml" => {
            "retreat = [0, 0, 0.1]\n[[part]]\nfrom = [0, 0, 0]\nto = [0, 0, 0.1]\nradius = 0.01\nopening = [0, 0.02, 0]\n"
                .into()
        }
        "params.toml" => {
            "samples = 500\ngravity = [0, 0, -1]\ncentre_of_mass = { given = [0.1, 0, -0.5] }\ncandidates = \"sites\"\n"
                .into()
        }
        _ => return None,
    })
}

/// Further variants of formats that have several.
fn variants() -> Vec<(&'static str, Vec<u8>)> {
    let bop = r#"{"0":{"cam_K":[60,0,8,0,60,6,0,0,1],"depth_scale":1.0,"cam_R_w2c":[1,0,0,0,1,0,0,0,1],"cam_t_w2c":[0,0,100]}}"#;
    let open3d = r#"{"extrinsic":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0.1,1],"intrinsic":{"width":16,"height":12,"intrinsic_matrix":[60,0,0,0,60,0,8,6,1]}}"#;
    vec![
        ("a.stl", stl_binary_cube("solid")),
        ("a.ply", ply_binary_cube(false)),
        ("a.ply", ply_binary_cube(true)),
        ("a.ply", PLY_CLOUD.into()),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .2 0\nf 1/1 2//2 \\\n3/3/3 -2 -1\n".into()),
        ("a.pcd", pcd_binary()),
        ("a.pcd", pcd_compressed()),
        ("camera.json", bop.into()),
        ("camera.json", open3d.into()),
        ("mask.png", png(SIZE, ColorType::Indexed, BitDepth::Four, &[0x10; 96])),
        ("pose.json", br#"{"position":[0.1,0,0.2],"quaternion_xyzw":[0,0,1,0]}"#.into()),
    ]
}

/// Files as inputs of [`crate::files::run`].
fn files() -> Vec<Vec<u8>> {
    let valid = KINDS.iter().map(|name| (*name, file(name).expect("a sample of every kind")));
    let of = |(name, content): (&str, Vec<u8>)| {
        let kind = KINDS.iter().position(|known| *known == name).expect("a known kind");
        [&[kind as u8], &content[..]].concat()
    };
    valid.chain(variants()).map(of).collect()
}

/// Seeds of a target that draws numbers: the plainest case, and cases that are made up.
fn made_up(count: u64, most: usize) -> Vec<Vec<u8>> {
    let made = (1..count).map(|seed| {
        let mut random = Random(seed);
        let length = 16 + random.below(most);
        // Small numbers, which take the plain choices, and any.
        let mask = [0x0f, 0x3f, 0xff][random.below(3)];
        (0..length).map(|_| random.bits() as u8 & mask).collect()
    });
    [vec![0; 16]].into_iter().chain(made).collect()
}

/// The inputs that a target begins with, without those that were found by fuzzing.
pub fn of(target: &str) -> Vec<Vec<u8>> {
    match target {
        "files" => files(),
        _ => made_up(48, 400),
    }
}

/// Inputs in a folder beside this crate: `corpus` are those that together take most ways through the library, `found` those
/// that broke a promise once.
pub fn stored(folder: &str, target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(target);
    let mut paths: Vec<_> =
        folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("an input beside this crate")).collect()
}
