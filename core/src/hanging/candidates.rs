//! Poses worth letting go of: every place of the object that can lie on something, laid on every place of the supporter that can
//! carry something, with the centre of mass straight below.

use super::object_contact::{self, ObjectContact};
use super::support_contact::{self, SupportContact};
use crate::geometry::{Point, Pose, Vector, any_perpendicular, rotate_about, unit_or};
use crate::mechanics::{Body, Support, is_clear};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix3, Quaternion, Rotation3, Translation3, UnitQuaternion};

/// A pose that is clear of the supporter.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Candidate {
    /// Quaternion x, y, z, w.
    rotation: [f32; 4],
    translation: [f32; 3],
    /// How much the contacts promise: the logarithm of how deep the object catches a bar, and whether that lies along it.
    pub(super) promise: f32,
    /// Which contacts: of the object and of the supporter.
    pub(super) contacts: [u32; 2],
    /// Not zero once it was let go.
    pub(super) is_tried: u32,
}

impl Candidate {
    pub(super) fn pose(&self) -> Pose {
        let rotation = UnitQuaternion::new_unchecked(Quaternion::from(self.rotation));
        Pose::from_parts(Translation3::from(self.translation), rotation)
    }
}

/// Of an object contact at most so many are kept, on different places of the supporter: what does not stay on these would hardly on
/// others.
const PER_CONTACT: usize = 4;
/// Kept at most.
pub(super) const MAX_CANDIDATES: usize = object_contact::MAX_CONTACTS * PER_CONTACT;
/// Support contacts are gone through in such steps, so that the first ones are far apart.
const STRIDE: usize = 37;

/// How far above the support the contact is held, metres: the least that is clear is taken.
const LIFTS: [f32; 2] = [0.0015, 0.005];
/// How far a candidate is off the supporter, metres.
pub(super) const CLEARANCE: f32 = 0.0005;
/// Points around a support contact that are tried before all others.
const PROBES: usize = 16;
/// ... and from how far around, metres.
const AROUND: f32 = 0.03;
/// Quarter turns about the vertical: first those that lay the bar along the direction in which the object catches it best, and
/// of these one way or the other in turn.
const TURNS: [[u8; 4]; 2] = [[0, 2, 1, 3], [2, 0, 3, 1]];
/// The promise of the first two.
const ALONG: f32 = 1.0;
/// What a contact promises that catches this or less, metres.
const LEAST_CAPTURE: f32 = 0.00075;

/// Fills `slots` and returns how many poses were made and how many of them are clear and kept.
pub(super) fn find(
    scene: (&Body, &Support),
    contacts: &[ObjectContact],
    supports: &[SupportContact],
    up: Vector,
    slots: &mut [Candidate],
    meter: &mut Meter,
) -> Result<[usize; 2], Stop> {
    let mut places = heapless::Vec::<Place, { support_contact::MAX_CONTACTS }>::new();
    for support in supports {
        // There are no more of them than it holds.
        let _ = places.push(Place::new(scene.1, support, up));
    }
    // Coprime to any number of contacts that is not a multiple of it.
    let stride = if places.len().is_multiple_of(STRIDE) { 1 } else { STRIDE };
    let (mut made, mut kept) = (0, 0);
    for (i, contact) in contacts.iter().enumerate() {
        let down = unit_or(scene.0.centre - contact.position, -contact.normal);
        let object_frame = frame(contact.bar_direction, down);
        let promise = libm::logf(contact.capture.max(LEAST_CAPTURE) / LEAST_CAPTURE);
        let most = kept + PER_CONTACT;
        for k in 0..places.len() {
            let j = k * stride % places.len();
            if kept == most {
                break;
            }
            for turn in TURNS[(i + k) % 2] {
                let yaw = core::f32::consts::FRAC_PI_2 * f32::from(turn);
                let support_frame = frame(rotate_about(up, yaw, places[j].along), -up);
                let rotation = Rotation3::from_matrix_unchecked(support_frame * object_frame.transpose());
                let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
                made += 1;
                if let Some(pose) = lowest_clear(scene, contact, &places[j], rotation, up, meter)? {
                    slots[kept] = Candidate {
                        rotation: pose.rotation.coords.into(),
                        translation: pose.translation.vector.into(),
                        promise: promise + if turn % 2 == 0 { ALONG } else { 0.0 },
                        contacts: [i as u32, j as u32],
                        is_tried: 0,
                    };
                    kept += 1;
                    break;
                }
            }
        }
    }
    Ok([made, kept])
}

/// The pose with this rotation that holds `contact` just above `place`, if one is clear.
fn lowest_clear(
    scene: (&Body, &Support),
    contact: &ObjectContact,
    place: &Place,
    rotation: UnitQuaternion<f32>,
    up: Vector,
    meter: &mut Meter,
) -> Result<Option<Pose>, Stop> {
    for lift in LIFTS {
        let shift = place.position + up * lift - rotation * contact.position;
        let pose = Pose::from_parts(Translation3::from(shift), rotation);
        meter.distance_queries(place.probes.len())?;
        let depth = |probe: &Point| -scene.0.field.distance(&pose.inverse_transform_point(probe));
        match place.probes.iter().map(depth).find(|depth| *depth > 0.0) {
            // So far inside that it stays there when it is lifted.
            Some(depth) if depth > LIFTS[1] => return Ok(None),
            Some(_) => {}
            None if is_clear(scene, &pose, CLEARANCE, meter)? => return Ok(Some(pose)),
            None => {}
        }
    }
    Ok(None)
}

/// A contact of the supporter, made ready.
struct Place {
    position: Point,
    /// Unit vector, level, along the bar.
    along: Vector,
    /// Some of the points around.
    probes: heapless::Vec<Point, PROBES>,
}

impl Place {
    fn new(support: &Support, contact: &SupportContact, up: Vector) -> Self {
        let level = contact.bar_direction - up * contact.bar_direction.dot(&up);
        let along = if level.norm() > 0.2 { level.normalize() } else { any_perpendicular(up) };
        Self { position: contact.position, along, probes: probes(support, contact.position) }
    }
}

/// Some of the points around a place, spread over all of them.
fn probes(support: &Support, place: Point) -> heapless::Vec<Point, PROBES> {
    let mut probes = heapless::Vec::new();
    let mut count = 0_u32;
    support.tree.for_each_within(&place, AROUND, |neighbour| {
        let point = support.tree.points()[neighbour.index as usize];
        if let Err(point) = probes.push(point) {
            // A later one replaces an earlier one as often as not, by a fixed hash of how many came before.
            let slot = (count.wrapping_mul(2_654_435_761) >> 16) as usize % (4 * PROBES);
            if let Some(probe) = probes.get_mut(slot) {
                *probe = point;
            }
        }
        count += 1;
    });
    probes
}

/// The right-handed frame of a direction, made perpendicular, and down.
fn frame(along: Vector, down: Vector) -> Matrix3<f32> {
    let along = unit_or(along - down * along.dot(&down), any_perpendicular(down));
    Matrix3::from_columns(&[along, down, along.cross(&down)])
}
