//! Turns a file's content into an object or a supporter: units, axes, limits, and notes for the user.

use super::terminal::say;
use super::{Axis, CloudArguments};
use anyhow::{Context, Result, ensure};
use hangpose::files::{CloudFile, MeshFile, SupporterFile};
use hangpose::geometry::{Aabb, Cloud, Point};
use hangpose::hanging::{CleaningCounts, NormalCounts, Supporter};
use hangpose::{TooLarge, sample_supporter};
use std::path::Path;

/// Transform from a file's coordinates to metres with z up.
pub(super) struct Placement {
    pub(super) scale: f32,
    pub(super) up: Axis,
    /// Name of the option that sets the scale, for warnings; `None` for depth images, whose scale is another matter.
    pub(super) scale_option: Option<&'static str>,
}

/// A shape in metres with z up.
pub(super) struct Placed<T> {
    pub(super) shape: T,
    /// Warning about an implausible size.
    pub(super) scale_warning: Option<String>,
}

/// Applies the placement to an object and prints notes and warnings to standard error.
pub(super) fn object(path: &Path, mut mesh: MeshFile, placement: &Placement) -> Result<Placed<MeshFile>> {
    let at = || path.display().to_string();
    TooLarge::check_mesh(&mesh).with_context(at)?;
    placement.apply(&mut mesh.vertices);
    placement.apply(&mut mesh.viewpoints);
    let aabb = mesh.mesh().with_context(at)?.aabb();
    let scale_warning = placement.warn_of_size(&aabb, "object");
    tell(path, &mesh.notes, &scale_warning);
    Ok(Placed { shape: mesh, scale_warning })
}

/// Applies the placement to a supporter, samples it if it is a mesh, and prints notes and warnings to standard error.
pub(super) fn supporter(
    path: &Path,
    file: SupporterFile,
    placement: &Placement,
    arguments: &CloudArguments,
    seed: u64,
) -> Result<Placed<CloudFile>> {
    let at = || path.display().to_string();
    let (mut cloud, notes) = match file {
        SupporterFile::Mesh(mut mesh) => {
            TooLarge::check_mesh(&mesh).with_context(at)?;
            placement.apply(&mut mesh.vertices);
            let checked = mesh.mesh().with_context(at)?;
            (sample_supporter(&checked, arguments.supporter_points as usize, seed), mesh.notes)
        }
        SupporterFile::Cloud(cloud) => {
            let mut cloud = placed_cloud(path, cloud, placement)?;
            let notes = core::mem::take(&mut cloud.notes);
            (cloud, notes)
        }
    };
    let aabb = Aabb::of(cloud.cloud().with_context(at)?.points());
    if !arguments.viewpoint.is_empty() {
        cloud.viewpoints = arguments.viewpoint.iter().map(|view| in_cloud(&cloud, *view)).collect();
        cloud.cloud().context("--viewpoint")?;
    }
    let scale_warning = placement.warn_of_size(&aabb, "supporter");
    tell(path, &notes, &scale_warning);
    Ok(Placed { shape: cloud, scale_warning })
}

/// Applies the placement to a cloud.
pub(super) fn placed_cloud(path: &Path, mut cloud: CloudFile, placement: &Placement) -> Result<CloudFile> {
    TooLarge::check_cloud(&cloud).with_context(|| path.display().to_string())?;
    placement.apply(&mut cloud.points);
    placement.apply(&mut cloud.viewpoints);
    cloud.origin = placement.up.turn(cloud.origin.map(|x| x * f64::from(placement.scale)));
    for normal in cloud.normals.iter_mut().flatten() {
        *normal = placement.up.turn(*normal);
    }
    Ok(cloud)
}

