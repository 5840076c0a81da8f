//! RRT-Connect (Kuffner and LaValle, "RRT-Connect: An Efficient Approach to Single-Query Path Planning", ICRA 2000) in SE(3).
//!
//! One tree grows from the goal, the other from one or more starts. The last centimetres along a hook are the hard part. So a
//! branch that is blocked does not end, but turns aside along what blocks it, as a hand feels its way out.

use super::permit::Permit;
use super::placement::{Leg, Placement};
use super::pull::Ends;
use super::route::Route;
use super::slide::aside;
use super::space::{Space, Touch};
use super::tree::Tree;
use crate::geometry::{Aabb, Point, Vector};
use crate::hanging::Distance;
use crate::memory::Arena;
use crate::monitor::{Meter, Stop};
use crate::params::Params;
use crate::random::Random;
use heapless::Vec;

/// Index of the tree that grows from the goal.
pub(super) const GOAL: usize = 0;
/// Index of the tree that grows from the starts.
pub(super) const START: usize = 1;

/// Ways from the goal that are tried first: what most often works.
const FIRST_WAYS: usize = 3;

// How branches grow. Set by hand.

/// Travel below which a branch has not moved, metres.
pub(super) const LEAST_TRAVEL: f32 = 0.0005;
/// Travel of a step aside, as a share of the reach of what moves.
const STRIDE: f32 = 0.1;
/// Steps aside of one branch.
const STEPS_ASIDE: usize = 16;
/// Required distance that a step aside aims at, as a multiple of the one that is tested: the step is exact to first order only.
pub(super) const ASIDE_EXCESS: f32 = 1.3;

/// Least travel of a step aside when an object is dragged, metres.
pub(super) const LEAST_STRIDE: f32 = 0.002;
/// Steps of one drag, after which the way out is tried.
const DRAG_STEPS: usize = 8;
/// Drags along the bar from the goal.
const DRAGS: usize = 24;
/// Share of a step below which a dragged object is stuck.
const STUCK: f32 = 0.2;
/// A step that is tried where a full one is stuck, as a share of it.
const SHORTER: f32 = 0.25;
/// Share of its rotation with which a dragged object goes on.
const SPIN: f32 = 0.5;
/// Distance from the object within which a bar carries it, metres.
pub(super) const BAR_RANGE: f32 = 0.003;
/// Cosine between the directions of bars that are one.
const SAME_BAR: f32 = 0.9;
/// Bars along which the object is dragged from the goal.
pub(super) const MAX_BARS: usize = 4;

/// A search for a way between a goal and one of several starts.
pub(super) struct Search<'q, 'a, 's> {
    pub(super) space: &'q mut Space<'a>,
    /// Distance that is kept from everything, metres.
    pub(super) required: f32,
    /// From the goal and from the starts.
    pub(super) trees: &'q mut [Tree<'s>; 2],
    /// The nodes of either tree at which they met last.
    pub(super) met: [usize; 2],
    /// Box of the positions that are sampled, and that the search stays in.
    pub(super) region: Aabb,
    pub(super) goal: Placement,
    pub(super) random: Random,
    pub(super) params: &'q Params,
    /// Working memory of the object's search, [`enclosed::bytes`](super::enclosed::bytes) of it: for pulls and for the proof that
    /// there is no way.
    pub(super) scratch: Option<Arena<'q>>,
    /// From where the object is pulled on.
    pub(super) ends: Ends,
    /// Poses sampled.
    pub(super) sampled: usize,
    /// Poses that may be sampled, all in all: shown as progress.
    pub(super) budget: usize,
    /// Ways from the goal that are tried first and have been: straight, dragged, pulled.
    pub(super) tried: usize,
    /// Largest distance between two poses that the caller is asked about.
    pub(super) step: Distance,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// A route was found.
    Found,
    /// All samples were used up.
    UsedUp,
    /// A tree was full.
    Full,
}

