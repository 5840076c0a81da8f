//! RRT-Connect (Kuffner and LaValle, "RRT-Connect: An Efficient Approach to Single-Query Path Planning", ICRA 2000) in SE(3).
//!
//! One tree grows from the goal, the other from one or more starts. The last centimetres along a hook are the hard part. So a
//! branch that is blocked does not end, but turns aside along what blocks it, as a hand feels its way out.

use super::path::PlanCounts;
use super::permit::Permit;
use super::placement::{Leg, Placement, rotation_by};
use super::route::Route;
use super::slide::aside;
use super::space::Space;
use super::tree::Tree;
use crate::geometry::{Aabb, Point, Vector, fibonacci_direction};
use crate::hanging::Distance;
use crate::monitor::{Meter, Stop};
use crate::random::Random;
use core::f32::consts::TAU;
use nalgebra::{Quaternion, UnitQuaternion};

/// Index of the tree that grows from the goal.
const GOAL: usize = 0;
/// Index of the tree that grows from the starts.
const START: usize = 1;

// How branches grow. Set by hand.

/// Travel below which a branch has not moved, metres.
const LEAST_TRAVEL: f32 = 0.0005;
/// Travel of a step aside, as a share of the reach of what moves.
const STRIDE: f32 = 0.1;
/// Steps aside of one branch.
const STEPS_ASIDE: usize = 24;
/// Required distance that a step aside aims at, as a multiple of the one that is tested: the step is exact to first order only.
const ASIDE_EXCESS: f32 = 1.3;

// Shares of the samples. Set by hand.

/// Share of the samples that are starts.
const OF_STARTS: f32 = 0.25;
/// Share of the other samples whose position is near the goal.
const NEAR_GOAL: f32 = 0.5;
/// Shares of the samples with the rotation of the goal, and with one close to it.
const ROTATED_AS_GOAL: [f32; 2] = [0.4, 0.3];
/// What is close to a rotation, radians.
const CLOSE_ROTATION: f32 = 0.8;

