//! How an object hangs: by a loop, by a hook, over a tip, or only by friction.

use super::enclosure::{Enclosure, Probe};
use super::{Body, Contact, Support};
use crate::geometry::{Pose, Vector, any_perpendicular, rotate_about};
use crate::monitor::{Meter, Stop};
use core::fmt;

/// How an object hangs.
///
/// Decided for a rest pose from the shapes alone. A *bar* is the part of the supporter at a contact that carries the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Kind {
    /// A bar of the supporter runs through a loop of the object. The two are linked: no motion frees the object but one past
    /// the end of the bar.
    Threaded,
    /// An open hook of the one holds the other: the object is caught on both sides of the bar, and comes free by lifting.
    Hooked,
    /// The object stands over a tip of the supporter with its cavity, as a cap on a peg or a mug upside down.
    Capped,
    /// The object is caught on one side at most: friction or balance holds it.
    Balanced,
}

impl Kind {
    /// All kinds, in the order in which people prefer them.
    pub const ALL: [Self; 4] = [Self::Threaded, Self::Hooked, Self::Capped, Self::Balanced];

    /// The name in files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Threaded => "threaded",
            Self::Hooked => "hooked",
            Self::Capped => "capped",
            Self::Balanced => "balanced",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of [`Kind`]s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinds(u8);

impl Kinds {
    /// Every kind.
    pub const ALL: Self = Self::of(&Kind::ALL);
    /// No kind.
    pub const NONE: Self = Self(0);

    /// The set of these kinds.
    pub const fn of(kinds: &[Kind]) -> Self {
        let (mut bits, mut k) = (0, 0);
        while k < kinds.len() {
            bits |= 1 << kinds[k] as u8;
            k += 1;
        }
        Self(bits)
    }

    /// Whether a kind is in the set.
    pub const fn contains(self, kind: Kind) -> bool {
        self.0 & (1 << kind as u8) != 0
    }
}

/// Share of the weight below which a contact does not decide the kind: it steadies the object and does not carry it.
const CARRYING_SHARE: f32 = 0.15;
/// Cosine between a contact's normal and up below which it steadies the object and does not carry it.
const CARRYING_COSINE: f32 = 0.2;
/// Depths below a contact at which the axis of the bar is looked for, metres: the first with room for the bar counts.
const BAR_DEPTHS: [f32; 4] = [0.004, 0.0025, 0.0015, 0.001];
/// Share of its depth below the contact that a point of the axis must be away from the object.
const MIN_ROOM: f32 = 0.6;
/// Thickness of the probe, as a share of that depth: a gap through which it does not pass is closed.
const PROBE_RADIUS: f32 = 0.4;
/// Lengths over which the object is moved sideways to see whether the supporter stops it, metres: as far as a hook is wide.
const SIDEWAYS: [f32; 8] = [0.004, 0.008, 0.012, 0.016, 0.02, 0.026, 0.032, 0.04];
/// Depth of an overlap that stops the object, metres: more than the errors of the cloud.
const STOPPING_DEPTH: f32 = 0.0015;
/// Sine of the angle to up below which a bar has no level direction.
const STEEP: f32 = 0.3;
/// Directions in which a steep bar is caught.
const STEEP_SIDES: usize = 4;

/// How the object hangs at `rest`, carried by `contacts`.
pub(crate) fn kind_of(
    scene: (&Body, &Support),
    rest: &Pose,
    contacts: &[Contact],
    up: &Vector,
    meter: &mut Meter,
) -> Result<Kind, Stop> {
    let (body, support) = scene;
    let to_object = rest.inverse();
    let mut kind = Kind::Balanced;
    for contact in contacts {
        if contact.force < CARRYING_SHARE || contact.normal.dot(up) < CARRYING_COSINE {
            continue;
        }
        let Some(probe) = probe_below(body, &to_object, contact) else { continue };
        let bar = support.bar_or_spread(&contact.position, &contact.normal);
        let towards = to_object * contact.normal;
        match probe.enclosure((&(to_object * bar), &towards, &(to_object * up)), meter)? {
            Enclosure::Loop => return Ok(Kind::Threaded),
            Enclosure::Cavity => kind = Kind::Capped,
            Enclosure::Open => {
                let is_below = (rest * body.centre - contact.position).dot(up) < 0.0;
                if kind == Kind::Balanced
                    && is_below
                    && is_caught(scene, rest, &probe, contact, &bar, up, meter)?
                {
                    kind = Kind::Hooked;
                }
            }
        }
    }
    Ok(kind)
}

/// The probe below a contact; `None` if there is no room for one, as between two layers of the object.
fn probe_below<'a>(body: &'a Body<'a>, to_object: &Pose, contact: &Contact) -> Option<Probe<'a>> {
    BAR_DEPTHS.into_iter().find_map(|depth| {
        let at = to_object * (contact.position - contact.normal * depth);
        let has_room = body.field.distance(&at) > MIN_ROOM * depth;
        has_room.then_some(Probe { body, at, radius: PROBE_RADIUS * depth })
    })
}

/// Whether the object is caught on both sides of the bar: it cannot move sideways without rising.
fn is_caught(
    (body, support): (&Body, &Support),
    rest: &Pose,
    probe: &Probe,
    contact: &Contact,
    bar: &Vector,
    up: &Vector,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let to_object = rest.inverse();
    let across = bar.cross(up);
    let (first, sides) = match across.norm() {
        length if length > STEEP => (across / length, 1),
        _ => (any_perpendicular(*up), STEEP_SIDES),
    };
    for k in 0..sides {
        let side = rotate_about(*up, core::f32::consts::PI * k as f32 / sides as f32, first);
        let mut is_held = [false; 2];
        for (is_held, side) in is_held.iter_mut().zip([side, -side]) {
            // When the object moves to one side, the bar meets what the object has on the other.
            *is_held = probe.is_stopped(&(to_object * -side), meter)?
                || is_stopped_by_supporter((body, support), rest, contact, &side, meter)?;
        }
        if is_held == [true; 2] {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether the supporter near a contact stops the object when it moves to a side, as the prongs of a fork do.
fn is_stopped_by_supporter(
    (body, support): (&Body, &Support),
    rest: &Pose,
    contact: &Contact,
    side: &Vector,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let [.., farthest] = SIDEWAYS;
    let to_object = rest.inverse();
    let (mut is_stopped, mut queries) = (false, 0);
    support.tree.for_each_within(&contact.position, 1.5 * farthest, |neighbour| {
        let point = support.tree.points()[neighbour.index as usize];
        for distance in SIDEWAYS {
            // Checked while nothing has stopped it: a point that is deep inside after one step stops the object.
            if is_stopped {
                return;
            }
            queries += 1;
            is_stopped = body.field.distance(&(to_object * (point - side * distance))) < -STOPPING_DEPTH;
        }
    });
    meter.distance_queries(queries)?;
    Ok(is_stopped)
}
