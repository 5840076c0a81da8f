//! Poses worth letting go of: a contact of the object, which can lie on something, laid on a place of the supporter that can carry
//! something, with the centre of mass straight below. They are made one at a time, the most promising first.

use super::object_contact::{self, ObjectContact};
use super::support_contact::{self, SupportContact};
use crate::geometry::{Point, Pose, Vector, any_perpendicular, unit_or};
use crate::hanging::settling::CLEARANCE;
use crate::mechanics::{Body, Support, first_within};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix3, Quaternion, Rotation3, Translation3, UnitQuaternion};

/// What a contact promises that catches this or less, metres.
const LEAST_CAPTURE: f32 = 0.00075;
/// What it promises more to lay the bar along the direction in which the object catches it best.
const ALONG: f32 = 1.0;
/// What it promises less if no level bar that is longer than this, metres, gets to it: what is inside a cup.
const ENCLOSED: f32 = 2.0;
const BAR_LENGTH: f32 = 0.1;
/// What it takes off the promise of a contact of the object that it was let go,
const TRIED_OBJECT: f32 = 0.5;
/// and off that of a place of the supporter.
const TRIED_SUPPORT: f32 = 0.3;
/// After so many places without room others that promise as much have their turn:
const PATIENCE: usize = 8;
/// so little is taken off.
const NO_ROOM: f32 = 0.001;
/// A contact is let go on at most so many places: what does not stay on these would hardly on others.
const PER_CONTACT: u32 = 4;
/// Poses that are made at most: where there is no room for so many, there is none.
const MOST_MADE: usize = 100_000;

/// How far above the place the contact is held, metres, before the object is pushed off what it runs into.
const LIFT: f32 = 0.0015;
/// It is pushed so often at most,
const PUSHES: usize = 5;
/// by so much more than is missing, metres,
const SPARE: f32 = 0.0002;
/// not out of what is deeper in it than this, metres, and no farther than this.
const MOST_DEPTH: f32 = 0.003;
const MOST_PUSH: f32 = 0.004;

/// A bar that is steeper than this, as a sine, is also followed.
const LEVEL: f32 = 0.1;
/// Points around a place that are tried before all others.
const PROBES: usize = 16;
/// ... and from how far around, metres.
const AROUND: f32 = 0.03;
/// So many of them make room for what was run into.
const REMEMBERED: u32 = 8;

/// How many poses were left after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CandidateCounts {
    /// Poses that lay a contact of the object on one of the supporter.
    pub made: usize,
    /// Those that are clear of the supporter, or could be pushed off it.
    pub clear: usize,
}

/// A pose that is clear of the supporter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Object to supporter.
    pub(super) pose: Pose,
    contact: usize,
    place: usize,
}

/// Makes candidates.
pub(super) struct CandidateSearch<'a> {
    scene: (&'a Body<'a>, &'a Support<'a>),
    up: Vector,
    contacts: &'a [ObjectContact],
    places: &'a mut [Place],
    /// Two a contact: along the bars of the supporter, and across them.
    ways: &'a mut [Way],
    pub(super) counts: CandidateCounts,
}

/// A contact of the object, to be laid along or across.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Way {
    /// The logarithm of how deep it catches a bar, less what it has disappointed.
    promise: f32,
    /// How many places it was laid on,
    visited: u32,
    /// and on how many of them it was clear.
    found: u32,
    /// Not zero if the last of these was not given yet:
    is_waiting: u32,
    /// which it was, and the pose, a quaternion x, y, z, w and a translation.
    place: u32,
    rotation: [f32; 4],
    translation: [f32; 3],
}

/// A contact of the supporter, made ready.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Place {
    position: Point,
    /// Unit vectors along the bar: level, and as it is.
    level: Vector,
    bar: Vector,
    /// What it has disappointed.
    tried: f32,
    /// Some of the points around, and those that were run into last.
    probes: [Point; PROBES],
    probe_count: u32,
    /// How often one was run into.
    met: u32,
}

impl<'a> CandidateSearch<'a> {
    /// Bytes of working memory.
    pub(super) const fn bytes() -> usize {
        array_bytes::<Place>(support_contact::MAX_CONTACTS)
            .saturating_add(array_bytes::<Way>(2 * object_contact::MAX_CONTACTS))
    }

