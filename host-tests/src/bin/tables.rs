//! Predicts poses for many pairs, drops them in Bullet and ODE, and writes the tables.

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use hangpose::{Candidates, Params};
use host_tests::shapes::OBJECTS;
use host_tests::tables::run::{Engine, Options, run};
use host_tests::tables::{case, real, report};
use indicatif::ProgressBar;
use std::path::PathBuf;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Profiles, with commas between them.
    #[arg(long, value_delimiter = ',', default_value = "paper,default")]
    profile: Vec<Profile>,
    /// Pairs that fit, made by the shape library; two thirds as many that cannot hang, and a fifteenth as many on several contacts,
    /// come on top.
    #[arg(long, default_value_t = 600)]
    pairs: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only pairs with this kind of object, such as "cap", out of all that are made: what a hundred pairs say of one kind.
    #[arg(long, value_name = "KIND", value_parser = object_kind)]
    only: Option<String>,
    /// Who judges. With both, the tables are Bullet's, and ODE is asked about the best pose of
    /// made pairs.
    #[arg(long, value_enum, default_value_t = Engine::Both)]
    engine: Engine,
    /// A folder of real meshes with a manifest.json, judged as well.
    #[arg(long, value_name = "DIR")]
    meshes: Option<PathBuf>,
    /// Pairs of real meshes at most.
    #[arg(long, default_value_t = 200)]
    real_pairs: usize,
    /// Where the tables go.
    #[arg(long, value_name = "FILE", default_value = "docs/RESULTS.md")]
    out: PathBuf,
    /// Where each row goes as it comes, a line of JSON each.
    #[arg(long, value_name = "FILE", default_value = "build/tables.jsonl")]
    json: PathBuf,
    /// A folder for a picture of each best pose, at release and at rest, named after what became of it.
    #[arg(long, value_name = "DIR")]
    gallery: Option<PathBuf>,
    /// Drop all of the ten best poses, not only until one succeeds: for the calibration of the probability.
    #[arg(long)]
    all: bool,
    /// Only the profiles side by side.
    #[arg(long)]
    summary: bool,
    /// Keep the rows that the JSON file has, instead of beginning anew.
    #[arg(long)]
    resume: bool,
    /// How many pairs at once.
    #[arg(long, default_value_t = std::thread::available_parallelism().map_or(1, Into::into))]
    threads: usize,
}

#[derive(Clone, Copy, ValueEnum)]
enum Profile {
    /// The published method.
    Paper,
    /// Ours.
    Default,
    /// The published method about the true centre of mass, without poses that collide.
    SitesOnly,
    /// The same, let go: only what stays is given, the most probable first.
    SitesSettled,
    /// Ours without gravity: the most promising contacts, as they are.
    ContactsOnly,
    /// Ours, at most eight poses let go once one stays.
    EightAttempts,
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
        }
    }
}

/// A name of a kind of object, as the tables have it.
fn object_kind(name: &str) -> Result<String, String> {
    let names = || OBJECTS.iter().map(|kind| kind.name);
    if names().any(|known| known == name) {
        return Ok(name.into());
    }
    Err(format!("there is no such kind of object; there are {}", names().collect::<Vec<_>>().join(", ")))
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
    let work = |mut cases: Vec<case::Case>, engine| {
        cases.retain(|case| arguments.only.as_ref().is_none_or(|kind| case.object_kind == *kind));
        let options = Options {
            profiles: &profiles,
            engine,
            threads: arguments.threads,
            record: &arguments.json,
            all: arguments.all,
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
        // ODE takes minutes for a scan's thousands of triangles against those of another.
        Some(folder) => {
            let engine = if arguments.engine == Engine::Both { Engine::Bullet } else { arguments.engine };
            work(real::real(folder, arguments.real_pairs)?, engine)?
        }
        None => Vec::new(),
    };
    let titled = [("Made pairs", &made), ("Several contacts", &several), ("Real meshes", &real)];
    let titled = titled.into_iter().filter(|(_, rows)| !rows.is_empty());
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
