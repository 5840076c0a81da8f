//! Poses worth letting go of: every place of the object that can lie on something, laid on every place of the supporter that can
//! carry something, with the centre of mass straight below.

use super::object_contact::ObjectContact;
use super::support_contact::SupportContact;
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

/// Kept at most; those of the object's most promising contacts come first.
pub(super) const MAX_CANDIDATES: usize = 4096;

/// How far above the support the contact is held, metres: the least that is clear is taken.
const LIFTS: [f32; 2] = [0.0015, 0.005];
/// How far a candidate is off the supporter, metres.
pub(super) const CLEARANCE: f32 = 0.0005;
/// Points around a support contact that are tried before all others.
const PROBES: usize = 16;
/// ... and from how far around, metres.
const AROUND: f32 = 0.03;
/// Quarter turns about the vertical: first those that lay the bar along the direction in which the object catches it best.
const TURNS: [u8; 4] = [0, 2, 1, 3];
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
    let (mut made, mut kept) = (0, 0);
    for (j, place) in supports.iter().enumerate() {
        let probes = probes(scene.1, place.position);
        let level = place.bar_direction - up * place.bar_direction.dot(&up);
        let along = if level.norm() > 0.2 { level.normalize() } else { any_perpendicular(up) };
        for (i, contact) in contacts.iter().enumerate() {
            let down = unit_or(scene.0.centre - contact.position, -contact.normal);
            let object_frame = frame(contact.bar_direction, down);
            for turn in TURNS {
                let yaw = core::f32::consts::FRAC_PI_2 * f32::from(turn);
                let rotation = frame(rotate_about(up, yaw, along), -up) * object_frame.transpose();
                let rotation =
                    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
                made += 1;
                let Some(pose) =
                    lowest_clear(scene, contact.position, place.position, rotation, up, &probes, meter)?
                else {
                    continue;
                };
                let promise = libm::logf(contact.capture.max(LEAST_CAPTURE) / LEAST_CAPTURE)
                    + if turn % 2 == 0 { ALONG } else { 0.0 };
                if kept < slots.len() {
                    slots[kept] = Candidate {
                        rotation: pose.rotation.coords.into(),
                        translation: pose.translation.vector.into(),
                        promise,
                        contacts: [i as u32, j as u32],
                        is_tried: 0,
                    };
                    kept += 1;
                } else if let Some(worst) = slots.iter_mut().min_by(|a, b| a.promise.total_cmp(&b.promise))
                    && worst.promise < promise
                {
                    *worst = Candidate {
                        rotation: pose.rotation.coords.into(),
                        translation: pose.translation.vector.into(),
                        promise,
                        contacts: [i as u32, j as u32],
                        is_tried: 0,
                    };
                }
            }
        }
    }
    Ok([made, kept])
}

/// The pose with this rotation that holds `contact` just above `place`, if one is clear.
fn lowest_clear(
    (body, support): (&Body, &Support),
    contact: Point,
    place: Point,
    rotation: UnitQuaternion<f32>,
    up: Vector,
    probes: &[Point],
    meter: &mut Meter,
) -> Result<Option<Pose>, Stop> {
    for lift in LIFTS {
        let shift = place + up * lift - rotation * contact;
        let pose = Pose::from_parts(Translation3::from(shift), rotation);
        meter.distance_queries(probes.len())?;
        let runs_through = |probe: &Point| body.field.distance(&pose.inverse_transform_point(probe)) < 0.0;
        if !probes.iter().any(runs_through) && is_clear(body, support, &pose, CLEARANCE, meter)? {
            return Ok(Some(pose));
        }
    }
    Ok(None)
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
