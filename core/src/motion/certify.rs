//! The last word on a route: tested on the mesh itself, which has details that the distance field lacks.

use super::path::MAX_CLEARANCE;
use super::route::Route;
use super::space::{MAX_STEPS, Space};
use crate::mechanics::is_off_surface;
use crate::monitor::{Meter, Stop};

/// Distance from obstacles, metres, below which the mesh is tested: details that the field lacks are thinner.
const NEAR: f32 = 0.003;
/// Largest travel between two tests of the mesh, metres.
const STEP: f32 = 0.001;
/// Distance from the mesh below which a point of the supporter touches it, metres.
const LEAST_DISTANCE: f32 = 0.00005;

/// The least distance from obstacles at the poses of a route that are tested, metres, capped at [`MAX_CLEARANCE`]; or the first leg
/// on which the supporter or an object that hangs passes through the mesh of the object, or that takes more than four times
/// [`MAX_STEPS`] tests, as its steps are a quarter as long. From one of these poses to the next no point of the object moves farther
/// than [`STEP`], or than a quarter of the distance there.
pub(super) fn certify(
    space: &mut Space,
    route: &Route,
    meter: &mut Meter,
) -> Result<Result<f32, usize>, Stop> {
    let moving = space.moving;
    let mut clearance = MAX_CLEARANCE;
    for index in 0..route.legs() {
        let (from, leg) = (route.places()[index], route.leg(index));
        let travel = leg.travel(moving.reach).max(1e-9);
        let (mut share, mut steps) = (0.0, 0);
        loop {
            let place = from.after(&leg, share);
            let distance = space.nearest(&place, MAX_CLEARANCE, meter)?.distance;
            clearance = clearance.min(distance);
            if distance < NEAR
                && let Some(body) = &moving.body
                && (space.crosses_hung(&place, meter)?
                    || !is_off_surface(
                        (body, space.obstacles.support),
                        &place.pose(&moving.centre),
                        LEAST_DISTANCE,
                        meter,
                    )?)
            {
                return Ok(Err(index));
            }
            if share >= 1.0 {
                break;
            }
            steps += 1;
            if steps > 4 * MAX_STEPS {
                return Ok(Err(index));
            }
            share = (share + (0.25 * distance).max(STEP) / travel).min(1.0);
        }
    }
    Ok(Ok(clearance))
}
