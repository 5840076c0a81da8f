//! The journal of a run: the rows that are done, so that a run that was ended goes on where it was.
//!
//! The first line says which run it is, and each other line has the rows of a pair. A line that was cut off is dropped.
//! The file is locked while a run writes to it.

use super::row::Row;
use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// What must be the same for a run to go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Run {
    /// Version of the program.
    pub(super) version: String,
    /// Hash of the table of pairs.
    pub(super) pairs: String,
    /// Hash of the constants of all pairs.
    pub(super) params: String,
    /// The options as they were given.
    pub(super) options: Vec<String>,
    /// The pairs of the shard: the first, and the one after the last.
    pub(super) shard: [usize; 2],
}

#[derive(Serialize, Deserialize)]
struct Line {
    pair: u64,
    rows: Vec<Row>,
}

/// The number of a pair that is done, and its rows.
pub(super) type Done = (u64, Vec<Row>);

/// The open journal.
pub(super) struct Journal {
    file: File,
    path: PathBuf,
}

impl Journal {
    /// Path of the journal beside a table.
    pub(super) fn path(output: &Path) -> PathBuf {
        let mut name = output.as_os_str().to_os_string();
        name.push(".partial");
        name.into()
    }

    /// Opens the journal at `path` and returns the rows that are in it. With `goes_on` it may have some.
    pub(super) fn open(path: &Path, run: &Run, goes_on: bool) -> Result<(Self, Vec<Done>)> {
        let name = path.display();
        let mut file = lock(path)?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).with_context(|| format!("{name}: cannot be read"))?;
        let mut lines = text.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n"));
        let begun = lines.next().map(serde_json::from_slice::<Run>);
        let mut end = 0;
        let mut done = Vec::new();
        if let Some(begun) = begun {
            let begun = begun.with_context(|| format!("{name}: is no journal of a batch; move it away"))?;
            ensure!(
                goes_on,
                "{name}: an earlier run has ended before it was done; pass --resume to go on with it, or delete this file to start anew"
            );
            begun.check(run).with_context(|| {
                format!("{name}: the earlier run cannot go on; delete this file to start anew")
            })?;
            end = text.split_inclusive(|byte| *byte == b'\n').next().map_or(0, <[u8]>::len);
            for line in lines {
                // A line that is broken and all after it, such as zeros after a failure of power, are computed again.
                let Ok(Line { pair, rows }) = serde_json::from_slice(line) else { break };
                end += line.len();
                done.push((pair, rows));
            }
        }
        let mut journal = Self { file, path: path.into() };
        let cannot = || format!("{}: cannot be written", path.display());
        journal.file.set_len(end as u64).with_context(cannot)?;
        journal.file.seek(SeekFrom::End(0)).with_context(cannot)?;
        if end == 0 {
            journal.append(run)?;
        }
        Ok((journal, done))
    }

    /// Adds the rows of a pair.
    pub(super) fn add(&mut self, pair: u64, rows: &[Row]) -> Result<()> {
        self.append(&Line { pair, rows: rows.to_vec() })
    }

    /// Writes a line at once, so that a kill leaves all of it or a torn end.
    fn append(&mut self, line: &impl Serialize) -> Result<()> {
        let mut text = serde_json::to_vec(line)?;
        text.push(b'\n');
        self.file.write_all(&text).with_context(|| {
            format!("{}: cannot be written; make room, then go on with --resume", self.path.display())
        })
    }

    /// Removes the journal of a run that is done.
    pub(super) fn remove(self) -> Result<()> {
        std::fs::remove_file(&self.path)
            .with_context(|| format!("{}: cannot be removed", self.path.display()))
    }
}

/// Opens a file and locks it against other runs.
fn lock(path: &Path) -> Result<File> {
    let name = path.display();
    loop {
        let file = File::options().read(true).write(true).create(true).truncate(false).open(path);
        let file = file.with_context(|| {
            format!("{name}: cannot be written; give a result in an existing folder with write permission")
        })?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                bail!(
                    "{name}: another run is writing it; wait for its end, or give another file for the result"
                )
            }
            Err(TryLockError::Error(error)) => {
                bail!("{name}: cannot be locked ({error}); give a result on a file system with locks")
            }
        }
        // Another run may have been done with the file and removed it between the two steps.
        if is_at(&file, path) {
            return Ok(file);
        }
    }
}

/// Whether an open file is the one at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let [opened, there] = [file.metadata(), std::fs::metadata(path)];
    matches!((opened, there), (Ok(a), Ok(b)) if (a.dev(), a.ino()) == (b.dev(), b.ino()))
}

/// Elsewhere a file that is open is not removed.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

impl Run {
    /// Fails if the other run would have other results.
    fn check(&self, now: &Self) -> Result<()> {
        let words = |run: &Self| match run.options.is_empty() {
            true => "no options".into(),
            false => run.options.join(" "),
        };
        let shard = |run: &Self| format!("pairs {} to {}", run.shard[0] + 1, run.shard[1]);
        ensure!(self.version == now.version, "it was of version {}, this is {}", self.version, now.version);
        ensure!(self.pairs == now.pairs, "the table of pairs has changed");
        ensure!(self.options == now.options, "it had {}, now there are {}", words(self), words(now));
        ensure!(self.shard == now.shard, "its shard was {}, now it is {}", shard(self), shard(now));
        ensure!(self.params == now.params, "a file of constants has changed");
        Ok(())
    }
}
