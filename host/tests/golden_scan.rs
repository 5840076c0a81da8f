//! Hashes of a volume's mesh and of the points of a depth image, which are the same on every machine.
//!
//! A changed hash says that the numbers of the fusion changed, not that they are wrong. After an intended change, use the
//! new hash, which the failing test prints.

use hangpose::Monitor;
use hangpose::geometry::{Point, Pose, Vector};
use hangpose::perception::depth::{DepthCamera, DepthImage};
use hangpose::perception::depth_points::{DepthPointsSettings, depth_points};
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Space, Volume, VolumeLimits, VolumeSettings};
use nalgebra::{Quaternion, UnitQuaternion};

const SIZE: [u32; 2] = [160, 120];
/// Radius of the ball around the origin, metres.
const RADIUS: f32 = 0.06;
/// Distance from the cameras to the ball, metres.
const AWAY: f32 = 0.4;
/// Rotations of the cameras around the ball, as quaternions x, y, z, w of any length.
const TURNS: [[f32; 4]; 4] =
    [[0.0, 0.0, 0.0, 1.0], [0.5, 0.1, 0.0, 1.0], [-0.3, 0.8, 0.2, 1.0], [0.1, -1.0, 0.6, 0.5]];

/// FNV-1a hash over the bits of numbers.
fn hash(numbers: impl IntoIterator<Item = u32>) -> String {
    let hash = numbers
        .into_iter()
        .flat_map(u32::to_le_bytes)
        .fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    format!("{hash:08x}")
}

/// The cameras' poses and depths in tenths of a millimetre, worked out with nothing but square roots: a ball before a wall.
fn views() -> Vec<(DepthCamera, Pose, Vec<u16>)> {
    let camera = DepthCamera::new(SIZE, [200.0, 201.0], [79.3, 60.1], [-0.1, 0.02, 1e-3, 0.0, 0.0]).unwrap();
    let view = |[x, y, z, w]: [f32; 4]| {
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let eye = rotation * Vector::new(0.0, 0.0, -AWAY);
        let depth = |u: u32, v: u32| {
            let [x, y] = camera.direction([u as f32, v as f32]);
            let square = x * x + y * y + 1.0;
            let root = AWAY * AWAY - square * (AWAY * AWAY - RADIUS * RADIUS);
            let depth = if root < 0.0 { 0.7 } else { (AWAY - root.sqrt()) / square };
            (depth * 10_000.0) as u16
        };
        let pixels = (0..SIZE[1]).flat_map(|v| (0..SIZE[0]).map(move |u| (u, v)));
        let depths = pixels.map(|(u, v)| depth(u, v)).collect();
        (camera, Pose::from_parts(eye.into(), rotation), depths)
    };
    TURNS.map(view).into()
}

#[test]
fn a_mesh_and_what_is_known_of_space_have_the_same_bytes_everywhere() {
    let limits = VolumeLimits { blocks: 8000 };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let settings = VolumeSettings { max_depth: 0.6, ..VolumeSettings::new(0.003) };
    let mut volume = Volume::new(&settings, &limits, &mut memory).unwrap();
    for (camera, pose, depths) in views() {
        let image = DepthImage::new(camera, &depths, 1e-4, pose).unwrap();
        volume.integrate(&image, None, &Monitor::new()).unwrap();
    }
    let mut scratch = vec![0; Isosurface::bytes(volume.blocks())];
    let surface = Isosurface::find(&volume, &mut scratch, &Monitor::new()).unwrap();
    let (mut vertices, mut triangles) =
        (vec![[0.0_f32; 3]; surface.vertices()], vec![[0; 3]; surface.triangles()]);
    surface.write(&mut vertices, &mut triangles).unwrap();
    assert!(vertices.len() > 3000);
    let mesh = vertices.iter().flatten().map(|x| x.to_bits()).chain(triangles.into_iter().flatten());
    let space = (0..30_000_u32).map(|i| {
        let place = [i % 31, i / 31 % 31, i / 961].map(|x| (x as f32 - 15.0) * 0.0051);
        match volume.space(&Point::from(place)) {
            Space::Free => 1,
            Space::Unknown => 2,
            Space::Surface(distance) => distance.to_bits(),
        }
    });
    let expected = ["3f55d37b", "e9147e1e"];
    assert_eq!([hash(mesh), hash(space)], expected);
}

#[test]
fn points_and_normals_have_the_same_bytes_everywhere() {
    let (camera, pose, depths) = views().swap_remove(2);
    let image = DepthImage::new(camera, &depths, 1e-4, pose).unwrap();
    let (mut points, mut normals) = (vec![[0.0_f32; 3]; depths.len()], vec![[0.0_f32; 3]; depths.len()]);
    let settings = DepthPointsSettings::default();
    let count = depth_points(&image, None, &settings, &mut points, &mut normals).unwrap().points;
    let numbers = points[..count].iter().chain(&normals[..count]).flatten().map(|x| x.to_bits());
    assert_eq!(hash(numbers), "73845bb4");
}
