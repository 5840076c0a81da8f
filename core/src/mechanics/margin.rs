//! Stability margins of a resting object.

use super::constants::{DEPARTURE_TIME, FORCE_STEPS, GRAVITY, SINKING_TILT, TILT_FRICTION_FACTOR, TILT_RATE};
use super::motion::{Motion, Settings};
use super::neighbourhood::Sleep;
use super::settle::max_sinking;
use super::{Body, Support};
use crate::geometry::{Point, Pose, Vector, rotate_about};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// Number of horizontal directions in which gravity is tilted.
pub const DIRECTIONS: usize = 8;
/// Order in which gravity is tilted: every second direction first, because those between two that hold need no test. The directions
/// of a row are independent of each other.
const TILT_ORDER: [[usize; DIRECTIONS / 2]; 2] = [[0, 2, 4, 6], [1, 3, 5, 7]];
/// Maximum number of reported contacts.
pub const MAX_CONTACTS: usize = 8;

/// Stability margins of an object at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Margin {
    /// Tilt of gravity at which the object last touched the supporter before it left, radians, towards each of eight
    /// horizontal directions, with 70 % of the friction and gravity turning at 2.5 rad/s. It is larger than the static
    /// limit, because leaving takes time. The first direction is the supporter's x axis (or its y axis, where gravity
    /// is along x), made perpendicular to gravity; the others follow counter-clockwise seen from above.
    /// [`Margin::MOST_TILT`] where it never left, and without a test between two such directions (`docs/MECHANICS.md` says why).
    /// The test stops at the first direction whose tilt is too small for the pose to be of use (0.15 radians or more); the
    /// directions that are not tested then are zero.
    pub tilts: [f32; DIRECTIONS],
    /// Duration for which the object stays, seconds, when gravity suddenly tilts by [`Margin::JOLT`] towards
    /// the direction of the least tilt and only friction ends its swing: a robot that carries the supporter
    /// starts or stops with 0.4 g. It is [`Margin::MOST_JOLT_TIME`] if the object is still there then, and
    /// zero if the jolt was not tested because some tilt was too small. Where no tilt made the object
    /// leave it is not tested, but counts as survived.
    pub jolt_time: f32,
    /// Largest drop of the centre of mass, metres, while gravity tilted by up to 0.9 radians. An object that
    /// drops when it is shaken lies on a ledge, not firmly.
    pub tilted_sinking: f32,
    /// Least rise of the centre of mass, metres, over the escapes that were found: times `m g` an upper bound of
    /// the escape energy (Dong and Pokorny, arXiv 2309.01224). Where no escape was found, the highest rise that
    /// was seen, which bounds nothing.
    pub escape_rise: f32,
    /// [`escape_rise`](Self::escape_rise) over the distance from the contacts to the centre of mass; no unit.
    pub escape_ratio: f32,
    /// Speed of a knock that carries the centre of mass over the rise, `sqrt(2 g h)`, m/s.
    pub knock_speed: f32,
    /// Error of the centre of mass that the object tolerates, metres, perpendicular to the line from the
    /// contacts to it: an error of this size turns the line by the least tilt.
    pub centre_of_mass_radius: f32,
}

impl Margin {
    /// Largest tilt of gravity that is tested, radians.
    pub const MOST_TILT: f32 = 1.2;
    /// Tilt of gravity by a jolt, radians: 21.8 degrees, the friction angle for a coefficient of 0.4.
    pub const JOLT: f32 = 0.380_506;
    /// Duration of the jolt test, seconds.
    pub const MOST_JOLT_TIME: f32 = 1.0;

    /// The least of the tilts, radians.
    pub fn least_tilt(&self) -> f32 {
        self.tilts.iter().copied().fold(Self::MOST_TILT, f32::min)
    }
}

/// A contact that carries the object at rest, in supporter coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contact {
    /// Position, metres.
    pub position: Point,
    /// Contact normal: the unit vector along which the supporter pushes the object.
    pub normal: Vector,
    /// Normal force, in multiples of the object's weight.
    pub force: f32,
}

impl Default for Contact {
    fn default() -> Self {
        Self { position: Point::origin(), normal: Vector::zeros(), force: 0.0 }
    }
}

