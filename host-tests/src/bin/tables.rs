//! Predicts poses for many pairs, simulates their release in Bullet and ODE, and writes the tables.

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use hangpose::{Candidates, Params};
use host_tests::scan::Spec;
use host_tests::shapes::OBJECTS;
use host_tests::tables::run::{Engine, Options, run};
use host_tests::tables::{case, real, report, scans};
use indicatif::ProgressBar;
use std::path::PathBuf;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Comma-separated profiles.
    #[arg(long, value_delimiter = ',', default_value = "paper,default")]
    profile: Vec<Profile>,
    /// Comma-separated scans on which to predict, instead of on the exact shapes: numbers of depth images of the object
    /// and of the supporter, such as 24+3, with an s for sensible single images, such as 1+1s, and
    /// with an o for meshes that are left open where no image shows the object, such as 1+1o. With 0 images, the exact
    /// shape is given. The tables go to the console.
    #[arg(long, value_delimiter = ',')]
    scan: Vec<Spec>,
    /// Number of generated pairs that fit. Two thirds as many that cannot hang, and a fifteenth as many on several
    /// contacts, are added.
    #[arg(long, default_value_t = 600)]
    pairs: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Restrict the generated pairs to this kind of object, such as "cap".
    #[arg(long, value_name = "KIND", value_parser = object_kind)]
    only: Option<String>,
    /// Number of points of each supporter's cloud where it is no scan.
    #[arg(long, default_value_t = case::POINTS)]
    points: usize,
    /// Engine that judges. With both, the tables are by Bullet, and ODE also judges the best pose of generated pairs.
    #[arg(long, value_enum, default_value_t = Engine::Both)]
    engine: Engine,
    /// Folder of real meshes with a manifest.json, which are evaluated as well.
    #[arg(long, value_name = "DIR")]
    meshes: Option<PathBuf>,
    /// Largest number of pairs of real meshes.
    #[arg(long, default_value_t = 200)]
    real_pairs: usize,
    /// File for the tables.
    #[arg(long, value_name = "FILE", default_value = "docs/RESULTS.md")]
    out: PathBuf,
    /// File for the rows, one line of JSON each.
    #[arg(long, value_name = "FILE", default_value = "build/tables.jsonl")]
    json: PathBuf,
    /// Folder for pictures of the best poses at release and at rest, named after their outcomes.
    #[arg(long, value_name = "DIR")]
    gallery: Option<PathBuf>,
    /// Judge all of the ten best poses, not only up to the first success, for the calibration of the probability.
    #[arg(long)]
    all: bool,
    /// Print only the tables that compare the profiles and those of how their best poses hang.
    #[arg(long)]
    summary: bool,
    /// Tell also by the motions that free the object how the best poses of generated pairs hang, as for real meshes.
    #[arg(long)]
    motion: bool,
    /// Keep the rows of the JSON file instead of starting over.
    #[arg(long)]
    resume: bool,
    /// Number of threads.
    #[arg(long, default_value_t = std::thread::available_parallelism().map_or(1, Into::into))]
    threads: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum Profile {
    /// The published method.
    Paper,
    /// The default method.
    Default,
    /// The sites of the published method with the true centre of mass, without colliding poses.
    SitesOnly,
    /// As `SitesOnly`, with simulated release: only poses that stay, the most probable first.
    SitesSettled,
    /// The default method without simulation: the most promising contact candidates.
    ContactsOnly,
    /// The default method with at most eight releases once a pose stays.
    EightAttempts,
    /// The default method with poses of any probability, for the calibration on scans.
    Improbable,
}

impl Profile {
    fn params(self) -> Params {
        let ours = Params::default();
        let candidates = Candidates::Sites;
        match self {
            Self::Paper => Params::paper(),
            Self::Default => ours,
            Self::SitesOnly => Params { candidates, settle: false, ..ours },
            Self::SitesSettled => Params { candidates, ..ours },
            Self::ContactsOnly => Params { settle: false, ..ours },
            Self::EightAttempts => Params { settle_attempts: 32, ..ours },
            Self::Improbable => Params { min_probability: 0.0, ..ours },
        }
    }
}

/// Parses the name of a kind of object, as in the tables.
fn object_kind(name: &str) -> Result<String, String> {
    let names = || OBJECTS.iter().map(|kind| kind.name);
    if names().any(|known| known == name) {
        return Ok(name.into());
    }
    Err(format!("there is no such kind of object; the kinds are {}", names().collect::<Vec<_>>().join(", ")))
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let folders = [&arguments.out, &arguments.json].map(|file| file.parent());
    for folder in folders.into_iter().chain([arguments.gallery.as_deref()]).flatten() {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    if !arguments.resume && arguments.json.exists() {
        std::fs::remove_file(&arguments.json).with_context(|| arguments.json.display().to_string())?;
    }
    let profiles: Vec<(String, Params)> = arguments
        .profile
        .iter()
        .map(|profile| {
            let name = profile.to_possible_value().map_or_else(String::new, |value| value.get_name().into());
            (name, profile.params())
        })
        .collect();
    let scans_or_exact: Vec<Option<Spec>> = if arguments.scan.is_empty() {
        vec![None]
    } else {
        arguments.scan.iter().copied().map(Some).collect()
    };
    let work = |mut cases: Vec<case::Case>, engine| {
        cases.retain(|case| arguments.only.as_ref().is_none_or(|kind| case.object_kind == *kind));
        cases.iter_mut().for_each(|case| case.points = arguments.points);
        let options = Options {
            profiles: &profiles,
            scans: &scans_or_exact,
            engine,
            threads: arguments.threads,
            record: &arguments.json,
            all: arguments.all,
            motion: arguments.motion,
            gallery: arguments.gallery.as_deref(),
        };
        let bar = ProgressBar::new(0);
        run(&cases, &options, |done, all| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        })
    };
    let made = work(case::made(arguments.pairs, arguments.seed), arguments.engine)?;
    let several = work(case::several(arguments.pairs / 15, arguments.seed), arguments.engine)?;
    let real = match &arguments.meshes {
        // ODE takes minutes to collide the thousands of triangles of two scans.
        Some(folder) => {
            let engine = if arguments.engine == Engine::Both { Engine::Bullet } else { arguments.engine };
            work(real::real(folder, arguments.real_pairs)?, engine)?
        }
        None => Vec::new(),
    };
    let titled = [("Generated pairs", &made), ("Several contacts", &several), ("Real meshes", &real)];
    let titled = titled.into_iter().filter(|(_, rows)| !rows.is_empty());
    if !arguments.scan.is_empty() {
        titled.for_each(|(title, rows)| print!("{title}:\n\n{}", scans::tables(rows)));
        return Ok(());
    }
    if arguments.summary {
        titled.for_each(|(title, rows)| print!("{title}:\n\n{}", report::summary(rows)));
        return Ok(());
    }
    let mut text = report::heading(&made);
    titled.for_each(|(title, rows)| text += &report::tables(title, rows));
    std::fs::write(&arguments.out, text).with_context(|| arguments.out.display().to_string())?;
    println!("{}", arguments.out.display());
    Ok(())
}