impl Search<'_, '_, '_> {
    /// Grows the trees by at most `samples` samples until they meet, and writes the route from a start to the goal.
    pub(super) fn run(
        &mut self,
        samples: usize,
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Outcome, Stop> {
        let starts = self.starts();
        // What was found by one may turn out not to be free: the search goes on with the next one.
        while self.tried < FIRST_WAYS {
            self.tried += 1;
            let is_found = match self.tried {
                1 => self.leave_straight(route, permit, meter)?,
                2 => self.drag_along_bars(route, permit, meter)?,
                _ => self.pull_along_bars(route, permit, meter)?,
            };
            if is_found {
                return Ok(Outcome::Found);
            }
        }
        for _ in 0..samples {
            if self.trees.iter().any(Tree::is_full) {
                return Ok(Outcome::Full);
            }
            let index = self.sampled;
            self.sampled += 1;
            meter.progress(index as f32 / self.budget as f32);
            let target = self.sample(starts);
            // Two of three samples are for the tree of the goal, which is the one in narrow places.
            let grown = if index % 3 == 2 { START } else { GOAL };
            let node = match index % 3 {
                0 => match index % 9 {
                    0 => self.drag_towards(&target, permit, meter)?,
                    3 => self.pull_on(index / 9, permit, meter)?,
                    _ => self.pull_towards(&target, permit, meter)?,
                },
                _ => self.grow(grown, &target, permit, meter)?.map(|(node, _)| node),
            };
            if let Some(node) = node
                && self.meets(grown, node, route, permit, meter)?
            {
                return Ok(Outcome::Found);
            }
        }
        Ok(Outcome::UsedUp)
    }

    /// Tries the straight ways to the starts.
    fn leave_straight(
        &mut self,
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        for start in 0..self.starts() {
            let target = self.trees[START].placement(start);
            let leg = self.goal.leg_to(&target);
            let way = self.space.way(&self.goal, &leg, self.required, meter)?;
            if way.is_free()
                && let Some(node) = self.add(GOAL, target, 0, way.clearance, permit)
            {
                self.met = [node, start];
                self.write(route);
                match permit.refused_leg(route, &self.step, meter)? {
                    Some(leg) => self.cut_off(leg),
                    None => return Ok(true),
                }
            }
        }
        Ok(false)
    }

    /// Drags the object from the goal along the bars that it is near there, both ways.
    fn drag_along_bars(
        &mut self,
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        for &(direction, _) in &self.bars(meter)? {
            for direction in [direction, -direction] {
                let mut at = 0;
                let mut leg = Leg { shift: direction, turn: Vector::zeros() };
                for _ in 0..DRAGS {
                    let Some(node) = self.drag(at, leg, permit, meter)? else { break };
                    let nodes = self.trees[GOAL].nodes();
                    let last =
                        nodes.get(node).and_then(|last| Some((nodes.get(last.parent as usize)?, last)));
                    let Some((before, last)) = last else { break };
                    leg = before.placement.leg_to(&last.placement);
                    at = node;
                    if self.meets(GOAL, node, route, permit, meter)? {
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// The bars that the object is near at the goal, one of each direction, and the places where they are near. Where none is, as at the
    /// round end of a peg, those along which the surface extends that carries the object. Their directions lead away from the middle of the
    /// supporter, as that in which most things come off does.
    pub(super) fn bars(&mut self, meter: &mut Meter) -> Result<Vec<(Vector, Point), MAX_BARS>, Stop> {
        let mut bars = self.bars_either_way(meter)?;
        let points = self.space.obstacles.support.tree.points();
        let sum: Vector = points.iter().map(|point| point.coords).sum();
        let middle = Point::from(sum / points.len() as f32);
        for (direction, at) in &mut bars {
            if direction.dot(&(*at - middle)) < 0.0 {
                *direction = -*direction;
            }
        }
        Ok(bars)
    }

    /// The same with directions whose sign has no meaning.
    fn bars_either_way(&mut self, meter: &mut Meter) -> Result<Vec<(Vector, Point), MAX_BARS>, Stop> {
        let touches = self.touches(0, BAR_RANGE, meter)?;
        let (support, up) = (self.space.obstacles.support, self.params.up());
        let near = |touch: &Touch| Some((support.bar_near(&touch.at, &touch.normal)?, touch.at));
        let bars = apart(touches.iter().filter_map(near));
        if !bars.is_empty() {
            return Ok(bars);
        }
        let carrying = touches.iter().filter(|touch| touch.normal.dot(&up) > 0.0);
        Ok(apart(carrying.map(|touch| (support.bar_or_spread(&touch.at, &touch.normal), touch.at))))
    }

    /// Connects the other tree to a new node. Returns whether that gives a route, which it writes, that the caller accepts.
    pub(super) fn meets(
        &mut self,
        grown: usize,
        node: usize,
        route: &mut Route,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let meeting = self.trees[grown].placement(node);
        let Some((other, true)) = self.grow(1 - grown, &meeting, permit, meter)? else { return Ok(false) };
        self.met = if grown == GOAL { [node, other] } else { [other, node] };
        self.write(route);
        Ok(match permit.refused_leg(route, &self.step, meter)? {
            Some(leg) => {
                self.cut_off(leg);
                false
            }
            None => true,
        })
    }

    /// Number of starts: they come first in their tree.
    fn starts(&self) -> usize {
        let nodes = self.trees[START].nodes();
        nodes.iter().zip(0..).take_while(|(node, index)| node.parent == *index).count()
    }

    /// Grows a branch of a tree towards a target. Returns its last node, and whether that is the target; `None` if it does not grow.
    fn grow(
        &mut self,
        tree: usize,
        target: &Placement,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<(usize, bool)>, Stop> {
        let Some(root) = self.trees[tree].nearest(target) else { return Ok(None) };
        self.grow_from((tree, root), target, permit, meter)
    }

    /// The same from a given node of the tree.
    pub(super) fn grow_from(
        &mut self,
        (tree, root): (usize, usize),
        target: &Placement,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<(usize, bool)>, Stop> {
        let reach = self.space.moving.reach;
        let mut at = root;
        for _ in 0..STEPS_ASIDE {
            let place = self.trees[tree].placement(at);
            let leg = place.leg_to(target);
            let way = self.space.way(&place, &leg, self.required, meter)?;
            if way.is_free() && leg.travel(reach) < 1e-6 {
                return Ok(Some((at, true)));
            }
            if way.is_free() || way.share * leg.travel(reach) >= LEAST_TRAVEL {
                match self.add(tree, place.after(&leg, way.share), at, way.clearance, permit) {
                    Some(node) => at = node,
                    None => break,
                }
            }
            if way.is_free() {
                return Ok(Some((at, true)));
            }
            let place = self.trees[tree].placement(at);
            let leg = place.leg_to(target);
            let stride = (STRIDE * reach / leg.travel(reach)).min(1.0);
            let (moved, clearance) = self.step_aside(&place, &leg.scaled(stride), meter)?;
            let next = place.after(&moved, 1.0);
            let gain = self.trees[GOAL].metric().distance(&place, target)
                - self.trees[GOAL].metric().distance(&next, target);
            if moved.travel(reach) < LEAST_TRAVEL || gain < LEAST_TRAVEL {
                break;
            }
            match self.add(tree, next, at, clearance, permit) {
                Some(node) => at = node,
                None => break,
            }
        }
        Ok((at != root).then_some((at, false)))
    }

    /// Drags the object on from the node of the goal's tree that is nearest to a target, towards the target.
    fn drag_towards(
        &mut self,
        target: &Placement,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let Some(from) = self.trees[GOAL].nearest(target) else { return Ok(None) };
        let leg = self.trees[GOAL].placement(from).leg_to(target);
        self.drag(from, leg, permit, meter)
    }

    /// Drags the object from a node of the goal's tree: it goes on in the direction in which it moved last, so that it follows
    /// a bent bar. Returns the last node, if it moves at all.
    fn drag(
        &mut self,
        from: usize,
        leg: Leg,
        permit: &mut Permit,
        meter: &mut Meter,
    ) -> Result<Option<usize>, Stop> {
        let reach = self.space.moving.reach;
        let stride = (STRIDE * reach).max(LEAST_STRIDE);
        let (mut at, mut leg) = (from, leg);
        for _ in 0..DRAG_STEPS {
            let place = self.trees[GOAL].placement(at);
            let wanted = leg.scaled(stride / leg.travel(reach).max(1e-9));
            let mut step = self.step_aside(&place, &wanted, meter)?;
            if step.0.travel(reach) < STUCK * stride {
                step = self.step_aside(&place, &wanted.scaled(SHORTER), meter)?;
                if step.0.travel(reach) < STUCK * SHORTER * stride {
                    break;
                }
            }
            let (moved, clearance) = step;
            let Some(node) = self.add(GOAL, place.after(&moved, 1.0), at, clearance, permit) else { break };
            (at, leg) = (node, Leg { turn: moved.turn * SPIN, ..moved });
        }
        Ok((at != from).then_some(at))
    }

    /// Goes a step, aside where something is in the way, as far as it is free. Returns the motion and its clearance.
    fn step_aside(&mut self, from: &Placement, wanted: &Leg, meter: &mut Meter) -> Result<(Leg, f32), Stop> {
        let keep = (ASIDE_EXCESS * self.required, self.trees[GOAL].metric().radius);
        let leg = aside(self.space, from, wanted, keep, meter)?;
        let way = self.space.way(from, &leg, self.required, meter)?;
        Ok((leg.scaled(way.share), way.clearance))
    }

    /// Adds a node, unless it is outside of the region, the tree is full or the caller, who has refused others, refuses it.
    pub(super) fn add(
        &mut self,
        tree: usize,
        placement: Placement,
        parent: usize,
        clearance: f32,
        permit: &mut Permit,
    ) -> Option<usize> {
        if !self.region.contains(&placement.centre()) || permit.is_picky() && !permit.accepts(&placement) {
            return None;
        }
        self.trees[tree].add(placement, Some(parent), clearance)
    }

    /// Writes the route through the nodes at which the trees met.
    fn write(&self, route: &mut Route) {
        route.clear();
        // Nodes lead to their roots, so that the part from the start is found backwards.
        follow(&self.trees[START], self.met[START], route);
        route.reverse();
        // Both trees have the node at which they meet.
        route.pop();
        follow(&self.trees[GOAL], self.met[GOAL], route);
    }

    /// Takes a leg of the route that was written last out of use, with all that was reached by it.
    pub(super) fn cut_off(&mut self, leg: usize) {
        let [goal, start] = &self.trees;
        let depth = start.chain(self.met[START]).count();
        // Of its ends, the one that is farther from the root.
        let (tree, node) = match leg + 1 < depth {
            true => (START, start.chain(self.met[START]).nth(depth - 2 - leg)),
            false => (GOAL, goal.chain(self.met[GOAL]).nth(leg + 1 - depth)),
        };
        if let Some(node) = node {
            self.trees[tree].cut_off(node);
        }
    }
}

/// Of these bars, those whose directions differ.
fn apart(bars: impl Iterator<Item = (Vector, Point)>) -> Vec<(Vector, Point), MAX_BARS> {
    let mut kept = Vec::<(Vector, Point), MAX_BARS>::new();
    for (direction, at) in bars {
        if kept.iter().all(|(other, _)| other.dot(&direction).abs() < SAME_BAR) {
            let _ = kept.push((direction, at));
        }
    }
    kept
}

/// Appends the places from a node to its root.
fn follow(tree: &Tree, from: usize, route: &mut Route) {
    let mut clearance = f32::INFINITY;
    for node in tree.chain(from) {
        let node = &tree.nodes()[node];
        route.push(node.placement, clearance);
        clearance = node.clearance;
    }
}
