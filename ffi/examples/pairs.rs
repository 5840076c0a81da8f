//! Writes objects, supporters and what Rust predicts for them, for ffi/tests/c/pairs.c to hold the archive against:
//! `cargo run -p hangpose-ffi --example pairs -- folder`.
//!
//! Each file is little-endian words of 32 bits: profile; vertices, triangles, points; the three arrays and the normals;
//! then what is expected: status, poses, and from `hangpose_prediction` the stage and the counts; and for each pose what
//! follows `struct_size` in `hangpose_pose`.

use hangpose::geometry::{Cloud, Mesh, Pose};
use hangpose::hanging::{HangingPose, MatchingCounts, SettlingCounts};
use hangpose::mechanics::{DIRECTIONS, MAX_CONTACTS};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files, predict_poses};
use std::error::Error;
use std::f32::consts::TAU;
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
    // Rings on which everything fits, and one that is too small for any peg.
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
    let params = if profile == 1 { Params::paper() } else { Params::default() };
    let (mesh, cloud) =
        (Mesh::new(&thing.vertices, &thing.triangles)?, Cloud::new(&support.points, Some(&support.normals))?);
    let (mut memory, mut more_memory, monitor) = (Vec::new(), Vec::new(), Monitor::new());
    let object = analyze_object(&mesh, &params, &mut memory, &monitor)?;
    let supporter = analyze_supporter(&cloud, &params, &mut more_memory, &monitor)?;
    let mut poses = [HangingPose::default(); CAPACITY];
    let found = predict_poses(&object, &supporter, &params, &mut poses, &monitor)?;

    let floats = |rows: &[[f32; 3]]| rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    let (vertices, triangles) = (&thing.vertices, &thing.triangles);
    let mut words = vec![profile, vertices.len() as u32, triangles.len() as u32, support.points.len() as u32];
    words.extend(floats(vertices));
    words.extend(triangles.iter().flatten());
    words.extend(floats(&support.points));
    words.extend(floats(&support.normals));
    words.extend([
        u32::from(found.poses.is_empty()),
        found.poses.len() as u32,
        found.rejection.map_or(0, |rejection| rejection.stage as u32 + 1),
    ]);
    let MatchingCounts { pairs, fitting, clear } = found.counts.matching;
    words.extend([pairs, fitting, clear].map(|count| count as u32));
    let SettlingCounts {
        candidates,
        clear,
        released,
        rotated_off,
        slid_off,
        moving,
        at_rest,
        wedged,
        probable,
        firm,
    } = found.counts.settling;
    let settling =
        [candidates, clear, released, rotated_off, slid_off, moving, at_rest, wedged, probable, firm];
    words.extend(settling.map(|count| count as u32));
    found.poses.iter().for_each(|pose| words.extend(pose_words(pose)));
    Ok(words)
}

fn pose_words(hanging: &HangingPose) -> Vec<u32> {
    let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let pose = |pose: &Pose| {
        [bits(pose.translation.vector.as_slice()), bits(pose.rotation.coords.as_slice())].concat()
    };
    let mut words = pose(&hanging.pose);
    words.push(u32::from(hanging.rest.is_some()));
    if let Some(rest) = &hanging.rest {
        words.push(rest.probability.to_bits());
        words.extend(pose(&rest.pose));
        words.extend(bits(&[rest.sinking, rest.clearance]));
        let margin = &rest.margin;
        words.extend(bits(&margin.tilts));
        words.extend(bits(&[margin.least_tilt(), margin.jolt_time, margin.tilted_sinking]));
        words.extend(bits(&[margin.escape_rise, margin.escape_ratio]));
        words.extend(bits(&[margin.knock_speed, margin.centre_of_mass_radius]));
        words.push(rest.contacts().len() as u32);
        for place in 0..MAX_CONTACTS {
            let contact = rest.contacts().get(place).copied().unwrap_or_default();
            words.extend(bits(contact.position.coords.as_slice()));
            words.extend(bits(contact.normal.as_slice()));
            words.push(contact.force.to_bits());
        }
    } else {
        words.extend([f32::NAN.to_bits(); 1 + 7 + 2 + DIRECTIONS + 7]);
        words.extend([0; 1 + 7 * MAX_CONTACTS]);
    }
    words.push(u32::from(hanging.matched.is_some()));
    if let Some(matched) = &hanging.matched {
        let cost = &matched.cost;
        words.extend([matched.object_site, matched.support_site]);
        words.extend([u32::from(matched.is_reversed), cost.collision]);
        words.extend(bits(&[cost.boundary, cost.contact_area, cost.total]));
    } else {
        words.extend([u32::MAX, u32::MAX, 0, 0]);
        words.extend([f32::NAN.to_bits(); 3]);
    }
    words
}

/// A ring around z.
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

/// A peg along y, 8 cm long, that rises by `rise` metres a metre.
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
