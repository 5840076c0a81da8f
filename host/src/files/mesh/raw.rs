//! The unchecked mesh that every reader fills, and its conversion to a valid mesh.

use std::collections::HashMap;

use super::super::source::{Format, Source};
use super::super::{FileError, Place};
use super::MeshFile;
use super::polygon::Triangulator;

/// Most vertices and face corners of a mesh that uses parts of its file many times, so that a short file could require any
/// amount of memory: more than the command takes, and 0.2 GB.
pub(super) const MOST_REPEATED: usize = 16_000_000;

/// Vertices and polygons of a file, unchecked.
#[derive(Default)]
pub(crate) struct RawMesh {
    pub(crate) vertices: Vec<[f32; 3]>,
    /// Vertex indices of the corners of all faces, concatenated.
    corners: Vec<u32>,
    faces: Vec<RawFace>,
    /// First index that does not fit in a u32.
    impossible: Option<(Place, i64)>,
    pub(crate) viewpoints: Vec<[f32; 3]>,
    pub(crate) notes: Vec<String>,
}

struct RawFace {
    /// End of its corners in `corners`.
    end: usize,
    /// Its line in a text file, 0 in other files.
    line: usize,
}

impl RawMesh {
    /// Adds a polygon by the vertex indices of its corners, counted from 0. `line` is 0 in files without lines.
    pub(crate) fn face(&mut self, corners: impl IntoIterator<Item = i64>, line: usize) {
        for index in corners {
            let corner = u32::try_from(index).unwrap_or_else(|_| {
                let place = place(self.faces.len(), line);
                self.impossible.get_or_insert((place, index));
                u32::MAX
            });
            self.corners.push(corner);
        }
        self.faces.push(RawFace { end: self.corners.len(), line });
    }

    pub(crate) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Number of vertices and face corners together.
    pub(crate) fn size(&self) -> usize {
        self.vertices.len() + self.corners.len()
    }

    /// Checks all indices and coordinates, merges equal vertices and triangulates the polygons.
    pub(crate) fn finish(self, source: &Source<'_>) -> Result<MeshFile, FileError> {
        if self.faces.is_empty() {
            let path = source.path.into();
            return Err(match self.vertices.is_empty() {
                true => FileError::NoTriangles { path },
                false => FileError::CloudNotMesh { path },
            });
        }
        let used = self.used(source)?;
        let Joined { vertices, new_index, places } = self.join(&used, source)?;
        let mut notes = self.notes;
        // An STL repeats the vertex at every corner, so that merging is no news.
        if source.format != Format::Stl && vertices.len() < places {
            notes.push(format!("{places} vertices at {} distinct positions were merged.", vertices.len()));
        }
        let unused = used.iter().filter(|used| !**used).count();
        if unused > 0 {
            notes.push(format!("{unused} of {} vertices belong to no face and were dropped.", used.len()));
        }

        let mut triangulator = Triangulator::default();
        let mut triangles = Vec::with_capacity(self.faces.len());
        let (mut start, mut dropped, mut thin) = (0, 0, 0);
        let mut ring = Vec::new();
        for face in &self.faces {
            ring.clear();
            ring.extend(self.corners[start..face.end].iter().map(|&corner| new_index[corner as usize]));
            start = face.end;
            ring.dedup();
            while ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            if ring.len() < 3 {
                dropped += 1;
                continue;
            }
            let before = triangles.len();
            triangulator.append(&vertices, &ring, &mut triangles);
            dropped += usize::from(triangles.len() == before);
            thin += triangles[before..].iter().filter(|t| !has_area(&vertices, t)).count();
        }
        if dropped > 0 {
            notes.push(format!(
                "{dropped} of {} faces had repeated vertices and were dropped.",
                self.faces.len()
            ));
        }
        if thin == triangles.len() {
            return Err(FileError::AllDegenerate { path: source.path.into(), faces: self.faces.len() });
        }
        if thin > 0 {
            notes.push(format!("{thin} of {} triangles have no area.", triangles.len()));
        }
        let (vertices, triangles) = without_strays(vertices, triangles);
        Ok(MeshFile { vertices, triangles, viewpoints: self.viewpoints, notes })
    }

    /// Flags of the vertices that faces use. An index out of range is an error.
    fn used(&self, source: &Source<'_>) -> Result<Vec<bool>, FileError> {
        let first = if source.format == Format::Obj { 1 } else { 0 };
        let out_of_range = |place: Place, index: i64| FileError::IndexOutOfRange {
            path: source.path.into(),
            place,
            index: index.saturating_add(first.into()),
            count: self.vertices.len(),
            first,
        };
        if let Some((place, index)) = &self.impossible {
            return Err(out_of_range(place.clone(), *index));
        }
        let mut used = vec![false; self.vertices.len()];
        let mut start = 0;
        for (number, face) in self.faces.iter().enumerate() {
            for &corner in &self.corners[start..face.end] {
                *used
                    .get_mut(corner as usize)
                    .ok_or_else(|| out_of_range(place(number, face.line), corner.into()))? = true;
            }
            start = face.end;
        }
        Ok(used)
    }

    /// Merges vertices at the same position, in the order of the file, and drops those that no face uses.
    fn join(&self, used: &[bool], source: &Source<'_>) -> Result<Joined, FileError> {
        let mut by_place: HashMap<[u32; 3], u32> = HashMap::with_capacity(self.vertices.len());
        let mut vertices: Vec<[f32; 3]> = Vec::new();
        let mut new_index = vec![u32::MAX; self.vertices.len()];
        let mut places = 0;
        for (old, vertex) in self.vertices.iter().enumerate() {
            if !used[old] {
                continue;
            }
            if !vertex.iter().all(|x| x.is_finite()) {
                return Err(source.not_finite("vertex", old));
            }
            places += 1;
            // Adding zero turns -0 into 0.
            let next = vertices.len() as u32;
            let new = *by_place.entry(vertex.map(|x| (x + 0.0).to_bits())).or_insert(next);
            if new == next {
                vertices.push(*vertex);
            }
            new_index[old] = new;
        }
        Ok(Joined { vertices, new_index, places })
    }
}

struct Joined {
    vertices: Vec<[f32; 3]>,
    /// Index in `vertices` of each vertex of the file.
    new_index: Vec<u32>,
    /// Number of vertices of the file that are used.
    places: usize,
}

fn place(face: usize, line: usize) -> Place {
    if line > 0 { Place::Line(line) } else { Place::Face(face) }
}

/// Whether the triangle has an area. Differences and products of f32 values are so accurate in f64 that only a true
/// zero is zero.
fn has_area(vertices: &[[f32; 3]], triangle: &[u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|i| vertices[i as usize].map(f64::from));
    let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
    [(1, 2), (2, 0), (0, 1)].iter().any(|&(i, j)| u[i] * v[j] != u[j] * v[i])
}

/// Drops vertices that no triangle uses, which the removal of a face can leave behind.
fn without_strays(vertices: Vec<[f32; 3]>, mut triangles: Vec<[u32; 3]>) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut used = vec![false; vertices.len()];
    for &corner in triangles.as_flattened() {
        used[corner as usize] = true;
    }
    if used.iter().all(|used| *used) {
        return (vertices, triangles);
    }
    let mut kept = Vec::new();
    let new_index: Vec<u32> = (vertices.iter().zip(used))
        .map(|(vertex, used)| {
            let index = kept.len() as u32;
            if used {
                kept.push(*vertex);
            }
            index
        })
        .collect();
    for corner in triangles.as_flattened_mut() {
        *corner = new_index[*corner as usize];
    }
    (kept, triangles)
}
