//! The default way from two analysed models to poses: contact on contact, and then gravity decides.

use super::object_contact::ObjectContact;
use super::support_contact::SupportContact;
use crate::geometry::{Point, Pose, Vector, any_perpendicular, rotate_about, unit_or};
use crate::mechanics::{Body, Fate, Near, Settings, Support, is_clear, settle};
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};

/// Prototype result.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Found {
    pub release: Pose,
    pub rest: Pose,
    pub tilts: u32,
    pub least: f32,
    pub sank: f32,
    pub contact: u32,
    pub support: u32,
    pub tries: u32,
}

#[derive(Clone, Copy)]
struct Candidate {
    pose: Pose,
    contact: u32,
    support: u32,
    prior: f32,
    done: bool,
}

/// Prototype search.
#[allow(missing_docs)]
pub fn search(
    body: &Body,
    contacts: &[ObjectContact],
    support: &Support,
    supports: &[SupportContact],
    knobs: &[f32],
    settings: &Settings,
    near: &mut [Near],
    report: &mut dyn FnMut(&Found, &Settings),
) -> [usize; 5] {
    let mut stats = [0; 5];
    let mut candidates: heapless::Vec<Candidate, 8192> = heapless::Vec::new();
    let up = Vector::z();
    let mut probes = [[0_u32; 16]; 128];
    for (s, probes) in supports.iter().zip(&mut probes) {
        let mut n = 0_u32;
        support.tree.for_each_within(&s.position, 0.03, |near| {
            // A sample of sixteen, the same in every run.
            let slot = if n < 16 { n } else { n.wrapping_mul(2_654_435_761) >> 8 & 63 };
            if slot < 16 {
                probes[slot as usize] = near.index;
            }
            n += 1;
        });
    }
    'all: for (i, c) in contacts.iter().enumerate().take(knobs[0] as usize) {
        let down = unit_or(body.centre - c.position, -c.normal);
        let object = frame(c.bar_direction, down);
        for (j, s) in supports.iter().enumerate() {
            let level = s.bar_direction - up * s.bar_direction.dot(&up);
            let along = if level.norm() > 0.2 { level.normalize() } else { any_perpendicular(up) };
            for k in 0..4 {
                let yaw = core::f32::consts::FRAC_PI_2 * [0.0, 2.0, 1.0, 3.0][k];
                let frame = frame(rotate_about(up, yaw, along), -up);
                let rotation = Rotation3::from_matrix_unchecked(frame * object.transpose());
                let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
                stats[0] += 1;
                for lift in [0.0015, 0.005] {
                    let shift = s.position + up * lift - rotation * c.position;
                    let pose = Pose::from_parts(Translation3::from(shift), rotation);
                    let to_object = pose.inverse();
                    let hits = |k: &u32| body.field.distance(&(to_object * support.tree.points()[*k as usize])) < 0.0;
                    if probes[j].iter().any(hits) {
                        continue;
                    }
                    stats[4] += 1;
                    if !is_clear(body, support, &pose, 0.0005) {
                        continue;
                    }
                    stats[1] += 1;
                    let prior = libm::logf((c.capture / 0.0015).max(0.5)) * knobs[2] + if k < 2 { knobs[3] } else { 0.0 };
                    let candidate =
                        Candidate { pose, contact: i as u32, support: j as u32, prior, done: false };
                    if candidates.push(candidate).is_err() {
                        break 'all;
                    }
                    break;
                }
            }
        }
    }
    let mut fails = [[0.0_f32; 256]; 2];
    let mut firm = 0;
    for tries in 0..knobs[1] as u32 {
        let value = |c: &Candidate| {
            c.prior - fails[0][c.contact as usize] - fails[1][c.support as usize]
        };
        let best = candidates
            .iter_mut()
            .filter(|c| !c.done)
            .max_by(|a, b| value(a).total_cmp(&value(b)));
        let Some(best) = best else { break };
        best.done = true;
        let candidate = *best;
        stats[2] += 1;
        let settled = settle(body, support, &candidate.pose, settings, near);
        stats[3] += settled.steps;
        let penalty = if settled.fate == Fate::Rests {
            let mut tilts = 4;
            let mut least = f32::INFINITY;
            for k in 0..8 {
                let angle = core::f32::consts::FRAC_PI_4 * k as f32;
                let (held, n) = crate::mechanics::tilt(body, support, &settled.pose, settings, angle, knobs[7], near);
                stats[3] += n;
                least = least.min(held);
                if least < knobs[8] { tilts = 0; break; }
            }
            firm += u32::from(tilts == 4);
            let found = Found {
                release: candidate.pose,
                rest: settled.pose,
                tilts, least,
                sank: settled.sank,
                contact: candidate.contact,
                support: candidate.support,
                tries,
            };
            report(&found, settings);
            if firm as f32 >= knobs[4] {
                break;
            }
            if tilts == 4 { 0.5 } else { 0.7 }
        } else {
            1.0
        };
        fails[0][candidate.contact as usize] += penalty * knobs[5];
        fails[1][candidate.support as usize] += penalty * knobs[6];
    }
    stats
}

fn frame(along: Vector, down: Vector) -> Matrix3<f32> {
    let along = unit_or(along - down * along.dot(&down), any_perpendicular(down));
    Matrix3::from_columns(&[along, down, along.cross(&down)])
}

/// For the prototype.
pub fn object_contacts<'s>(
    surface: &crate::geometry::Surface,
    points: &[Point],
    normals: &[Vector],
    centre: Point,
    least: f32,
    slots: &'s mut [ObjectContact],
) -> &'s [ObjectContact] {
    super::object_contact::find(surface, points, normals, centre, least, slots)
}

/// For the prototype.
pub fn support_contacts<'s>(support: &Support, least: f32, slots: &'s mut [SupportContact]) -> &'s [SupportContact] {
    super::support_contact::find(support.tree, support.normals, Vector::z(), least, slots)
}
