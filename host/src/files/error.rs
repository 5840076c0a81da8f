//! Errors of the file readers.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

/// Location of an error in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    Whole,
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0.
    Byte(usize),
    /// A face in the order of the file, counted from 0.
    Face(usize),
    /// A named part of the file.
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
/// The message states what is wrong, where, and how to mend it. Every variant names its file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file does not exist.
    #[error("{path}: no such file; check the path")]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The path is a directory or device, or the file cannot be read, for example without permission.
    #[error("{path}: cannot be read: {reason}; give the path of a file with read permission")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Reason given by the operating system.
        reason: String,
    },
    /// The file has zero bytes.
    #[error("{path}: the file is empty; export or copy it again")]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The extension is not that of a supported format.
    #[error(
        "{path}: {}; supported are {known}: rename the file if it has one of these formats, otherwise {}",
        said(extension),
        exported(extension)
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Its extension, empty if it has none.
        extension: String,
        /// The supported extensions.
        known: &'static str,
    },
    /// No folder of the package exists.
    #[error(
        "{path}: the package {package:?} was not found in AMENT_PREFIX_PATH, ROS_PACKAGE_PATH or above the file that names it; source the setup file of its workspace, or give a path without package://"
    )]
    NoPackage {
        /// The file.
        path: PathBuf,
        /// The package.
        package: String,
    },
    /// The file is shorter than its header declares.
    #[error("{path}: {place}: {reason}; the file is cut off or its header is wrong: copy or export it again")]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Where the file ends, or its header.
        place: Place,
        /// The declared and the actual size.
        reason: String,
    },
    /// The file violates the rules of its format, or has another format than its extension says.
    #[error("{path}: {place}: {reason}; {remedy}")]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Location of the error.
        place: Place,
        /// Reason given by the reader of the format.
        reason: String,
        /// How to mend the file.
        remedy: &'static str,
    },
    /// A mesh file has neither faces nor vertices.
    #[error(
        "{path}: holds no triangles; check that the exporter includes the mesh, not only lines, cameras or materials"
    )]
    NoTriangles {
        /// The file.
        path: PathBuf,
    },
    /// A cloud file has no points.
    #[error("{path}: holds no points{}; check that the camera or exporter wrote any", all_missing(*missing))]
    NoPoints {
        /// The file.
        path: PathBuf,
        /// Number of points that are marked as missing (NaN).
        missing: usize,
    },
    /// The file is a point cloud where a mesh is needed.
    #[error(
        "{path}: is a point cloud (points without faces), but a mesh is needed; reconstruct its surface first and save it as obj, stl, ply or glb"
    )]
    CloudNotMesh {
        /// The file.
        path: PathBuf,
    },
    /// The file is a mesh where a point cloud is needed.
    #[error(
        "{path}: is a mesh, but a point cloud is needed; sample points on its surface first and save them as ply, pcd or xyz"
    )]
    MeshNotCloud {
        /// The file.
        path: PathBuf,
    },
    /// A coordinate or a normal is NaN or infinite.
    #[error(
        "{path}: {item} {index} (counted from 0) is not finite; check the exporter, or remove it and everything that uses it"
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// `vertex`, `point` or `normal of point`.
        item: &'static str,
        /// Index of the item in the order of the file, counted from 0.
        index: usize,
    },
    /// A face uses a vertex that does not exist.
    #[error(
        "{path}: {place} uses vertex {index}, but there are {count} vertices, counted from {first}; the file is cut off or its exporter is faulty: export it again"
    )]
    IndexOutOfRange {
        /// The file.
        path: PathBuf,
        /// The face.
        place: Place,
        /// Index of the vertex, counted as in the format.
        index: i64,
        /// Number of vertices.
        count: usize,
        /// Index of the first vertex in this format: 1 in OBJ, 0 elsewhere.
        first: u32,
    },
    /// No face has an area.
    #[error("{path}: none of its {faces} faces has an area; check the scale and the unit of the export")]
    AllDegenerate {
        /// The file.
        path: PathBuf,
        /// Number of faces.
        faces: usize,
    },
    /// The mesh exceeds the reader's limit.
    #[error("{path}: has more than {most} vertices and face corners in all; decimate the mesh first")]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Largest permitted number of vertices and face corners.
        most: usize,
    },
}

fn said(extension: &str) -> String {
    match extension {
        "" => "the file name has no extension".into(),
        other => format!("\".{other}\" is not a supported format"),
    }
}

fn exported(extension: &str) -> &'static str {
    match extension {
        // The format of most meshes of robots.
        "dae" => "convert it, for example by `assimp export mesh.dae mesh.obj`, and name that file",
        _ => "export it as one",
    }
}

fn all_missing(missing: usize) -> String {
    match missing {
        0 => String::new(),
        n => format!(": all {n} are marked as missing (NaN)"),
    }
}
