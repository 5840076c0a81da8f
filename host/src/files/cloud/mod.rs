//! Point clouds.

mod pcd;
mod write;
mod xyz;

pub use write::ply as cloud_ply_bytes;

use std::path::Path;

use super::source::{CLOUDS, Format, Source};
use super::{FileError, mesh, ply};

/// Content of a point cloud file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CloudFile {
    /// Points in the unit of the file, each finite, as offsets from the `origin`.
    pub points: Vec<[f32; 3]>,
    /// Where the points are in the frame of the file: zero unless its coordinates are so large, as those of a map are, that
    /// `f32` would lose details.
    pub origin: [f64; 3],
    /// Positions from which the points were seen, as far as the file says, as offsets from the `origin`.
    pub viewpoints: Vec<[f32; 3]>,
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
            RawCloud {
                points: ply.vertices,
                normals: ply.normals,
                viewpoints: ply.viewpoints,
                ..RawCloud::default()
            }
        }
        Format::Stl | Format::Gltf | Format::Urdf => return Err(mesh_not_cloud()),
    }
    .finish(source)
}

/// Points of a file, unchecked.
#[derive(Default)]
struct RawCloud {
    points: Vec<[f64; 3]>,
    viewpoints: Vec<[f64; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    /// Number of points that were marked as missing (NaN) and dropped.
    missing: usize,
    notes: Vec<String>,
}

impl RawCloud {
    fn finish(self, source: &Source<'_>) -> Result<CloudFile, FileError> {
        let Self { points, viewpoints, mut normals, missing, mut notes } = self;
        if points.is_empty() {
            return Err(FileError::NoPoints { path: source.path.into(), missing });
        }
        let finite = |p: &[f64; 3]| p.iter().all(|x| (*x as f32).is_finite());
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
            if let Some(index) = list.iter().position(|n| !finite(&n.map(f64::from))) {
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
        let origin = origin(&points);
        if origin != [0.0; 3] {
            let [x, y, z] = origin;
            notes.push(format!(
                "The coordinates are far from the origin: ({x}, {y}, {z}) was subtracted before the analysis."
            ));
        }
        let moved = |list: Vec<[f64; 3]>| -> Vec<[f32; 3]> {
            list.into_iter().map(|p| [0, 1, 2].map(|i| (p[i] - origin[i]) as f32)).collect()
        };
        Ok(CloudFile { points: moved(points), origin, viewpoints: moved(viewpoints), normals, notes })
    }
}

/// What to subtract from the points so that `f32` holds their details: zero if they are close enough to the origin.
fn origin(points: &[[f64; 3]]) -> [f64; 3] {
    /// Distance from the origin, in extents of the cloud, up to which the error of `f32`, 6e-8 of a coordinate, does not
    /// matter.
    const FAR: f64 = 1000.0;
    let bounds = |pick: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|a, b| [0, 1, 2].map(|i| pick(a[i], b[i]))).unwrap_or_default()
    };
    let (low, high) = (bounds(f64::min), bounds(f64::max));
    let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let distance = low.iter().chain(&high).map(|x| x.abs()).fold(0.0, f64::max);
    if extent > 0.0 && distance > FAR * extent { low.map(f64::floor) } else { [0.0; 3] }
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
