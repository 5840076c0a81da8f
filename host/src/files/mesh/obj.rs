//! Wavefront OBJ: vertices and faces.
//!
//! The format is parsed here, because the existing crates are unsuitable. tobj 4 reads a polyline (`l 1 2 3`) as a
//! triangle, drops vertices without faces, renumbers the rest for every group and names no line in its errors. obj 0.10
//! loses the faces before an empty `g`, panics at some non-ASCII group names and rejects `vt` with one number.

use super::super::source::Source;
use super::super::text::{before_comment, lines, number, short, three};
use super::super::{FileError, Place};
use super::RawMesh;

pub(super) fn read(source: &Source<'_>) -> Result<RawMesh, FileError> {
    let mut mesh = RawMesh::default();
    let mut carried = String::new();
    for (number, line) in lines(&source.bytes) {
        // A backslash at the end continues a line on the next.
        if let Some(begun) = line.strip_suffix('\\') {
            carried.push_str(begun);
            carried.push(' ');
            continue;
        }
        let whole = if carried.is_empty() { line } else { (std::mem::take(&mut carried) + &line).into() };
        statement(&mut mesh, &whole, number)
            .map_err(|reason| source.malformed(Place::Line(number), reason))?;
    }
    statement(&mut mesh, &carried, 0).map_err(|reason| source.malformed(Place::Whole, reason))?;
    Ok(mesh)
}

fn statement(mesh: &mut RawMesh, line: &str, line_number: usize) -> Result<(), String> {
    let mut words = before_comment(line).split_ascii_whitespace();
    match words.next() {
        Some("v") => {
            let vertex = three(&mut words)?;
            // One more number is a weight; three more are a colour, which is ignored.
            let weight = match (words.next(), words.next()) {
                (Some(word), None) => number(word).ok_or("the weight is not a number")?,
                _ => 1.0,
            };
            mesh.vertices.push(vertex.map(|x| (x / weight) as f32));
        }
        Some("f") => {
            let corners: Vec<i64> =
                words.map(|word| corner(word, mesh.vertices.len())).collect::<Result<_, _>>()?;
            if corners.len() < 3 {
                return Err(format!("a face needs three corners, this one has {}", corners.len()));
            }
            mesh.face(corners, line_number);
        }
        // Normals, textures, groups, materials, lines and curves are ignored.
        _ => {}
    }
    Ok(())
}

/// The vertex index of `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 0. A negative index counts back from the last
/// vertex.
fn corner(word: &str, vertices: usize) -> Result<i64, String> {
    let vertex = word.split('/').next().unwrap_or_default();
    match vertex.parse::<i64>() {
        Ok(0) | Err(_) => Err(format!("\"{}\" is not a vertex: vertices are counted from 1", short(word))),
        Ok(index) if index > 0 => Ok(index - 1),
        Ok(index) => match (vertices as i64).checked_add(index) {
            Some(index) if index >= 0 => Ok(index),
            _ => Err(format!("\"{}\" counts back past the first of {vertices} vertices", short(word))),
        },
    }
}
