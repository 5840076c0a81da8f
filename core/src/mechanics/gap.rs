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
    if let Err(bound) = field.sample_near(at) {
        let least = bound - patch.reach();
        if least > margin || !patch.is_long() {
            // The bricks of the field cover its band. Patches overlap: what of one may be closer to the body than half of its
            // reach from its centre, is closer to the centre of another.
            return Gap::Beyond(least.max(bound - 0.5 * patch.reach()).max(FIELD_BAND_RATIO * field.band()));
        }
    }
    match nearest_on_patch(body, patch, rotation, at, |_| margin) {
        Ok(nearest) => Gap::Near { distance: nearest.gap, at: nearest.at, gradient: nearest.gradient },
        Err(_) => Gap::Beyond((field.distance(at) - patch.reach()).max(FIELD_BAND_RATIO * field.band())),
    }
}
