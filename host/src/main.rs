//! The command `hangpose`.

mod cli;

use clap::Parser;
use std::process::ExitCode;

/// Exit status for bad input or an output that cannot be written.
const FAILED: u8 = 1;

fn main() -> ExitCode {
    let command = cli::Arguments::parse().command;
    let result = match &command {
        cli::Command::Predict(arguments) => cli::predict::run(arguments),
        cli::Command::Plan(arguments) => cli::plan::run(arguments),
        cli::Command::View(arguments) => cli::view::run(arguments),
        cli::Command::Inspect(arguments) => cli::inspect::run(arguments),
        cli::Command::Scan(arguments) => cli::scan::run(arguments),
    };
    result.unwrap_or_else(|error| {
        // Options that do not go together, where the parser cannot tell.
        let error = error.downcast::<clap::Error>().map_or_else(|error| error, |error| error.exit());
        cli::say("error", format_args!("{error:#}"));
        ExitCode::from(FAILED)
    })
}
