//! `hangpose batch`: predicts many pairs, and `hangpose merge`: joins what several runs have predicted.

mod journal;
mod merge;
mod models;
mod options;
mod pairs;
mod row;
mod table;

pub(crate) use merge::run as merge;
pub(super) use options::Given;

use super::output::Output;
use super::{BatchArguments, progress, terminal};
use anyhow::{Context, Result, anyhow};
use hangpose::hanging::HangingPose;
use hangpose::{Monitor, predict_poses};
use journal::{Done, Journal, Run};
use models::{ObjectModel, Store, SupporterModel};
use pairs::Pair;
use row::Row;
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use table::Format;

/// Bytes of a MiB.
const MIB: usize = 1 << 20;

/// A part of the pairs: consecutive ones, so that each shard reads few files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shard {
    /// From 1.
    index: usize,
    count: usize,
}

impl Shard {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').map(|(index, count)| (index.parse(), count.parse()));
        match parts {
            Some((Ok(index), Ok(count))) if 1 <= index && index <= count => Ok(Self { index, count }),
            _ => Err("use i/n with i from 1 to n, as in 2/4".into()),
        }
    }

    /// Its part of so many pairs.
    fn range(self, pairs: usize) -> Range<usize> {
        let end = |index: usize| (index as u128 * pairs as u128 / self.count as u128) as usize;
        end(self.index - 1)..end(self.index)
    }
}