/// Points on a mesh of things near the supporter, close enough together that no part of an object fits between them.
pub(super) fn scene_mesh(path: &Path, mut mesh: MeshFile, placement: &Placement) -> Result<CloudFile> {
    let at = || path.display().to_string();
    TooLarge::check_mesh(&mesh).with_context(at)?;
    placement.apply(&mut mesh.vertices);
    let checked = mesh.mesh().with_context(at)?;
    let area: f64 =
        checked.triangles().iter().map(|triangle| area(triangle.map(|v| mesh.vertices[v as usize]))).sum();
    let count = (area / (SCENE_SPACING * SCENE_SPACING)) as usize;
    Ok(sample_supporter(&checked, count.clamp(1_000, MAX_SCENE_POINTS), 0))
}

/// Distance between the points of a mesh of a scene, m.
const SCENE_SPACING: f64 = 0.003;
/// Most points of a mesh of a scene; a larger one gets them farther apart.
const MAX_SCENE_POINTS: usize = 200_000;

/// Area of a triangle, m².
fn area(corners: [[f32; 3]; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| Point::from(corner).cast::<f64>());
    0.5 * (b - a).cross(&(c - a)).norm()
}

/// The points as the core takes them, with the places to hang on.
pub(super) fn seen<'a>(file: &'a CloudFile, arguments: &CloudArguments) -> Result<Cloud<'a>> {
    let cloud = file.cloud()?;
    let Some([ax, ay, az, bx, by, bz]) = arguments.region else { return Ok(cloud) };
    let corners = [[ax, ay, az], [bx, by, bz]].map(|corner| in_cloud(file, corner));
    let cloud = cloud.hang_within(corners[0], corners[1]).context("--region")?;
    let is_inside = |p: &Point| (0..3).all(|i| corners[0][i] <= p[i] && p[i] <= corners[1][i]);
    ensure!(
        cloud.points().iter().any(is_inside),
        "--region: no point of the supporter is in the box; give its corners in metres in the supporter frame, after scale and up axis"
    );
    Ok(cloud)
}

/// Coordinates of the supporter frame as an offset from the cloud's origin.
fn in_cloud(cloud: &CloudFile, position: [f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| (position[i] - cloud.origin[i]) as f32)
}

/// Prints notes about the points and the normals of a cloud. The reader has already reported those that were not of unit length.
pub(super) fn tell_of_cloud(path: &Path, supporter: &Supporter, cloud: &Cloud) {
    let CleaningCounts { strays, on_planes, .. } = supporter.cleaning();
    let all = cloud.points().len();
    let guessed = supporter.guessed();
    if guessed > 0 {
        let note = "points were added where no camera saw the far side of bars and plates";
        say("note", format_args!("{}: {guessed} {note}", path.display()));
    }
    for (count, what) in [
        (strays, "are strays in the air and were dropped"),
        (on_planes, "are on walls or tables, which are obstacles: nothing hangs on them"),
    ] {
        if count > 0 {
            say("note", format_args!("{}: {count} of {all} points {what}", path.display()));
        }
    }
    let NormalCounts { estimated, reversed, .. } = supporter.normals();
    let points = cloud.points().len();
    let is_seen = !cloud.viewpoints().is_empty();
    if estimated == points
        && cloud.normals().is_some_and(|given| given.iter().any(|normal| *normal != [0.0; 3]))
    {
        let note = "the given normals are not those of the surface on which the points are, so none was used";
        say("note", format_args!("{}: {note}", path.display()));
    }
    let side = match (estimated == points, is_seen) {
        (true, true) => "and face the viewpoint",
        (true, false) => "and their signs are a guess: pass --viewpoint if the camera position is known",
        (false, _) => "and oriented like the normals around them",
    };
    if estimated > 0 {
        let path = path.display();
        say(
            "note",
            format_args!(
                "{path}: {estimated} of {points} normals were estimated from neighbouring points {side}"
            ),
        );
    }
    let kept = supporter.points().points().len();
    if reversed == kept {
        let note = "the normals pointed into the solid, so all were reversed";
        say("note", format_args!("{}: {note}", path.display()));
    } else if reversed > 0 {
        let side = match is_seen {
            true => "to face the viewpoint",
            false => "by the shape of the cloud: pass --viewpoint if the camera position is known",
        };
        say(
            "note",
            format_args!(
                "{}: the signs of the normals did not agree, so {reversed} of {kept} were reversed {side}",
                path.display()
            ),
        );
    }
}

