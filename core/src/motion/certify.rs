//! The last word on a route: tested on the mesh itself, which has details that the distance field lacks.

use super::path::MAX_CLEARANCE;
use super::placement::Placement;
use super::route::Route;
use super::space::{Distances, MAX_STEPS, Space};
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
/// [`MAX_STEPS`] tests, as its steps are a quarter as long. From one of these poses to the next nothing comes nearer to an obstacle by more
/// than [`STEP`], or than a quarter of the distance there.
pub(super) fn certify(
    space: &mut Space,
    route: &Route,
    meter: &mut Meter,
) -> Result<Result<f32, usize>, Stop> {
    let mut clearance = MAX_CLEARANCE;
    let Some(first) = route.places().first() else { return Ok(Ok(clearance)) };
    let Some(mut distances) = tested(space, first, meter)? else { return Ok(Err(0)) };
    for index in 0..route.legs() {
        let (from, leg) = (route.places()[index], route.leg(index));
        let travels = space.travels(&from, &leg);
        let (mut share, mut steps) = (0.0, 0);
        while share < 1.0 {
            clearance = clearance.min(distances.least());
            steps += 1;
            if steps > 4 * MAX_STEPS {
                return Ok(Err(index));
            }
            share = (share + travels.share(&distances, |distance| 0.25 * distance, STEP)).min(1.0);
            match tested(space, &from.after(&leg, share), meter)? {
                Some(next) => distances = next,
                None => return Ok(Err(index)),
            }
        }
    }
    Ok(Ok(clearance.min(distances.least())))
}

/// Distances from obstacles at a place; `None` if something passes through the mesh.
fn tested(space: &mut Space, place: &Placement, meter: &mut Meter) -> Result<Option<Distances>, Stop> {
    let distances = space.distances(place, f32::NEG_INFINITY, meter)?;
    let moving = space.moving;
    // Between the points of a plane that was thinned nothing may be near.
    let is_near = distances.least() < NEAR || space.obstacles.support.reach > NEAR;
    let Some(body) = moving.body.as_ref().filter(|_| is_near) else { return Ok(Some(distances)) };
    let pose = place.pose(&moving.centre);
    let is_through = space.crosses_hung(place, meter)?
        || !is_off_surface((body, space.obstacles.support), &pose, LEAST_DISTANCE, meter)?;
    Ok((!is_through).then_some(distances))
}
