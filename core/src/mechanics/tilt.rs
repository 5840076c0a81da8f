//! How far gravity may tilt before a resting object leaves.

use super::contact::Near;
use super::settle::{Motion, Settings};
use super::{Body, Support};
use crate::geometry::{Pose, Vector};

/// The greatest tilt.
pub const MOST: f32 = 1.05;

/// Tilts gravity towards the horizontal direction at `azimuth`, at `rate` rad/s, until the body leaves; returns the angle, and
/// the steps.
pub fn tilt(
    body: &Body,
    support: &Support,
    rest: &Pose,
    settings: &Settings,
    azimuth: f32,
    rate: f32,
    near: &mut [Near],
) -> (f32, usize) {
    let start = body.at(rest);
    let limit = 0.06_f32.max(0.5 * body.extent);
    let strength = settings.gravity.norm();
    let (s, c) = libm::sincosf(azimuth);
    let across = Vector::new(c, s, 0.0);
    let mut motion = Motion::new(body, support, start, near);
    let mut angle = 0.0;
    let mut steps = 0;
    let mut loose = 0.0;
    let mut since = 0;
    while angle < MOST {
        steps += 1;
        angle = rate * steps as f32 * settings.time_step;
        let (sin, cos) = libm::sincosf(angle);
        let down = across * sin - Vector::z() * cos;
        motion.step(&(down * strength), settings);
        if motion.touches {
            since = 0;
            loose = angle;
        } else {
            since += 1;
        }
        let sank = down.dot(&(motion.state.centre - start.centre)) ;
        // Swinging into the new direction of gravity is not falling.
        if since as f32 * settings.time_step > 0.12 || sank > limit + body.reach {
            return (loose, steps);
        }
    }
    (if since > 5 { loose } else { MOST }, steps)
}
