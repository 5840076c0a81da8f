//! Files with which other programs predict from the same input.

use crate::tables::case::Case;
use anyhow::Result;
use hangpose::files::CloudFile;
use hangpose::geometry::Mesh;
use serde::Serialize;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// A pair and its files.
#[derive(Clone, Debug, Serialize)]
pub struct Pair {
    /// Name of the pair.
    pub name: String,
    /// Kind of the object.
    pub object_kind: String,
    /// Kind of the supporter.
    pub supporter_kind: String,
    /// Seed of the samples.
    pub seed: u64,
    /// File of the object's mesh, in the folder of the list.
    pub object: String,
    /// File of the supporter's cloud with normals, in the same folder.
    pub supporter: String,
    /// Triangles of the object.
    pub triangles: usize,
    /// Points of the supporter.
    pub points: usize,
}

/// Writes the mesh and the cloud of each case, and `pairs.json` with the list of them.
pub fn export(cases: &[Case], folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    let mut pairs = Vec::new();
    for (index, case) in cases.iter().enumerate() {
        let (object, supporter) = (format!("{index}_object.ply"), format!("{index}_supporter.ply"));
        let (mesh, cloud) = (case.object.mesh(), case.supporter_cloud());
        write_mesh(&folder.join(&object), &mesh)?;
        write_cloud(&folder.join(&supporter), &cloud)?;
        pairs.push(Pair {
            name: case.name.clone(),
            object_kind: case.object_kind.clone(),
            supporter_kind: case.supporter_kind.clone(),
            seed: case.seed,
            object,
            supporter,
            triangles: mesh.triangles().len(),
            points: cloud.points.len(),
        });
    }
    std::fs::write(folder.join("pairs.json"), serde_json::to_string_pretty(&pairs)?)?;
    Ok(())
}

/// Writes a mesh as PLY, binary.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    write!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", vertices.len())?;
    write!(file, "property float x\nproperty float y\nproperty float z\n")?;
    write!(file, "element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles.len())?;
    for vertex in vertices {
        write_all(&mut file, &[vertex.x, vertex.y, vertex.z])?;
    }
    for triangle in triangles {
        file.write_all(&[3])?;
        for index in triangle {
            file.write_all(&index.to_le_bytes())?;
        }
    }
    Ok(file.flush()?)
}

/// Writes a cloud with its normals as PLY, binary.
pub fn write_cloud(path: &Path, cloud: &CloudFile) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    write!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", cloud.points.len())?;
    let normals = cloud.normals.as_deref().unwrap_or_default();
    let names =
        if normals.is_empty() { ["x", "y", "z"].as_slice() } else { &["x", "y", "z", "nx", "ny", "nz"] };
    for name in names {
        writeln!(file, "property float {name}")?;
    }
    writeln!(file, "end_header")?;
    for (index, point) in cloud.points.iter().enumerate() {
        write_all(&mut file, point)?;
        if let Some(normal) = normals.get(index) {
            write_all(&mut file, normal)?;
        }
    }
    Ok(file.flush()?)
}

/// Writes numbers as 32-bit floats, little endian.
pub fn write_all(file: &mut impl Write, numbers: &[f32]) -> Result<()> {
    for number in numbers {
        file.write_all(&number.to_le_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{OBJECTS, SUPPORTERS};
    use hangpose::files::{read_cloud, read_mesh};

    #[test]
    fn files_read_back() {
        let (object, supporter) = (OBJECTS[0].make(1).solid, SUPPORTERS[0].make(1).solid);
        let folder = std::env::temp_dir().join(format!("hangpose-export-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let cloud = hangpose::sample_supporter(&supporter.mesh(), 300, 1);
        write_mesh(&folder.join("mesh.ply"), &object.mesh()).unwrap();
        write_cloud(&folder.join("cloud.ply"), &cloud).unwrap();
        let (mesh, points) =
            (read_mesh(&folder.join("mesh.ply")).unwrap(), read_cloud(&folder.join("cloud.ply")).unwrap());
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!((mesh.vertices, mesh.triangles), (object.vertices, object.triangles));
        assert_eq!((points.points, points.normals), (cloud.points, cloud.normals));
    }
}
