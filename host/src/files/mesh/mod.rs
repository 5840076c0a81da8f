//! Triangle meshes.

mod gltf;
mod obj;
mod polygon;
mod raw;
mod stl;
mod urdf;
mod write;

use std::path::Path;

pub use write::ply as ply_bytes;

use super::FileError;
use super::ply::{self, Ply};
use super::source::{Format, MESHES, Source};
use raw::RawMesh;

/// Content of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Vertices in the frame and unit of the file. Each is finite, distinct from the others, and used by a triangle.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of each triangle, in the winding order of the file, which by convention is counter-clockwise seen
    /// from outside. Every index is in range and no triangle repeats one. A triangle may have no area.
    pub triangles: Vec<[u32; 3]>,
    /// Positions of the cameras that the mesh was made from, in the frame and unit of the file, if it says so.
    pub viewpoints: Vec<[f32; 3]>,
    /// What the reader changed or ignored, as sentences for the user.
    pub notes: Vec<String>,
}

/// Reads a mesh: OBJ, STL, PLY, GLB, glTF or URDF, according to the extension.
///
/// The path may begin with `package://`, and `robot.urdf#link` is one link of a URDF.
pub fn read_mesh(path: &Path) -> Result<MeshFile, FileError> {
    read(&Source::open(path, MESHES)?)
}

pub(super) fn read(source: &Source<'_>) -> Result<MeshFile, FileError> {
    match source.format {
        Format::Obj => obj::read(source)?,
        Format::Stl => stl::read(source)?,
        Format::Ply => of_ply(ply::read(source)?),
        Format::Gltf => gltf::read(source)?,
        Format::Urdf => urdf::read(source)?,
        Format::Pcd | Format::Xyz => {
            return Err(FileError::CloudNotMesh { path: source.path.into() });
        }
    }
    .finish(source)
}

fn of_ply(ply: Ply) -> RawMesh {
    let mut mesh = RawMesh::default();
    mesh.vertices = ply.vertices.into_iter().map(|vertex| vertex.map(|x| x as f32)).collect();
    mesh.viewpoints = ply.viewpoints.into_iter().map(|position| position.map(|x| x as f32)).collect();
    for face in ply.faces {
        mesh.face(face.corners, face.line);
    }
    mesh
}

/// The vertices of an OBJ without faces.
pub(super) fn obj_points(source: &Source<'_>) -> Result<Vec<[f64; 3]>, FileError> {
    let raw = obj::read(source)?;
    match raw.face_count() {
        0 => Ok(raw.vertices.into_iter().map(|vertex| vertex.map(f64::from)).collect()),
        _ => Err(FileError::MeshNotCloud { path: source.path.into() }),
    }
}
