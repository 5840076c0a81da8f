//! The probability that a pose hangs. `docs/PROBABILITY.md` says where the constants come from.

use crate::mechanics::{DIRECTIONS, Margin, Unseen};

// A logistic regression of success, as the judge in `host-tests` defines it, on the margins of a rest pose. Fitted on
// the poses of seeds 7 and 100; `make calibrate` prints a new fit of seed 100 beside these values.

/// Intercept of the score.
const INTERCEPT: f32 = -7.06;
/// Score for each second of the jolt test that the pose survives, 1/s.
const PER_JOLT: f32 = 2.79;
/// Score for each radian of the least tilt, 1/rad.
const PER_TILT: f32 = 1.24;
/// Score for each metre by which the centre of mass sinks in the tilt test beyond `FREE_SINKING`, 1/m. Set by hand, as
/// small as orders poses on a ledge behind the others.
const PER_SINKING: f32 = -40.0;
/// Sinking in the tilt test that does not count, metres.
const FREE_SINKING: f32 = 0.008;
/// Sinking beyond `FREE_SINKING` that counts at most, metres.
const MAX_SINKING: f32 = 0.01;
/// Score for each metre of clearance at release, 1/m.
const PER_CLEARANCE: f32 = 6690.0;
/// Clearance that counts at most, metres: the share that hangs does not grow beyond it.
const MAX_CLEARANCE: f32 = 0.001;

// A logistic regression of robustness, which the judge tests as well. Fitted on all poses of the pairs of seed 100 that fit;
// `make calibrate` prints a new fit.

/// Intercept of the score of robustness.
const ROBUST_INTERCEPT: f32 = -7.12;
/// Score of robustness for each second of the jolt test that the pose survives, 1/s.
const ROBUST_PER_JOLT: f32 = 3.28;
/// Score of robustness for each radian of the mean tilt, 1/rad.
const ROBUST_PER_TILT: f32 = 3.99;
/// Score of robustness for each unit of the escape ratio, up to [`MAX_ESCAPE_RATIO`]; no unit.
const ROBUST_PER_ESCAPE: f32 = 5.94;
/// Escape ratio that counts at most: who has to lift the centre of mass by twice the lever does not come off by a knock.
const MAX_ESCAPE_RATIO: f32 = 2.0;

/// Probability from which a pose is firm: [`Params::firm_enough`](crate::Params::firm_enough) such releases end the
/// search.
const FIRM: f32 = 0.975;
/// Probability from which a pose is reliable: a long search ends with such a pose, and goes on without. With 0.95 one more of 98
/// scanned pairs hangs, and the slowest of a hundred pairs takes seven times the median; 0.8 and 0.9 do not differ on scans
/// (commands at `ENOUGH_QUERIES`).
const RELIABLE: f32 = 0.9;

// Doubt: minus the logarithm of the share of poses that hang, of those that would hang if what no camera has seen were as
// it is guessed. Fitted with the factor in docs/PROBABILITY.md on scans of seed 12.

/// Doubt about a shallow pose for each part of the directions from which no camera looked at the object.
const PER_OBJECT: f32 = 0.5;
/// Doubt for each part of the supporter in the object's box that is in the shadow of the object's mesh.
const PER_SHADOW: f32 = 1.8;
/// Doubt about a shallow pose for each part of the supporter close to the object that was guessed.
const PER_SUPPORTER: f32 = 0.8;
/// Escape ratio from which a pose is deep: to come off, the centre of mass would have to rise by the lever. Deep poses hang as
/// often as if all had been seen; for others the doubt grows linearly. Of 0.5, 1 and 2 the likeliest on scans of seed 12.
const DEEP: f32 = 1.0;

/// Share of the poses that hang, of those that would hang if what no camera has seen were as it is guessed.
fn share_that_is_right(unseen: &Unseen, escape_ratio: f32) -> f32 {
    let Unseen { object, shadow, supporter, .. } = unseen;
    let shallowness = 1.0 - escape_ratio.min(DEEP) / DEEP;
    libm::expf(-(PER_SHADOW * shadow + (PER_OBJECT * object + PER_SUPPORTER * supporter) * shallowness))
}

