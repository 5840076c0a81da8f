//! How likely it is that a pose hangs: `docs/PROBABILITY.md` says where the constants come from.

use crate::mechanics::Margin;

/// A logistic regression of success, as the judge in `host-tests` defines it, on what is known of a rest: a constant,
const CONSTANT: f32 = -7.06;
/// for each second that it stays when jolted,
const PER_JOLT: f32 = 2.79;
/// for each radian of the least tilt,
const PER_TILT: f32 = 1.24;
/// and for each metre of clearance, which tells nothing more beyond `MOST_CLEARANCE`, metres.
const PER_CLEARANCE: f32 = 6690.0;
const MOST_CLEARANCE: f32 = 0.001;

/// Poses that are at least this probable need no better ones beside them.
pub(super) const FIRM: f32 = 0.975;

/// The probability that an object hangs that rests with this margin and was released with this clearance, metres.
pub(super) fn of(margin: &Margin, clearance: f32) -> f32 {
    let score = CONSTANT
        + PER_JOLT * margin.jolt_time
        + PER_TILT * margin.least_tilt()
        + PER_CLEARANCE * clearance.min(MOST_CLEARANCE);
    1.0 / (1.0 + libm::expf(-score))
}
