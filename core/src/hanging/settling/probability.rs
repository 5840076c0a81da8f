//! The probability that a pose hangs. `docs/PROBABILITY.md` says where the constants come from.

use crate::mechanics::{DIRECTIONS, ENOUGH_PLAY, Kind, Margin, Unseen};

// A logistic regression of success, as the judge in `host-tests` defines it, on what a release shows. `make calibrate` prints a new
// fit beside these values.

/// Intercept of the score.
const INTERCEPT: f32 = -10.05;
/// Score for each second of the jolt test that the pose survives, 1/s.
const PER_JOLT: f32 = 2.79;
/// Score for each radian of the least tilt, 1/rad.
const PER_TILT: f32 = 1.24;
/// Score for each metre of clearance at release, 1/m.
const PER_CLEARANCE: f32 = 5010.0;
/// Clearance that counts at most, metres: the share that hangs does not grow beyond it.
const MAX_CLEARANCE: f32 = 0.001;
/// Score for each metre of play, 1/m.
const PER_PLAY: f32 = 1600.0;
/// Score of a balanced pose.
const BALANCED: f32 = -1.75;
/// Score for each metre by which the centre of mass sinks in the tilt test beyond `FREE_SINKING`, 1/m. Set by hand, as
/// small as orders poses on a ledge behind the others.
const PER_SINKING: f32 = -40.0;
/// Sinking in the tilt test that does not count, metres.
const FREE_SINKING: f32 = 0.008;
/// Sinking beyond `FREE_SINKING` that counts at most, metres.
const MAX_SINKING: f32 = 0.01;
/// Score that a pose must have in reserve for its rank: poses are ranked by what remains of their probability if the odds are six
/// times worse. Smaller: a weak pose of a preferred kind comes before a firm one of another. On seeds 43 to 46 (`tables --summary
/// --engine bullet --profile default --pairs 240`) 96.1 % of the best poses hang with it and 95.8 % without, 85.7 and 85.3 % robustly.
const RESERVE: f32 = 1.74;

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

/// What must remain of the probability with room ([`with_room`]) for a pose to be firm: it survives the jolt test and a tilt of about
/// 1 rad. [`Params::firm_enough`](crate::Params::firm_enough) such releases end the search.
const FIRM: f32 = 0.975;
/// The same for a pose to be reliable: a long search ends with such a pose, and goes on without. With 0.95 one more of 98 scanned pairs
/// hangs, and the slowest of a hundred pairs takes seven times the median; 0.8 and 0.9 do not differ on scans
/// (commands at `ENOUGH_QUERIES`).
const RELIABLE: f32 = 0.9;

// Doubt: minus the logarithm of the share of poses that hang, of those that would hang if what no camera has seen were as
// it is guessed. Fitted with the factor in docs/PROBABILITY.md on scans of seed 12.

/// Doubt for an error of the centre of mass as large as [`Margin::centre_of_mass_radius`].
const PER_CENTRE_ERROR: f32 = 0.6;
/// Error of the centre of mass that counts at most, in multiples of that radius.
const MAX_CENTRE_ERROR: f32 = 0.5;
/// Doubt about a shallow pose for each part of the directions from which no camera looked at the object.
const PER_OBJECT: f32 = 0.8;
/// Doubt for each part of the supporter in the object's box that is in the shadow of the object's mesh.
const PER_SHADOW: f32 = 1.8;
/// Doubt about a shallow pose for each part of the supporter close to the object that was guessed.
const PER_SUPPORTER: f32 = 0.8;
/// Escape ratio from which a pose is deep: to come off, the centre of mass would have to rise by the lever. Deep poses hang as
/// often as if all had been seen; for others the doubt grows linearly. Of 0.5, 1 and 2 the likeliest on scans of seed 12.
const DEEP: f32 = 1.0;

/// Doubt for each metre of [`Given::spacing`] beyond [`DENSE`], 1/m. A line through the shares that hang on clouds of 30 to 10 000
/// points of the pairs of seed 71 (`tables --points`), with normals and without.
const PER_SPACING: f32 = 60.0;
/// Distance between the points of a cloud up to which poses hang as often as on denser ones, metres: about as much as the bars are thick.
const DENSE: f32 = 0.008;