/// Whether a pose of this probability is firm: it is about as probable as a pose can be with what is unseen of the object
/// and the supporter. A pose in the shadow is not, since another may be out of it.
pub(super) fn is_firm(probability: f32, margin: &Margin, unseen: &Unseen) -> bool {
    is_at_least(FIRM, probability, margin, unseen)
}

/// Whether a pose of this probability is reliable, as far as what is unseen allows.
pub(super) fn is_reliable(probability: f32, margin: &Margin, unseen: &Unseen) -> bool {
    is_at_least(RELIABLE, probability, margin, unseen)
}

fn is_at_least(least: f32, probability: f32, margin: &Margin, unseen: &Unseen) -> bool {
    probability >= least * share_that_is_right(&Unseen { shadow: 0.0, ..*unseen }, margin.escape_ratio)
}

/// The least tilt, radians, at which a pose with this clearance, in metres, reaches `probability` if it survives the
/// jolt test and is deep.
pub(super) fn least_tilt(probability: f32, clearance: f32, unseen: &Unseen) -> f32 {
    let probability = probability / share_that_is_right(unseen, DEEP);
    if probability >= 1.0 {
        return f32::INFINITY;
    }
    let score = libm::logf(probability / (1.0 - probability));
    let rest = INTERCEPT + PER_JOLT * Margin::MOST_JOLT_TIME + PER_CLEARANCE * clearance.min(MAX_CLEARANCE);
    (score - rest) / PER_TILT
}

/// The probability that a pose with this margin hangs, released with this clearance, in metres.
pub(super) fn of(margin: &Margin, clearance: f32, unseen: &Unseen) -> f32 {
    let score = INTERCEPT
        + PER_JOLT * margin.jolt_time
        + PER_TILT * margin.least_tilt()
        + PER_SINKING * (margin.tilted_sinking - FREE_SINKING).clamp(0.0, MAX_SINKING)
        + PER_CLEARANCE * clearance.min(MAX_CLEARANCE);
    share_that_is_right(unseen, margin.escape_ratio) / (1.0 + libm::expf(-score))
}

/// The probability that a pose with this margin also stays when gravity tilts by [`Margin::JOLT`].
pub(super) fn of_robust(margin: &Margin, unseen: &Unseen) -> f32 {
    let mean_tilt = margin.tilts.iter().sum::<f32>() / DIRECTIONS as f32;
    let score = ROBUST_INTERCEPT
        + ROBUST_PER_JOLT * margin.jolt_time
        + ROBUST_PER_TILT * mean_tilt
        + ROBUST_PER_ESCAPE * margin.escape_ratio.min(MAX_ESCAPE_RATIO);
    share_that_is_right(unseen, margin.escape_ratio) / (1.0 + libm::expf(-score))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deep_pose_does_not_depend_on_guesses_but_on_what_is_in_the_shadow() {
        let said = |escape_ratio: f32, unseen: &Unseen| {
            of(&Margin { escape_ratio, ..Margin::default() }, 0.001, unseen)
        };
        let guessed = Unseen { object: 0.75, supporter: 0.5, ..Unseen::default() };
        let hidden = Unseen { shadow: 0.5, ..Unseen::default() };
        let seen = said(0.0, &Unseen::default());
        assert!(said(0.0, &guessed) < said(0.5, &guessed) && said(0.5, &guessed) < seen);
        assert_eq!(said(DEEP, &guessed), seen);
        assert_eq!(said(2.0 * DEEP, &guessed), seen);
        assert!(said(DEEP, &hidden) < seen && said(DEEP, &hidden) == said(0.0, &hidden));
    }

    #[test]
    fn the_least_tilt_is_the_one_with_that_probability() {
        for (probability, clearance) in [(0.8, 0.0008), (0.95, 0.001), (0.97, 0.001)] {
            let tilt = least_tilt(probability, clearance, &Unseen::default());
            let margin =
                Margin { tilts: [tilt; DIRECTIONS], jolt_time: Margin::MOST_JOLT_TIME, ..Margin::default() };
            assert!(
                tilt < Margin::MOST_TILT
                    && (of(&margin, clearance, &Unseen::default()) - probability).abs() < 1e-4,
                "{tilt}"
            );
        }
        assert_eq!(least_tilt(0.0, 0.001, &Unseen::default()), f32::NEG_INFINITY);
    }
}
