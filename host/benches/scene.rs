//! `cargo bench`: time of a prediction with the default profile on the sample hook alone, and with 290,000 points of the room
//! around it: a wall behind the hook, a floor, and a table, with noise of a millimetre.

use hangpose::hanging::{HangingPose, Request, predict, predict_bytes};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files};
use std::path::Path;
use std::time::Instant;

const RUNS: usize = 9;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mug = files::read_mesh(&samples.join("mug.obj"))?;
    let hook = files::read_cloud(&samples.join("hook.ply"))?;
    let mut scene = hook.clone();
    scene.points.extend(room());
    scene.normals = None;
    let alone = files::CloudFile { normals: None, ..hook };
    let (params, monitor) = (Params::default(), Monitor::new());
    println!("median of {RUNS} runs, milliseconds, without normals");
    println!("cloud        points  supporter  matching   total   ratio");
    let mut of_hook = None;
    for (name, file) in [("hook alone", &alone), ("in a room", &scene)] {
        let (mesh, cloud) = (mug.mesh()?, file.cloud()?);
        let mut times = [const { Vec::new() }; 3];
        for _ in 0..RUNS {
            let (mut for_object, mut for_supporter) = (Vec::new(), Vec::new());
            let start = Instant::now();
            let object = analyze_object(&mesh, &params, &mut for_object, &monitor)?;
            let after_object = Instant::now();
            let supporter = analyze_supporter(&cloud, &params, &mut for_supporter, &monitor)?;
            let after_supporter = Instant::now();
            let mut scratch = vec![0; predict_bytes(&supporter.limits())];
            let mut poses = [HangingPose::default(); 10];
            std::hint::black_box(predict(
                &object,
                &supporter,
                &Request::ANY,
                &params,
                &mut poses,
                &mut scratch,
                &monitor,
            )?);
            let end = Instant::now();
            let stages = [after_supporter - after_object, end - after_supporter, end - start];
            for (times, stage) in times.iter_mut().zip(stages) {
                times.push(stage);
            }
        }
        let [supporter, matching, total] = times.map(|mut stage| {
            stage.sort();
            stage[RUNS / 2].as_secs_f64() * 1000.0
        });
        let ratio = total / *of_hook.get_or_insert(total);
        println!("{name:11} {:7} {supporter:10.1} {matching:9.1} {total:7.1} {ratio:7.2}", file.points.len());
    }
    Ok(())
}

/// Points at random on a wall of 2 m by 2 m 10 cm behind the hook, on a floor of that size 1 m below it, and on a table.
fn room() -> impl Iterator<Item = [f32; 3]> {
    let mut state = 1_u64;
    let mut random = move || {
        // Knuth's generator (MMIX).
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    (0..290_000).map(move |index| {
        let [a, b, noise] = [2.0 * random() - 1.0, 2.0 * random() - 1.0, 0.002 * (random() - 0.5)];
        match index % 29 {
            0..13 => [-0.107 + noise, a, b],
            13..26 => [0.9 + a, b, -0.993 + noise],
            _ => [0.6 + 0.3 * a, 0.6 * b, -0.313 + noise],
        }
    })
}
