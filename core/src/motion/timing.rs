//! When the object is where.

use super::path::Waypoint;
use super::placement::{Leg, Placement};
use super::task::Speed;
use crate::geometry::Point;

/// Sets the times of waypoints, from `start` seconds on: from rest to rest, at no time faster than `speed`, with accelerations
/// along the path and at its corners within its limits. `centre` is that of the moving thing, in its own coordinates.
///
/// The speed is that of a parameter that grows by one a leg. Each waypoint gets the largest speed at which its change of direction
/// takes no more acceleration than allowed; then a pass forwards and one backwards limit speeding up and braking.
pub(super) fn set_times(waypoints: &mut [Waypoint], start: f32, speed: &Speed, centre: &Point) {
    let place = |waypoint: &Waypoint| Placement::of(&waypoint.pose, centre);
    let leg = |waypoints: &[Waypoint], k: usize| place(&waypoints[k]).leg_to(&place(&waypoints[k + 1]));
    let Some(last) = waypoints.len().checked_sub(1) else { return };
    // Times hold the largest pace at each waypoint first, in multiples of the limits: a leg of length l, in seconds at full
    // speed, takes l / pace seconds.
    waypoints[0].seconds = 0.0;
    waypoints[last].seconds = 0.0;
    for k in 1..last {
        let corner = corner_pace(&leg(waypoints, k - 1), &leg(waypoints, k), speed);
        let before = waypoints[k - 1].seconds;
        let reached = after(before, &leg(waypoints, k - 1), speed);
        waypoints[k].seconds = corner.min(reached).min(1.0);
    }
    for k in (0..last).rev() {
        let reached = after(waypoints[k + 1].seconds, &leg(waypoints, k), speed);
        waypoints[k].seconds = waypoints[k].seconds.min(reached);
    }
    let (mut time, mut pace) = (start, 0.0);
    for k in 0..=last {
        let next = waypoints[k].seconds;
        if k > 0 {
            time += duration(pace, next, &leg(waypoints, k - 1), speed);
        }
        pace = next;
        waypoints[k].seconds = time;
    }
}

/// Length of a leg in seconds at full speed.
fn length(leg: &Leg, speed: &Speed) -> f32 {
    (leg.shift.norm() / speed.linear).max(leg.turn.norm() / speed.angular)
}

/// Largest change of pace a second along a leg.
fn acceleration(leg: &Leg, speed: &Speed) -> f32 {
    let length = length(leg, speed).max(1e-9);
    let (shift, turn) = (leg.shift.norm() / length, leg.turn.norm() / length);
    (speed.linear_acceleration / shift.max(1e-9)).min(speed.angular_acceleration / turn.max(1e-9))
}

/// Largest pace at the end of a leg.
fn after(pace: f32, leg: &Leg, speed: &Speed) -> f32 {
    libm::sqrtf(pace * pace + 2.0 * acceleration(leg, speed) * length(leg, speed))
}

/// Time of a leg between two paces, seconds: speeding up, at full pace, and braking.
fn duration(from: f32, to: f32, leg: &Leg, speed: &Speed) -> f32 {
    let (length, acceleration) = (length(leg, speed), acceleration(leg, speed));
    if length <= 0.0 {
        return 0.0;
    }
    let peak = libm::sqrtf(acceleration * length + 0.5 * (from * from + to * to)).min(1.0).max(from).max(to);
    let changing = (2.0 * peak - from - to) / acceleration;
    let way = (2.0 * peak * peak - from * from - to * to) / (2.0 * acceleration);
    changing + (length - way).max(0.0) / peak
}

/// Largest pace at which the change of velocity between two legs, over the mean of their times, is within the accelerations.
fn corner_pace(before: &Leg, after: &Leg, speed: &Speed) -> f32 {
    let [l, m] = [before, after].map(|leg| length(leg, speed).max(1e-9));
    let mean = 0.5 * (l + m);
    let linear = (after.shift / m - before.shift / l).norm();
    let angular = (after.turn / m - before.turn / l).norm();
    let pace = |change: f32, limit: f32| libm::sqrtf(limit * mean / change.max(1e-9));
    pace(linear, speed.linear_acceleration).min(pace(angular, speed.angular_acceleration))
}
