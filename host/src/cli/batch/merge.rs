//! `hangpose merge`: joins the results of shards to the result of one run.

use super::super::output::Output;
use super::super::{MergeArguments, terminal};
use super::pairs::{self, Name};
use super::read;
use super::row::Row;
use super::table::{self, Format};
use anyhow::{Context, Result, bail, ensure};
use std::collections::HashMap;
use std::path::Path;
use std::process::ExitCode;

/// Number of missing pairs that a message names.
const NAMED: usize = 5;

pub(crate) fn run(arguments: &MergeArguments) -> Result<ExitCode> {
    let (table, output) = (&arguments.pairs, &arguments.output);
    let format = Format::of(output)?;
    let pairs = pairs::names(table, &read(table)?)?;
    let inputs: Vec<&Path> = arguments.shards.iter().chain([table]).map(|path| path.as_path()).collect();
    let destination = Output::prepare(output, &inputs)?;
    let (mut rows, mut origins) = (Vec::new(), HashMap::new());
    for shard in &arguments.shards {
        let found = table::read(shard)?;
        for row in &found {
            let origin = *origins.entry(row.pair).or_insert(shard);
            ensure!(
                origin == shard,
                "pair {} is in {} and in {}: give each shard once",
                row.pair,
                origin.display(),
                shard.display()
            );
        }
        rows.extend(found);
    }
    let rows = check(pairs.iter(), rows)
        .with_context(|| format!("the shards are not those of {}", table.display()))?;
    destination.write(format.bytes(&rows)?)?;
    terminal::print(format!(
        "{}: {} pairs of {} shards\n",
        output.display(),
        pairs.len(),
        arguments.shards.len()
    ))?;
    Ok(ExitCode::SUCCESS)
}

/// The rows in the order of the pairs. Fails unless they are the rows of exactly these pairs.
pub(super) fn check<'p>(pairs: impl ExactSizeIterator<Item = &'p Name>, rows: Vec<Row>) -> Result<Vec<Row>> {
    let mut found: HashMap<u64, Vec<Row>> = HashMap::new();
    for row in rows {
        found.entry(row.pair).or_default().push(row);
    }
    let (mut sorted, mut missing, count) = (Vec::new(), Vec::new(), pairs.len());
    for pair in pairs {
        let Some(rows) = found.remove(&pair.number) else {
            missing.push(pair.number.to_string());
            continue;
        };
        let is_same =
            |row: &Row| (&row.id, &row.object, &row.supporter) == (&pair.id, &pair.object, &pair.supporter);
        if let Some(row) = rows.iter().find(|row| !is_same(row)) {
            bail!(
                "pair {} is {} on {} in the rows, but {} on {} in the table of pairs",
                pair.number,
                row.object,
                row.supporter,
                pair.object,
                pair.supporter
            );
        }
        sorted.extend(rows);
    }
    ensure!(
        missing.is_empty(),
        "{} of {count} pairs have no row: {}{}",
        missing.len(),
        missing[..missing.len().min(NAMED)].join(", "),
        if missing.len() > NAMED { ", ..." } else { "" }
    );
    if let Some(other) = found.keys().min() {
        bail!("there is a row of pair {other}, which is not among the pairs");
    }
    Ok(sorted)
}
