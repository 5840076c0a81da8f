//! The probability that a rest is what it seems: `docs/PROBABILITY.md` has where the constants come from.

use super::pose::Rest;
use crate::mechanics::Margin;

/// Logistic regression of "hangs and stays under tilt" on what the margin says.
const CONSTANT: f32 = -1.0;
const PER_TILT: f32 = 3.0;
const PER_KNOCK: f32 = 0.5;

/// The probability for a rest whose margin is known.
pub(super) fn of(rest: &Rest) -> f32 {
    let Margin { knock_speed, .. } = rest.margin;
    let x = CONSTANT + PER_TILT * rest.margin.least_tilt() + PER_KNOCK * knock_speed.min(2.0);
    1.0 / (1.0 + libm::expf(-x))
}