pub(crate) fn run(arguments: &BatchArguments) -> Result<ExitCode> {
    let start = Instant::now();
    let (table, output) = (&arguments.pairs, &arguments.output);
    let format = Format::of(output)?;
    let content = read(table)?;
    let all = pairs::read(table, &content, &arguments.given)?;
    let range = arguments.shard.range(all.len());
    let pairs = &all[range.clone()];
    let destination = Output::prepare(output, &inputs(table, pairs))?;
    // Beside the file that a symbolic link leads to, so that all runs that write it meet there.
    let journal_path = Journal::path(&std::fs::canonicalize(output).unwrap_or_else(|_| output.clone()));
    let run = Run {
        version: env!("CARGO_PKG_VERSION").into(),
        pairs: hash(&content),
        params: hash(
            pairs.iter().map(|pair| format!("{:?}\n", pair.wish.params)).collect::<String>().as_bytes(),
        ),
        options: arguments.given.in_words(),
        shard: [range.start, range.end],
    };
    if arguments.resume && output.is_file() && !journal_path.exists() {
        let rows = table::read(output)?;
        merge::check(pairs.iter().map(|pair| &pair.name), rows).with_context(|| {
            format!("{}: is there already, but not from these pairs; delete it", output.display())
        })?;
        terminal::print(format!("{}: is complete already\n", output.display()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let (journal, done) = Journal::open(&journal_path, &run, arguments.resume)?;
    let mut done: HashMap<u64, Vec<Row>> = done.into_iter().collect();
    let earlier = done.len();
    let todo: Vec<&Pair> = pairs.iter().filter(|pair| !done.contains_key(&pair.name.number)).collect();
    let journal = Mutex::new(journal);
    done.extend(predict_all(&todo, jobs(arguments), arguments.memory as usize * MIB, &journal)?);
    let rows: Vec<Row> = pairs.iter().filter_map(|pair| done.remove(&pair.name.number)).flatten().collect();
    destination.write(format.bytes(&rows)?)?;
    journal.into_inner().unwrap_or_else(PoisonError::into_inner).remove()?;
    terminal::print(summary(pairs.len(), earlier, &rows, output, start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

fn read(table: &Path) -> Result<Vec<u8>> {
    std::fs::read(table)
        .map_err(|error| anyhow!("{}: cannot be read ({error}); give a CSV file of pairs", table.display()))
}

/// The files that the result must not replace.
fn inputs<'a>(table: &'a Path, pairs: &'a [Pair]) -> Vec<&'a Path> {
    let mut files = vec![table];
    for pair in pairs {
        files.extend([pair.object_path.as_path(), &pair.supporter_path]);
        files.extend(pair.wish.options.method.params.as_deref());
        files.extend(pair.wish.options.request.file());
    }
    files.sort();
    files.dedup();
    files
}

/// Number of threads: that of the option, or of the processors that the process may use.
fn jobs(arguments: &BatchArguments) -> usize {
    let all = || std::thread::available_parallelism().map_or(1, |count| count.get());
    arguments.jobs.map_or_else(all, |jobs| jobs as usize)
}

/// Predicts pairs in their order on `jobs` threads, adds each to the journal as it is done, and returns their rows.
fn predict_all(pairs: &[&Pair], jobs: usize, memory: usize, journal: &Mutex<Journal>) -> Result<Vec<Done>> {
    // Half for either side.
    let objects = Store::<ObjectModel>::new(pairs.iter().copied(), memory / 2);
    let supporters = Store::<SupporterModel>::new(pairs.iter().copied(), memory / 2);
    let next = AtomicUsize::new(0);
    let bar = progress::of_pairs(pairs.len());
    let work = || {
        let mut done = Vec::new();
        while let Some(pair) = pairs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let rows = predict(pair, &objects, &supporters);
            objects.release(pair);
            supporters.release(pair);
            let added = journal.lock().unwrap_or_else(PoisonError::into_inner).add(pair.name.number, &rows);
            if added.is_err() {
                // Nothing more can be kept, so the other threads end, too.
                next.store(pairs.len(), Ordering::Relaxed);
            }
            added?;
            bar.inc(1);
            done.push((pair.name.number, rows));
        }
        Ok(done)
    };
    let shown = terminal::show_below(&bar);
    let found = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs.min(pairs.len())).map(|_| scope.spawn(work)).collect();
        let join = |worker: std::thread::ScopedJoinHandle<'_, Result<Vec<_>>>| {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        workers.into_iter().map(join).collect::<Result<Vec<_>>>()
    });
    drop(shown);
    Ok(found?.into_iter().flatten().collect())
}

/// The rows of a pair. An error becomes a row, too.
fn predict(pair: &Pair, objects: &Store<ObjectModel>, supporters: &Store<SupporterModel>) -> Vec<Row> {
    let predicted = || -> Result<Vec<Row>> {
        let (object, supporter) = (objects.get(pair), supporters.get(pair));
        let object =
            object.get().context("the object is read")?.as_ref().map_err(|error| anyhow!("{error}"))?;
        let supporter =
            supporter.get().context("the supporter is read")?.as_ref().map_err(|error| anyhow!("{error}"))?;
        let (options, params) = (&pair.wish.options, &pair.wish.params);
        let wishes = options.request.read(&options.frames, supporter.origin)?;
        let warnings = [&object.warnings[..], &supporter.warnings].concat().join("; ");
        let warning = Some(warnings.as_str()).filter(|warning| !warning.is_empty());
        let mut poses = vec![HangingPose::default(); options.top as usize];
        let found = predict_poses(
            object.object(),
            supporter.supporter(),
            &wishes.request()?,
            params,
            &mut poses,
            &Monitor::new(),
        )?;
        if found.poses.is_empty() {
            return Ok(vec![Row::rejected(pair, found.rejection.as_ref(), warning)]);
        }
        let row = |(rank, pose)| Row::hung(pair, rank, pose, supporter.origin, warning);
        Ok((1..).zip(found.poses).map(row).collect())
    };
    predicted().unwrap_or_else(|error| vec![Row::failed(pair, &format!("{error:#}"))])
}

/// What became of the pairs, in a line.
fn summary(pairs: usize, earlier: usize, rows: &[Row], output: &Path, seconds: f64) -> String {
    let hung = rows.iter().filter(|row| row.rank == Some(1)).count();
    let failed = rows.iter().filter(|row| row.error.is_some()).count();
    let rejected = pairs - hung - failed;
    let earlier = if earlier > 0 { format!(" ({earlier} of them in an earlier run)") } else { String::new() };
    let errors = if failed > 0 { ": see the column error" } else { "" };
    format!(
        "{}: {pairs} pairs{earlier} in {seconds:.1} s: {hung} hang, {rejected} do not, {failed} with an error{errors}\n",
        output.display()
    )
}

/// 64 bits that tell two contents apart (FNV-1a), which do not depend on the version of the standard library.
fn hash(bytes: &[u8]) -> String {
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    format!("{:016x}", bytes.iter().fold(0xcbf2_9ce4_8422_2325, step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_all_pairs_in_order() {
        for (pairs, count) in [(200, 4), (7, 3), (2, 5), (0, 2)] {
            let ranges = (1..=count).map(|index| Shard { index, count }.range(pairs));
            assert_eq!(ranges.flatten().collect::<Vec<_>>(), (0..pairs).collect::<Vec<_>>());
        }
        assert_eq!(Shard::parse("2/4"), Ok(Shard { index: 2, count: 4 }));
        assert!(["0/4", "5/4", "1", "a/b", "1/0", "-1/2"].iter().all(|text| Shard::parse(text).is_err()));
    }

    #[test]
    fn the_hash_is_fnv_1a() {
        // From the test vectors of its authors.
        assert_eq!(hash(b""), "cbf29ce484222325");
        assert_eq!(hash(b"foobar"), "85944171f73967e8");
    }
}
