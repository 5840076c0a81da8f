//! Measures the time of each stage of a prediction on one thread, over generated or real pairs that can hang.

use anyhow::Result;
use clap::Parser;
use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::{Monitor, Params};
use host_tests::tables::case::{Case, Fit, made};
use host_tests::tables::real::real;
use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Number of generated pairs that fit.
    #[arg(long, default_value_t = 44)]
    pairs: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 61)]
    seed: u64,
    /// Folder of real meshes with a manifest.json, to be measured instead.
    #[arg(long, value_name = "DIR")]
    meshes: Option<PathBuf>,
    /// Number of runs, of which the median counts.
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// File for the figures of each pair, one line of JSON each.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Stages that are measured.
const STAGES: [&str; 3] = ["object", "supporter", "prediction"];

/// Figures of one pair under one profile.
#[derive(serde::Serialize)]
struct Row {
    pair: String,
    profile: &'static str,
    triangles: usize,
    /// Durations of the stages, ms.
    milliseconds: [f64; STAGES.len()],
    /// Bytes of the object, the supporter and the prediction.
    bytes: [usize; STAGES.len()],
    poses: usize,
    released: usize,
}

impl Row {
    fn total(&self) -> f64 {
        self.milliseconds.iter().sum()
    }
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let mut cases = match &arguments.meshes {
        Some(folder) => real(folder, arguments.pairs)?,
        None => made(arguments.pairs, arguments.seed),
    };
    cases.retain(|case| case.fit != Fit::No);
    let mut file = arguments.json.map(std::fs::File::create).transpose()?;
    println!("{} pairs, median of {} runs each, one thread, milliseconds", cases.len(), arguments.runs);
    println!("| profile | stage | median | 95 % | most |\n|---|---|--:|--:|--:|");
    for (profile, params) in [("paper", Params::paper()), ("default", Params::default())] {
        let mut rows = Vec::new();
        for case in &cases {
            let row = measure(case, profile, &params, arguments.runs)?;
            if let Some(file) = &mut file {
                writeln!(file, "{}", serde_json::to_string(&row)?)?;
            }
            rows.push(row);
        }
        for (k, stage) in STAGES.iter().enumerate() {
            print_row(profile, stage, rows.iter().map(|row| row.milliseconds[k]));
        }
        print_row(
            profile,
            "supporter and prediction",
            rows.iter().map(|row| row.total() - row.milliseconds[0]),
        );
        print_row(profile, "all", rows.iter().map(Row::total));
        let most = rows.iter().map(|row| row.bytes.iter().sum::<usize>()).max().unwrap_or_default();
        println!("| {profile} | memory, MiB | | | {:.1} |", most as f64 / f64::from(1 << 20));
    }
    Ok(())
}

fn print_row(profile: &str, stage: &str, values: impl Iterator<Item = f64>) {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    println!("| {profile} | {stage} | {:.1} | {:.1} | {:.1} |", at(0.5), at(0.95), at(1.0));
}

/// Predicts a pair `runs` times.
fn measure(case: &Case, profile: &'static str, params: &Params, runs: usize) -> Result<Row> {
    let (mesh, cloud_file) = (case.object.mesh(), case.supporter_cloud());
    let (cloud, monitor) = (cloud_file.cloud()?, Monitor::new());
    let params = Params { seed: case.seed, ..params.clone() };
    let limits = Limits { points: cloud.points().len(), ..Object::limits(&mesh, &params) };
    let bytes = [Object::bytes(&limits), Supporter::bytes(&limits), predict_bytes(&limits)];
    let mut memory = bytes.map(|size| vec![0; size]);
    let mut times = [const { Vec::new() }; STAGES.len()];
    let (mut count, mut released) = (0, 0);
    for _ in 0..runs {
        let [object_memory, supporter_memory, scratch] = &mut memory;
        let mut poses = [HangingPose::default(); 10];
        let start = Instant::now();
        let object = Object::analyze(&mesh, &params, object_memory, &monitor)?;
        let after_object = Instant::now();
        let supporter = Supporter::analyze(&cloud, &params, supporter_memory, &monitor)?;
        let after_supporter = Instant::now();
        let prediction = predict(&object, &supporter, &Request::ANY, &params, &mut poses, scratch, &monitor)?;
        let stages = [after_object - start, after_supporter - after_object, after_supporter.elapsed()];
        (count, released) = (prediction.poses.len(), prediction.counts.settling.released);
        for (times, stage) in times.iter_mut().zip(stages) {
            times.push(stage.as_secs_f64() * 1000.0);
        }
    }
    let milliseconds = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[runs / 2]
    });
    let (pair, triangles) = (case.name.clone(), mesh.triangles().len());
    Ok(Row { pair, profile, triangles, milliseconds, bytes, poses: count, released })
}
