//! STL, text and binary.
//!
//! The format is parsed here: stl_io 0.11 reads a binary file whose header begins with "solid " as text, reads only the
//! first of several solids, and rejects the `facet normal nan nan nan` that exporters write for thin facets. Normals
//! are ignored.

use super::super::source::Source;
use super::super::text::{lines, short, three};
use super::super::{FileError, Place};
use super::RawMesh;

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn read(source: &Source<'_>) -> Result<RawMesh, FileError> {
    let bytes = &source.bytes;
    // Only the length is conclusive: binary files with a header that begins with "solid" are common.
    let count = bytes.get(80..HEADER).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let fits = count.is_some_and(|count| bytes.len() == HEADER + TRIANGLE * count);
    if !fits && is_text(bytes) { text(source) } else { binary(source, count) }
}

fn is_text(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(1024)]).to_ascii_lowercase();
    let start = start.trim_start_matches('\u{feff}').trim_start();
    start.starts_with("solid") && !start.contains('\0')
}

fn binary(source: &Source<'_>, count: Option<usize>) -> Result<RawMesh, FileError> {
    let length = source.bytes.len();
    let Some(count) = count else {
        let reason =
            format!("a binary STL begins with {HEADER} bytes of header, but there are {length} in all");
        return Err(source.truncated(Place::Byte(length), reason));
    };
    let wanted = HEADER + TRIANGLE * count;
    if wanted > length {
        let reason =
            format!("the header declares {count} triangles in {wanted} bytes, but there are {length}");
        return Err(source.truncated(Place::Byte(length), reason));
    }
    let mut mesh = RawMesh::default();
    for triangle in source.bytes[HEADER..wanted].chunks_exact(TRIANGLE) {
        let first = mesh.vertices.len() as i64;
        // Twelve bytes of normal, three vertices, two attribute bytes.
        mesh.vertices.extend(triangle[12..48].chunks_exact(12).map(|vertex| {
            [0, 4, 8].map(|k| f32::from_le_bytes([vertex[k], vertex[k + 1], vertex[k + 2], vertex[k + 3]]))
        }));
        mesh.face(first..first + 3, 0);
    }
    if wanted < length {
        mesh.notes.push(format!("{} bytes after the last triangle were ignored.", length - wanted));
    }
    Ok(mesh)
}

fn text(source: &Source<'_>) -> Result<RawMesh, FileError> {
    let mut mesh = RawMesh::default();
    let (mut facet_start, mut in_solid, mut in_facet) = (0, false, false);
    let mut last = 0;
    for (number, line) in lines(&source.bytes) {
        let malformed = |reason: String| source.malformed(Place::Line(number), reason);
        let mut words = line.split_ascii_whitespace();
        let Some(word) = words.next() else { continue };
        last = number;
        match word.to_ascii_lowercase().as_str() {
            "solid" => in_solid = true,
            "endsolid" => in_solid = false,
            "facet" if !in_facet => {
                in_facet = true;
                facet_start = mesh.vertices.len();
            }
            "vertex" if in_facet => {
                mesh.vertices.push(three(&mut words).map_err(malformed)?.map(|x| x as f32));
            }
            "endfacet" if in_facet => {
                in_facet = false;
                let corners = mesh.vertices.len() - facet_start;
                if corners != 3 {
                    return Err(malformed(format!("a facet needs three vertices, this one has {corners}")));
                }
                mesh.face(facet_start as i64..mesh.vertices.len() as i64, number);
            }
            "outer" | "endloop" => {}
            other => return Err(malformed(format!("unexpected \"{}\"", short(other)))),
        }
    }
    if in_solid || in_facet {
        return Err(source.truncated(Place::Line(last), "the last solid has no \"endsolid\""));
    }
    Ok(mesh)
}
