//! A supporter is whatever the robot has of it: a scan or a model.

use std::path::Path;

use super::source::{ANY, Format, Source};
use super::{CloudFile, FileError, MeshFile, cloud, mesh};

/// What a supporter's file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum SupporterFile {
    /// A surface.
    Mesh(MeshFile),
    /// Points.
    Cloud(CloudFile),
}

/// Reads a supporter, mesh or cloud.
///
/// The extension decides, but for PLY and OBJ, which can be either: with faces they are a mesh, without a cloud.
pub fn read_supporter(path: &Path) -> Result<SupporterFile, FileError> {
    let source = Source::open(path, ANY)?;
    match source.format {
        Format::Pcd | Format::Xyz => cloud::read(&source).map(SupporterFile::Cloud),
        Format::Stl | Format::Gltf => mesh::read(&source).map(SupporterFile::Mesh),
        Format::Obj | Format::Ply => match mesh::read(&source) {
            Err(FileError::CloudNotMesh { .. }) => cloud::read(&source).map(SupporterFile::Cloud),
            mesh => mesh.map(SupporterFile::Mesh),
        },
    }
}
