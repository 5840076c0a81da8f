//! Writes objects, supporters and the predictions that Rust makes for them, for ffi/tests/c/pairs.c to compare with the
//! archive: `cargo run -p hangpose-ffi --example pairs -- folder`.
//!
//! The comparison proves that the C call, in the C caller's memory, gives the same bits as the Rust call. It does not
//! test the conversion from the core's types to the C structs, because both sides use it; tests/conversions.rs does.
//!
//! Each file holds little-endian words of 32 bits: profile; number of vertices, triangles and points; the three arrays
//! and the normals; the expected status; the words of `hangpose_prediction` from `pose_count` to
//! `settling_no_approach`, then its work; and for each pose the words of `hangpose_pose` after `struct_size`.

use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{HangingPose, Request};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files, predict_poses};
use hangpose_ffi::{
    HANGPOSE_OK, HANGPOSE_PROFILE_PAPER, HANGPOSE_REJECTED, hangpose_pose, hangpose_prediction,
};
use std::error::Error;
use std::f32::consts::TAU;
use std::mem::offset_of;
use std::path::Path;

const CAPACITY: usize = 10;

struct Thing {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

struct Support {
    points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: pairs folder")?;
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mut things = Vec::new();
    for name in ["mug.obj", "scissors.obj"] {
        let file = files::read_mesh(&samples.join(name))?;
        things.push(Thing { vertices: file.vertices, triangles: file.triangles });
    }
    // Two rings that fit on every supporter, and one that is too small for each of them.
    for (radius, thickness) in [(0.03, 0.003), (0.05, 0.008), (0.004, 0.002)] {
        things.push(ring(radius, thickness));
    }
    let mut supports = Vec::new();
    for name in ["hook.ply", "mug_tree.ply"] {
        let file = files::read_cloud(&samples.join(name))?;
        let normals = file.normals.ok_or("the samples have normals")?;
        supports.push(Support { points: file.points, normals });
    }
    for (radius, rise) in [(0.004, 0.0), (0.012, 0.3)] {
        supports.push(peg(radius, rise));
    }
    let mut written = 0;
    for (i, thing) in things.iter().enumerate() {
        for (j, support) in supports.iter().enumerate() {
            let profile = u32::from((i + j) % 2 == 1);
            let words = words(thing, support, profile)?;
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            std::fs::write(Path::new(&folder).join(format!("pair_{written:02}.bin")), bytes)?;
            written += 1;
        }
    }
    println!("{written} pairs");
    Ok(())
}

fn words(thing: &Thing, support: &Support, profile: u32) -> Result<Vec<u32>, Box<dyn Error>> {
    let params = if profile == HANGPOSE_PROFILE_PAPER { Params::paper() } else { Params::default() };
    let (mesh, cloud) =
        (Mesh::new(&thing.vertices, &thing.triangles)?, Cloud::new(&support.points, Some(&support.normals))?);
    let (mut memory, mut more_memory, monitor) = (Vec::new(), Vec::new(), Monitor::new());
    let object = analyze_object(&mesh, &params, &mut memory, &monitor)?;
    let supporter = analyze_supporter(&cloud, &params, &mut more_memory, &monitor)?;
    let mut poses = [HangingPose::default(); CAPACITY];
    let found = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor)?;

    let floats = |rows: &[[f32; 3]]| rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    let (vertices, triangles) = (&thing.vertices, &thing.triangles);
    let mut words = vec![profile, vertices.len() as u32, triangles.len() as u32, support.points.len() as u32];
    words.extend(floats(vertices));
    words.extend(triangles.iter().flatten());
    words.extend(floats(&support.points));
    words.extend(floats(&support.normals));
    let status = if found.poses.is_empty() { HANGPOSE_REJECTED } else { HANGPOSE_OK };
    words.push(status as u32);
    let prediction = hangpose_prediction::from(&found);
    let end = offset_of!(hangpose_prediction, settling_no_approach) + size_of::<u32>();
    words.extend(words_between(&prediction, offset_of!(hangpose_prediction, pose_count), end));
    for work in [prediction.rays, prediction.distance_queries] {
        words.extend([work as u32, (work >> 32) as u32]);
    }
    for pose in found.poses {
        let after_size = offset_of!(hangpose_pose, has_pose);
        words.extend(words_between(&hangpose_pose::from(pose), after_size, size_of::<hangpose_pose>()));
    }
    Ok(words)
}

/// The words of a C struct between two offsets in bytes, where there is no padding.
fn words_between<T>(of: &T, start: usize, end: usize) -> Vec<u32> {
    assert!(end <= size_of::<T>() && align_of::<T>() >= 4);
    let first = std::ptr::from_ref(of).cast::<u32>();
    // SAFETY: within the struct and aligned; every field in between is a number or an array of numbers of 32 bits.
    (start / 4..end / 4).map(|word| unsafe { first.add(word).read() }).collect()
}

/// A ring around the z axis; radius of the centre line and of the tube, metres.
fn ring(radius: f32, thickness: f32) -> Thing {
    const ROWS: u32 = 40;
    const COLUMNS: u32 = 14;
    let vertices = (0..ROWS * COLUMNS).map(|i| {
        let (around, across) = (turn(i / COLUMNS, ROWS), turn(i % COLUMNS, COLUMNS));
        let r = radius + thickness * libm::cosf(across);
        [r * libm::cosf(around), r * libm::sinf(around), thickness * libm::sinf(across)]
    });
    let triangles = (0..ROWS * COLUMNS).flat_map(|i| {
        let at = |row: u32, column: u32| row % ROWS * COLUMNS + column % COLUMNS;
        let (r, k) = (i / COLUMNS, i % COLUMNS);
        let [a, b, c, d] = [at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1)];
        [[a, b, c], [a, c, d]]
    });
    Thing { vertices: vertices.collect(), triangles: triangles.collect() }
}

/// A peg along the y axis, 8 cm long, with a slope of `rise`; radius in metres.
fn peg(radius: f32, rise: f32) -> Support {
    const COLUMNS: u32 = 30;
    let normals: Vec<[f32; 3]> = (0..80 * COLUMNS)
        .map(|i| turn(i % COLUMNS, COLUMNS))
        .map(|a| [libm::sinf(a), 0.0, libm::cosf(a)])
        .collect();
    let points = normals.iter().zip(0..).map(|(n, i)| {
        let along = 0.001 * (i / COLUMNS) as f32;
        [radius * n[0], along, radius * n[2] + rise * along]
    });
    Support { points: points.collect(), normals }
}

fn turn(step: u32, steps: u32) -> f32 {
    TAU * step as f32 / steps as f32
}
