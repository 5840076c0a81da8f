//! Pulls the object off, as a hand does that gives way: what it touches turns it and leads it aside.
//!
//! The steps of [`drag`](Search::drag) turn the object by itself, to first order. A narrow hole on a bent bar jams then; in the
//! simulation it follows the bar.

use super::enclosed;
use super::permit::Permit;
use super::placement::{Leg, Placement};
use super::route::Route;
use super::search::{ASIDE_EXCESS, BAR_RANGE, GOAL, LEAST_STRIDE, LEAST_TRAVEL, MAX_BARS, Search};
use super::slide::aside;
use super::space::{Touch, Touches};
use crate::geometry::{Point, Vector, fibonacci_direction, unit_or};
use crate::mechanics::{Pull, Sleep, Support, pulled};
use crate::monitor::{Meter, Stop};
use heapless::Vec;

// Set by hand.

/// Travel of one pull, as a share of the reach of what moves.
const STRIDE: f32 = 0.05;
/// A pull that is tried where a full one is stuck, as a share of it.
const SHORTER: f32 = 0.25;
/// Share of a pull below which the object is stuck.
const STUCK: f32 = 0.1;
/// How often the end of a pull is pushed off what it is too close to.
const CORRECTIONS: usize = 2;
/// Pulls straight on.
const STRAIGHT: usize = 16;
/// Directions in which the object is pulled on from the end of a bar.
const DIRECTIONS: usize = 14;
/// Pulls along a bar at most: ten times the reach of what moves.
const ALONG_BAR: usize = 200;
/// Pulls along a bar that are made even where they lead no farther from the goal, as round the bend of a hook.
const ROUND_BENDS: usize = 64;
/// Share of the length of pulls by which they must lead farther from the goal after that.
const FARTHER: f32 = 0.25;
/// Pulls along a bar after which the way out is tried.
const UNTIL_TRIED: usize = 8;
/// Distance from the object within which a bar leads it, metres: it is pulled with a little more than the required distance.
const LEADING_RANGE: f32 = 2.0 * BAR_RANGE;
/// Most patches and groups of a supporter off which the object is pulled: their sleeps take the memory of the proof that there is no
/// way, which is not needed at the same time. So many patches cover half a square metre.
const MAX_SLEEPERS: usize = enclosed::bytes(0) / size_of::<Sleep>();

/// A node of the goal's tree from which the object is pulled on, and the point at which it is pulled, in object coordinates; by default
/// its centre.
pub(super) type End = (usize, Option<Point>);
/// The goal, and the ends of bars, both ways.
pub(super) type Ends = Vec<End, { 1 + 2 * MAX_BARS }>;

