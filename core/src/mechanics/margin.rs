//! How firmly a resting object stays.

use super::motion::{Motion, Settings};
use super::neighbourhood::Sleep;
use super::settle::most_sinking;
use super::{Body, GRAVITY, Support};
use crate::geometry::{Point, Pose, Vector, rotate_about};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// Directions in which gravity is tilted.
pub const DIRECTIONS: usize = 8;
/// Contacts that are told of, at most.
pub const MAX_CONTACTS: usize = 8;

/// By how much an object stays up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Margin {
    /// How far gravity may tilt, radians, with 70 % of the friction, towards each of eight horizontal directions: the first is the
    /// supporter's x axis (or its y axis, where gravity is along x, made perpendicular to gravity), the others follow counter-clockwise
    /// seen from above. At most [`Margin::MOST_TILT`], where the search ends; zero for directions that were not tried any more, because
    /// another is hopeless.
    pub tilts: [f32; DIRECTIONS],
    /// How long it stays, seconds, when gravity tilts by [`Margin::JOLT`] at once, towards where it survives the least tilt, and nothing
    /// but friction stops its swing: as it does when a robot that carries the supporter starts or stops with 0.4 g.
    /// [`Margin::MOST_JOLT_TIME`] if it is still there then; zero if that was not tried, because some tilt is hopeless.
    pub jolt_time: f32,
    /// How far the centre of mass sank at most, metres, while gravity tilted by up to 0.9 radians: what comes to lie deeper when it is
    /// shaken does not lie firmly where it is.
    pub tilted_sinking: f32,
    /// The least rise of the centre of mass, metres, over the ways of escape that were found: what an escape costs over `m g`
    /// (escape energy: Dong and Pokorny, arXiv 2309.01224). An upper bound of the least that any escape costs, and the highest
    /// rise seen where none was found.
    pub escape_rise: f32,
    /// The same over the distance from the contacts to the centre of mass; no unit.
    pub escape_ratio: f32,
    /// The speed of a knock that would carry the centre of mass over that rise, `sqrt(2 g h)`, m/s.
    pub knock_speed: f32,
    /// How far the centre of mass may be from where it was taken to be, metres, square to the line from the contacts: what turns
    /// that line as far as the least of the tilts does.
    pub centre_of_mass_radius: f32,
}

impl Margin {
    /// Gravity is tilted up to this, radians.
    pub const MOST_TILT: f32 = 1.2;
    /// A jolt tilts gravity by this, radians: 21.8 degrees, where friction of 0.4 ends.
    pub const JOLT: f32 = 0.380_506;
    /// It is watched for this long, seconds.
    pub const MOST_JOLT_TIME: f32 = 1.0;

    /// The least of the tilts, radians.
    pub fn least_tilt(&self) -> f32 {
        self.tilts.iter().copied().fold(Self::MOST_TILT, f32::min)
    }
}

/// A place where the supporter bears the object, in supporter coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contact {
    /// Metres.
    pub position: Point,
    /// Unit vector in which the supporter pushes.
    pub normal: Vector,
    /// How hard it pushes along it, in multiples of the object's weight.
    pub force: f32,
}

impl Default for Contact {
    fn default() -> Self {
        Self { position: Point::origin(), normal: Vector::zeros(), force: 0.0 }
    }
}

/// The margin and what bears.
pub(crate) struct Firmness {
    pub(crate) margin: Margin,
    pub(crate) contacts: heapless::Vec<Contact, MAX_CONTACTS>,
}

/// How fast gravity tilts, rad/s: slowly against how fast things fall, so that the angle at which it leaves is the angle at which
/// it began to.
const RATE: f32 = 2.5;
/// Friction is taken to be so much less while gravity tilts: what tilts at once, as when a robot stops, swings as far again beyond, and
/// what would hold it in the middle of the swing lets it slip at the end.
const SLIPPERY: f32 = 0.7;
/// Up to this tilt, radians, what hangs well does not sink: beyond, what lies in a hook rolls out of it.
const SINKING_TILT: f32 = 0.9;
/// Without contact for so long, seconds, it has left.
pub(super) const GONE: f32 = 0.1;

