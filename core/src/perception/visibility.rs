//! Which points of a cloud a viewpoint can have seen.

use crate::geometry::{Point, PointTree, Vector, Viewpoints, unit_or};
use crate::monitor::{Meter, Stop};

/// Range in which points hide others, metres: thicker than what things hang on. What is farther away hides as well, but
/// such points say little about whether a bar was seen from both sides.
const RANGE: f32 = 0.025;
/// Tangent of the angle to the viewpoint within which a point hides another: 18 degrees.
const HIDING: f32 = 0.33;
/// Distance from the way to the viewpoint within which a point hides another, in distances between points. In a sparse cloud
/// hardly a point is within the angle.
const BESIDE: f32 = 0.75;
/// Sine of the least angle between a surface and the way to a point that hides it: others are the surface's own points,
/// lifted by noise.
const OFF_SURFACE: f32 = 0.5;
/// Least distance of a point that hides another, in distances between points. Nearer ones are noise of the surface.
const CLEAR: f32 = 1.5;
/// The same when a cloud is judged: few points hide others in a sparse one, and noise may hide some.
const CLEAR_ENOUGH: f32 = 1.2;
/// Points that are looked at to judge a cloud.
const PROBES: usize = 512;
/// Share of hidden points from which the viewpoints do not explain a cloud: it was seen from elsewhere as well. In clouds
/// of one view, errors of the camera hide up to a tenth.
const MAX_HIDDEN: usize = 5;

/// The direction to the viewpoint that looks most directly at a point among those that see it, and its cosine with the
/// point's normal, of either sign. `spacing` is the distance between the points around, metres.
pub(crate) fn best_view(
    tree: &PointTree,
    (point, normal): (&Point, &Vector),
    spacing: f32,
    viewpoints: Viewpoints,
) -> Option<(Vector, f32)> {
    let mut best = None::<(Vector, f32)>;
    for viewpoint in viewpoints.iter() {
        let way = unit_or(viewpoint - point, Vector::zeros());
        let cosine = way.dot(normal);
        let is_better = best.is_none_or(|(_, before)| cosine.abs() > before.abs());
        if is_better && !is_hidden(tree, (point, normal), (spacing, CLEAR), &way) {
            best = Some((way, cosine));
        }
    }
    best
}

/// Whether the viewpoints can have seen the points of a cloud, but for a few.
pub(crate) fn explain(
    tree: &PointTree,
    normals: &[Vector],
    spacings: &[f32],
    viewpoints: Viewpoints,
    meter: &Meter,
) -> Result<bool, Stop> {
    let probes = normals.len().min(PROBES);
    let mut hidden = 0;
    for index in (0..probes).map(|k| k * normals.len() / probes) {
        meter.check_cancelled()?;
        let (point, normal) = (&tree.points()[index], &normals[index]);
        hidden += usize::from(viewpoints.iter().all(|viewpoint| {
            let way = unit_or(viewpoint - point, Vector::zeros());
            is_hidden(tree, (point, normal), (spacings[index], CLEAR_ENOUGH), &way)
        }));
    }
    Ok(hidden * MAX_HIDDEN < probes)
}

/// Whether other points are between a point and a viewpoint in the direction `way`.
///
/// `spacing` is the distance between the points around, metres, and nearer ones than `clear` times that do not count.
fn is_hidden(
    tree: &PointTree,
    (point, normal): (&Point, &Vector),
    (spacing, clear): (f32, f32),
    way: &Vector,
) -> bool {
    let least = clear * spacing;
    let is_on_way = |offset: &Vector| {
        let along = offset.dot(way);
        along > 0.0 && (offset - way * along).norm() < (HIDING * along).max(BESIDE * spacing)
    };
    let mut is_hidden = false;
    tree.for_each_within(point, RANGE, |neighbour| {
        let offset = tree.points()[neighbour.index as usize] - point;
        let distance = libm::sqrtf(neighbour.distance_squared);
        is_hidden |=
            distance > least && is_on_way(&offset) && offset.dot(normal).abs() > OFF_SURFACE * distance;
    });
    is_hidden
}
