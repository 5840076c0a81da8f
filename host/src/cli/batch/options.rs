//! The options that a batch shares with `predict`: given once for all pairs, or for one pair in a column of its table.

use super::super::{CloudArguments, FrameArguments, MethodArguments, RequestArguments};
use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, Args, Command, CommandFactory, FromArgMatches, Parser};
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// The options of one pair.
#[derive(Args)]
pub(super) struct PairOptions {
    /// Maximum number of poses of a pair.
    #[arg(long, value_name = "K", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000), help_heading = "Options of predict, for every pair that has none in a column")]
    pub(super) top: u32,
    #[command(flatten, next_help_heading = "Options of predict, for every pair that has none in a column")]
    pub(super) frames: FrameArguments,
    #[command(flatten, next_help_heading = "Options of predict, for every pair that has none in a column")]
    pub(super) cloud: CloudArguments,
    #[command(flatten, next_help_heading = "Options of predict, for every pair that has none in a column")]
    pub(super) request: RequestArguments,
    #[command(flatten, next_help_heading = "Options of predict, for every pair that has none in a column")]
    pub(super) method: MethodArguments,
}

/// Parses the options of a pair without the rest of the command.
#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Line {
    #[command(flatten)]
    options: PairOptions,
}

/// Options whose values are files: in a column they are relative to the table.
const FILES: [&str; 2] = ["params", "scene"];

/// Separates the values of an option that may be repeated, within a cell.
const BETWEEN: char = ';';

/// The options of the command line as they were given, to be repeated for each pair.
#[derive(Clone, Debug, Default)]
pub(crate) struct Given(Vec<(String, Vec<OsString>)>);

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        PairOptions::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        PairOptions::augment_args_for_update(command)
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut given = Self::default();
        given.update_from_arg_matches(matches)?;
        Ok(given)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        let command = Line::command();
        let is_given = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
        let given = command.get_arguments().filter(|argument| is_given(argument.get_id().as_str()));
        self.0 = given
            .filter_map(|argument| Some((argument.get_long()?.to_string(), argument.get_id().as_str())))
            .map(|(name, id)| (name, matches.get_raw(id).into_iter().flatten().map(Into::into).collect()))
            .collect();
        Ok(())
    }
}

impl Given {
    /// The options as text, for the journal.
    pub(super) fn in_words(&self) -> Vec<String> {
        let word = |name: &str, value: &OsString| format!("--{name}={}", value.to_string_lossy());
        self.0.iter().flat_map(|(name, values)| values.iter().map(move |value| word(name, value))).collect()
    }

    /// The options of a pair whose table has these cells in columns that are options. A cell that is not empty replaces
    /// what the command line says. Files are relative to `folder`.
    pub(super) fn with_cells(
        &self,
        cells: &[(&Column, String)],
        folder: &Path,
    ) -> Result<PairOptions, clap::Error> {
        let filled = || cells.iter().filter(|(_, cell)| !cell.is_empty());
        let mut words = Vec::new();
        for (column, cell) in filled() {
            let values = if column.is_repeated { cell.split(BETWEEN).collect() } else { vec![cell.as_str()] };
            words.extend(values.into_iter().map(str::trim).map(|value| match column.is_file {
                true => word(&column.option, folder.join(value).as_os_str()),
                false => word(&column.option, value.as_ref()),
            }));
        }
        let is_replaced = |name: &str| filled().any(|(column, _)| column.option == name);
        for (name, values) in self.0.iter().filter(|(name, _)| !is_replaced(name)) {
            words.extend(values.iter().map(|value| word(name, value)));
        }
        Ok(Line::try_parse_from(words)?.options)
    }
}

fn word(name: &str, value: &OsStr) -> OsString {
    let mut word = OsString::from(format!("--{name}="));
    word.push(value);
    word
}

/// A column that is an option.
pub(super) struct Column {
    pub(super) name: String,
    option: String,
    /// Whether a cell may have several values.
    is_repeated: bool,
    /// Whether the value is a path.
    is_file: bool,
}

/// All columns that are options.
pub(super) fn columns() -> Vec<Column> {
    let command = Line::command();
    let options = command.get_arguments().filter_map(|argument| Some((argument.get_long()?, argument)));
    let column = |(option, argument): (&str, &clap::Arg)| Column {
        name: option.replace('-', "_"),
        option: option.into(),
        is_repeated: matches!(argument.get_action(), ArgAction::Append),
        is_file: FILES.contains(&option),
    };
    options.map(column).collect()
}
