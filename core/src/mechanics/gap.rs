//! Distance of a body from one patch of the supporter.

use super::constants::FIELD_BAND_RATIO;
use super::touch::nearest_on_patch;
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
    /// Nothing of the patch is closer than this, metres; it may be farther away.
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
    let patch = &support.patches[patch];
    match nearest_on_patch(body, patch, rotation, at, margin) {
        Ok(nearest) => Gap::Near { distance: nearest.gap, at: nearest.at, gradient: nearest.gradient },
        // Outside of the bricks of the field, which cover its band, nothing of it is within the band.
        Err(_) => {
            let band = (FIELD_BAND_RATIO * body.field.band()).min(margin);
            Gap::Beyond((body.field.distance(at) - patch.reach()).max(band))
        }
    }
}
