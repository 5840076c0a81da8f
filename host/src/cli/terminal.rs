//! Text output: results on standard output, notes, warnings and errors on standard error.

use anstyle::AnsiColor;
use anyhow::{Context, Result};
use indicatif::ProgressBar;
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

/// Prints a result. A pipe that its reader has closed, as `head` does, is not an error.
pub(super) fn print(content: impl AsRef<[u8]>) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(content.as_ref()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output cannot be written"),
    }
}

/// The progress bar that is shown, if any. Messages are printed above it.
static BAR: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Shows a progress bar below the messages until the result is dropped.
pub(super) fn show_below(bar: &ProgressBar) -> impl Drop + use<> {
    struct Shown(ProgressBar);
    impl Drop for Shown {
        fn drop(&mut self) {
            *BAR.lock().unwrap_or_else(PoisonError::into_inner) = None;
            self.0.finish_and_clear();
        }
    }
    *BAR.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.clone());
    Shown(bar.clone())
}

/// Prints a message of `kind` `note`, `warning` or `error` to standard error.
///
/// A failure to write is ignored, since there is no other channel to report it on.
pub(crate) fn say(kind: &str, text: impl Display) {
    let colour = match kind {
        "error" => AnsiColor::Red,
        "warning" => AnsiColor::Yellow,
        _ => AnsiColor::Cyan,
    };
    let style = colour.on_default().bold();
    // Without colours where standard error is no terminal or NO_COLOR is set.
    let print = || writeln!(anstream::stderr(), "{style}{kind}{style:#}: {text}");
    let _ = match &*BAR.lock().unwrap_or_else(PoisonError::into_inner) {
        Some(bar) => bar.suspend(print),
        None => print(),
    };
}
