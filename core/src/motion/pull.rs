//! Pulls the object off, as a hand does that gives way: what it touches turns it and leads it aside.
//!
//! The steps of [`drag`](Search::drag) turn the object by itself, to first order. A narrow hole on a bent bar jams then; in the
//! simulation it follows the bar.

use super::enclosed;
use super::permit::Permit;
use super::placement::Placement;
use super::route::Route;
use super::search::{ASIDE_EXCESS, BAR_RANGE, GOAL, LEAST_STRIDE, LEAST_TRAVEL, MAX_BARS, SAME_BAR, Search};
use super::space::Touches;
use crate::geometry::{Point, Vector, fibonacci_direction, unit_or};
use crate::mechanics::{Pull, Sleep, Support, pulled};
use crate::monitor::{Meter, Stop};
use crate::motion::failure::Obstacle;
use heapless::Vec;

// Set by hand.

/// Travel of one pull, as a share of the reach of what moves.
const STRIDE: f32 = 0.05;
/// Share of that below which the object is stuck.
const STUCK: f32 = 0.1;
/// Pulls straight on.
const STRAIGHT: usize = 16;
/// Directions in which the object is pulled from the goal.
const DIRECTIONS: usize = 14;
/// How often it is pulled straight on in one direction: as far as five times its reach.
const TRIES: usize = 6;
/// Pulls along a bar.
const ALONG_BAR: usize = 64;
/// Pulls along a bar after which the way out is tried.
const UNTIL_TRIED: usize = 8;
/// Distance from the object within which a bar leads it, metres: it is pulled with a little more than the required distance.
const LEADING_RANGE: f32 = 2.0 * BAR_RANGE;
/// Most patches and groups of a supporter off which the object is pulled: their sleeps take the memory of the proof that there is no
/// way, which is not needed at the same time. So many patches cover half a square metre.
const MAX_SLEEPERS: usize = enclosed::bytes(0) / size_of::<Sleep>();

impl Search<'_, '_, '_> {
    /// Pulls the object from the goal along the bars that it is near there, both ways, then in all directions. Returns whether that
    /// gives a route, which it writes.
    pub(super) fn pull_off(
        &mut self,
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let to_object = self.goal.pose(&self.space.moving.centre).inverse();
        let mut tried = Vec::<Vector, MAX_BARS>::new();
        for &(bar, at) in &self.bars_at(0, BAR_RANGE, meter)? {
            if tried.iter().any(|other| other.dot(&bar).abs() > SAME_BAR) || tried.push(bar).is_err() {
                continue;
            }
            for direction in [bar, -bar] {
                if self.pull_along((direction, to_object * at), route, permit, meter)? {
                    return Ok(true);
                }
            }
        }
        for direction in (0..DIRECTIONS).map(|index| fibonacci_direction(index, DIRECTIONS)) {
            let mut at = 0;
            for _ in 0..TRIES {
                let Some(next) = self.pull_straight(at, direction, permit, meter)? else { break };
                at = next;
                if self.meets(GOAL, at, route, permit, meter)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Pulls the object from the goal along the bar at a point of it, given in object coordinates, starting in a direction.
    fn pull_along(
        &mut self,
        (direction, point): (Vector, Point),
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let centre = self.space.moving.centre;
        let (mut at, mut direction) = (0, direction);
        for pull in 1..=ALONG_BAR {
            let here = self.trees[GOAL].placement(at).pose(&centre) * point;
            let bars = self.bars_at(at, LEADING_RANGE, meter)?;
            let nearest =
                bars.iter().min_by(|(_, a), (_, b)| (a - here).norm().total_cmp(&(b - here).norm()));
            if let Some((bar, _)) = nearest {
                direction = if bar.dot(&direction) < 0.0 { -bar } else { *bar };
            }
            let Some(next) = self.pull(at, (direction, Some(point)), permit, meter)? else { break };
            at = next;
            if pull % UNTIL_TRIED == 0 && self.meets(GOAL, at, route, permit, meter)? {
                return Ok(true);
            }
        }
        self.meets(GOAL, at, route, permit, meter)
    }

    /// Pulls the object on from the node of the goal's tree that is nearest to a target, by its centre towards the target's. Returns the
    /// last node, if it moves at all.
    pub(super) fn pull_towards(
        &mut self,
        target: &Placement,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let Some(from) = self.trees[GOAL].nearest(target) else { return Ok(None) };
        let shift = self.trees[GOAL].placement(from).leg_to(target).shift;
        self.pull_straight(from, unit_or(shift, self.params.up()), permit, meter)
    }

    /// Pulls the object on from a node of the goal's tree by its centre. Returns the last node, if it moves at all.
    fn pull_straight(
        &mut self,
        from: usize,
        direction: Vector,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let mut at = from;
        for _ in 0..STRAIGHT {
            let Some(next) = self.pull(at, (direction, None), permit, meter)? else { break };
            at = next;
        }
        Ok((at != from).then_some(at))
    }

    /// Pulls once from a node of the goal's tree in a direction, by a point in object coordinates or by the centre. Returns the node
    /// where that ends; `None` if the object is stuck.
    fn pull(
        &mut self,
        from: usize,
        (direction, at): (Vector, Option<Point>),
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let moving = self.space.moving;
        let support = self.space.obstacles.support;
        let sleepers = Support::sleepers(support.patches.len());
        let (Some(body), Some(scratch)) = (moving.body, &mut self.scratch) else { return Ok(None) };
        let mut arena = scratch.scratch();
        let Some(sleeps) = arena.unset(sleepers).ok().filter(|sleeps| sleeps.len() <= MAX_SLEEPERS) else {
            return Ok(None);
        };
        let place = self.trees[GOAL].placement(from);
        let stride = (STRIDE * moving.reach).max(LEAST_STRIDE);
        let pull = Pull { direction, at, travel: stride, gap: ASIDE_EXCESS * self.required };
        let pose = pulled((&body, support), &place.pose(&moving.centre), &pull, self.params, sleeps, meter)?;
        let target = Placement::of(&pose, &moving.centre);
        if place.leg_to(&target).travel(moving.reach) < LEAST_TRAVEL {
            return Ok(None);
        }
        let grown = self.grow_from((GOAL, from), &target, permit, meter)?;
        Ok(grown.map(|(node, _)| node).filter(|node| {
            place.leg_to(&self.trees[GOAL].placement(*node)).travel(moving.reach) >= STUCK * stride
        }))
    }

    /// The directions of the bars within `range` metres of the object at a node of the goal's tree, and the places where they are
    /// near.
    pub(super) fn bars_at(
        &mut self,
        node: usize,
        range: f32,
        meter: &mut Meter,
    ) -> Result<Vec<(Vector, Point), { Touches::CAPACITY }>, Stop> {
        let mut touches = Touches::within(range);
        let place = self.trees[GOAL].placement(node);
        self.space.collect(&place, &mut touches, meter)?;
        let support = self.space.obstacles.support;
        let mut bars = Vec::new();
        for touch in touches.list.iter().filter(|touch| touch.obstacle == Obstacle::Supporter) {
            if let Some(bar) = support.bar_near(&touch.at, &touch.normal) {
                // There is room for all touches.
                let _ = bars.push((bar, touch.at));
            }
        }
        Ok(bars)
    }
}
