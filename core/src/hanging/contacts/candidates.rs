//! Candidate poses: a contact of the object is laid on a contact of the supporter, with the centre of mass straight
//! below. They are made one at a time, the highest score first.

use super::constants::*;
use super::counts::CandidateCounts;
use super::object_contact::ObjectContact;
use super::support_contact::SupportContact;
use crate::geometry::{Point, Pose, Vector, any_perpendicular, unit_or};
use crate::hanging::request::Request;
use crate::hanging::settling::CLEARANCE;
use crate::hanging::settling::wishes::is_clear_of_scene;
use crate::mechanics::{Body, Frames, Support, first_within};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix3, Quaternion, Rotation3, Translation3, UnitQuaternion};

/// A pose that is clear of the supporter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Object to supporter.
    pub(super) pose: Pose,
    contact: usize,
    place: usize,
}

/// Makes candidates in the order of their scores.
pub(super) struct CandidateSearch<'a> {
    scene: (&'a Body<'a>, &'a Support<'a>),
    request: &'a Request<'a>,
    up: Vector,
    contacts: &'a [ObjectContact],
    places: &'a mut [Place],
    /// Two for each contact of the object: its bar direction along the supporter's bars, and across them.
    ways: &'a mut [Way],
    pub(super) counts: CandidateCounts,
    /// Clear poses that touch the scene or an object that hangs already.
    pub(super) in_scene: usize,
}

/// A contact of the object in one of its two directions, and how far its trials have got.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Way {
    /// Logarithm of the capture depth, less the discounts for releases that failed.
    score: f32,
    /// Number of places it was laid on.
    visited: u32,
    /// Number of places on which a pose was clear.
    found: u32,
    /// 1 while the last clear pose has not been returned, else 0.
    is_waiting: u32,
    /// Index of the place of that pose.
    place: u32,
    /// Rotation of that pose, a quaternion x, y, z, w.
    rotation: [f32; 4],
    /// Translation of that pose, metres.
    translation: [f32; 3],
}

/// A contact of the supporter with what laying an object on it needs.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Place {
    position: Point,
    /// Unit vector along the bar's projection onto the horizontal plane.
    level: Vector,
    /// Unit vector along the bar.
    bar: Vector,
    /// Sum of the discounts for releases here that failed.
    discount: f32,
    /// Points that are tested for collision first: some around the place, and those hit last.
    probes: [Point; PROBES],
    probe_count: u32,
    /// Number of collisions remembered so far.
    collisions: u32,
}

impl<'a> CandidateSearch<'a> {
    /// Bytes of working memory.
    pub(super) const fn bytes() -> usize {
        array_bytes::<Place>(MAX_SUPPORT_CONTACTS).saturating_add(array_bytes::<Way>(2 * MAX_OBJECT_CONTACTS))
    }

