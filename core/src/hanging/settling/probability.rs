//! How likely it is that a pose hangs: `docs/PROBABILITY.md` says where the constants come from.

use crate::mechanics::Margin;

/// A logistic regression of success, as the judge in `host-tests` defines it, on what is known of a rest: a constant,
const CONSTANT: f32 = -7.06;
/// for each second that it stays when jolted,
const PER_JOLT: f32 = 2.79;
/// for each radian of the least tilt,
const PER_TILT: f32 = 1.24;
/// for each metre that it sinks while gravity tilts, beyond `LEAST_SINKING` and up to `MOST_SINKING` more, metres,
const PER_SINKING: f32 = -40.0;
const LEAST_SINKING: f32 = 0.008;
const MOST_SINKING: f32 = 0.01;
/// and for each metre of clearance, which tells nothing more beyond `MOST_CLEARANCE`, metres.
const PER_CLEARANCE: f32 = 6690.0;
const MOST_CLEARANCE: f32 = 0.001;

/// Poses that are at least this probable need no better ones beside them.
pub(super) const FIRM: f32 = 0.975;

/// The least tilt, radians, with which that can be as high as `probability`, if it was released with this clearance and stays when jolted.
pub(super) fn least_tilt(probability: f32, clearance: f32) -> f32 {
    let score = libm::logf(probability / (1.0 - probability));
    let rest = CONSTANT + PER_JOLT * Margin::MOST_JOLT_TIME + PER_CLEARANCE * clearance.min(MOST_CLEARANCE);
    (score - rest) / PER_TILT
}

/// The probability that an object hangs that rests with this margin and was released with this clearance, metres.
pub(super) fn of(margin: &Margin, clearance: f32) -> f32 {
    let score = CONSTANT
        + PER_JOLT * margin.jolt_time
        + PER_TILT * margin.least_tilt()
        + PER_SINKING * (margin.tilted_sinking - LEAST_SINKING).clamp(0.0, MOST_SINKING)
        + PER_CLEARANCE * clearance.min(MOST_CLEARANCE);
    1.0 / (1.0 + libm::expf(-score))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::DIRECTIONS;

    #[test]
    fn the_least_tilt_is_the_one_with_that_probability() {
        for (probability, clearance) in [(0.8, 0.0008), (0.95, 0.001), (0.97, 0.001)] {
            let tilt = least_tilt(probability, clearance);
            let margin =
                Margin { tilts: [tilt; DIRECTIONS], jolt_time: Margin::MOST_JOLT_TIME, ..Margin::default() };
            assert!(
                tilt < Margin::MOST_TILT && (of(&margin, clearance) - probability).abs() < 1e-4,
                "{tilt}"
            );
        }
        assert_eq!(least_tilt(0.0, 0.001), f32::NEG_INFINITY);
    }
}
