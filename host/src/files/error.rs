//! What can go wrong with a file, where, and how to mend it.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

/// Where in a file something was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Nowhere in particular.
    Whole,
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0.
    Byte(usize),
    /// A face in the order of the file, counted from 0.
    Face(usize),
    /// A part by its name, for formats that are a tree.
    Part(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => write!(f, "the file"),
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Face(face) => write!(f, "face {face} (counted from 0)"),
            Self::Part(name) => write!(f, "{name}"),
        }
    }
}

/// Why a file could not be read.
///
/// The message says what, where and how to mend it. Every variant names its file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FileError {
    /// Nothing is there.
    #[error("{path}: no such file; check the path")]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// Something is there, but it cannot be read: a directory, or without permission.
    #[error("{path}: cannot be read: {reason}; give the path of a file that you may read")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        reason: String,
    },
    /// Zero bytes.
    #[error("{path}: the file is empty; export or copy it again")]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The extension names no format that is read here.
    #[error(
        "{path}: {}; known are {known}: rename the file if it is one of these, else export it as one",
        said(extension)
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Its extension, empty if it has none.
        extension: String,
        /// The extensions that would do.
        known: &'static str,
    },
    /// The file ends before what it promises.
    #[error("{path}: {place}: {reason}; the file is cut off or its header is wrong: copy or export it again")]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Where it ends, or the header that promises too much.
        place: Place,
        /// What was promised and what is there.
        reason: String,
    },
    /// The file is not what its extension says, or breaks the rules of its format.
    #[error("{path}: {place}: {reason}; {remedy}")]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What the format's reader says.
        reason: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A mesh file without faces and without vertices.
    #[error(
        "{path}: holds no triangles; check that the exporter includes the mesh, not only lines, cameras or materials"
    )]
    NoTriangles {
        /// The file.
        path: PathBuf,
    },
    /// A cloud file without points.
    #[error("{path}: holds no points{}; check that the camera or exporter wrote any", all_missing(*missing))]
    NoPoints {
        /// The file.
        path: PathBuf,
        /// How many points are marked as missing (NaN).
        missing: usize,
    },
    /// A point cloud where a mesh is needed.
    #[error(
        "{path}: is a point cloud (points without faces), but a mesh is needed; reconstruct its surface first and save that as obj, stl, ply or glb"
    )]
    CloudNotMesh {
        /// The file.
        path: PathBuf,
    },
    /// A mesh where a point cloud is needed.
    #[error(
        "{path}: is a mesh, but a point cloud is needed; sample points on its surface first and save them as ply, pcd or xyz"
    )]
    MeshNotCloud {
        /// The file.
        path: PathBuf,
    },
    /// A coordinate or a normal that is NaN or infinite.
    #[error(
        "{path}: {item} {index} (counted from 0) is not finite; check the exporter, or remove it and what uses it"
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// `vertex`, `point` or `normal of point`.
        item: &'static str,
        /// Which, in the order of the file, counted from 0.
        index: usize,
    },
    /// A face that uses a vertex that does not exist.
    #[error(
        "{path}: {place} uses vertex {index}, but there are {count} vertices, counted from {first}; the file is cut off or its exporter is faulty: export it again"
    )]
    IndexOutOfRange {
        /// The file.
        path: PathBuf,
        /// Which face.
        place: Place,
        /// The vertex that it asks for, as the format counts.
        index: i64,
        /// How many vertices there are.
        count: usize,
        /// The number of the first vertex in this format: 0, in OBJ 1.
        first: u32,
    },
    /// Faces, but none with an area.
    #[error("{path}: none of its {faces} faces has an area; check the scale and the unit of the export")]
    AllDegenerate {
        /// The file.
        path: PathBuf,
        /// How many there are.
        faces: usize,
    },
    /// More than can be counted or held.
    #[error("{path}: has more than {most} vertices and corners of faces; decimate the mesh first")]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit.
        most: usize,
    },
}

fn said(extension: &str) -> String {
    match extension {
        "" => "the name has no extension to tell its format".into(),
        other => format!("\".{other}\" is not a format that is read here"),
    }
}

fn all_missing(missing: usize) -> String {
    match missing {
        0 => String::new(),
        n => format!(": all {n} are marked as missing (NaN)"),
    }
}
