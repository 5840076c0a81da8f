//! Text with one point per line: XYZ, PTS and similar formats.

use super::super::source::Source;
use super::super::text::{before_comment, lines, number, short};
use super::super::{FileError, Place};
use super::RawCloud;

/// Reads `x y z`, or `x y z nx ny nz`, separated by spaces, tabs, commas or semicolons.
///
/// Of `x y z intensity`, `x y z r g b` and `x y z intensity r g b`, which laser scanners write, only x, y and z are
/// used. `#` and `//` begin a comment. A single number before the points is their count.
pub(super) fn read(source: &Source<'_>) -> Result<RawCloud, FileError> {
    let mut rows: Vec<f64> = Vec::new();
    let mut width = 0;
    let mut claimed = None;
    for (line, text) in lines(&source.bytes) {
        let malformed = |reason: String| source.malformed(Place::Line(line), reason);
        let text = before_comment(&text).split("//").next().unwrap_or_default();
        let words = || text.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty());
        let count = words().count();
        if count == 0 {
            continue;
        }
        if count == 1 && width == 0 && claimed.is_none() {
            claimed = Some(text.trim().parse::<usize>().map_err(|_| malformed(expected(text.trim())))?);
            continue;
        }
        if width == 0 {
            if ![3, 4, 6, 7].contains(&count) {
                return Err(malformed(format!(
                    "expected 3 numbers (x y z) or 6 (x y z and a normal), found {count}"
                )));
            }
            width = count;
        }
        if count != width {
            return Err(malformed(format!("the previous points have {width} numbers, this one has {count}")));
        }
        for word in words() {
            rows.push(number(word).ok_or_else(|| malformed(expected(word)))?);
        }
    }
    let rows: Vec<&[f64]> = rows.chunks_exact(width.max(1)).collect();
    if let Some(claimed) = claimed.filter(|claimed| *claimed > rows.len()) {
        return Err(source.truncated(
            Place::Whole,
            format!("it begins with a count of {claimed} points, but has {}", rows.len()),
        ));
    }

    let three =
        |from: usize| rows.iter().map(|row| [row[from], row[from + 1], row[from + 2]]).collect::<Vec<_>>();
    let mut cloud = RawCloud { points: three(0), ..RawCloud::default() };
    if width == 6 && !are_colours(&rows) {
        cloud.normals = Some(three(3).into_iter().map(|normal| normal.map(|x| x as f32)).collect());
    } else if width > 3 {
        cloud.notes.push(format!("Columns 4 to {width} look like intensity or colour and were ignored."));
    }
    if let Some(claimed) = claimed.filter(|claimed| *claimed < rows.len()) {
        cloud.notes.push(format!(
            "The file begins with a count of {claimed} points, but {} were found.",
            rows.len()
        ));
    }
    Ok(cloud)
}

fn expected(word: &str) -> String {
    format!("expected a number, not \"{}\"", short(word))
}

/// Whether the columns hold whole numbers from 0 to 255 that are not all as small as components of normals.
fn are_colours(rows: &[&[f64]]) -> bool {
    let mut values = rows.iter().flat_map(|row| &row[3..6]);
    values.clone().all(|x| x.fract() == 0.0 && (0.0..=255.0).contains(x)) && values.any(|x| *x > 1.0)
}
