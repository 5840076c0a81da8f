//! Point clouds.

mod pcd;
mod xyz;

use std::path::Path;

use super::source::{CLOUDS, Format, Source};
use super::{FileError, mesh, ply};

/// A point cloud as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct CloudFile {
    /// Points in the file's frame and unit, each finite.
    pub points: Vec<[f32; 3]>,
    /// A normal for each point, if the file has any: of unit length, or zero where the file has none for that point.
    pub normals: Option<Vec<[f32; 3]>>,
    /// What a person should know: short sentences.
    pub notes: Vec<String>,
}

/// Reads a point cloud: PLY, PCD or XYZ text, told by the extension. An OBJ with vertices but no faces is one too.
pub fn read_cloud(path: &Path) -> Result<CloudFile, FileError> {
    read(&Source::open(path, CLOUDS)?)
}

pub(super) fn read(source: &Source<'_>) -> Result<CloudFile, FileError> {
    let mesh_not_cloud = || FileError::MeshNotCloud { path: source.path.into() };
    match source.format {
        Format::Pcd => pcd::read(source)?,
        Format::Xyz => xyz::read(source)?,
        Format::Obj => RawCloud { points: mesh::obj_points(source)?, ..RawCloud::default() },
        Format::Ply => {
            let ply = ply::read(source)?;
            if !ply.faces.is_empty() {
                return Err(mesh_not_cloud());
            }
            RawCloud { points: ply.vertices, normals: ply.normals, ..RawCloud::default() }
        }
        Format::Stl | Format::Gltf => return Err(mesh_not_cloud()),
    }
    .finish(source)
}

/// Points as they stand in the file, unchecked.
#[derive(Default)]
struct RawCloud {
    points: Vec<[f32; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    /// How many points were marked as missing and left out.
    missing: usize,
    notes: Vec<String>,
}

impl RawCloud {
    fn finish(self, source: &Source<'_>) -> Result<CloudFile, FileError> {
        let Self { points, mut normals, missing, mut notes } = self;
        if points.is_empty() {
            return Err(FileError::NoPoints { path: source.path.into(), missing });
        }
        let finite = |p: &[f32; 3]| p.iter().all(|x| x.is_finite());
        if let Some(index) = points.iter().position(|p| !finite(p)) {
            return Err(source.not_finite("point", index));
        }
        if missing > 0 {
            notes.push(format!(
                "{missing} of {} points were missing (NaN) and were left out.",
                missing + points.len()
            ));
        }
        if let Some(list) = &mut normals {
            if let Some(index) = list.iter().position(|n| !finite(n)) {
                return Err(source.not_finite("normal of point", index));
            }
            let (zero, changed) = normalise(list);
            if zero == list.len() {
                normals = None;
                notes.push("All normals are zero and were ignored.".into());
            } else {
                if zero > 0 {
                    notes.push(format!("{zero} of {} normals are zero.", list.len()));
                }
                if changed > 0 {
                    notes.push(format!(
                        "{changed} of {} normals were not of unit length and were renormalised.",
                        list.len()
                    ));
                }
            }
        }
        Ok(CloudFile { points, normals, notes })
    }
}

/// Makes normals of unit length, but for zeros; returns how many were zero and how many were far from it.
fn normalise(normals: &mut [[f32; 3]]) -> (usize, usize) {
    // What a text file with three decimals is off by.
    const FAR: f64 = 2e-3;
    let (mut zero, mut changed) = (0, 0);
    for normal in normals {
        let exact = normal.map(f64::from);
        let length = exact.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 {
            zero += 1;
            continue;
        }
        changed += usize::from((length - 1.0).abs() > FAR);
        // One that is as close as f32 gets stays as it is, bit for bit.
        if (length - 1.0).abs() > 1e-6 {
            *normal = exact.map(|x| (x / length) as f32);
        }
    }
    (zero, changed)
}
