//! Text files of matrices: 3 x 3 intrinsics, 4 x 4 poses, and the trajectories of Open3D (`.log`).

use std::path::Path;

use super::{numbers, rigid};
use crate::files::text::{before_comment, lines};
use crate::files::{FileError, Place, source};
use hangpose_core::geometry::Pose;

/// The numbers of a line and its number in the file, counted from 1.
pub(super) type Line = (usize, Vec<f64>);

/// The lines of a text file that hold numbers. Commas separate like spaces; brackets are ignored.
pub(super) fn read_lines(path: &Path, remedy: &'static str) -> Result<Vec<Line>, FileError> {
    let bytes = source::read(path)?;
    let mut found = Vec::new();
    for (number, line) in lines(&bytes) {
        let line = before_comment(&line).replace([',', ';', '[', ']'], " ");
        if line.trim().is_empty() {
            continue;
        }
        let values = numbers(&line).map_err(|reason| malformed(path, number, reason, remedy))?;
        found.push((number, values));
    }
    match found.is_empty() {
        true => Err(FileError::Empty { path: path.into() }),
        false => Ok(found),
    }
}

/// Focal lengths and principal point of a 3 x 3 matrix.
pub(super) fn intrinsics(path: &Path) -> Result<[f64; 4], FileError> {
    let remedy = "write the 3 x 3 matrix fx 0 cx, 0 fy cy, 0 0 1 in three lines, or give JSON";
    let lines = read_lines(path, remedy)?;
    let all: Vec<f64> = lines.iter().flat_map(|(_, values)| values.iter().copied()).collect();
    let m: [f64; 9] = all.try_into().map_err(|all: Vec<f64>| {
        malformed(path, lines[0].0, format!("expected nine numbers, found {}", all.len()), remedy)
    })?;
    checked(m).map_err(|reason| malformed(path, lines[0].0, reason, remedy))
}

/// Focal lengths and principal point of a row-major 3 x 3 matrix.
pub(super) fn checked(m: [f64; 9]) -> Result<[f64; 4], String> {
    if m[3] != 0.0 || m[6..] != [0.0, 0.0, 1.0] {
        return Err("the matrix is not fx 0 cx, 0 fy cy, 0 0 1: is it transposed?".into());
    }
    if m[1] != 0.0 {
        return Err(format!("the matrix has a skew of {}, which is not supported", m[1]));
    }
    Ok([m[0], m[4], m[2], m[5]])
}

/// The poses of one or more 4 x 4 matrices below each other.
pub(super) fn poses(path: &Path, lines: &[Line]) -> Result<Vec<Pose>, FileError> {
    let remedy = "write four lines of four numbers for each pose, row by row";
    let matrix = |rows: &[Line]| {
        let all: Vec<f64> = rows.iter().flat_map(|(_, values)| values.iter().copied()).collect();
        if rows.len() < 4 || rows.iter().any(|(_, values)| values.len() != 4) {
            return Err(malformed(path, rows[0].0, "expected four lines of four numbers".into(), remedy));
        }
        rigid::of_rows(&all).map_err(|reason| malformed(path, rows[0].0, reason, NOT_RIGID))
    };
    lines.chunks(4).map(matrix).collect()
}

/// The poses of an Open3D trajectory: a line of three indices before each matrix.
pub(super) fn log(path: &Path, lines: &[Line]) -> Result<Vec<Pose>, FileError> {
    let remedy = "write three indices and then a 4 x 4 matrix for each pose, as Open3D does in .log files";
    let pose = |part: &[Line]| {
        if part[0].1.len() != 3 {
            return Err(malformed(path, part[0].0, "expected three indices".into(), remedy));
        }
        match part.len() {
            5 => poses(path, &part[1..]).map(|poses| poses[0]),
            _ => Err(malformed(path, part[0].0, "the matrix is cut off".into(), remedy)),
        }
    };
    lines.chunks(5).map(pose).collect()
}

/// How to mend a pose that is none.
pub(super) const NOT_RIGID: &str = "give rotations without scale and mirroring, row by row, and leave out the images whose pose is not known";

pub(super) fn malformed(path: &Path, line: usize, reason: String, remedy: &'static str) -> FileError {
    FileError::Malformed { path: path.into(), place: Place::Line(line), reason, remedy }
}
