//! Plans paths for generated pairs in several scenes, replays them in Bullet, and prints tables.

use anyhow::{Context, Result};
use clap::Parser;
use hangpose::motion::Motion;
use host_tests::reach::enclosed::Enclosure;
use host_tests::reach::report;
use host_tests::reach::row::Row;
use host_tests::reach::run::{Options, enclosure, pair, tree};
use host_tests::reach::surroundings::Around;
use host_tests::tables::case::{Fit, made};
use indicatif::ProgressBar;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Number of generated pairs that fit.
    #[arg(long, default_value_t = 110)]
    pairs: usize,
    /// Number of mug trees with one free branch.
    #[arg(long, default_value_t = 30)]
    trees: usize,
    /// Number of pairs of each kind that enclose each other; as many have a way out.
    #[arg(long, default_value_t = 30)]
    enclosed: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 51)]
    seed: u64,
    /// Comma-separated scenes of the generated pairs.
    #[arg(long, value_delimiter = ',', value_enum, default_value = "nothing,wall,shelf,neighbours")]
    scene: Vec<Around>,
    /// A gripper with two fingers holds the lower end of the object. Enclosed pairs have none.
    #[arg(long)]
    gripper: bool,
    /// OMPL's RRT-Connect plans the same problems, but for those with any start.
    #[arg(long, conflicts_with = "gripper")]
    peer: bool,
    /// Largest number of poses that are sampled.
    #[arg(long, default_value_t = Motion::DEFAULT.samples)]
    samples: usize,
    /// Capacity of either tree of the planner.
    #[arg(long, default_value_t = Motion::DEFAULT.nodes)]
    nodes: usize,
    /// Restrict the generated pairs to those whose name has this text.
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// File for the rows, one line of JSON each.
    #[arg(long, value_name = "FILE", default_value = "build/reach.jsonl")]
    json: PathBuf,
    /// File of which a section is replaced by the tables, or to which it is added. By default they go to the console.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Heading of that section.
    #[arg(long, default_value = "Paths")]
    section: String,
}

/// Draws of shapes for each pair that encloses, of which some do not fit.
const DRAWS: usize = 10;

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    if let Some(folder) = arguments.json.parent() {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let name = arguments.json.display().to_string();
    let mut file = std::fs::File::create(&arguments.json).with_context(|| name.clone())?;
    let motion = Motion { samples: arguments.samples, nodes: arguments.nodes, ..Motion::DEFAULT };
    let options = Options { motion, gripper: arguments.gripper, peer: arguments.peer };
    let mut cases = made(arguments.pairs, arguments.seed);
    cases.retain(|case| case.fit == Fit::Yes);
    cases.retain(|case| arguments.only.as_ref().is_none_or(|text| case.name.contains(text)));
    let bar = ProgressBar::new((cases.len() + arguments.trees + 8 * arguments.enclosed) as u64);
    let mut keep = |rows: &mut Vec<Row>, new: Vec<Row>| -> Result<()> {
        for row in &new {
            writeln!(file, "{}", serde_json::to_string(row)?).with_context(|| name.clone())?;
        }
        rows.extend(new);
        bar.inc(1);
        Ok(())
    };
    let [mut pairs, mut closed, mut opened] = [const { Vec::new() }; 3];
    for case in &cases {
        keep(&mut pairs, pair(case, &arguments.scene, &options).with_context(|| case.name.clone())?)?;
    }
    for k in 0..arguments.trees as u64 {
        let seed = arguments.seed.wrapping_mul(10_007).wrapping_add(k);
        let row = tree(seed, &options).with_context(|| format!("tree {seed}"))?;
        keep(&mut pairs, row.into_iter().collect())?;
    }
    for kind in [Enclosure::Rail, Enclosure::Loop, Enclosure::Cage, Enclosure::Slot] {
        for (rows, is_closed) in [(&mut closed, true), (&mut opened, false)] {
            let mut seeds = (0..(DRAWS * arguments.enclosed) as u64).map(|k| arguments.seed << 16 | k);
            for _ in 0..arguments.enclosed {
                let mut row = None;
                while row.is_none() {
                    let Some(seed) = seeds.next() else { break };
                    row = enclosure(kind, seed, is_closed, &options).with_context(|| kind.name())?;
                }
                keep(rows, row.into_iter().collect())?;
            }
        }
    }
    bar.finish_and_clear();
    let held = if arguments.gripper { ", held by a gripper with two fingers" } else { "" };
    let text = format!(
        "{} generated pairs of seed {}{held}, single thread.\n\n{}",
        cases.len(),
        arguments.seed,
        report::tables(&pairs, &closed, &opened)
    );
    match &arguments.out {
        Some(out) => replace_section(out, &format!("## {}", arguments.section), &text),
        None => {
            print!("{text}");
            Ok(())
        }
    }
}

/// Replaces the section of a file by this text, or adds it at the end.
fn replace_section(out: &Path, heading: &str, text: &str) -> Result<()> {
    let whole = std::fs::read_to_string(out).with_context(|| out.display().to_string())?;
    let mut lines: Vec<&str> = whole.lines().collect();
    let start = lines.iter().position(|line| line.trim_end() == heading).unwrap_or(lines.len());
    let after = lines.get(start + 1..).unwrap_or_default();
    let end = after.iter().position(|line| line.starts_with("## ")).map_or(lines.len(), |k| start + 1 + k);
    let tail = lines.split_off(end);
    lines.truncate(start);
    let [before, after] = [lines, tail].map(|lines| lines.join("\n"));
    let before = before.trim_end();
    let joined = format!("{before}\n\n{heading}\n\n{}\n\n{after}", text.trim_end());
    std::fs::write(out, joined.trim_end().to_owned() + "\n").with_context(|| out.display().to_string())
}
