//! glTF 2.0, as one file (GLB) or as JSON with its buffers beside it or inside it.
//!
//! The gltf crate reads and validates the JSON. Buffers are read in `buffers`, because the crate's import would also
//! load and decode every image. Their numbers are read in `accessor`, because the crate's iterators trust offsets,
//! counts and types.

mod accessor;
mod buffers;

use gltf::json::validation::{Checked, Error as Fault};
use gltf::mesh::Mode;
use gltf::{Document, Node, Primitive, Semantic};
use nalgebra::{Matrix4, Point3};

use super::super::source::Source;
use super::super::{FileError, Place};
use super::RawMesh;
use super::raw::MOST_REPEATED;
use std::rc::Rc;

pub(super) fn read(source: &Source<'_>) -> Result<RawMesh, FileError> {
    let malformed = |reason: String| source.malformed(Place::Whole, reason);
    let bytes = source.bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&source.bytes);
    // The crate subtracts the 12 bytes of the header from the declared length without a check.
    if bytes.starts_with(b"glTF") {
        match bytes.get(8..12).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize) {
            Some(length) if length < 12 => {
                return Err(malformed(format!("a GLB cannot be {length} bytes long")));
            }
            Some(length) if length <= bytes.len() => {}
            Some(length) => {
                let reason = format!("the header declares {length} bytes, but there are {}", bytes.len());
                return Err(source.truncated(Place::Byte(bytes.len()), reason));
            }
            None => {
                return Err(
                    source.truncated(Place::Byte(source.bytes.len()), "a GLB begins with 12 bytes of header")
                );
            }
        }
    }
    let gltf::Gltf { document, blob } =
        gltf::Gltf::from_slice_without_validation(bytes).map_err(|e| malformed(reason(&e)))?;
    let document = validate(document).map_err(malformed)?;
    let mut scene = Scene {
        source,
        buffers: buffers::read(source, &document, blob)?,
        mesh: RawMesh::default(),
        others: 0,
        skinned: 0,
    };
    scene.walk(&document)?;
    Ok(scene.finish())
}

/// Has the crate validate every index and type, after working around two defects: it looks up the accessor of POSITION
/// without a check, and it requires bounds, which exporters omit and which are not needed here.
fn validate(document: Document) -> Result<Document, String> {
    let mut root = document.into_json();
    for (number, mesh) in root.meshes.iter().enumerate() {
        for primitive in &mesh.primitives {
            let Some(positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
                continue;
            };
            let Some(accessor) = root.accessors.get_mut(positions.value()) else {
                return Err(format!("mesh {number} uses accessor {}, which is missing", positions.value()));
            };
            for bound in [&mut accessor.min, &mut accessor.max] {
                bound.get_or_insert_with(|| vec![0.0; 3].into());
            }
        }
    }
    Document::from_json(root).map_err(|e| reason(&e))
}

/// The message of the crate, reduced to the first entry of a list.
fn reason(error: &gltf::Error) -> String {
    match error {
        gltf::Error::Validation(list) => match list.first() {
            Some((path, Fault::Unsupported)) => {
                format!("{path} names an unsupported extension")
            }
            Some((path, error)) => format!("{path}: {error}"),
            None => error.to_string(),
        },
        _ => error.to_string(),
    }
}

struct Scene<'a> {
    source: &'a Source<'a>,
    buffers: Vec<Rc<Vec<u8>>>,
    mesh: RawMesh,
    /// Number of primitives that are points or lines.
    others: usize,
    /// Number of meshes with a skeleton.
    skinned: usize,
}

impl Scene<'_> {
    /// Visits every node of every scene once; without scenes, every node that is no child of another.
    fn walk(&mut self, document: &Document) -> Result<(), FileError> {
        let mut is_child = vec![false; document.nodes().len()];
        for child in document.nodes().flat_map(|node| node.children()) {
            is_child[child.index()] = true;
        }
        let mut pending: Vec<(Node<'_>, Matrix4<f64>)> = match document.scenes().len() {
            0 => {
                document.nodes().filter(|n| !is_child[n.index()]).map(|n| (n, Matrix4::identity())).collect()
            }
            _ => document.scenes().flat_map(|s| s.nodes()).map(|n| (n, Matrix4::identity())).collect(),
        };
        pending.reverse();
        // A valid node has one parent. In an invalid file this also ends a cycle.
        let mut visited = vec![false; document.nodes().len()];
        while let Some((node, parent)) = pending.pop() {
            if std::mem::replace(&mut visited[node.index()], true) {
                continue;
            }
            let local = Matrix4::from(node.transform().matrix()).map(f64::from);
            let transform = parent * local;
            if let Some(mesh) = node.mesh() {
                self.skinned += usize::from(node.skin().is_some());
                for primitive in mesh.primitives() {
                    let place = format!("mesh {}, primitive {}", mesh.index(), primitive.index());
                    self.primitive(&primitive, &transform, &place)?;
                }
            }
            let first = pending.len();
            pending.extend(node.children().map(|child| (child, transform)));
            pending[first..].reverse();
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        primitive: &Primitive<'_>,
        transform: &Matrix4<f64>,
        place: &str,
    ) -> Result<(), FileError> {
        let malformed = |reason: String| self.source.malformed(Place::Part(place.into()), reason);
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.others += 1;
            return Ok(());
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Err(malformed("it has no POSITION".into()));
        };
        let positions = accessor::positions(&positions, &self.buffers).map_err(malformed)?;
        let indices = match primitive.indices() {
            Some(indices) => accessor::indices(&indices, &self.buffers).map_err(malformed)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(&index) = indices.iter().find(|index| **index as usize >= positions.len()) {
            return Err(FileError::IndexOutOfRange {
                path: self.source.path.into(),
                place: Place::Part(place.into()),
                index: index.into(),
                count: positions.len(),
                first: 0,
            });
        }
        // Of a mesh that is used once, each vertex and each corner has bytes of its own in a buffer.
        let most = MOST_REPEATED.max(self.buffers.iter().map(|buffer| buffer.len()).sum());
        if self.mesh.size() + positions.len() + 3 * indices.len() > most {
            return Err(FileError::TooLarge { path: self.source.path.into(), most });
        }

        let first = self.mesh.vertices.len() as i64;
        self.mesh.vertices.extend(positions.iter().map(|p| {
            let p = transform.transform_point(&Point3::from(p.map(f64::from)));
            [p.x as f32, p.y as f32, p.z as f32]
        }));
        // A reflection reverses the winding order.
        let mirrored = transform.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        let mut add = |[a, b, c]: [u32; 3]| {
            let corners = if mirrored { [a, c, b] } else { [a, b, c] };
            self.mesh.face(corners.map(|i| first + i64::from(i)), 0);
        };
        match primitive.mode() {
            Mode::TriangleStrip => {
                for (i, w) in indices.windows(3).enumerate() {
                    add(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] });
                }
            }
            Mode::TriangleFan => {
                for w in indices.get(1..).unwrap_or_default().windows(2) {
                    add([indices[0], w[0], w[1]]);
                }
            }
            _ => {
                for w in indices.chunks_exact(3) {
                    add([w[0], w[1], w[2]]);
                }
            }
        }
        Ok(())
    }

    fn finish(mut self) -> RawMesh {
        if self.others > 0 {
            self.mesh.notes.push(format!("{} primitives are points or lines and were ignored.", self.others));
        }
        if self.skinned > 0 {
            self.mesh
                .notes
                .push(format!("{} meshes have a skeleton and were read in their bind pose.", self.skinned));
        }
        self.mesh
    }
}
