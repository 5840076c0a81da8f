//! Distance of a body from one patch of the supporter.

use super::constants::{FIELD_BAND_RATIO, HOLLOW_CURVATURE};
use super::touch::nearest_from_sample;
use super::{Body, Support};
use crate::geometry::{Point, Vector};
use nalgebra::Rotation3;

/// The distance of a body from a patch.
pub(crate) enum Gap {
    /// The nearest point of the patch, or the deepest inside the body.
    Near {
        /// Signed distance, metres, negative inside.
        distance: f32,
        /// The point, in object coordinates.
        at: Point,
        /// Gradient of the signed distance of the body there: of unit length, or zero where it is undefined.
        gradient: Vector,
    },
    /// The patch is farther away than this, metres, or what of it is closer lies on another patch as well.
    Beyond(f32),
}

/// Distance of a body from a patch: the nearest point if it is within `margin` metres, otherwise a lower bound. `at` is the
/// position of the patch in object coordinates; `rotation` rotates object to supporter coordinates.
pub(crate) fn gap_to_patch(
    body: &Body,
    support: &Support,
    patch: usize,
    (rotation, at): (&Rotation3<f32>, &Point),
    margin: f32,
) -> Gap {
    let (patch, field) = (&support.patches[patch], body.field);
    let (sample, reach) = (field.sample_near(at), patch.reach());
    let distance = sample.as_ref().map_or_else(|bound| *bound, |(gap, _)| *gap);
    let band = FIELD_BAND_RATIO * field.band();
    if sample.is_err() && (distance - reach > margin || !patch.is_long()) {
        // The bricks of the field cover its band. Patches overlap: what of one may be closer to the body than half of its
        // reach from its centre, is closer to the centre of another.
        return Gap::Beyond((distance - 0.5 * reach).max(band));
    }
    let least = (distance - reach).max(band);
    if distance - reach > margin {
        return Gap::Beyond(least);
    }
    match nearest_from_sample(sample, (body, patch), rotation, at, |_| margin) {
        Ok(nearest) => Gap::Near { distance: nearest.gap, at: nearest.at, gradient: nearest.gradient },
        Err(travel) => Gap::Beyond((margin + travel).max(least)),
    }
}

/// Estimate of how much closer to a body than the middle of a flat piece any other point of it is, metres, within `radius` of the middle:
/// where the gap there changes by `slope` per metre along the piece. It allows for hollows of the body.
pub(crate) fn fall_over(radius: f32, slope: f32) -> f32 {
    slope * radius + 0.5 * HOLLOW_CURVATURE * radius * radius
}
