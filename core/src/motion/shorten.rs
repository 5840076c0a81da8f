//! Makes a route short and smooth.

use super::placement::Placement;
use super::route::Route;
use super::space::Space;
use crate::monitor::{Meter, Stop};
use crate::random::Random;

/// Random shortcuts that are tried.
const SHORTCUTS: usize = 24;
/// Travel that a shortcut saves at least, metres.
const WORTH_IT: f32 = 0.003;
/// Rounds in which corners are cut.
const ROUNDS: usize = 2;
/// Share of either leg that is cut off at a corner.
const CUT: f32 = 0.25;
/// Travel of a leg below which its corners are not cut, metres.
const SHORT_LEG: f32 = 0.004;

/// Shortens and smooths a route. Shortcuts come no closer to obstacles than the way that they replace, or keep `clearance` metres.
pub(super) fn shorten(
    space: &mut Space,
    route: &mut Route,
    (required, clearance): (f32, f32),
    random: &mut Random,
    meter: &mut Meter,
) -> Result<(), Stop> {
    let reach = space.moving.reach;
    let mut shortcut = Shortcut { space, required, clearance, least_saving: WORTH_IT };
    // Past as many places as possible at once, then fewer.
    let mut first = 0;
    while first + 2 <= route.legs() {
        let mut skipped = route.legs() - first;
        while skipped >= 2 && !shortcut.between((first, 0.0), (first + skipped - 1, 1.0), route, meter)? {
            skipped /= 2;
        }
        first += 1;
    }
    for _ in 0..SHORTCUTS {
        let mut ends = [(); 2].map(|()| random.next_f32() * route.legs() as f32);
        ends.sort_unstable_by(f32::total_cmp);
        let [from, to] = ends.map(|end| (end as usize, end - libm::floorf(end)));
        if from.0 != to.0 {
            shortcut.between(from, to, route, meter)?;
        }
    }
    shortcut.least_saving = 0.0;
    for _ in 0..ROUNDS {
        let mut leg = 0;
        while leg + 1 < route.legs() {
            let is_long = |leg: usize| route.leg(leg).travel(reach) > SHORT_LEG;
            let is_cut = is_long(leg)
                && is_long(leg + 1)
                && shortcut.between((leg, 1.0 - CUT), (leg + 1, CUT), route, meter)?;
            // The cut is a leg of its own.
            leg += if is_cut { 2 } else { 1 };
        }
    }
    Ok(())
}

struct Shortcut<'q, 'a> {
    space: &'q mut Space<'a>,
    required: f32,
    clearance: f32,
    /// Travel that a shortcut saves at least, metres.
    least_saving: f32,
}

impl Shortcut<'_, '_> {
    /// Replaces the part of a route between two points, each given by a leg and the share of it, by the direct way, if that is
    /// free and shorter.
    fn between(
        &mut self,
        (first, from): (usize, f32),
        (last, to): (usize, f32),
        route: &mut Route,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let point = |leg: usize, share: f32| route.places()[leg].after(&route.leg(leg), share);
        let (start, end) = (point(first, from), point(last, to));
        let leg = start.leg_to(&end);
        let reach = self.space.moving.reach;
        let part = |leg: usize| {
            let share =
                1.0 - if leg == first { from } else { 0.0 } - if leg == last { 1.0 - to } else { 0.0 };
            route.leg(leg).travel(reach) * share
        };
        let before = (first..=last).map(part).sum::<f32>();
        if before - leg.travel(reach) < self.least_saving {
            return Ok(false);
        }
        // In the middle a shortcut is most likely blocked.
        let least = route.clearance(first..last + 1);
        let required = least.min(self.clearance).max(self.required);
        if self.space.distance_if_free(&start.after(&leg, 0.5), required, meter)?.is_none() {
            return Ok(false);
        }
        let way = self.space.way(&start, &leg, required, meter)?;
        if !way.is_free() {
            return Ok(false);
        }
        let (before, after) = (route.clearance(first..first + 1), route.clearance(last..last + 1));
        let mut places = heapless::Vec::<Placement, 2>::new();
        let mut clearances = heapless::Vec::<f32, 3>::new();
        if from > 0.0 {
            let _ = (places.push(start), clearances.push(before));
        }
        let _ = clearances.push(way.clearance);
        if to < 1.0 {
            let _ = (places.push(end), clearances.push(after));
        }
        Ok(route.replace(first, last + 1, &places, &clearances))
    }
}
