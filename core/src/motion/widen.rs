//! Moves a route off what it passes, where there is room.

use super::placement::Leg;
use super::route::Route;
use super::slide::aside;
use super::space::Space;
use crate::monitor::{Meter, Stop};

/// Distance from obstacles that is aimed at, metres: near the corner of a plate the points of a cloud may be off by half of it.
const AIM: f32 = 0.0025;
/// Rounds over the route. What two places need is found by one after the other.
const ROUNDS: usize = 2;
/// Travel that counts as a move, metres.
const LEAST_TRAVEL: f32 = 0.0002;

/// Moves the places of a route, but for its ends, away from obstacles to `clearance` metres or to [`AIM`], where the ways to them become
/// no narrower. A search leads along what is in the way, as close as is allowed. `radius` is what a radian counts, metres.
pub(super) fn widen(
    space: &mut Space,
    route: &mut Route,
    (clearance, radius): (f32, f32),
    meter: &mut Meter,
) -> Result<(), Stop> {
    let aim = clearance.min(AIM);
    let reach = space.moving.reach;
    for _ in 0..ROUNDS {
        for at in 1..route.legs() {
            let least = route.clearance(at - 1..at + 1);
            let (Some([from, place, to]), true) = (route.places().get(at - 1..at + 2), least < aim) else {
                continue;
            };
            let (from, place, to) = (*from, *place, *to);
            let off = aside(space, &place, &Leg::NONE, (aim, radius), meter)?;
            if off.travel(reach) < LEAST_TRAVEL {
                continue;
            }
            let moved = place.after(&off, 1.0);
            let before = space.way(&from, &from.leg_to(&moved), least, meter)?;
            if !before.is_free() {
                continue;
            }
            let after = space.way(&moved, &moved.leg_to(&to), least, meter)?;
            if after.is_free() && before.clearance.min(after.clearance) > least {
                route.replace(at - 1, at + 1, &[moved], &[before.clearance, after.clearance]);
            }
        }
    }
    Ok(())
}
