//! Point clouds.

mod pcd;
mod xyz;

use std::path::Path;

use super::source::{CLOUDS, Format, Source};
use super::{FileError, mesh, ply};

/// Content of a point cloud file.
#[derive(Clone, Debug, PartialEq)]
pub struct CloudFile {
    /// Points in the frame and unit of the file, each finite.
    pub points: Vec<[f32; 3]>,
    /// One normal per point, if the file has normals: of unit length, or zero where the file has none for the point.
    pub normals: Option<Vec<[f32; 3]>>,
    /// What the reader changed or ignored, as sentences for the user.
    pub notes: Vec<String>,
}

/// Reads a point cloud: PLY, PCD or XYZ text, according to the extension, or an OBJ with vertices but no faces.
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

/// Points of a file, unchecked.
#[derive(Default)]
struct RawCloud {
    points: Vec<[f32; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    /// Number of points that were marked as missing (NaN) and dropped.
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
                "{missing} of {} points were missing (NaN) and were dropped.",
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

/// Normalises all normals that are not zero. Returns the number of zero normals and of those that were not of unit
/// length.
fn normalise(normals: &mut [[f32; 3]]) -> (usize, usize) {
    // Error in length of a normal written with three decimals.
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
        // A normal of unit length within the rounding of f32 keeps its bits.
        if (length - 1.0).abs() > 1e-6 {
            *normal = exact.map(|x| (x / length) as f32);
        }
    }
    (zero, changed)
}
