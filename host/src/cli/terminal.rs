//! What people read: results on standard output, notes, warnings and errors on standard error.

use anyhow::{Context, Result};
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Prints a result. A reader that has seen enough and closed the pipe, such as `head`, is no error.
pub(super) fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output cannot be written"),
    }
}

/// Says something beside the result: `kind` is `note`, `warning` or `error`.
///
/// Where nobody listens on standard error, there is nobody to tell that either.
pub(crate) fn say(kind: &str, text: impl Display) {
    let _ = writeln!(std::io::stderr(), "{kind}: {text}");
}