/// What is known of a pose beside its margin.
pub(super) struct Given {
    pub(super) kind: Kind,
    /// Distance from the supporter at release, metres.
    pub(super) clearance: f32,
    /// Travel without contact as the object is lifted off, metres, up to [`ENOUGH_PLAY`].
    pub(super) play: f32,
    /// By how much the centre of mass may be wrong, metres.
    pub(super) centre_error: f32,
    pub(super) unseen: Unseen,
    /// How far apart the points of the supporter are where it carries, metres.
    pub(super) spacing: f32,
}

impl Given {
    /// The same if cameras had seen all.
    pub(super) fn as_if_seen(&self) -> Self {
        Self { unseen: Unseen::default(), ..*self }
    }

    /// The same with a dense cloud of the supporter.
    pub(super) fn as_if_dense(&self) -> Self {
        Self { spacing: 0.0, ..*self }
    }

    /// Score of a pose, but for its margin.
    fn score(&self) -> f32 {
        INTERCEPT
            + PER_CLEARANCE * self.clearance.min(MAX_CLEARANCE)
            + PER_PLAY * self.play.min(ENOUGH_PLAY)
            + if self.kind == Kind::Balanced { BALANCED } else { 0.0 }
    }
}

/// Share of the poses that hang, of those that would hang if what no camera has seen were as it is guessed.
fn share_as_guessed(unseen: &Unseen, escape_ratio: f32) -> f32 {
    let Unseen { object, shadow, supporter, .. } = unseen;
    let shallowness = 1.0 - escape_ratio.min(DEEP) / DEEP;
    libm::expf(-(PER_SHADOW * shadow + (PER_OBJECT * object + PER_SUPPORTER * supporter) * shallowness))
}

/// Share of the poses that hang, of those that would hang with the centre of mass where it is assumed.
fn share_as_weighed(centre_error: f32, margin: &Margin) -> f32 {
    let tolerated = margin.centre_of_mass_radius.max(f32::MIN_POSITIVE);
    libm::expf(-PER_CENTRE_ERROR * (centre_error / tolerated).min(MAX_CENTRE_ERROR))
}

/// Share of the poses that hang, of those that would hang if the supporter's surface were as it is put through its points.
fn share_as_sampled(spacing: f32) -> f32 {
    libm::expf(-PER_SPACING * (spacing - DENSE).max(0.0))
}

/// What remains of the probability ([`cautious`]) of a pose if the object had room where it hangs and its centre of mass were certain. Both
/// are much the same for all poses of a pair, so a longer search would not better them.
pub(super) fn with_room(margin: &Margin, clearance: f32, unseen: &Unseen) -> f32 {
    let (kind, play, centre_error, spacing) = (Kind::Hooked, ENOUGH_PLAY, 0.0, 0.0);
    cautious(margin, &Given { kind, clearance, play, centre_error, unseen: *unseen, spacing })
}

/// Whether a pose is firm: it is about as good as a pose can be. What was not seen of the object and near it is the same for all poses
/// and does not count, but the shadow does, since another pose may be out of it.
pub(super) fn is_firm(margin: &Margin, clearance: f32, unseen: &Unseen) -> bool {
    with_room(margin, clearance, &shadow_of(unseen)) >= FIRM
}

/// Whether a pose is reliable, as far as what is unseen allows.
pub(super) fn is_reliable(margin: &Margin, clearance: f32, unseen: &Unseen) -> bool {
    with_room(margin, clearance, &shadow_of(unseen)) >= RELIABLE
}

fn shadow_of(unseen: &Unseen) -> Unseen {
    Unseen { shadow: unseen.shadow, ..Unseen::default() }
}

/// The least tilt, radians, at which such a pose is [`cautious`]ly `probability` if it survives the jolt test, is deep, and its centre of mass
/// is where it is assumed.
pub(super) fn least_tilt(probability: f32, given: &Given) -> f32 {
    let probability = probability / share_as_guessed(&given.unseen, DEEP);
    if probability >= 1.0 {
        return f32::INFINITY;
    }
    let score = libm::logf(probability / (1.0 - probability));
    (score + RESERVE - given.score() - PER_JOLT * Margin::MOST_JOLT_TIME) / PER_TILT
}

