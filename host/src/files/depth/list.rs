//! Which files a scan consists of: those that match a pattern, or those that a list of TUM names.

use std::path::{Path, PathBuf};

use super::ScanError;
use super::numbers;
use crate::files::text::{before_comment, lines};
use crate::files::{FileError, Place, source};

/// A file and when it was taken, seconds, where that is known.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Listed {
    pub(super) path: PathBuf,
    pub(super) time: Option<f64>,
}

/// The files that match a pattern such as `scan/*.png`, by name, or those listed in a text file, `time path` on each line.
pub(super) fn files(pattern: &str, what: &'static str) -> Result<Vec<Listed>, ScanError> {
    let list = Path::new(pattern);
    if list.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("txt")) && list.is_file() {
        return Ok(read_list(list)?);
    }
    let matches = matching(pattern, what)?;
    let time = |path: &Path| path.file_stem()?.to_str().filter(|stem| stem.contains('.'))?.parse().ok();
    Ok(matches.into_iter().map(|path| Listed { time: time(&path), path }).collect())
}

/// The files that match a pattern, by name. A pattern without wildcards is the path of one file.
pub(super) fn matching(pattern: &str, what: &'static str) -> Result<Vec<PathBuf>, ScanError> {
    if Path::new(pattern).is_file() {
        return Ok(vec![pattern.into()]);
    }
    let bad = |reason: String| ScanError::Pattern { pattern: pattern.into(), what, reason };
    let mut found = Vec::new();
    for path in glob::glob(pattern).map_err(|error| bad(error.to_string()))? {
        let path = path.map_err(|error| bad(error.to_string()))?;
        if path.is_file() {
            found.push(path);
        }
    }
    found.sort();
    if found.is_empty() {
        return Err(bad("no file matches".into()));
    }
    Ok(found)
}

fn read_list(path: &Path) -> Result<Vec<Listed>, FileError> {
    let bytes = source::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut listed = Vec::new();
    for (number, line) in lines(&bytes) {
        let mut words = before_comment(&line).split_whitespace();
        let Some(time) = words.next() else { continue };
        let malformed = |reason: String| FileError::Malformed {
            path: path.into(),
            place: Place::Line(number),
            reason,
            remedy: "write the time in seconds and the path of an image on each line, as TUM does in depth.txt",
        };
        let time = numbers(time).map_err(malformed)?[0];
        let file = words.next().ok_or_else(|| malformed("has no path".into()))?;
        listed.push(Listed { path: folder.join(file), time: Some(time) });
    }
    if listed.is_empty() {
        return Err(FileError::Empty { path: path.into() });
    }
    Ok(listed)
}
