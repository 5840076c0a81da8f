//! Triangle meshes.

mod gltf;
mod obj;
mod polygon;
mod raw;
mod stl;

use std::path::Path;

use super::FileError;
use super::ply::{self, Ply};
use super::source::{Format, MESHES, Source};
use raw::RawMesh;

/// A mesh as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Vertices in the file's frame and unit. Each is finite, used by a triangle, and at a place of its own.
    pub vertices: Vec<[f32; 3]>,
    /// Corners of each triangle, counter-clockwise seen from outside if the file keeps to that. Every index is in range and
    /// no triangle repeats one; some may have no area.
    pub triangles: Vec<[u32; 3]>,
    /// What a person should know: short sentences.
    pub notes: Vec<String>,
}

/// Reads a mesh: OBJ, STL, PLY, GLB or glTF, told by the extension.
pub fn read_mesh(path: &Path) -> Result<MeshFile, FileError> {
    read(&Source::open(path, MESHES)?)
}

pub(super) fn read(source: &Source<'_>) -> Result<MeshFile, FileError> {
    match source.format {
        Format::Obj => obj::read(source)?,
        Format::Stl => stl::read(source)?,
        Format::Ply => of_ply(ply::read(source)?),
        Format::Gltf => gltf::read(source)?,
        Format::Pcd | Format::Xyz => {
            return Err(FileError::CloudNotMesh { path: source.path.into() });
        }
    }
    .finish(source)
}

fn of_ply(ply: Ply) -> RawMesh {
    let mut mesh = RawMesh::default();
    mesh.vertices = ply.vertices;
    for face in ply.faces {
        mesh.face(face.corners, face.line);
    }
    mesh
}

/// The vertices of an OBJ without faces.
pub(super) fn obj_points(source: &Source<'_>) -> Result<Vec<[f32; 3]>, FileError> {
    let raw = obj::read(source)?;
    match raw.face_count() {
        0 => Ok(raw.vertices),
        _ => Err(FileError::MeshNotCloud { path: source.path.into() }),
    }
}