/// The probability that a pose with this margin hangs.
pub(super) fn of(margin: &Margin, given: &Given) -> f32 {
    share_as_sampled(given.spacing) * share(margin, given) * logistic(score(margin, given))
}

/// The probability that a pose hangs, less a reserve, for its rank. It takes the cloud for dense: another place of it is hardly denser.
pub(super) fn cautious(margin: &Margin, given: &Given) -> f32 {
    share(margin, given) * logistic(score(margin, given) - RESERVE)
}

fn score(margin: &Margin, given: &Given) -> f32 {
    given.score()
        + PER_JOLT * margin.jolt_time
        + PER_TILT * margin.least_tilt()
        + PER_SINKING * (margin.tilted_sinking - FREE_SINKING).clamp(0.0, MAX_SINKING)
}

fn logistic(score: f32) -> f32 {
    1.0 / (1.0 + libm::expf(-score))
}

/// The probability that a pose with this margin also stays when gravity tilts by [`Margin::JOLT`].
pub(super) fn of_robust(margin: &Margin, given: &Given) -> f32 {
    let mean_tilt = margin.tilts.iter().sum::<f32>() / DIRECTIONS as f32;
    let score = ROBUST_INTERCEPT
        + ROBUST_PER_JOLT * margin.jolt_time
        + ROBUST_PER_TILT * mean_tilt
        + ROBUST_PER_ESCAPE * margin.escape_ratio.min(MAX_ESCAPE_RATIO);
    share_as_sampled(given.spacing) * share(margin, given) * logistic(score)
}

fn share(margin: &Margin, given: &Given) -> f32 {
    share_as_guessed(&given.unseen, margin.escape_ratio) * share_as_weighed(given.centre_error, margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(unseen: Unseen) -> Given {
        Given {
            kind: Kind::Hooked,
            clearance: 0.001,
            play: ENOUGH_PLAY,
            centre_error: 0.0,
            unseen,
            spacing: 0.0,
        }
    }

    #[test]
    fn a_deep_pose_does_not_depend_on_guesses_but_on_what_is_in_the_shadow() {
        let said = |escape_ratio: f32, unseen: &Unseen| {
            of(&Margin { escape_ratio, ..Margin::default() }, &given(*unseen))
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
            let given = Given { clearance, ..given(Unseen::default()) };
            let tilt = least_tilt(probability, &given);
            let margin =
                Margin { tilts: [tilt; DIRECTIONS], jolt_time: Margin::MOST_JOLT_TIME, ..Margin::default() };
            assert!(
                tilt < Margin::MOST_TILT && (cautious(&margin, &given) - probability).abs() < 1e-4,
                "{tilt}"
            );
        }
        assert_eq!(least_tilt(0.0, &given(Unseen::default())), f32::NEG_INFINITY);
    }

    #[test]
    fn what_holds_by_chance_is_tight_sparse_or_may_be_weighed_wrongly_hangs_less_often() {
        let sure = given(Unseen::default());
        let margin = Margin { centre_of_mass_radius: 0.05, ..Margin::default() };
        let said = |given: &Given| of(&margin, given);
        assert!(said(&Given { kind: Kind::Balanced, ..given(Unseen::default()) }) < said(&sure));
        assert!(said(&Given { play: 0.002, ..given(Unseen::default()) }) < said(&sure));
        let weighed = |centre_error| Given { centre_error, ..given(Unseen::default()) };
        let sampled = |spacing| said(&Given { spacing, ..given(Unseen::default()) });
        assert!(sampled(0.03) < sampled(0.02) && sampled(0.02) < sampled(DENSE));
        assert!(sampled(DENSE) == said(&sure) && sampled(f32::INFINITY) == 0.0);
        assert!(said(&weighed(0.02)) < said(&weighed(0.01)) && said(&weighed(0.01)) < said(&sure));
    }
}
