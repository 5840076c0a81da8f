//! Destination of a result. It is checked to be writable before the computation and written in one step at the end.

use super::terminal;
use anyhow::{Context, Result, anyhow, ensure};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Destination of a text or of bytes.
pub(super) enum Output {
    /// Standard output.
    Standard,
    /// A regular file, created or replaced atomically.
    File(PathBuf),
    /// A pipe or device, written to directly.
    Stream { stream: File, path: PathBuf },
}

impl Output {
    /// Checks that `path` can be written and is none of `inputs`, without changing it. `-` is standard output.
    pub(super) fn prepare(path: &Path, inputs: &[&Path]) -> Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Standard);
        }
        let cannot = |error: io::Error| cannot_write(path, &error);
        // A symbolic link is kept; its target is replaced.
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if target.exists() && !target.is_file() {
            let stream = File::options().write(true).open(&target).map_err(cannot)?;
            return Ok(Self::Stream { stream, path: path.to_path_buf() });
        }
        if target.is_file() {
            let is_target = |input: &&Path| std::fs::canonicalize(input).is_ok_and(|input| input == target);
            ensure!(
                !inputs.iter().any(is_target),
                "{}: is also an input and would be overwritten; give another file for the result",
                path.display()
            );
            File::options().append(true).open(&target).map_err(cannot)?;
        }
        // Created and removed at once, so that an aborted run leaves no file behind.
        temporary_beside(&target).map_err(cannot)?;
        Ok(Self::File(target))
    }

    /// Writes `content`.
    pub(super) fn write(self, content: impl AsRef<[u8]>) -> Result<()> {
        match self {
            Self::Standard => terminal::print(content),
            Self::Stream { mut stream, path } => match stream.write_all(content.as_ref()) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                result => result.with_context(|| path.display().to_string()),
            },
            Self::File(path) => {
                let cannot = |error: io::Error| cannot_write(&path, &error);
                let mut temporary = temporary_beside(&path).map_err(cannot)?;
                temporary.write_all(content.as_ref()).map_err(cannot)?;
                temporary.persist(&path).map_err(|error| cannot(error.error))?;
                Ok(())
            }
        }
    }
}

/// The cause and the remedy, without the confusing name of the temporary file.
fn cannot_write(path: &Path, error: &io::Error) -> anyhow::Error {
    anyhow!(
        "{}: cannot be written ({}); give a file in an existing folder with write permission",
        path.display(),
        error.kind()
    )
}

/// A temporary file in the folder of `path`, to be renamed to `path`.
fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The usual mode of a new file, before the umask is applied.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