    pub(super) fn new(
        scene: (&'a Body<'a>, &'a Support<'a>),
        contacts: &'a [ObjectContact],
        supports: &[SupportContact],
        up: Vector,
        arena: &mut Arena<'a>,
    ) -> Result<Self, OutOfMemory> {
        let places = arena.slice::<Place>(supports.len())?;
        for (place, support) in places.iter_mut().zip(supports) {
            *place = Place::new(scene.1, support, up);
        }
        let ways = arena.slice::<Way>(2 * contacts.len())?;
        for (k, way) in ways.iter_mut().enumerate() {
            let ObjectContact { capture, passage, .. } = contacts[k / 2];
            way.promise = libm::logf(capture.max(LEAST_CAPTURE) / LEAST_CAPTURE)
                + if is_along(k) { ALONG } else { 0.0 }
                - if passage < BAR_LENGTH { ENCLOSED } else { 0.0 };
        }
        Ok(Self { scene, up, contacts, places, ways, counts: CandidateCounts::default() })
    }

    /// The most promising candidate that was not given yet.
    pub(super) fn next(&mut self, meter: &mut Meter) -> Result<Option<Candidate>, Stop> {
        loop {
            // Where it is not known yet on which place there is room, none may have disappointed. Of equal ones the first, which
            // catches best.
            let value = |way: &Way| match way.is_waiting {
                0 => way.promise,
                _ => way.promise - self.places[way.place as usize].tried,
            };
            let ways = self.ways.iter().enumerate().rev();
            let Some((index, best)) = ways.max_by(|(_, a), (_, b)| value(a).total_cmp(&value(b))) else {
                break;
            };
            if best.promise == f32::NEG_INFINITY {
                break;
            }
            if best.is_waiting > 0 {
                let candidate =
                    Candidate { pose: best.pose(), contact: index / 2, place: best.place as usize };
                self.ways[index].is_waiting = 0;
                return Ok(Some(candidate));
            }
            self.look_for_room(index, meter)?;
        }
        Ok(None)
    }

    /// Lays a contact on the next places until it is clear on one.
    fn look_for_room(&mut self, index: usize, meter: &mut Meter) -> Result<(), Stop> {
        // Neighbours in the list are neighbours on the supporter: the first ones are to be far apart.
        let count = self.places.len();
        let stride = if count.is_multiple_of(STRIDE) { 1 } else { STRIDE };
        for _ in 0..PATIENCE {
            let Way { visited, found, .. } = self.ways[index];
            if visited as usize == count || found == PER_CONTACT || self.counts.made >= MOST_MADE {
                self.ways[index].promise = f32::NEG_INFINITY;
                return Ok(());
            }
            let place = visited as usize * stride % count;
            self.ways[index].visited += 1;
            if let Some(pose) = self.lay(index, place, meter)? {
                self.counts.clear += 1;
                let way = &mut self.ways[index];
                (way.found, way.is_waiting, way.place) = (found + 1, 1, place as u32);
                (way.rotation, way.translation) =
                    (pose.rotation.coords.into(), pose.translation.vector.into());
                return Ok(());
            }
        }
        self.ways[index].promise -= NO_ROOM;
        Ok(())
    }

    /// Takes a share off what others with the same contact or on the same place promise.
    pub(super) fn discount(&mut self, candidate: &Candidate, share: f32) {
        for way in &mut self.ways[2 * candidate.contact..][..2] {
            way.promise -= share * TRIED_OBJECT;
        }
        self.places[candidate.place].tried += share * TRIED_SUPPORT;
    }

    /// Lays a contact on a place, one way round or the other, if it is clear there.
    fn lay(&mut self, way: usize, place: usize, meter: &mut Meter) -> Result<Option<Pose>, Stop> {
        let (contact, place_index, place) = (&self.contacts[way / 2], place, &mut self.places[place]);
        let down = unit_or(self.scene.0.centre - contact.position, -contact.normal);
        let object_frame = frame(contact.bar_direction, down);
        let (level, bar) = if is_along(way) {
            (place.level, place.bar)
        } else {
            let across = self.up.cross(&place.level);
            (across, across)
        };
        // Which comes first is drawn by lot.
        let first = if (way / 2 + place_index).is_multiple_of(2) { 1.0 } else { -1.0 };
        for sign in [first, -first] {
            // With the centre of mass straight below, or, for a long hole, as steep as the bar.
            for (along, is_needed) in [(level, true), (bar, bar.dot(&self.up).abs() > LEVEL)] {
                if !is_needed {
                    continue;
                }
                let down = unit_or(along * along.dot(&self.up) - self.up, -self.up);
                let rotation = frame(along * sign, down) * object_frame.transpose();
                let rotation =
                    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
                self.counts.made += 1;
                if let Some(pose) = clear_pose(self.scene, contact, place, rotation, self.up, meter)? {
                    return Ok(Some(pose));
                }
            }
        }
        Ok(None)
    }
}

