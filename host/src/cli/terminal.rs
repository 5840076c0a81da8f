//! Text output: results on standard output, notes, warnings and errors on standard error.

use anyhow::{Context, Result};
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Prints a result. A pipe that its reader has closed, as `head` does, is not an error.
pub(super) fn print(content: impl AsRef<[u8]>) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(content.as_ref()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output cannot be written"),
    }
}

/// Prints a message of `kind` `note`, `warning` or `error` to standard error.
///
/// A failure to write is ignored, since there is no other channel to report it on.
pub(crate) fn say(kind: &str, text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{kind}: {text}");
}