/// Tilts gravity in every direction from `rest`. `least` is the tilt, radians, below which the rest of the directions do not matter
/// any more: those that are not tried have a tilt of zero.
pub(crate) fn firmness(
    scene: (&Body, &Support),
    rest: &Pose,
    down: &Vector,
    params: &Params,
    least: f32,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<Firmness, Stop> {
    let body = scene.0;
    let settings = Settings::damped(params);
    let start = body.at(rest);
    let contacts = {
        let mut motion = Motion::new(scene, start, settings, sleeps);
        for _ in 0..3 {
            motion.step(&(down * GRAVITY), meter)?;
        }
        let mut contacts = heapless::Vec::new();
        for (position, normal, force) in motion.bearing() {
            // There is room for all that matter; more of a flat contact say nothing new.
            let _ = contacts.push(Contact { position, normal, force });
        }
        contacts
    };
    let (mut weight, mut place) = (0.0, Vector::zeros());
    for contact in &contacts {
        weight += contact.force;
        place += contact.position.coords * contact.force;
    }
    let lever = if weight > 0.0 { (start.centre.coords - place / weight).norm() } else { 0.0 };

    let tilting = Settings { friction: SLIPPERY * params.friction, ..settings };
    let mut margin = Margin::default();
    let (mut escape, mut highest) = (f32::INFINITY, 0.0_f32);
    let (mut weakest, mut is_hopeless) = (0, false);
    for k in 0..DIRECTIONS {
        let motion = Motion::new(scene, start, tilting, sleeps);
        let Tilted { held, rise, sinking, left } =
            tilt_until_it_leaves(motion, body, down, &towards(k, down), meter)?;
        margin.tilts[k] = held;
        margin.tilted_sinking = margin.tilted_sinking.max(sinking);
        highest = highest.max(rise);
        if left {
            escape = escape.min(rise);
        }
        if held < margin.tilts[weakest] {
            weakest = k;
        }
        is_hopeless = held < least;
        if is_hopeless {
            break;
        }
    }
    if !is_hopeless {
        let motion = Motion::new(scene, start, Settings::undamped(params), sleeps);
        margin.jolt_time = jolt_until_it_leaves(motion, body, down, &towards(weakest, down), meter)?;
    }
    margin.escape_rise = if escape.is_finite() { escape } else { highest };
    margin.escape_ratio = if lever > 0.0 { margin.escape_rise / lever } else { 0.0 };
    margin.knock_speed = libm::sqrtf(2.0 * GRAVITY * margin.escape_rise);
    margin.centre_of_mass_radius = lever * libm::sinf(margin.least_tilt().min(core::f32::consts::FRAC_PI_2));
    Ok(Firmness { margin, contacts })
}

/// The horizontal direction with this number: see [`Margin::tilts`].
fn towards(direction: usize, down: &Vector) -> Vector {
    let axis = if down.x.abs() < 0.9 { Vector::x() } else { Vector::y() };
    let first = (axis - down * axis.dot(down)).normalize();
    rotate_about(-down, core::f32::consts::TAU * direction as f32 / DIRECTIONS as f32, first)
}

/// Watches whether the body leaves under a pull that goes on.
struct Watch {
    start: Point,
    /// Steps without contact.
    loose: usize,
}

impl Watch {
    fn new(motion: &Motion) -> Self {
        Self { start: motion.state.centre, loose: 0 }
    }

    /// How far the centre of mass has moved, and whether it has left: gravity is tilted by an angle with this cosine, along `pull`.
    fn look(&mut self, motion: &Motion, body: &Body, pull: &Vector, cos: f32) -> (Vector, bool) {
        let moved = motion.state.centre - self.start;
        self.loose = if motion.touches { 0 } else { self.loose + 1 };
        // The swing into the new direction is not a fall.
        let swing = body.reach * (1.0 - cos);
        let gone = motion.settings.steps(GONE);
        (moved, self.loose > gone || pull.dot(&moved) > most_sinking(body) + swing)
    }
}

/// What became of the body when gravity tilted.
#[derive(Default)]
struct Tilted {
    /// How far it had tilted before the body left, radians.
    held: f32,
    /// How far the centre of mass rose until then, and how far it sank until [`SINKING_TILT`], at most, metres.
    rise: f32,
    sinking: f32,
    /// Whether it left at all.
    left: bool,
}

/// Tilts gravity towards `across`.
fn tilt_until_it_leaves(
    mut motion: Motion,
    body: &Body,
    down: &Vector,
    across: &Vector,
    meter: &mut Meter,
) -> Result<Tilted, Stop> {
    let mut watch = Watch::new(&motion);
    let Settings { time_step, .. } = motion.settings;
    let steps = motion.settings.steps(Margin::MOST_TILT / RATE);
    let mut tilted = Tilted::default();
    for step in 1..=steps {
        let angle = RATE * time_step * step as f32;
        let (sin, cos) = libm::sincosf(angle);
        let pull = down * cos + across * sin;
        motion.step(&(pull * GRAVITY), meter)?;
        let (moved, has_left) = watch.look(&motion, body, &pull, cos);
        if motion.touches {
            tilted.held = angle;
            let sunk = down.dot(&moved);
            tilted.rise = tilted.rise.max(-sunk);
            if angle < SINKING_TILT {
                tilted.sinking = tilted.sinking.max(sunk);
            }
        }
        if has_left {
            return Ok(Tilted { left: true, ..tilted });
        }
    }
    let left = watch.loose > 0;
    Ok(Tilted { held: if left { tilted.held } else { Margin::MOST_TILT }, left, ..tilted })
}

/// How long the body stays when gravity tilts towards `across` at once, seconds.
fn jolt_until_it_leaves(
    mut motion: Motion,
    body: &Body,
    down: &Vector,
    across: &Vector,
    meter: &mut Meter,
) -> Result<f32, Stop> {
    let mut watch = Watch::new(&motion);
    let (sin, cos) = libm::sincosf(Margin::JOLT);
    let pull = down * cos + across * sin;
    let Settings { time_step, .. } = motion.settings;
    // One step less, so that every measured time is below `MOST_JOLT_TIME`, which is reserved for a body that stays.
    let steps = motion.settings.steps(Margin::MOST_JOLT_TIME) - 1;
    let mut held = 0.0;
    for step in 1..=steps {
        motion.step(&(pull * GRAVITY), meter)?;
        if motion.touches {
            held = time_step * step as f32;
        }
        if watch.look(&motion, body, &pull, cos).1 {
            return Ok(held);
        }
    }
    Ok(Margin::MOST_JOLT_TIME)
}
