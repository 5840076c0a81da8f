//! `hangpose completions` and `hangpose man`: what a shell and the manual know of the command.

use super::{Arguments, CompletionsArguments, ManArguments, terminal};
use anyhow::{Context, Result};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

/// Name of the installed command.
const NAME: &str = "hangpose";

pub(crate) fn completions(arguments: &CompletionsArguments) -> Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), NAME, &mut script);
    terminal::print(script)?;
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn man(arguments: &ManArguments) -> Result<ExitCode> {
    let folder = &arguments.folder;
    let mut command = Arguments::command().disable_help_subcommand(true);
    // Gives each subcommand its full name.
    command.build();
    let pages = || {
        std::fs::create_dir_all(folder)?;
        command.get_subcommands().chain([&command]).try_for_each(|command| page(command, folder))
    };
    pages().with_context(|| {
        format!("{}: no man pages can be written; give a folder with write permission", folder.display())
    })?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the man page of a command.
fn page(command: &Command, folder: &Path) -> io::Result<()> {
    let man = Man::new(command.clone()).source(concat!("hangpose ", env!("CARGO_PKG_VERSION")));
    let mut text = Vec::new();
    man.render_title(&mut text)?;
    man.render_name_section(&mut text)?;
    man.render_synopsis_section(&mut text)?;
    man.render_description_section(&mut text)?;
    man.render_options_section(&mut text)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut text)?;
    }
    examples(command, &mut text)?;
    std::fs::write(folder.join(man.get_filename()), text)
}

/// Writes the examples of the help line by line, where the crate would fill them into a paragraph.
fn examples(command: &Command, out: &mut dyn Write) -> io::Result<()> {
    let Some(help) = command.get_after_help() else { return Ok(()) };
    let mut roff = Roff::new();
    roff.control("SH", ["EXAMPLES"]).control("nf", []);
    for line in help.to_string().lines().filter(|line| line.starts_with(' ')) {
        roff.text([roman(line.trim_start())]);
    }
    out.write_all(roff.control("fi", []).to_roff().as_bytes())
}
