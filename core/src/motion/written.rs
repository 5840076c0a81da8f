//! Waypoints in the caller's memory.

use super::path::Waypoint;
use super::placement::{Leg, Placement};
use super::route::{Route, parts};
use crate::geometry::Point;
use crate::hanging::Distance;

/// Metres and radians below which a motion is none: single precision.
const LEAST_LEG: f32 = 1e-6;

/// Waypoints that are written one after another, and counted also where there is no room for them.
pub(super) struct Written<'w> {
    pub(super) waypoints: &'w mut [Waypoint],
    pub(super) count: usize,
    /// Largest distance between two waypoints.
    pub(super) step: Distance,
}

impl Written<'_> {
    /// Appends the route of something with this centre, in its own coordinates.
    pub(super) fn route(&mut self, route: &Route, centre: &Point) {
        if let Some(first) = route.places().first() {
            self.push(first, centre);
        }
        for ends in route.places().windows(2) {
            if let [from, to] = ends {
                self.leg(from, &from.leg_to(to), centre);
            }
        }
    }

    /// Appends a motion, unless it is none, from a place that has been written.
    pub(super) fn leg(&mut self, from: &Placement, leg: &Leg, centre: &Point) {
        if leg.shift.norm() + leg.turn.norm() < LEAST_LEG {
            return;
        }
        let parts = parts(leg, &self.step);
        let room = self.waypoints.len().saturating_sub(self.count).min(parts);
        for part in 1..=room {
            self.push(&from.after(leg, part as f32 / parts as f32), centre);
        }
        self.count += parts - room;
    }

    fn push(&mut self, place: &Placement, centre: &Point) {
        if let Some(slot) = self.waypoints.get_mut(self.count) {
            *slot = Waypoint { seconds: 0.0, pose: place.pose(centre) };
        }
        self.count += 1;
    }
}
