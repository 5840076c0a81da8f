//! Content and format of a file, and the errors that all formats share.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::locate::{locate, split_link};
use super::{FileError, Place};

/// File formats, determined by the extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Obj,
    Stl,
    Ply,
    Gltf,
    Pcd,
    Xyz,
    Urdf,
}

pub(super) const MESHES: &str = "obj, stl, ply, glb, gltf and urdf";
pub(super) const CLOUDS: &str = "ply, pcd, xyz, txt and pts";
pub(super) const ANY: &str = "obj, stl, ply, glb, gltf, urdf, pcd, xyz, txt and pts";

impl Format {
    fn of(extension: &str) -> Option<Self> {
        Some(match extension {
            "obj" => Self::Obj,
            "stl" => Self::Stl,
            "ply" => Self::Ply,
            "glb" | "gltf" => Self::Gltf,
            "pcd" => Self::Pcd,
            "xyz" | "txt" | "pts" => Self::Xyz,
            "urdf" => Self::Urdf,
            _ => return None,
        })
    }

    fn remedy(self) -> &'static str {
        match self {
            Self::Obj => "check that it is a Wavefront OBJ, or re-export it",
            Self::Stl => "check that it is an STL, or re-export it as binary STL",
            Self::Ply => {
                "check that it is a PLY, or re-export it as binary PLY with x, y, z and vertex_indices"
            }
            Self::Gltf => "re-export it as glb without mesh compression, sparse accessors or quantization",
            Self::Pcd => {
                "check that it is a PCD of version 0.7 with fields x, y, z, or save it as binary PCD"
            }
            Self::Urdf => {
                "check the file and what it names; a xacro becomes a URDF by `xacro robot.urdf.xacro > robot.urdf`"
            }
            Self::Xyz => "write x y z or x y z nx ny nz on each line, and put # before headings",
        }
    }
}

/// A file read into memory.
pub(super) struct Source<'a> {
    /// Its name as it was given.
    pub(super) path: &'a Path,
    /// Where it is.
    pub(super) file: PathBuf,
    /// The link of a URDF that was asked for.
    pub(super) link: Option<String>,
    pub(super) format: Format,
    pub(super) bytes: Vec<u8>,
}

impl<'a> Source<'a> {
    /// Reads the whole file; `known` lists the supported extensions for the error message.
    pub(super) fn open(path: &'a Path, known: &'static str) -> Result<Self, FileError> {
        let (file, link) = split_link(path);
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let format = Format::of(&extension);
        let file = locate(&file, None)?;
        let bytes = read_at(path, &file)?;
        let format =
            format.ok_or_else(|| FileError::UnknownFormat { path: path.into(), extension, known })?;
        if bytes.is_empty() {
            return Err(FileError::Empty { path: path.into() });
        }
        Ok(Self { path, file, link, format, bytes })
    }

    pub(super) fn malformed(&self, place: Place, reason: impl Into<String>) -> FileError {
        FileError::Malformed {
            path: self.path.into(),
            place,
            reason: reason.into(),
            remedy: self.format.remedy(),
        }
    }

    pub(super) fn truncated(&self, place: Place, reason: impl Into<String>) -> FileError {
        FileError::Truncated { path: self.path.into(), place, reason: reason.into() }
    }

    pub(super) fn not_finite(&self, item: &'static str, index: usize) -> FileError {
        FileError::NotFinite { path: self.path.into(), item, index }
    }
}

pub(super) fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    read_at(path, path)
}

/// The content of `file`, which errors call `path`.
fn read_at(path: &Path, file: &Path) -> Result<Vec<u8>, FileError> {
    let unreadable = |reason: &str| FileError::Unreadable { path: path.into(), reason: reason.into() };
    let from_io = |e: std::io::Error| match e.kind() {
        ErrorKind::NotFound => FileError::Missing { path: path.into() },
        _ => unreadable(&e.to_string()),
    };
    let metadata = fs::metadata(file).map_err(from_io)?;
    if metadata.is_dir() {
        return Err(unreadable("it is a directory"));
    }
    // Reading a device or a pipe may never end.
    if !metadata.is_file() {
        return Err(unreadable("it is not a regular file"));
    }
    fs::read(file).map_err(from_io)
}