/// The contacts that carry the object at the rest pose `rest`.
pub(crate) fn carrying_contacts(
    scene: (&Body, &Support),
    rest: &Pose,
    down: &Vector,
    params: &Params,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<heapless::Vec<Contact, MAX_CONTACTS>, Stop> {
    let mut motion = Motion::new(scene, scene.0.at(rest), Settings::damped(params), sleeps);
    for _ in 0..FORCE_STEPS {
        motion.step(&(down * GRAVITY), meter)?;
    }
    // The capacity suffices for all that matter; more contacts between flat faces are redundant.
    let carrying = motion.loaded_contacts().take(MAX_CONTACTS);
    Ok(carrying.map(|(position, normal, force)| Contact { position, normal, force }).collect())
}

/// Distance from the contacts, weighted with their forces, to the centre of mass `centre` in supporter coordinates, metres.
pub(crate) fn lever(centre: &Point, contacts: &[Contact]) -> f32 {
    let (mut weight, mut moment) = (0.0, Vector::zeros());
    for contact in contacts {
        weight += contact.force;
        moment += contact.position.coords * contact.force;
    }
    if weight > 0.0 { (centre.coords - moment / weight).norm() } else { 0.0 }
}

/// Tests the stability of the rest pose `rest`, carried by `contacts`: gravity tilts in every direction, and then it jolts. A
/// tilt below `least`, radians, ends the test: the tilts of the remaining directions and the jolt time are zero. `sleeps` is working
/// memory for each of two tilts at a time.
pub(crate) fn margin(
    scene: (&Body, &Support),
    (rest, contacts): (&Pose, &[Contact]),
    down: &Vector,
    params: &Params,
    least: f32,
    [sleeps, other_sleeps]: [&mut [Sleep]; 2],
    meter: &mut Meter,
) -> Result<Margin, Stop> {
    let body = scene.0;
    let settings = Settings::damped(params);
    let start = body.at(rest);
    let lever = lever(&start.centre, contacts);

    let tilting = Settings { friction: TILT_FRICTION_FACTOR * params.friction, ..settings };
    let mut margin = Margin::default();
    let (mut escape, mut highest) = (f32::INFINITY, 0.0_f32);
    let (mut weakest, mut is_too_small) = (0, false);
    let tilt = |direction: usize, sleeps: &mut [Sleep], meter: &mut Meter| {
        let motion = Motion::new(scene, start, tilting, sleeps);
        tilt_gravity(motion, body, down, &tilt_direction(scene.1, direction, down), meter)
    };
    'rows: for row in TILT_ORDER {
        let is_between_held = |tilts: &[f32; DIRECTIONS], k: usize| {
            [k + DIRECTIONS - 1, k + 1].iter().all(|side| tilts[side % DIRECTIONS] == Margin::MOST_TILT)
        };
        let mut to_test = heapless::Vec::<usize, { DIRECTIONS / 2 }>::new();
        for k in row {
            if is_between_held(&margin.tilts, k) {
                margin.tilts[k] = Margin::MOST_TILT;
            } else {
                // As long as a row.
                let _ = to_test.push(k);
            }
        }
        for pair in to_test.chunks(2) {
            let outcomes = match *pair {
                [first, second] => {
                    let (first, second) = meter.run_both(
                        |meter| tilt(first, sleeps, meter),
                        |meter| tilt(second, other_sleeps, meter),
                        |outcome| outcome.held < least,
                    )?;
                    [Some(first), second]
                }
                [single] => [Some(tilt(single, sleeps, meter)?), None],
                _ => [None, None],
            };
            for (&k, outcome) in pair.iter().zip(outcomes.into_iter().flatten()) {
                let TiltOutcome { held, rise, sinking, left } = outcome;
                margin.tilts[k] = held;
                margin.tilted_sinking = margin.tilted_sinking.max(sinking);
                highest = highest.max(rise);
                if left {
                    escape = escape.min(rise);
                }
                if held < margin.tilts[weakest] {
                    weakest = k;
                }
                is_too_small = held < least;
                if is_too_small {
                    break 'rows;
                }
            }
        }
    }
    if margin.least_tilt() == Margin::MOST_TILT {
        margin.jolt_time = Margin::MOST_JOLT_TIME;
    } else if !is_too_small {
        let motion = Motion::new(scene, start, Settings::undamped(params), sleeps);
        margin.jolt_time = jolt_gravity(motion, body, down, &tilt_direction(scene.1, weakest, down), meter)?;
    }
    margin.escape_rise = if escape.is_finite() { escape } else { highest };
    margin.escape_ratio = if lever > 0.0 { margin.escape_rise / lever } else { 0.0 };
    margin.knock_speed = libm::sqrtf(2.0 * GRAVITY * margin.escape_rise);
    margin.centre_of_mass_radius = lever * libm::sinf(margin.least_tilt().min(core::f32::consts::FRAC_PI_2));
    Ok(margin)
}