/// Places are gone through in such steps, which is coprime to any number of them that is not a multiple of it.
const STRIDE: usize = 37;

fn is_along(way: usize) -> bool {
    way.is_multiple_of(2)
}

impl Way {
    fn pose(&self) -> Pose {
        let rotation = UnitQuaternion::new_unchecked(Quaternion::from(self.rotation));
        Pose::from_parts(Translation3::from(self.translation), rotation)
    }
}

/// The pose with this rotation that holds `contact` just above `place`, pushed off what it runs into, if that makes it clear.
fn clear_pose(
    scene: (&Body, &Support),
    contact: &ObjectContact,
    place: &mut Place,
    rotation: UnitQuaternion<f32>,
    up: Vector,
    meter: &mut Meter,
) -> Result<Option<Pose>, Stop> {
    let field = scene.0.field;
    let to_object = rotation.to_rotation_matrix().transpose();
    let start = place.position + up * LIFT - rotation * contact.position;
    let mut shift = start;
    for _ in 0..PUSHES {
        let (mut least, mut point) = (CLEARANCE, None);
        for (count, probe) in place.probes[..place.probe_count as usize].iter().enumerate() {
            let gap = field.distance(&Point::from(to_object * (probe.coords - shift)));
            if gap < -MOST_DEPTH {
                meter.distance_queries(count)?;
                return Ok(None);
            }
            if gap < least {
                (least, point) = (gap, Some(*probe));
            }
        }
        meter.distance_queries(place.probe_count as usize)?;
        if point.is_none() {
            let pose = Pose::from_parts(Translation3::from(shift), rotation);
            let Some(met) = first_within(scene, &pose, CLEARANCE, meter)? else { return Ok(Some(pose)) };
            place.remember(met);
            point = Some(met);
        }
        let Some(point) = point else { break };
        let (gap, gradient) = field.sample(&Point::from(to_object * (point.coords - shift)));
        shift -= rotation * gradient * (CLEARANCE + SPARE - gap);
        if gap < -MOST_DEPTH || (shift - start).norm() > MOST_PUSH {
            break;
        }
    }
    Ok(None)
}

impl Place {
    fn new(support: &Support, contact: &SupportContact, up: Vector) -> Self {
        let bar = contact.bar_direction;
        let level = bar - up * bar.dot(&up);
        let level = if level.norm() > 0.2 { level.normalize() } else { any_perpendicular(up) };
        let (probes, probe_count) = probes(support, contact.position);
        Self { position: contact.position, level, bar, tried: 0.0, probes, probe_count, met: 0 }
    }

    /// What one object's contact runs into here, the next is likely to run into as well.
    fn remember(&mut self, point: Point) {
        let slot = if self.probe_count < PROBES as u32 {
            self.probe_count += 1;
            self.probe_count - 1
        } else {
            PROBES as u32 - 1 - self.met % REMEMBERED
        };
        self.probes[slot as usize] = point;
        self.met += 1;
    }
}

/// Some of the points around a place, spread over all of them, and how many.
fn probes(support: &Support, place: Point) -> ([Point; PROBES], u32) {
    let mut probes = [Point::origin(); PROBES];
    let mut count = 0_u32;
    support.tree.for_each_within(&place, AROUND, |neighbour| {
        let point = support.tree.points()[neighbour.index as usize];
        let slot = if count < PROBES as u32 {
            count as usize
        } else {
            // A later one replaces an earlier one as often as not, by a fixed hash of how many came before.
            (count.wrapping_mul(2_654_435_761) >> 16) as usize % (4 * PROBES)
        };
        if let Some(probe) = probes.get_mut(slot) {
            *probe = point;
        }
        count += 1;
    });
    (probes, count.min(PROBES as u32))
}

/// The right-handed frame of a direction, made perpendicular, and down.
fn frame(along: Vector, down: Vector) -> Matrix3<f32> {
    let along = unit_or(along - down * along.dot(&down), any_perpendicular(down));
    Matrix3::from_columns(&[along, down, along.cross(&down)])
}