/// A search for a way between a goal and one of several starts.
pub(super) struct Search<'q, 'a, 's> {
    pub(super) space: &'q Space<'a>,
    /// Distance that is kept from everything, metres.
    pub(super) required: f32,
    /// From the goal and from the starts.
    pub(super) trees: &'q mut [Tree<'s>; 2],
    /// The nodes of either tree at which they met last.
    pub(super) met: [usize; 2],
    /// Box of the positions that are sampled.
    pub(super) region: Aabb,
    pub(super) goal: Placement,
    pub(super) random: Random,
    pub(super) counts: PlanCounts,
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
        for _ in 0..samples {
            let index = self.counts.samples;
            self.counts.samples += 1;
            // First straight to each of the starts; then two of three samples are for the tree of the goal, which is the one in
            // narrow places.
            let (target, grown) = if index < starts {
                (self.trees[START].nodes()[index].placement, GOAL)
            } else {
                (self.sample(starts), if index % 3 == 2 { START } else { GOAL })
            };
            let Some((node, _)) = self.grow(grown, &target, permit, meter)? else {
                if self.trees.iter().any(Tree::is_full) {
                    return Ok(Outcome::Full);
                }
                continue;
            };
            let meeting = self.trees[grown].nodes()[node].placement;
            let Some((other, true)) = self.grow(1 - grown, &meeting, permit, meter)? else { continue };
            self.met = if grown == GOAL { [node, other] } else { [other, node] };
            self.write(route);
            match permit.refused_leg(route, &self.step) {
                Some(leg) => self.cut_off(leg),
                None => return Ok(Outcome::Found),
            }
        }
        Ok(Outcome::UsedUp)
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
        let reach = self.space.moving.reach;
        let mut at = root;
        for _ in 0..STEPS_ASIDE {
            let place = self.trees[tree].nodes()[at].placement;
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
            let place = self.trees[tree].nodes()[at].placement;
            let leg = place.leg_to(target);
            let stride = (STRIDE * reach / leg.travel(reach)).min(1.0);
            let keep = (ASIDE_EXCESS * self.required, self.trees[GOAL].metric().radius);
            let leg = aside(self.space, &place, &leg.scaled(stride), keep, meter)?;
            let way = self.space.way(&place, &leg, self.required, meter)?;
            let next = place.after(&leg, way.share);
            let gain = self.trees[GOAL].metric().distance(&place, target)
                - self.trees[GOAL].metric().distance(&next, target);
            if way.share * leg.travel(reach) < LEAST_TRAVEL || gain < LEAST_TRAVEL {
                break;
            }
            match self.add(tree, next, at, way.clearance, permit) {
                Some(node) => at = node,
                None => break,
            }
        }
        Ok((at != root).then_some((at, false)))
    }

    /// Adds a node, unless the tree is full or the caller, who has refused others, refuses it.
    fn add(
        &mut self,
        tree: usize,
        placement: Placement,
        parent: usize,
        clearance: f32,
        permit: &mut Permit,
    ) -> Option<usize> {
        if permit.is_picky() && !permit.accepts(&placement) {
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

    /// A placement to grow towards.
    fn sample(&mut self, starts: usize) -> Placement {
        if self.random.next_f32() < OF_STARTS {
            let index = (self.random.next_f32() * starts as f32) as usize;
            return self.trees[START].nodes()[index.min(starts - 1)].placement;
        }
        let goal = self.goal;
        let centre = if self.random.next_f32() < NEAR_GOAL {
            let distance = self.random.next_f32() * self.space.moving.reach;
            goal.centre() + self.direction() * distance
        } else {
            let at = Vector::from([(); 3].map(|()| self.random.next_f32()));
            self.region.min + self.region.extents().component_mul(&at)
        };
        let (choice, [same, close]) = (self.random.next_f32(), ROTATED_AS_GOAL);
        let rotation = if choice < same {
            goal.rotation()
        } else if choice < same + close {
            let angle = self.random.next_f32() * CLOSE_ROTATION;
            rotation_by(&(self.direction() * angle)) * goal.rotation()
        } else {
            self.rotation()
        };
        Placement::new(centre, rotation)
    }

    /// A unit vector, uniform over the sphere.
    fn direction(&mut self) -> Vector {
        let (z, angle) = (2.0 * self.random.next_f32() - 1.0, TAU * self.random.next_f32());
        let across = libm::sqrtf((1.0 - z * z).max(0.0));
        Vector::new(across * libm::cosf(angle), across * libm::sinf(angle), z)
    }

    /// A rotation, uniform over SO(3) (Shoemake, "Uniform Random Rotations", 1992).
    fn rotation(&mut self) -> UnitQuaternion<f32> {
        let share = self.random.next_f32();
        let [a, b] = [(); 2].map(|()| TAU * self.random.next_f32());
        let (low, high) = (libm::sqrtf(1.0 - share), libm::sqrtf(share));
        let (sin_a, cos_a) = libm::sincosf(a);
        let (sin_b, cos_b) = libm::sincosf(b);
        UnitQuaternion::new_normalize(Quaternion::new(high * cos_b, low * sin_a, low * cos_a, high * sin_b))
    }
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

/// Directions in which ways out are tried.
const DIRECTIONS: usize = 32;

/// Places outside of a box, one in each of some directions from a place, with its rotation. They are not tested.
pub(super) fn outside<'o>(
    aabb: &'o Aabb,
    from: &'o Placement,
    reach: f32,
    up: Vector,
) -> impl Iterator<Item = Placement> + 'o {
    // Straight up comes first: that is how most things are taken off.
    let directions =
        core::iter::once(up).chain((0..DIRECTIONS).map(|index| fibonacci_direction(index, DIRECTIONS)));
    directions.map(move |direction| {
        let centre = from.centre();
        // Least way until the ball around what moves is off the box.
        let is_off = |distance: f32| aabb.distance_squared(&(centre + direction * distance)) > reach * reach;
        let far = aabb.diagonal() + reach + libm::sqrtf(aabb.distance_squared(&centre));
        let (mut near, mut far) = (0.0, far * 1.01);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if is_off(middle) { far = middle } else { near = middle }
        }
        let leg = Leg { shift: direction * far, turn: Vector::zeros() };
        from.after(&leg, 1.0)
    })
}

/// Halvings of the distance to the outside: to a thousandth.
const HALVINGS: usize = 10;

/// The smallest box around points and a margin.
pub(super) fn box_around(aabb: &Aabb, points: impl IntoIterator<Item = Point>, margin: f32) -> Aabb {
    let all = points.into_iter().fold(*aabb, |all, point| all.grow(&point));
    let margin = Vector::repeat(margin);
    Aabb { min: all.min - margin, max: all.max + margin }
}