/// Unit vector of a horizontal direction, by its index in [`Margin::tilts`].
fn tilt_direction(support: &Support, direction: usize, down: &Vector) -> Vector {
    let axis = if down.x.abs() < 0.9 { Vector::x() } else { Vector::y() };
    // The axis is that of the caller.
    let axis = support.frame * axis;
    let first = (axis - down * axis.dot(down)).normalize();
    rotate_about(-down, core::f32::consts::TAU * direction as f32 / DIRECTIONS as f32, first)
}

/// Detects that the body leaves the supporter while gravity is tilted.
struct DepartureDetector {
    start: Point,
    /// Number of steps since the last contact.
    steps_without_contact: usize,
}

impl DepartureDetector {
    fn new(motion: &Motion) -> Self {
        Self { start: motion.state.centre, steps_without_contact: 0 }
    }

    /// Returns the displacement of the centre of mass and whether the body has left, after a step in which
    /// gravity was along `pull`, tilted by an angle with cosine `cos`.
    fn update(&mut self, motion: &Motion, body: &Body, pull: &Vector, cos: f32) -> (Vector, bool) {
        let moved = motion.state.centre - self.start;
        self.steps_without_contact = if motion.touches { 0 } else { self.steps_without_contact + 1 };
        // The swing into the new direction of gravity is not a fall.
        let swing = body.reach * (1.0 - cos);
        let has_departed = self.steps_without_contact > motion.settings.steps(DEPARTURE_TIME);
        (moved, has_departed || pull.dot(&moved) > max_sinking(body) + swing)
    }
}

/// Outcome of a slow tilt of gravity.
#[derive(Default)]
struct TiltOutcome {
    /// Tilt at the last contact before the body left, radians.
    held: f32,
    /// Largest rise of the centre of mass until the last contact, metres.
    rise: f32,
    /// Largest drop of the centre of mass up to a tilt of [`SINKING_TILT`], metres.
    sinking: f32,
    /// Whether the body left.
    left: bool,
}

/// Tilts gravity slowly from `down` towards the horizontal unit vector `across`, until the body leaves or the
/// test ends.
fn tilt_gravity(
    mut motion: Motion,
    body: &Body,
    down: &Vector,
    across: &Vector,
    meter: &mut Meter,
) -> Result<TiltOutcome, Stop> {
    let mut departure = DepartureDetector::new(&motion);
    let Settings { time_step, .. } = motion.settings;
    let steps = motion.settings.steps(Margin::MOST_TILT / TILT_RATE);
    let mut outcome = TiltOutcome::default();
    for step in 1..=steps {
        let angle = TILT_RATE * time_step * step as f32;
        let (sin, cos) = libm::sincosf(angle);
        let pull = down * cos + across * sin;
        motion.step(&(pull * GRAVITY), meter)?;
        let (moved, has_left) = departure.update(&motion, body, &pull, cos);
        if motion.touches {
            outcome.held = angle;
            let sunk = down.dot(&moved);
            outcome.rise = outcome.rise.max(-sunk);
            if angle < SINKING_TILT {
                outcome.sinking = outcome.sinking.max(sunk);
            }
        }
        if has_left {
            return Ok(TiltOutcome { left: true, ..outcome });
        }
    }
    let left = departure.steps_without_contact > 0;
    Ok(TiltOutcome { held: if left { outcome.held } else { Margin::MOST_TILT }, left, ..outcome })
}

/// Returns the duration for which the body stays when gravity suddenly tilts by [`Margin::JOLT`] towards
/// `across`, seconds.
fn jolt_gravity(
    mut motion: Motion,
    body: &Body,
    down: &Vector,
    across: &Vector,
    meter: &mut Meter,
) -> Result<f32, Stop> {
    let mut departure = DepartureDetector::new(&motion);
    let (sin, cos) = libm::sincosf(Margin::JOLT);
    let pull = down * cos + across * sin;
    let Settings { time_step, .. } = motion.settings;
    // One step less, so that every measured time is below `MOST_JOLT_TIME`, which is reserved for a body that
    // stays.
    let steps = motion.settings.steps(Margin::MOST_JOLT_TIME) - 1;
    let mut held = 0.0;
    for step in 1..=steps {
        motion.step(&(pull * GRAVITY), meter)?;
        if motion.touches {
            held = time_step * step as f32;
        }
        if departure.update(&motion, body, &pull, cos).1 {
            return Ok(held);
        }
    }
    Ok(Margin::MOST_JOLT_TIME)
}
