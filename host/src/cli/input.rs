//! Reads an object or a supporter: file, units, axes, limits, and what a person should know about it.

use super::{Axis, CloudArguments};
use anyhow::{Context, Result};
use hangpose::files::{self, CloudFile, MeshFile, SupporterFile};
use hangpose::geometry::Aabb;
use hangpose::{TooLarge, sample_supporter};
use std::path::Path;

/// Reads an object and says on standard error what is odd about it.
pub(super) fn read_object(path: &Path, scale: f32, up: Axis) -> Result<MeshFile> {
    let mut mesh = files::read_mesh(path)?;
    TooLarge::check_mesh(&mesh).with_context(|| path.display().to_string())?;
    place(&mut mesh.vertices, scale, up);
    let aabb = mesh.mesh().with_context(|| path.display().to_string())?.aabb();
    tell(path, &mesh.notes, warn_of_size(&aabb, "object", "--object-scale"));
    Ok(mesh)
}

/// Reads a supporter, samples it if it is a mesh, and says on standard error what is odd about it.
pub(super) fn read_supporter(
    path: &Path,
    scale: f32,
    up: Axis,
    arguments: &CloudArguments,
) -> Result<CloudFile> {
    let (cloud, notes) = match files::read_supporter(path)? {
        SupporterFile::Mesh(mut mesh) => {
            TooLarge::check_mesh(&mesh).with_context(|| path.display().to_string())?;
            place(&mut mesh.vertices, scale, up);
            let checked = mesh.mesh().with_context(|| path.display().to_string())?;
            (sample_supporter(&checked, arguments.supporter_points as usize, 0), mesh.notes)
        }
        SupporterFile::Cloud(mut cloud) => {
            TooLarge::check_cloud(&cloud).with_context(|| path.display().to_string())?;
            place(&mut cloud.points, scale, up);
            for normal in cloud.normals.iter_mut().flatten() {
                *normal = up.turn(*normal);
            }
            let notes = core::mem::take(&mut cloud.notes);
            (cloud, notes)
        }
    };
    let aabb = Aabb::of(cloud.cloud().with_context(|| path.display().to_string())?.points());
    tell(path, &notes, warn_of_size(&aabb, "supporter", "--supporter-scale"));
    Ok(cloud)
}

fn place(points: &mut [[f32; 3]], scale: f32, up: Axis) {
    for point in points {
        *point = up.turn(point.map(|x| x * scale));
    }
}

fn tell(path: &Path, notes: &[String], warning: Option<String>) {
    for note in notes {
        eprintln!("note: {}: {note}", path.display());
    }
    if let Some(warning) = warning {
        eprintln!("warning: {}: {warning}", path.display());
    }
}

/// Nothing that hangs on a hook, and no hook, is larger than this, in metres ...
const TOO_LARGE: f32 = 5.0;
/// ... or smaller than this.
const TOO_SMALL: f32 = 0.005;

/// What the size says about the unit, if it is not one for a hand.
fn warn_of_size(aabb: &Aabb, what: &str, option: &str) -> Option<String> {
    let size = aabb.extents().max();
    let (unit, scale) = match size {
        0.0..TOO_SMALL => ("kilometres", "1000"),
        TOO_SMALL..=TOO_LARGE => return None,
        TOO_LARGE..=100.0 => ("centimetres", "0.01"),
        _ => ("millimetres", "0.001"),
    };
    Some(format!(
        "the {what} is {size} m large, which is no size for a hand; if it is in {unit}, say {option} {scale}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hangpose::geometry::Point;

    #[test]
    fn odd_sizes_name_the_likely_unit() {
        let warning = |size: f32| {
            warn_of_size(&Aabb::of(&[Point::origin(), Point::new(0.01 * size, size, 0.0)]), "mug", "--scale")
        };
        assert_eq!(warning(0.1), None);
        assert!(warning(120.0).unwrap().ends_with("if it is in millimetres, say --scale 0.001"));
        assert!(warning(12.0).unwrap().ends_with("if it is in centimetres, say --scale 0.01"));
        assert!(warning(0.0001).unwrap().ends_with("if it is in kilometres, say --scale 1000"));
    }
}
