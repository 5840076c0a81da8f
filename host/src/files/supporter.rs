//! Supporters, which may be scans or models.

use std::path::Path;

use super::source::{ANY, Format, Source};
use super::{CloudFile, FileError, MeshFile, cloud, mesh};

/// Content of a supporter's file.
#[derive(Clone, Debug, PartialEq)]
pub enum SupporterFile {
    /// A triangle mesh.
    Mesh(MeshFile),
    /// A point cloud.
    Cloud(CloudFile),
}

/// Reads a supporter, mesh or cloud.
///
/// The extension decides. PLY and OBJ can hold either: a file with faces is a mesh, a file without faces is a cloud.
pub fn read_supporter(path: &Path) -> Result<SupporterFile, FileError> {
    let source = Source::open(path, ANY)?;
    match source.format {
        Format::Pcd | Format::Xyz => cloud::read(&source).map(SupporterFile::Cloud),
        Format::Stl | Format::Gltf | Format::Urdf => mesh::read(&source).map(SupporterFile::Mesh),
        Format::Obj | Format::Ply => match mesh::read(&source) {
            Err(FileError::CloudNotMesh { .. }) => cloud::read(&source).map(SupporterFile::Cloud),
            mesh => mesh.map(SupporterFile::Mesh),
        },
    }
}
