//! Where a result goes: found to be writable before the work begins, and written in one piece at the end.

use anyhow::{Context, Result};
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A place for a file.
pub(super) enum Output {
    /// Standard output.
    Standard,
    /// A file that appears, or is replaced, when it is complete.
    File { temporary: NamedTempFile, path: PathBuf },
    /// Something that is no file, such as a pipe, and is written to as it is.
    Stream(std::fs::File),
}

impl Output {
    /// Makes sure that `path` can be written, without changing what is there; `-` is standard output.
    pub(super) fn prepare(path: &Path) -> Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Standard);
        }
        let remedy = || {
            format!("{}: cannot be written; give a file in a folder that you may write to", path.display())
        };
        // A link stays a link: what it points to is replaced.
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if target.exists() && !target.is_file() {
            return Ok(Self::Stream(
                std::fs::File::options().write(true).open(&target).with_context(remedy)?,
            ));
        }
        if target.is_file() {
            std::fs::File::options().append(true).open(&target).with_context(remedy)?;
        }
        let folder = match target.parent() {
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
        Ok(Self::File { temporary: builder.tempfile_in(folder).with_context(remedy)?, path: target })
    }

    /// Writes `text`.
    pub(super) fn write(self, text: &str) -> Result<()> {
        match self {
            Self::Standard => std::io::stdout().write_all(text.as_bytes()).context("standard output"),
            Self::Stream(mut stream) => {
                stream.write_all(text.as_bytes()).context("the JSON could not be written")
            }
            Self::File { mut temporary, path } => {
                temporary.write_all(text.as_bytes()).with_context(|| path.display().to_string())?;
                temporary.persist(&path).with_context(|| path.display().to_string())?;
                Ok(())
            }
        }
    }
}
