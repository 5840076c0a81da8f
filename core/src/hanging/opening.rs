//! The opening of an object in which a bar lies: how deep it holds the bar, and how high it is.
//!
//! *Down* is the direction of gravity when the object hangs: from a contact towards the centre of mass.

use crate::geometry::{Point, Surface, Vector, any_perpendicular, unit_or};
use crate::monitor::{Meter, Stop};

/// Depths below a contact at which rays to both sides test whether a bar is caught, metres.
const DEPTHS: [f32; 6] = [0.0015, 0.003, 0.006, 0.012, 0.024, 0.048];
/// Least height that is told apart, metres: hooks and handles that are made for bars open by as much, and a bar has little play in what
/// is lower. Without it, the best poses of racquets are in the tightest meshes of their strings: of 640 pairs 609 instead of 614 hang on
/// seed 1 (`tables --summary --engine bullet --profile default --pairs 600`), of 1024 pairs of seeds 43 to 46 991 instead of 992.
const LEAST_HEIGHT: f32 = 0.03;

/// How far a bar, a line without thickness along the unit vector `bar`, must move `down` from `contact` before it can leave to
/// either side, metres; 0 if it is not caught. `room` is the distance from the contact down to the surface opposite, metres,
/// infinite if there is none.
pub(super) fn capture(
    surface: &Surface,
    contact: &Point,
    (down, bar): (&Vector, &Vector),
    room: f32,
    meter: &mut Meter,
) -> Result<f32, Stop> {
    let side = unit_or(bar.cross(down), any_perpendicular(*down));
    meter.rays(2 * DEPTHS.len())?;
    let is_caught = |depth: &f32| {
        let from = contact + down * *depth;
        *depth < room && surface.any_hit(&from, &side) && surface.any_hit(&from, &-side)
    };
    // From the deepest up: a crease right below the contact may catch nothing although a deeper level does.
    Ok(DEPTHS.into_iter().rev().find(is_caught).unwrap_or(0.0))
}

/// Height of the opening: how far the bar moves down until it can leave to a side or is stopped, metres; at least
/// [`LEAST_HEIGHT`], also where nothing is caught, and infinite if it can do neither within 48 mm. It follows from what [`capture`]
/// returns and takes.
pub(super) fn height(capture: f32, room: f32) -> f32 {
    let free = DEPTHS.into_iter().find(|depth| *depth > capture).unwrap_or(f32::INFINITY);
    free.min(room).max(LEAST_HEIGHT)
}
