//! PLY, a format for meshes and point clouds.
//!
//! ply-rs-bw reads the header and binary bodies. Text bodies are read here, because its grammar accepts neither `.5`,
//! `1.` and empty lines nor `nan`, which needs an error message of its own.

use std::io::Cursor;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::source::Source;
use super::text::{lines, number, short};
use super::{FileError, Place};

/// The vertices and faces of a file, unchecked.
#[derive(Default)]
pub(super) struct Ply {
    pub(super) vertices: Vec<[f64; 3]>,
    /// One normal per vertex, if the file has normals.
    pub(super) normals: Option<Vec<[f32; 3]>>,
    pub(super) faces: Vec<Face>,
    /// Positions of cameras, see [`viewpoint_comments`].
    pub(super) viewpoints: Vec<[f64; 3]>,
}

/// A polygon.
pub(super) struct Face {
    /// Vertex indices of its corners, counted from 0.
    pub(super) corners: Vec<i64>,
    /// Its line in a text file, 0 in a binary file.
    pub(super) line: usize,
}

const NAMES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// A vertex or a face; other properties are dropped.
#[derive(Default)]
struct Row {
    numbers: [f64; 6],
    indices: Vec<i64>,
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(slot) = NAMES.iter().position(|known| *known == name) {
            return match scalar(&property) {
                Some(value) => {
                    self.numbers[slot] = value;
                    PropertyAccessResult::Set
                }
                None => PropertyAccessResult::UnsupportedType,
            };
        }
        if !is_indices(name) {
            return PropertyAccessResult::Ignored;
        }
        self.indices = match property {
            Property::ListChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListInt(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUInt(list) => list.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// A number in full precision; `None` for a list.
fn scalar(property: &Property) -> Option<f64> {
    match *property {
        Property::Double(value) => Some(value),
        _ => property.to_f32_lossy().map(f64::from),
    }
}

fn is_indices(name: &str) -> bool {
    name == "vertex_indices" || name == "vertex_index"
}

pub(super) fn read(source: &Source<'_>) -> Result<Ply, FileError> {
    let parser = Parser::<Row>::new();
    let mut reader = Reader::new(Cursor::new(source.bytes.as_slice()));
    let header = parser.read_header(&mut reader).map_err(|e| {
        let place = e.line().map_or(Place::Whole, Place::Line);
        match e.kind() {
            std::io::ErrorKind::UnexpectedEof => source.truncated(place, "the header has no end_header"),
            _ => source.malformed(place, first_line(&e.to_string())),
        }
    })?;
    let body = reader.get_ref().position() as usize;
    check_lengths(source, &header, body)?;

    let viewpoints = header.comments.iter().filter_map(|comment| viewpoint(comment)).collect();
    let mut ply = Ply { viewpoints, ..Ply::default() };
    let mut text = Text::new(source, body);
    for element in header.elements.values() {
        let rows = match header.encoding {
            Encoding::Ascii => text.rows(element)?,
            _ => {
                let rows = parser.read_payload_for_element(&mut reader, element, &header);
                rows.map_err(|e| match e.kind() {
                    std::io::ErrorKind::UnexpectedEof => {
                        source.truncated(Place::Byte(source.bytes.len()), first_line(&e.to_string()))
                    }
                    _ => source.malformed(
                        Place::Byte(reader.get_ref().position() as usize),
                        first_line(&e.to_string()),
                    ),
                })?
                .into_iter()
                .map(|row| (row, 0))
                .collect()
            }
        };
        match element.name.as_str() {
            "vertex" => ply.vertices(source, element, rows)?,
            "face" => ply.faces(source, element, rows)?,
            "tristrips" => {
                return Err(source.malformed(
                    Place::Part("element tristrips".into()),
                    "triangle strips are not supported",
                ));
            }
            _ => {}
        }
    }
    Ok(ply)
}

/// Lines of a header that keep the positions of cameras, for which PLY has no element: `comment viewpoint x y z`.
pub(super) fn viewpoint_comments(viewpoints: &[[f32; 3]]) -> String {
    viewpoints.iter().map(|[x, y, z]| format!("comment viewpoint {x} {y} {z}\n")).collect()
}

/// The position of a camera that a comment keeps.
fn viewpoint(comment: &str) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = comment
        .trim()
        .strip_prefix("viewpoint ")?
        .split_whitespace()
        .map_while(|word| word.parse().ok())
        .collect();
    numbers.try_into().ok()
}

impl Ply {
    fn vertices(
        &mut self,
        source: &Source<'_>,
        element: &ElementDef,
        rows: Vec<(Row, usize)>,
    ) -> Result<(), FileError> {
        let has = |names: &[&str]| names.iter().all(|name| element.properties.contains_key(*name));
        if !has(&NAMES[..3]) {
            return Err(source.malformed(Place::Part("element vertex".into()), "it lacks x, y or z"));
        }
        self.vertices = rows.iter().map(|(row, _)| [0, 1, 2].map(|k| row.numbers[k])).collect();
        self.normals = has(&NAMES[3..])
            .then(|| rows.iter().map(|(row, _)| [3, 4, 5].map(|k| row.numbers[k] as f32)).collect());
        Ok(())
    }

    fn faces(
        &mut self,
        source: &Source<'_>,
        element: &ElementDef,
        rows: Vec<(Row, usize)>,
    ) -> Result<(), FileError> {
        if element.count > 0 && !element.properties.keys().any(|name| is_indices(name)) {
            return Err(source.malformed(Place::Part("element face".into()), "it lacks vertex_indices"));
        }
        self.faces.extend(rows.into_iter().map(|(row, line)| Face { corners: row.indices, line }));
        Ok(())
    }
}

/// Rejects element counts that exceed the length of the file, before anything is read or reserved.
fn check_lengths(source: &Source<'_>, header: &Header, body: usize) -> Result<(), FileError> {
    let held = source.bytes.len() - body;
    let mut wanted = 0_usize;
    for element in header.elements.values() {
        let size = match header.encoding {
            // At least a digit and a space per property.
            Encoding::Ascii => 2 * element.properties.len(),
            // A list may be empty, so only its length field counts.
            _ => element
                .properties
                .values()
                .map(|property| match &property.data_type {
                    PropertyType::Scalar(kind) | PropertyType::List(kind, _) => size(kind),
                })
                .sum(),
        };
        let name = &element.name;
        if size == 0 && element.count > 0 {
            return Err(source.malformed(Place::Part(format!("element {name}")), "it has no properties"));
        }
        wanted = wanted.saturating_add(size.saturating_mul(element.count));
        // No space follows the last number of a text.
        if wanted > held + 1 {
            let reason = format!(
                "the header declares {} of element {name}, for which {held} bytes after the header are too few",
                element.count
            );
            return Err(source.truncated(Place::Byte(body), reason));
        }
    }
    Ok(())
}

fn size(kind: &ScalarType) -> usize {
    match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

/// The message of ply-rs-bw without the line number in front and the quoted line behind.
fn first_line(message: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    let message = match message.split_once(": ") {
        Some((line, message)) if line.starts_with("Line ") => message,
        _ => message,
    };
    message.trim_end_matches('.').to_string()
}

/// The body of a text PLY, with one row per line.
struct Text<'a> {
    source: &'a Source<'a>,
    lines: Box<dyn Iterator<Item = (usize, std::borrow::Cow<'a, str>)> + 'a>,
}

impl<'a> Text<'a> {
    fn new(source: &'a Source<'a>, body: usize) -> Self {
        let before = source.bytes[..body].iter().filter(|b| **b == b'\n').count();
        let lines = lines(&source.bytes[body..]).map(move |(n, line)| (n + before, line));
        Self { source, lines: Box::new(lines.filter(|(_, line)| !line.is_empty())) }
    }

    fn rows(&mut self, element: &ElementDef) -> Result<Vec<(Row, usize)>, FileError> {
        let mut rows = Vec::with_capacity(element.count);
        for i in 0..element.count {
            let Some((line, text)) = self.lines.next() else {
                let reason = format!(
                    "the header declares {} of element {}, but there are {i}",
                    element.count, element.name
                );
                return Err(self.source.truncated(Place::Whole, reason));
            };
            let row =
                row(element, &text).map_err(|reason| self.source.malformed(Place::Line(line), reason))?;
            rows.push((row, line));
        }
        Ok(rows)
    }
}

fn row(element: &ElementDef, text: &str) -> Result<Row, String> {
    let mut words = text.split_ascii_whitespace();
    let mut row = Row::default();
    for (name, property) in &element.properties {
        let word = words.next().ok_or_else(|| format!("{name} of element {} is missing", element.name))?;
        let nonsense =
            |word: &str| format!("{name} of element {} cannot be \"{}\"", element.name, short(word));
        match property.data_type {
            PropertyType::Scalar(_) => {
                let value = number(word).ok_or_else(|| nonsense(word))?;
                if let Some(slot) = NAMES.iter().position(|known| known == name) {
                    row.numbers[slot] = value;
                }
            }
            PropertyType::List(..) => {
                let length: usize = word.parse().map_err(|_| nonsense(word))?;
                for i in 0..length {
                    let word = words
                        .next()
                        .ok_or_else(|| format!("{name} declares {length} numbers, but has {i}"))?;
                    if is_indices(name) {
                        row.indices.push(word.parse().map_err(|_| nonsense(word))?);
                    }
                }
            }
        }
    }
    match words.next() {
        Some(word) => {
            Err(format!("\"{}\" is more than the header declares for element {}", short(word), element.name))
        }
        None => Ok(row),
    }
}