    /// Lays the contacts that are in the requested region of the object on `supports`.
    pub(super) fn new(
        scene: (&'a Body<'a>, &'a Support<'a>),
        contacts: &'a [ObjectContact],
        request: &'a Request<'a>,
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
            let contact = &contacts[k / 2];
            if !request.by.contains(&Frames::of(scene).on_object(&contact.position)) {
                way.score = f32::NEG_INFINITY;
                continue;
            }
            let lever = (contact.position - scene.0.centre).norm() / scene.0.reach;
            way.score = libm::logf(contact.capture.clamp(MIN_CAPTURE, MAX_CAPTURE) / MIN_CAPTURE)
                + LEVER_BONUS * lever
                - OPENING_PENALTY * (contact.opening() / scene.0.reach).min(1.0)
                + if is_along(k) { ALONG_BONUS } else { 0.0 }
                + if is_along(k) && contact.is_in_loop() { LOOP_BONUS } else { 0.0 }
                - if contact.is_enclosed() { ENCLOSED_PENALTY } else { 0.0 };
        }
        let counts = CandidateCounts::default();
        Ok(Self { scene, request, up, contacts, places, ways, counts, in_scene: 0 })
    }

    /// The candidate with the highest score that has not been returned yet.
    pub(super) fn next(&mut self, meter: &mut Meter) -> Result<Option<Candidate>, Stop> {
        loop {
            // Until the next place with room is known, a place's discount cannot count. Of equal scores the first wins,
            // which has the deepest capture.
            let value = |way: &Way| match way.is_waiting {
                0 => way.score,
                _ => way.score - self.places[way.place as usize].discount,
            };
            let ways = self.ways.iter().enumerate().rev();
            let Some((index, best)) = ways.max_by(|(_, a), (_, b)| value(a).total_cmp(&value(b))) else {
                break;
            };
            if best.score == f32::NEG_INFINITY {
                break;
            }
            if best.is_waiting > 0 {
                let candidate =
                    Candidate { pose: best.pose(), contact: index / 2, place: best.place as usize };
                self.ways[index].is_waiting = 0;
                return Ok(Some(candidate));
            }
            self.find_clear_place(index, meter)?;
        }
        Ok(None)
    }

    /// Lays a contact on the next places until it is clear on one, on at most [`PATIENCE`] of them.
    fn find_clear_place(&mut self, index: usize, meter: &mut Meter) -> Result<(), Stop> {
        // Neighbours in the list are neighbours on the supporter, but consecutive trials should be far apart.
        let count = self.places.len();
        let stride = if count.is_multiple_of(PLACE_STRIDE) { 1 } else { PLACE_STRIDE };
        for _ in 0..PATIENCE {
            let Way { visited, found, .. } = self.ways[index];
            if visited as usize == count
                || found == MAX_PLACES_PER_CONTACT
                || self.counts.made >= MAX_POSES_MADE
            {
                self.ways[index].score = f32::NEG_INFINITY;
                return Ok(());
            }
            let place = visited as usize * stride % count.max(1);
            self.ways[index].visited += 1;
            if let Some(pose) = self.lay(index, place, meter)? {
                self.counts.clear += 1;
                if !is_clear_of_scene(self.scene, self.request, &pose, CLEARANCE, meter)? {
                    self.in_scene += 1;
                    continue;
                }
                let way = &mut self.ways[index];
                (way.found, way.is_waiting, way.place) = (found + 1, 1, place as u32);
                (way.rotation, way.translation) =
                    (pose.rotation.coords.into(), pose.translation.vector.into());
                return Ok(());
            }
        }
        // A loop that is too narrow for the bars loses its bonus before all places are tried.
        let is_in_loop = is_along(index) && self.contacts[index / 2].is_in_loop();
        self.ways[index].score -= if is_in_loop { NARROW_LOOP_DISCOUNT } else { NO_ROOM_DISCOUNT };
        Ok(())
    }

    /// Drops the contacts inside cavities, which only caps hang by.
    pub(super) fn drop_enclosed(&mut self) {
        for (way, contact) in self.ways.chunks_mut(2).zip(self.contacts) {
            if contact.is_enclosed() {
                way.iter_mut().for_each(|way| way.score = f32::NEG_INFINITY);
            }
        }
    }

    /// Takes a share of the discounts off the scores of the candidates with the same contact or on the same place.
    pub(super) fn discount(&mut self, candidate: &Candidate, share: f32) {
        for way in &mut self.ways[2 * candidate.contact..][..2] {
            way.score -= share * OBJECT_DISCOUNT;
        }
        self.places[candidate.place].discount += share * SUPPORT_DISCOUNT;
    }

    /// The clear pose of a contact on a place, in either sense of the bar direction, if there is one.
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
        // Either sense comes first for half of the pairs.
        let first = if (way / 2 + place_index).is_multiple_of(2) { 1.0 } else { -1.0 };
        for sign in [first, -first] {
            // With the centre of mass straight below; or tilted with the bar, as a long hole has to be.
            for (along, is_needed) in [(level, true), (bar, bar.dot(&self.up).abs() > LEVEL_SINE)] {
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

fn is_along(way: usize) -> bool {
    way.is_multiple_of(2)
}

impl Way {
    fn pose(&self) -> Pose {
        let rotation = UnitQuaternion::new_unchecked(Quaternion::from(self.rotation));
        Pose::from_parts(Translation3::from(self.translation), rotation)
    }
}

/// The pose with this rotation that holds `contact` just above `place`. Small penetrations are resolved by pushes;
/// `None` if that does not make it clear.
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
    for _ in 0..MAX_PUSHES {
        let (mut least, mut point) = (CLEARANCE, None);
        for (count, probe) in place.probes[..place.probe_count as usize].iter().enumerate() {
            let gap = field.distance(&Point::from(to_object * (probe.coords - shift)));
            if gap < -MAX_PENETRATION {
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
        shift -= rotation * gradient * (CLEARANCE + PUSH_OVERSHOOT - gap);
        if gap < -MAX_PENETRATION || (shift - start).norm() > MAX_PUSH {
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
        Self { position: contact.position, level, bar, discount: 0.0, probes, probe_count, collisions: 0 }
    }

    /// Adds a point of a collision to the probes: the next pose is likely to collide with it as well.
    fn remember(&mut self, point: Point) {
        let slot = if self.probe_count < PROBES as u32 {
            self.probe_count += 1;
            self.probe_count - 1
        } else {
            PROBES as u32 - 1 - self.collisions % REMEMBERED_PROBES
        };
        self.probes[slot as usize] = point;
        self.collisions += 1;
    }
}

/// A sample of the points around a place, and its size.
fn probes(support: &Support, place: Point) -> ([Point; PROBES], u32) {
    let mut probes = [Point::origin(); PROBES];
    let mut count = 0_u32;
    support.tree.for_each_within(&place, PROBE_RADIUS, |neighbour| {
        let point = support.tree.points()[neighbour.index as usize];
        let slot = if count < PROBES as u32 {
            count as usize
        } else {
            // Reservoir sampling with a fixed hash of the count instead of random numbers, so that runs repeat.
            (count.wrapping_mul(2_654_435_761) >> 16) as usize % (4 * PROBES)
        };
        if let Some(probe) = probes.get_mut(slot) {
            *probe = point;
        }
        count += 1;
    });
    (probes, count.min(PROBES as u32))
}

/// The right-handed frame of `down` and the part of `along` that is perpendicular to it.
fn frame(along: Vector, down: Vector) -> Matrix3<f32> {
    let along = unit_or(along - down * along.dot(&down), any_perpendicular(down));
    Matrix3::from_columns(&[along, down, along.cross(&down)])
}
