//! Measures predictions on one thread: the time of each stage over generated or real pairs that can hang, its growth with
//! the sizes of the inputs, and what `make bench` needs for other programs.

use anyhow::{Result, ensure};
use clap::{Args, Parser, Subcommand};
use hangpose::Params;
use hangpose::hanging::predict_bytes;
use host_tests::performance::export::export;
use host_tests::performance::growth::measure_growth;
use host_tests::performance::primitives::Data;
use host_tests::performance::refine::{refine, weld};
use host_tests::performance::stages::{Figures, STAGES, measure};
use host_tests::performance::step::Resting;
use host_tests::solid::Solid;
use host_tests::tables::case::{Case, Fit, made};
use host_tests::tables::real::real;
use serde::Serialize;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

#[derive(Parser)]
#[command(about, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    task: Option<Task>,
    #[command(flatten)]
    pairs: Pairs,
    /// Number of runs, of which the fastest counts, stage by stage.
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// File for the figures of each pair, one line of JSON each.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Profile that is measured, instead of both.
    #[arg(long)]
    profile: Option<String>,
}

#[derive(Args)]
struct Pairs {
    /// Number of generated pairs that fit.
    #[arg(long, default_value_t = 44)]
    pairs: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 61)]
    seed: u64,
    /// Also the pairs that cannot hang, two thirds as many.
    #[arg(long)]
    all: bool,
    /// Folder of real meshes with a manifest.json, to be measured instead.
    #[arg(long, value_name = "DIR")]
    meshes: Option<PathBuf>,
    /// Least number of triangles of an object; longest edges are halved until then. The surface stays the same.
    #[arg(long, default_value_t = 0)]
    triangles: usize,
}

#[derive(Subcommand)]
enum Task {
    /// Write the pairs to files, for other programs.
    Export {
        #[command(flatten)]
        pairs: Pairs,
        /// Folder for the files and their list.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Measure time and memory from 1,000 to 1,000,000 triangles and points.
    Growth {
        /// Largest size.
        #[arg(long, default_value_t = 1_000_000)]
        largest: usize,
        /// Number of runs, of which the fastest counts, stage by stage.
        #[arg(long, default_value_t = 3)]
        runs: usize,
        /// Folder of the samples.
        #[arg(long, value_name = "DIR", default_value = "samples")]
        samples: PathBuf,
        /// File for the figures, one line of JSON each.
        #[arg(long, value_name = "FILE")]
        json: PathBuf,
    },
    /// Write the data of the single queries, this project's answers, and the scene of the time steps, for other programs.
    Primitives {
        /// Folder of the samples.
        #[arg(long, value_name = "DIR", default_value = "samples")]
        samples: PathBuf,
        /// Folder for the files.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
}

/// Figures of one pair under one profile.
#[derive(Serialize)]
struct Row {
    pair: String,
    profile: &'static str,
    #[serde(flatten)]
    figures: Figures,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    match arguments.task {
        None => {
            let profiles = [("paper", Params::paper()), ("default", Params::default())];
            let chosen = |name: &str| arguments.profile.as_deref().is_none_or(|profile| profile == name);
            let profiles: Vec<_> = profiles.into_iter().filter(|(name, _)| chosen(name)).collect();
            ensure!(!profiles.is_empty(), "there are the profiles paper and default");
            let file = arguments.json.map(File::create).transpose()?;
            measure_pairs(&cases(&arguments.pairs)?, &profiles, arguments.runs, file)
        }
        Some(Task::Export { pairs, out }) => export(&cases(&pairs)?, &out),
        Some(Task::Growth { largest, runs, samples, json }) => {
            let mut file = File::create(json)?;
            println!("| axis | size | profile | object | supporter | matching, ms | memory, MiB |");
            println!("|---|--:|---|--:|--:|--:|--:|");
            measure_growth(&samples, largest, runs, |row| {
                let [object, supporter, matching] = row.figures.milliseconds;
                println!(
                    "| {} | {} | {} | {object:.1} | {supporter:.1} | {matching:.1} | {:.1} |",
                    row.axis,
                    row.size,
                    row.profile,
                    mebibytes(&row.figures)
                );
                Ok(writeln!(file, "{}", serde_json::to_string(&row)?)?)
            })
        }
        Some(Task::Primitives { samples, out }) => {
            Data::new(&samples)?.export(&out)?;
            let resting = Resting::new()?;
            let mut scene = resting.describe();
            scene["steps"] = resting
                .with(|object, supporter, _| {
                    resting.release(object, supporter, &mut vec![0; predict_bytes(&supporter.limits())])
                })?
                .into();
            scene["drift_in_bullet"] = resting.drift_in_bullet(0.5).into();
            Ok(std::fs::write(out.join("scene.json"), serde_json::to_string(&scene)?)?)
        }
    }
}

/// The pairs that are asked for.
fn cases(pairs: &Pairs) -> Result<Vec<Case>> {
    let mut cases = match &pairs.meshes {
        Some(folder) => real(folder, pairs.pairs)?,
        None => made(pairs.pairs, pairs.seed),
    };
    cases.retain(|case| pairs.all || case.fit != Fit::No);
    for case in &mut cases {
        let solid = Solid::clone(&case.object);
        if solid.triangles.len() < pairs.triangles {
            let (vertices, triangles) = refine(weld(&solid.vertices, &solid.triangles), pairs.triangles);
            case.object = Solid { vertices, triangles, ..solid }.into();
        }
    }
    Ok(cases)
}

fn measure_pairs(
    cases: &[Case],
    profiles: &[(&'static str, Params)],
    runs: usize,
    mut file: Option<File>,
) -> Result<()> {
    println!("{} pairs, the fastest of {runs} runs each, one thread, milliseconds", cases.len());
    println!("| profile | stage | median | 95 % | 99 % | most |\n|---|---|--:|--:|--:|--:|");
    for &(profile, ref params) in profiles {
        let mut all = Vec::new();
        for case in cases {
            let cloud = case.supporter_cloud();
            let params = Params { seed: case.seed, ..params.clone() };
            let figures = measure(&case.object.mesh(), &cloud.cloud()?, &params, runs)?;
            if let Some(file) = &mut file {
                let row = Row { pair: case.name.clone(), profile, figures: figures.clone() };
                writeln!(file, "{}", serde_json::to_string(&row)?)?;
            }
            all.push(figures);
        }
        for (k, stage) in STAGES.iter().enumerate() {
            print_row(profile, stage, all.iter().map(|figures| figures.milliseconds[k]));
        }
        let after_object = all.iter().map(|figures| figures.total() - figures.milliseconds[0]);
        print_row(profile, "supporter and matching", after_object);
        print_row(profile, "all", all.iter().map(Figures::total));
        let most = all.iter().map(mebibytes).fold(0.0, f64::max);
        println!("| {profile} | memory, MiB | | | | {most:.1} |");
    }
    Ok(())
}

fn mebibytes(figures: &Figures) -> f64 {
    figures.bytes.iter().sum::<usize>() as f64 / f64::from(1 << 20)
}

fn print_row(profile: &str, stage: &str, values: impl Iterator<Item = f64>) {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    println!("| {profile} | {stage} | {:.1} | {:.1} | {:.1} | {:.1} |", at(0.5), at(0.95), at(0.99), at(1.0));
}
