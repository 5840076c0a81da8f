//! `cargo bench`: time of each stage and memory of one prediction, for the samples on one thread.

use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::{Monitor, Params, files};
use std::path::Path;
use std::time::Instant;

const RUNS: usize = 15;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    println!("median of {RUNS} runs, milliseconds; memory is models and scratch, MiB");
    println!("object    supporter  profile    object  supporter  matching    total   memory");
    for (object, supporter) in
        [("mug", "mug_tree"), ("mug", "hook"), ("scissors", "mug_tree"), ("scissors", "hook")]
    {
        let object_file = files::read_mesh(&samples.join(format!("{object}.obj")))?;
        let supporter_file = files::read_cloud(&samples.join(format!("{supporter}.ply")))?;
        for (profile, params) in [("paper", Params::paper()), ("default", Params::default())] {
            let (mesh, cloud, monitor) = (object_file.mesh()?, supporter_file.cloud()?, Monitor::new());
            let limits = Limits { points: cloud.points().len(), ..Object::limits(&mesh, &params) };
            let sizes = [Object::bytes(&limits), Supporter::bytes(&limits), predict_bytes(&limits)];
            let mut memory = sizes.map(|size| vec![0; size]);
            let mebibytes = sizes.iter().sum::<usize>() as f64 / f64::from(1 << 20);
            let mut times = [const { Vec::new() }; 4];
            for _ in 0..RUNS {
                let [object_memory, supporter_memory, scratch] = &mut memory;
                let start = Instant::now();
                let object = Object::analyze(&mesh, &params, object_memory, &monitor)?;
                let after_object = Instant::now();
                let supporter = Supporter::analyze(&cloud, &params, supporter_memory, &monitor)?;
                let after_supporter = Instant::now();
                let mut poses = [HangingPose::default(); 10];
                std::hint::black_box(predict(
                    &object,
                    &supporter,
                    &Request::ANY,
                    &params,
                    &mut poses,
                    scratch,
                    &monitor,
                )?);
                let end = Instant::now();
                let stages = [
                    after_object - start,
                    after_supporter - after_object,
                    end - after_supporter,
                    end - start,
                ];
                for (times, stage) in times.iter_mut().zip(stages) {
                    times.push(stage);
                }
            }
            let [object_time, supporter_time, matching, total] = times.map(|mut stage| {
                stage.sort();
                stage[RUNS / 2].as_secs_f64() * 1000.0
            });
            println!(
                "{object:9} {supporter:10} {profile:8} {object_time:8.1}  {supporter_time:9.1} {matching:9.1} {total:8.1} {mebibytes:8.2}"
            );
        }
    }
    Ok(())
}
