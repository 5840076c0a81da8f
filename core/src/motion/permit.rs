//! The caller's say in where the object may be.

use super::placement::{Leg, Placement};
use super::route::{Route, parts};
use crate::geometry::{Point, Pose};
use crate::hanging::Distance;
use crate::mechanics::Frames;
use crate::monitor::{Meter, Stop};

/// Asks the caller whether poses are accepted, and counts how often.
pub(super) struct Permit<'p> {
    accepts: &'p mut dyn FnMut(&Pose) -> bool,
    frames: Frames,
    /// Centre of what moves, in its own coordinates.
    centre: Point,
    pub(super) asked: usize,
    pub(super) refused: usize,
}

impl<'p> Permit<'p> {
    pub(super) fn new(accepts: &'p mut dyn FnMut(&Pose) -> bool, frames: Frames, centre: Point) -> Self {
        Self { accepts, frames, centre, asked: 0, refused: 0 }
    }

    pub(super) fn accepts(&mut self, at: &Placement) -> bool {
        self.asked += 1;
        let is_accepted = (self.accepts)(&self.frames.outwards(&at.pose(&self.centre)));
        self.refused += usize::from(!is_accepted);
        is_accepted
    }

    /// Whether the caller accepts every pose of a leg, at distances of at most `step`, but the first.
    fn accepts_leg(
        &mut self,
        from: &Placement,
        leg: &Leg,
        step: &Distance,
        meter: &Meter,
    ) -> Result<bool, Stop> {
        let parts = parts(leg, step);
        for part in 1..=parts {
            meter.check_cancelled()?;
            if !self.accepts(&from.after(leg, part as f32 / parts as f32)) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The first leg of a route on which the caller refuses a pose.
    pub(super) fn refused_leg(
        &mut self,
        route: &Route,
        step: &Distance,
        meter: &Meter,
    ) -> Result<Option<usize>, Stop> {
        for (leg, ends) in route.places().windows(2).enumerate() {
            if let [from, to] = ends
                && !self.accepts_leg(from, &from.leg_to(to), step, meter)?
            {
                return Ok(Some(leg));
            }
        }
        Ok(None)
    }

    /// Whether the caller has refused a pose: then it is worth asking early.
    pub(super) fn is_picky(&self) -> bool {
        self.refused > 0
    }
}