impl Search<'_, '_, '_> {
    /// Pulls the object from the goal along the bars that it is near there, both ways, and notes where it is stuck. Returns whether
    /// that gives a route, which it writes.
    pub(super) fn pull_along_bars(
        &mut self,
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let to_object = self.goal.pose(&self.space.moving.centre).inverse();
        // There is room for all.
        let _ = self.ends.push((0, None));
        for &(bar, at) in &self.bars(meter)? {
            for direction in [bar, -bar] {
                if self.pull_along((direction, to_object * at), route, permit, meter)? {
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
        let start = self.goal.pose(&centre) * point;
        let (mut at, mut direction, mut without, mut farthest) = (0, direction, 0, 0.0_f32);
        for pull in 1..=ALONG_BAR {
            let here = self.trees[GOAL].placement(at).pose(&centre) * point;
            let nearest = self.nearest_bar(at, &here, meter)?;
            if let Some(bar) = nearest {
                direction = if bar.dot(&direction) < 0.0 { -bar } else { bar };
            }
            // Off the bar, the samples lead on.
            without = if nearest.is_some() { 0 } else { without + 1 };
            if without == UNTIL_TRIED {
                break;
            }
            let Some(next) = self.pull(at, (direction, Some(point)), permit, meter)? else { break };
            at = next;
            if pull % UNTIL_TRIED == 0 {
                if self.meets(GOAL, at, route, permit, meter)? {
                    return Ok(true);
                }
                let distance = (here - start).norm();
                let pulled = UNTIL_TRIED as f32 * STRIDE * self.space.moving.reach;
                if pull >= ROUND_BENDS && distance < farthest + FARTHER * pulled {
                    break;
                }
                farthest = farthest.max(distance);
            }
        }
        if at != 0 {
            let _ = self.ends.push((at, Some(point)));
        }
        self.meets(GOAL, at, route, permit, meter)
    }

    /// The direction of the bar that the object touches at a node closest to a point; its sign has no meaning. A function of its own, so that
    /// the touches are off the stack while the object is pulled.
    #[inline(never)]
    fn nearest_bar(&mut self, at: usize, point: &Point, meter: &mut Meter) -> Result<Option<Vector>, Stop> {
        let touches = self.touches(at, LEADING_RANGE, meter)?;
        let support = self.space.obstacles.support;
        let away = |touch: &Touch| (touch.at - point).norm_squared();
        let mut asked = f32::NEG_INFINITY;
        loop {
            let left = touches.iter().filter(|touch| away(touch) > asked);
            let Some(touch) = left.min_by(|a, b| away(a).total_cmp(&away(b))) else { return Ok(None) };
            let bar = support.bar_near(&touch.at, &touch.normal);
            if bar.is_some() {
                return Ok(bar);
            }
            asked = away(touch);
        }
    }

    /// Pulls the object on from one of the ends in one of the directions, each pair after the other. Returns the last node, if it moves
    /// at all.
    pub(super) fn pull_on(
        &mut self,
        index: usize,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let count = self.ends.len().max(1);
        let Some(&end) = self.ends.get(index % count) else { return Ok(None) };
        let direction = fibonacci_direction(index / count % DIRECTIONS, DIRECTIONS);
        self.pull_straight(end, direction, permit, meter)
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
        self.pull_straight((from, None), unit_or(shift, self.params.up()), permit, meter)
    }

    /// Pulls the object on from a node of the goal's tree. Returns the last node, if it moves at all.
    fn pull_straight(
        &mut self,
        (from, point): End,
        direction: Vector,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let mut at = from;
        for _ in 0..STRAIGHT {
            let Some(next) = self.pull(at, (direction, point), permit, meter)? else { break };
            at = next;
        }
        Ok((at != from).then_some(at))
    }

    /// Pulls once from a node of the goal's tree in a direction, at a point; a second time less far, if the object is stuck. Returns the
    /// node where that ends; `None` if it is stuck again.
    fn pull(
        &mut self,
        from: usize,
        how: (Vector, Option<Point>),
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let stride = (STRIDE * self.space.moving.reach).max(LEAST_STRIDE);
        for stride in [stride, SHORTER * stride] {
            if let Some(node) = self.pull_by(stride, from, how, permit, meter)? {
                return Ok(Some(node));
            }
        }
        Ok(None)
    }

    /// Pulls once, `travel` metres.
    fn pull_by(
        &mut self,
        travel: f32,
        from: usize,
        (direction, at): (Vector, Option<Point>),
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let (moving, support) = (self.space.moving, self.space.obstacles.support);
        let place = self.trees[GOAL].placement(from);
        // Where nothing is in the way, the simulation would lead there as well.
        let straight = Leg { shift: direction * travel, turn: Vector::zeros() };
        let way = self.space.way(&place, &straight, ASIDE_EXCESS * self.required, meter)?;
        if way.is_free() {
            return Ok(self.add(GOAL, place.after(&straight, 1.0), from, way.clearance, permit));
        }
        let sleepers = Support::sleepers(support.patches.len());
        let (Some(body), Some(scratch)) = (moving.body, &mut self.scratch) else { return Ok(None) };
        let mut arena = scratch.scratch();
        let Some(sleeps) = arena.unset(sleepers).ok().filter(|sleeps| sleeps.len() <= MAX_SLEEPERS) else {
            return Ok(None);
        };
        let pull = Pull { direction, at, travel, gap: ASIDE_EXCESS * self.required };
        let pose = pulled((&body, support), &place.pose(&moving.centre), &pull, self.params, sleeps, meter)?;
        let mut target = Placement::of(&pose, &moving.centre);
        // The simulation is no more exact than the distance field.
        let keep = (ASIDE_EXCESS * self.required, self.trees[GOAL].metric().radius);
        for _ in 0..CORRECTIONS {
            let off = aside(self.space, &target, &Leg::NONE, keep, meter)?;
            if off.travel(moving.reach) == 0.0 {
                break;
            }
            target = target.after(&off, 1.0);
        }
        if place.leg_to(&target).travel(moving.reach) < LEAST_TRAVEL {
            return Ok(None);
        }
        let grown = self.grow_from((GOAL, from), &target, permit, meter)?;
        Ok(grown.map(|(node, _)| node).filter(|node| {
            place.leg_to(&self.trees[GOAL].placement(*node)).travel(moving.reach) >= STUCK * travel
        }))
    }

    /// What the object is near at a node of the goal's tree, of the supporter, within `range` metres.
    pub(super) fn touches(
        &mut self,
        node: usize,
        range: f32,
        meter: &mut Meter,
    ) -> Result<Vec<Touch, { Touches::CAPACITY }>, Stop> {
        let mut touches = Touches::within(range);
        let place = self.trees[GOAL].placement(node);
        self.space.collect_on_supporter(&place, &mut touches, meter)?;
        Ok(touches.list)
    }
}