fn tell(path: &Path, notes: &[String], warning: &Option<String>) {
    for note in notes {
        say("note", format_args!("{}: {note}", path.display()));
    }
    if let Some(warning) = warning {
        say("warning", format_args!("{}: {warning}", path.display()));
    }
}

/// Largest plausible extent of an object or supporter, m.
pub(super) const TOO_LARGE: f32 = 5.0;
/// Smallest plausible extent of an object or supporter, m.
pub(super) const TOO_SMALL: f32 = 0.005;

impl Placement {
    fn apply(&self, points: &mut [[f32; 3]]) {
        for point in points {
            *point = self.up.turn(point.map(|x| x * self.scale));
        }
    }

    /// A warning that names the likely unit if the size is implausible.
    fn warn_of_size(&self, aabb: &Aabb, what: &str) -> Option<String> {
        let size = aabb.extents().max();
        let units: &[(&str, f32)] = match size {
            TOO_SMALL..=TOO_LARGE => return None,
            0.0..TOO_SMALL => &[("kilometres", 1000.0)],
            TOO_LARGE..40.0 => &[("centimetres", 0.01), ("inches", 0.0254)],
            // It may be a hook in millimetres or a basket in centimetres.
            40.0..=100.0 => &[("millimetres", 0.001), ("centimetres", 0.01)],
            _ => &[("millimetres", 0.001)],
        };
        let advice = match (self.scale_option, self.scale) {
            (None, _) => "limit what the images show by a crop box or a mask".into(),
            (Some(option), 1.0) => {
                let names: Vec<_> = units.iter().map(|(name, _)| *name).collect();
                let factors: Vec<_> = units.iter().map(|(_, factor)| factor.to_string()).collect();
                format!("if its unit is {}, pass {option} {}", names.join(" or "), factors.join(" or "))
            }
            (Some(option), wrong) => {
                let scale = rounded(wrong * units[0].1);
                format!("it was scaled with {option} {wrong}: try {option} {scale}")
            }
        };
        Some(format!(
            "the {what} is {} m large, but {TOO_SMALL} to {TOO_LARGE} m is plausible; {advice}",
            rounded(size)
        ))
    }
}

/// Rounded to three significant digits.
fn rounded(x: f32) -> f32 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hangpose::geometry::Point;

    fn warning(scale: f32, size: f32) -> Option<String> {
        let placement = Placement { scale, up: Axis::Z, scale_option: Some("--scale") };
        placement.warn_of_size(&Aabb::of(&[Point::origin(), Point::new(0.01 * size, size, 0.0)]), "mug")
    }

    #[test]
    fn odd_sizes_name_the_likely_unit() {
        let end = |size| warning(1.0, size).unwrap().split_once("; ").unwrap().1.to_string();
        assert_eq!(warning(1.0, 0.1), None);
        assert_eq!(end(120.0), "if its unit is millimetres, pass --scale 0.001");
        assert_eq!(end(12.0), "if its unit is centimetres or inches, pass --scale 0.01 or 0.0254");
        assert_eq!(end(0.0001), "if its unit is kilometres, pass --scale 1000");
        assert_eq!(end(77.0), "if its unit is millimetres or centimetres, pass --scale 0.001 or 0.01");
        assert!(warning(1.0, 123.456).unwrap().starts_with("the mug is 123 m large"));
    }

    #[test]
    fn a_wrong_scale_is_put_right() {
        assert!(warning(1000.0, 114.0).unwrap().ends_with("with --scale 1000: try --scale 1"));
        assert!(warning(0.001, 0.000114).unwrap().ends_with("with --scale 0.001: try --scale 1"));
    }
}
