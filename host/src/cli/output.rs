//! Where a result goes: found to be writable before the work begins, and written in one piece at the end.

use super::terminal;
use anyhow::{Context, Result, anyhow, ensure};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A place for a text.
pub(super) enum Output {
    /// Standard output.
    Standard,
    /// A file that appears, or is replaced, when it is complete.
    File(PathBuf),
    /// Something that is no file, such as a pipe, and is written to as it is.
    Stream { stream: File, path: PathBuf },
}

impl Output {
    /// Makes sure that `path` can be written and is none of `inputs`, without changing what is there; `-` is
    /// standard output.
    pub(super) fn prepare(path: &Path, inputs: &[&Path]) -> Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Standard);
        }
        let cannot = |error: io::Error| cannot_write(path, &error);
        // A link stays a link: what it points to is replaced.
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if target.exists() && !target.is_file() {
            let stream = File::options().write(true).open(&target).map_err(cannot)?;
            return Ok(Self::Stream { stream, path: path.to_path_buf() });
        }
        if target.is_file() {
            let is_target = |input: &&Path| std::fs::canonicalize(input).is_ok_and(|input| input == target);
            ensure!(
                !inputs.iter().any(is_target),
                "{}: is read as well and would be written over; give another file for the result",
                path.display()
            );
            File::options().append(true).open(&target).map_err(cannot)?;
        }
        // Made and removed at once: nothing is left behind if the work is broken off.
        temporary_beside(&target).map_err(cannot)?;
        Ok(Self::File(target))
    }

    /// Writes `text`.
    pub(super) fn write(self, text: &str) -> Result<()> {
        match self {
            Self::Standard => terminal::print(text),
            Self::Stream { mut stream, path } => match stream.write_all(text.as_bytes()) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                result => result.with_context(|| path.display().to_string()),
            },
            Self::File(path) => {
                let cannot = |error: io::Error| cannot_write(&path, &error);
                let mut temporary = temporary_beside(&path).map_err(cannot)?;
                temporary.write_all(text.as_bytes()).map_err(cannot)?;
                temporary.persist(&path).map_err(|error| cannot(error.error))?;
                Ok(())
            }
        }
    }
}

/// Says why and what to do, without the name of the temporary file, which would only confuse.
fn cannot_write(path: &Path, error: &io::Error) -> anyhow::Error {
    anyhow!(
        "{}: cannot be written ({}); give a file in a folder that exists and that you may write to",
        path.display(),
        error.kind()
    )
}

/// A file in the folder of `path`, to be renamed to it.
fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file; the user's mask takes away what it takes away.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
