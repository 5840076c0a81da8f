//! The table of pairs: a CSV file with a line for each pair.

use super::options::{self, Column, Given, PairOptions};
use anyhow::{Context, Result, anyhow, bail, ensure};
use csv::{ErrorKind, Position, ReaderBuilder, StringRecord, Trim};
use hangpose::Params;
use hangpose::files::is_located;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A pair as its table names it.
pub(super) struct Name {
    /// Number among the pairs of the table, from 1.
    pub(super) number: u64,
    pub(super) id: String,
    pub(super) object: String,
    pub(super) supporter: String,
}

/// A pair with its options.
pub(super) struct Pair {
    pub(super) name: Name,
    pub(super) object_path: PathBuf,
    pub(super) supporter_path: PathBuf,
    pub(super) wish: Arc<Wish>,
}

/// The options of pairs whose cells are the same.
pub(super) struct Wish {
    pub(super) options: PairOptions,
    pub(super) params: Params,
}

/// Columns that are no options.
const OWN: [&str; 3] = ["id", "object", "supporter"];

/// Reads the pairs of a table whose content is `bytes`. All of them are checked before any is predicted, so that a
/// mistake is reported at once.
pub(super) fn read(path: &Path, bytes: &[u8], given: &Given) -> Result<Vec<Pair>> {
    // Without columns, so that a mistake on the command line is not reported as one of a line.
    Wish::new(given.with_cells(&[], Path::new(""))?)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    // Most lines of a long table have the same options.
    let mut wishes: HashMap<Vec<String>, Arc<Wish>> = HashMap::new();
    let columns = options::columns();
    let pair = |Line { at, name, cells }: Line| {
        let key = cells.iter().map(|(_, cell)| cell.clone()).collect();
        let wish = match wishes.get(&key) {
            Some(wish) => wish.clone(),
            None => {
                let options = given.with_cells(&cells, folder);
                let options = options.map_err(|error| anyhow!("{at}: {}", in_line(&error)))?;
                let wish = Arc::new(Wish::new(options).context(at)?);
                wishes.insert(key, wish.clone());
                wish
            }
        };
        let [object_path, supporter_path] = [&name.object, &name.supporter].map(|file| beside(folder, file));
        Ok(Pair { name, object_path, supporter_path, wish })
    };
    lines(path, bytes, &columns)?.into_iter().map(pair).collect()
}

/// Reads what a table calls its pairs, without their options.
pub(super) fn names(path: &Path, bytes: &[u8]) -> Result<Vec<Name>> {
    Ok(lines(path, bytes, &options::columns())?.into_iter().map(|line| line.name).collect())
}

/// A file that a table in a folder names.
fn beside(folder: &Path, name: &str) -> PathBuf {
    if is_located(name.as_ref()) { name.into() } else { folder.join(name) }
}

/// A line of a table.
struct Line<'c> {
    /// Where it is, for messages.
    at: String,
    name: Name,
    /// Its options.
    cells: Vec<(&'c Column, String)>,
}

fn lines<'c>(path: &Path, bytes: &[u8], columns: &'c [Column]) -> Result<Vec<Line<'c>>> {
    let at = |line: u64| format!("{}, line {line}", path.display());
    let broken = |error: csv::Error| broken(path, &error);
    // A byte order mark, which spreadsheets write, would become part of the first name.
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(bytes);
    let header = reader.headers().map_err(broken)?.clone();
    check_header(&header, columns).with_context(|| at(1))?;
    let column = |name: &str| columns.iter().find(|column| column.name == name);
    let options: Vec<_> =
        header.iter().zip(0..).filter_map(|(name, place)| Some((column(name)?, place))).collect();
    let own = OWN.map(|name| header.iter().position(|column| column == name));
    let mut lines = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let at = at(record.position().map_or(0, Position::line));
        let [id, object, supporter] =
            own.map(|place| place.map_or(String::new(), |place| record[place].to_string()));
        for (name, value) in [("object", &object), ("supporter", &supporter)] {
            ensure!(!value.is_empty(), "{at}: the {name} is empty; give the path of a file");
        }
        let number = lines.len() as u64 + 1;
        let id = if id.is_empty() { number.to_string() } else { id };
        let cells = options.iter().map(|&(column, place): &(_, usize)| (column, record[place].to_string()));
        lines.push(Line { at, name: Name { number, id, object, supporter }, cells: cells.collect() });
    }
    ensure!(
        !lines.is_empty(),
        "{}: there are no pairs; write one on each line below the header",
        path.display()
    );
    Ok(lines)
}

impl Wish {
    /// Reads the constants and checks that the options go together.
    fn new(options: PairOptions) -> Result<Self> {
        let params = options.method.params_for(&options.frames)?;
        options.request.check(&params)?;
        Ok(Self { options, params })
    }
}

fn check_header(header: &StringRecord, options: &[Column]) -> Result<()> {
    let known: Vec<&str> = OWN.into_iter().chain(options.iter().map(|column| column.name.as_str())).collect();
    let mut seen = HashSet::new();
    for column in header {
        ensure!(seen.insert(column), "the column {column:?} appears twice; remove one");
        if !known.contains(&column) {
            bail!("the column {column:?} is unknown; the columns are {}", known.join(", "));
        }
    }
    for name in ["object", "supporter"] {
        ensure!(
            seen.contains(name),
            "the column {name} is missing; the first line names the columns, as in object,supporter"
        );
    }
    Ok(())
}

fn broken(path: &Path, error: &csv::Error) -> anyhow::Error {
    let (place, reason) = match error.kind() {
        ErrorKind::UnequalLengths { pos, expected_len, len } => {
            (pos.as_ref(), format!("it has {len} fields, but the header has {expected_len}"))
        }
        ErrorKind::Utf8 { pos, .. } => (pos.as_ref(), "it is not UTF-8; save the table as UTF-8".into()),
        _ => (None, error.to_string()),
    };
    match place {
        Some(place) => anyhow!("{}, line {}: {reason}", path.display(), place.line()),
        None => anyhow!("{}: {reason}", path.display()),
    }
}

/// What the parser of options has to say, without its hints on usage.
fn in_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let text = text.trim_start_matches("error: ");
    let lines = text.split("\n\n").next().unwrap_or(text).lines().map(str::trim);
    lines.collect::<Vec<_>>().join(" ")
}
