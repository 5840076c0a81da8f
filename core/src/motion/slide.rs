//! How to go on where the straight way is blocked: along what blocks it.

use super::placement::{Leg, Placement};
use super::space::{Space, Touches};
use crate::geometry::Vector;
use crate::monitor::{Meter, Stop};

/// Distance beyond the required one within which obstacles turn a motion aside, metres.
const RANGE: f32 = 0.002;
/// Sweeps over the touches. Each touch turns the motion aside; a few sweeps satisfy two or three at once.
const SWEEPS: usize = 8;

/// The motion closest to `wanted`, in the metric that counts a radian as `radius` metres, that does not bring any touch closer than
/// `required` metres, to first order. Touches that are closer already are moved away from.
pub(super) fn aside(
    space: &mut Space,
    at: &Placement,
    wanted: &Leg,
    (required, radius): (f32, f32),
    meter: &mut Meter,
) -> Result<Leg, Stop> {
    let mut touches = Touches::within(required + RANGE);
    space.collect(at, &mut touches, meter)?;
    let (mut leg, centre) = (*wanted, at.centre());
    let inverse_inertia = 1.0 / (radius * radius);
    let mut pushes = [0.0_f32; Touches::CAPACITY];
    for _ in 0..SWEEPS {
        for (touch, push) in touches.list.iter().zip(&mut pushes) {
            let twist: Vector = (touch.at - centre).cross(&touch.normal);
            let approach = leg.shift.dot(&touch.normal) + leg.turn.dot(&twist);
            let missing = required - touch.distance - approach;
            let mass = 1.0 / (1.0 + twist.norm_squared() * inverse_inertia);
            let change = (*push + missing * mass).max(0.0) - *push;
            *push += change;
            leg.shift += touch.normal * change;
            leg.turn += twist * (inverse_inertia * change);
        }
    }
    Ok(leg)
}
