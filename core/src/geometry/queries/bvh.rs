//! A tree of bounding boxes over items that have a box each: triangles, points or boxes.
//!
//! Knows only boxes; how far or where an item is hit, comes from the caller as a closure.

use super::ray::Ray;
use crate::geometry::{Aabb, Point};
use crate::monitor::{Meter, Stop};
use bytemuck::{Pod, Zeroable};

/// A box with either two children or a run of items.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Node {
    min: [f32; 3],
    /// First of the two children, which are neighbours, or first item.
    first: u32,
    max: [f32; 3],
    /// Number of items; zero for an inner node.
    count: u32,
}

impl Node {
    pub(crate) fn aabb(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }

    /// The items of a leaf, as positions in the tree's order; `None` for an inner node.
    pub(crate) fn items(&self) -> Option<core::ops::Range<usize>> {
        (self.count > 0).then(|| self.first as usize..(self.first + self.count) as usize)
    }

    /// The two children of an inner node.
    pub(crate) fn children(&self) -> [u32; 2] {
        [self.first, self.first + 1]
    }
}

/// What a tree is built over.
pub(crate) trait Bounded {
    /// The box around it.
    fn bounds(&self) -> Aabb;

    /// Twice the coordinate of the box's centre along an axis.
    fn centre(&self, axis: usize) -> f32;
}

impl Bounded for Point {
    fn bounds(&self) -> Aabb {
        Aabb { min: *self, max: *self }
    }

    fn centre(&self, axis: usize) -> f32 {
        self[axis] + self[axis]
    }
}

impl Bounded for [Point; 3] {
    fn bounds(&self) -> Aabb {
        let [a, b, c] = self;
        Aabb { min: lesser(&lesser(a, b), c), max: greater(&greater(a, b), c) }
    }

    fn centre(&self, axis: usize) -> f32 {
        let [a, b, c] = self.map(|corner| corner[axis]);
        a.min(b).min(c) + a.max(b).max(c)
    }
}

impl Bounded for [Point; 2] {
    /// A box, by its corners.
    fn bounds(&self) -> Aabb {
        Aabb { min: self[0], max: self[1] }
    }

    fn centre(&self, axis: usize) -> f32 {
        self[0][axis] + self[1][axis]
    }
}

/// The lesser coordinates of two points, all of which are numbers.
fn lesser(a: &Point, b: &Point) -> Point {
    Point::from([0, 1, 2].map(|i| if b[i] < a[i] { b[i] } else { a[i] }))
}

/// The greater coordinates of two points, all of which are numbers.
fn greater(a: &Point, b: &Point) -> Point {
    Point::from([0, 1, 2].map(|i| if b[i] > a[i] { b[i] } else { a[i] }))
}

/// The smallest box around two that are not both empty.
fn union(a: &Aabb, b: &Aabb) -> Aabb {
    Aabb { min: lesser(&a.min, &b.min), max: greater(&a.max, &b.max) }
}

/// A tree over `n` items. Queries name items by their position in the tree's order.
#[derive(Clone, Copy)]
pub(crate) struct Bvh<'m> {
    nodes: &'m [Node],
}

/// Items of a leaf at most. A leaf has at least two, unless the tree has only one.
const LEAF_ITEMS: usize = 4;
/// Bins along the widest axis, between which the surface-area heuristic may cut.
const BINS: usize = 12;
/// Items between two looks at the monitor. A budget: they take about 0.05 ms.
const ITEMS_A_CHECK: usize = 2048;
/// Depth from which nodes are halved by count, so that no tree is deeper than `MAX_DEPTH`.
const HEURISTIC_DEPTH: u32 = 28;
/// Largest depth, which bounds every traversal stack: `HEURISTIC_DEPTH` plus the halvings of `mesh::MAX_COUNT` items.
pub(super) const MAX_DEPTH: usize = 60;

impl<'m> Bvh<'m> {
    /// The most nodes that a tree over `items` may take: its leaves hold at least two.
    pub(crate) const fn max_nodes(items: usize) -> usize {
        if items < 2 { 1 } else { items }
    }

    /// Builds the tree over `items`, at least one, and puts them into tree order, and their names in `order` with them.
    /// `nodes` takes [`max_nodes`](Self::max_nodes).
    pub(crate) fn build<B: Bounded>(
        order: &mut [u32],
        items: &mut [B],
        nodes: &'m mut [Node],
        meter: &Meter,
    ) -> Result<Self, Stop> {
        debug_assert!(order.len() == items.len() && !items.is_empty());
        debug_assert!(nodes.len() >= Self::max_nodes(items.len()));
        let mut used = 1;
        let mut pending = heapless::Vec::<(usize, usize, usize, u32), { MAX_DEPTH + 2 }>::new();
        let mut next = Some((0, 0, order.len(), 0));
        while let Some((node, first, count, depth)) = next {
            let run = &mut items[first..first + count];
            // The boxes around the items and around their centres.
            let (mut aabb, mut centres) = (Aabb::EMPTY, Aabb::EMPTY);
            for part in run.chunks(ITEMS_A_CHECK) {
                meter.check_cancelled()?;
                for bounds in part.iter().map(B::bounds) {
                    aabb = union(&aabb, &bounds);
                    centres = union(&centres, &(bounds.min + bounds.max.coords).bounds());
                }
            }
            nodes[node] =
                Node { min: aabb.min.into(), max: aabb.max.into(), first: first as u32, count: count as u32 };
            if count > LEAF_ITEMS {
                let middle = split(&mut order[first..first + count], run, &centres, depth, meter)?;
                (nodes[node].first, nodes[node].count) = (used as u32, 0);
                // Holds one sibling per level, so it cannot be full.
                let _ = pending.push((used + 1, first + middle, count - middle, depth + 1));
                next = Some((used, first, middle, depth + 1));
                used += 2;
            } else {
                next = pending.pop();
            }
        }
        Ok(Self { nodes: &nodes[..used] })
    }

    /// The tree that [`build`](Self::build) made in `nodes`.
    pub(crate) fn of(nodes: &'m [Node]) -> Self {
        Self { nodes }
    }

    pub(crate) fn nodes(&self) -> &'m [Node] {
        self.nodes
    }

    pub(crate) fn aabb(&self) -> Aabb {
        self.nodes[0].aabb()
    }

    /// How many items are below a node.
    pub(crate) fn count_items(&self, node: u32) -> u32 {
        let mut count = 0;
        self.descend_from(node, |_, node| {
            count += node.count;
            true
        });
        count
    }

    /// Visits the leaves whose box is closer to `point` than a limit, nearer ones first. `visit` is given the
    /// items of a leaf and the square of the limit, and returns the square of the new limit, which may only
    /// shrink.
    pub(crate) fn visit_near(
        &self,
        point: &Point,
        limit_squared: f32,
        mut visit: impl FnMut(core::ops::Range<usize>, f32) -> f32,
    ) {
        let mut limit = limit_squared;
        let distance = |node: u32| self.nodes[node as usize].aabb().distance_squared(point);
        let mut stack = heapless::Vec::<(u32, f32), { MAX_DEPTH + 2 }>::new();
        let mut next = Some((0, distance(0)));
        while let Some((node, at)) = next {
            next = None;
            // Others may have come nearer since the node was put aside.
            if at <= limit {
                let node = &self.nodes[node as usize];
                if let Some(items) = node.items() {
                    limit = visit(items, limit);
                } else {
                    let [left, right] = node.children().map(|child| (child, distance(child)));
                    let (near, far) = if right.1 < left.1 { (right, left) } else { (left, right) };
                    if far.1 <= limit {
                        let _ = stack.push(far);
                    }
                    next = Some(near).filter(|near| near.1 <= limit);
                }
            }
            next = next.or_else(|| stack.pop());
        }
    }

    /// Visits the leaves that a ray enters before a limit, nearer ones first. `visit` is given the items of a
    /// leaf and the limit, and returns the new limit, which may only shrink; below zero ends the search.
    pub(crate) fn visit_along(
        &self,
        ray: &Ray,
        limit: f32,
        mut visit: impl FnMut(core::ops::Range<usize>, f32) -> f32,
    ) {
        let mut limit = limit;
        let entry = |node: u32, limit| ray.enter(&self.nodes[node as usize].aabb(), limit);
        let mut stack = heapless::Vec::<(u32, f32), { MAX_DEPTH + 2 }>::new();
        let mut next = entry(0, limit).map(|at| (0, at));
        while let Some((node, at)) = next {
            if at > limit {
                next = stack.pop();
                continue;
            }
            let node = &self.nodes[node as usize];
            if let Some(items) = node.items() {
                limit = visit(items, limit);
                if limit < 0.0 {
                    return;
                }
                next = stack.pop();
                continue;
            }
            let [left, right] = node.children().map(|child| entry(child, limit).map(|at| (child, at)));
            next = match (left, right) {
                (Some(left), Some(right)) => {
                    let (near, far) = if right.1 < left.1 { (right, left) } else { (left, right) };
                    let _ = stack.push(far);
                    Some(near)
                }
                (Some(only), None) | (None, Some(only)) => Some(only),
                (None, None) => stack.pop(),
            };
        }
    }

    /// Visits the leaves that may hold something nearer than a limit, nearer ones first. `state` is handed to the closures:
    /// `bound` gives a lower bound of the distance of everything in a node, or `None` if the node does not matter, `limit` the
    /// limit, which may shrink, and `visit` takes the items of a leaf, and the leaf.
    pub(crate) fn visit_ordered<S>(
        &self,
        state: &mut S,
        mut bound: impl FnMut(&mut S, &Node) -> Option<f32>,
        limit: impl Fn(&S) -> f32,
        mut visit: impl FnMut(&mut S, core::ops::Range<usize>, &Node),
    ) {
        let mut stack = heapless::Vec::<(u32, f32), { MAX_DEPTH + 2 }>::new();
        let mut next = bound(state, &self.nodes[0]).map(|at| (0, at));
        while let Some((node, at)) = next {
            let node = &self.nodes[node as usize];
            next = None;
            if at < limit(state) {
                if let Some(items) = node.items() {
                    visit(state, items, node);
                } else {
                    let [left, right] = node
                        .children()
                        .map(|child| Some((child, bound(state, &self.nodes[child as usize])?)));
                    next = match (left, right) {
                        (Some(left), Some(right)) => {
                            let (near, far) = if right.1 < left.1 { (right, left) } else { (left, right) };
                            let _ = stack.push(far);
                            Some(near)
                        }
                        (only, None) | (None, only) => only,
                    };
                }
            }
            next = next.or_else(|| stack.pop());
        }
    }

    /// Descends from the root: `visit` looks at a node and says whether to go on to its children.
    pub(crate) fn descend(&self, visit: impl FnMut(u32, &Node) -> bool) {
        self.descend_from(0, visit);
    }

    fn descend_from(&self, node: u32, mut visit: impl FnMut(u32, &Node) -> bool) {
        let mut stack = heapless::Vec::<u32, { MAX_DEPTH + 2 }>::new();
        let mut next = Some(node);
        while let Some(index) = next {
            let node = &self.nodes[index as usize];
            next = if visit(index, node) && node.count == 0 {
                let [left, right] = node.children();
                let _ = stack.push(right);
                Some(left)
            } else {
                stack.pop()
            };
        }
    }
}

/// Puts `items` and their names into two groups of at least two and returns the size of the first. `centres` is the box
/// around twice their centres.
fn split<B: Bounded>(
    order: &mut [u32],
    items: &mut [B],
    centres: &Aabb,
    depth: u32,
    meter: &Meter,
) -> Result<usize, Stop> {
    let axis = centres.extents().imax();
    let (low, width) = (centres.min[axis], centres.extents()[axis]);
    if depth < HEURISTIC_DEPTH && width > 0.0 {
        let bin = |item: &B| (((item.centre(axis) - low) / width * BINS as f32) as u32).min(BINS as u32 - 1);
        if let Some(cut) = cheapest_cut(items, bin, meter)? {
            return partition(order, items, |item| bin(item) < cut as u32, meter);
        }
    }
    halve(order, items, axis, meter)
}

/// The first bin of the right-hand group where the surface-area heuristic is least, if any cut leaves two items
/// on each side.
fn cheapest_cut<B: Bounded>(
    items: &[B],
    bin: impl Fn(&B) -> u32,
    meter: &Meter,
) -> Result<Option<usize>, Stop> {
    let mut counts = [0_usize; BINS];
    let mut boxes = [Aabb::EMPTY; BINS];
    for part in items.chunks(ITEMS_A_CHECK) {
        meter.check_cancelled()?;
        for item in part {
            let bin = bin(item) as usize;
            counts[bin] += 1;
            boxes[bin] = union(&boxes[bin], &item.bounds());
        }
    }
    let mut right_cost = [0.0; BINS];
    let (mut aabb, mut count) = (Aabb::EMPTY, 0);
    for bin in (1..BINS).rev() {
        aabb = union(&aabb, &boxes[bin]);
        count += counts[bin];
        right_cost[bin] = aabb.half_area() * count as f32;
    }
    let (mut aabb, mut count) = (Aabb::EMPTY, 0);
    let mut best: Option<(f32, usize)> = None;
    for cut in 1..BINS {
        aabb = union(&aabb, &boxes[cut - 1]);
        count += counts[cut - 1];
        let cost = aabb.half_area() * count as f32 + right_cost[cut];
        if count >= 2 && items.len() - count >= 2 && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, cut));
        }
    }
    Ok(best.map(|(_, cut)| cut))
}

/// Moves the items that are `left` to the front and returns how many they are.
fn partition<B>(
    order: &mut [u32],
    items: &mut [B],
    left: impl Fn(&B) -> bool,
    meter: &Meter,
) -> Result<usize, Stop> {
    let mut middle = 0;
    for i in 0..items.len() {
        meter.check_at(i)?;
        if left(&items[i]) {
            order.swap(middle, i);
            items.swap(middle, i);
            middle += 1;
        }
    }
    Ok(middle)
}

/// Puts the half of the items with the lesser centres in front: quickselect, ties broken by name, so that the
/// result does not depend on how the sorting is done.
fn halve<B: Bounded>(order: &mut [u32], items: &mut [B], axis: usize, meter: &Meter) -> Result<usize, Stop> {
    let middle = items.len() / 2;
    let (mut from, mut to) = (0, items.len());
    while to - from > 1 {
        // The pivot goes to the end; those before it are gathered at the front.
        let pivot = from + (to - from) / 2;
        order.swap(pivot, to - 1);
        items.swap(pivot, to - 1);
        let (value, name) = (items[to - 1].centre(axis), order[to - 1]);
        let mut store = from;
        for i in from..to - 1 {
            meter.check_at(i)?;
            if items[i].centre(axis).total_cmp(&value).then(order[i].cmp(&name)).is_lt() {
                order.swap(i, store);
                items.swap(i, store);
                store += 1;
            }
        }
        order.swap(store, to - 1);
        items.swap(store, to - 1);
        if store < middle {
            from = store + 1;
        } else {
            to = store;
        }
    }
    Ok(middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn with_tree(points: &[Point], check: impl Fn(&Bvh, &[u32])) {
        let mut nodes = vec![Node::zeroed(); Bvh::max_nodes(points.len())];
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut items = points.to_vec();
        let bvh = Bvh::build(&mut order, &mut items, &mut nodes, &Meter::unwatched()).unwrap();
        assert!(order.iter().zip(&items).all(|(&index, item)| points[index as usize] == *item));
        check(&bvh, &order);
    }

    fn random_points(count: usize, seed: u64) -> Vec<Point> {
        let mut random = Random::new(seed);
        (0..count).map(|_| Point::from([(); 3].map(|()| random.next_f32()))).collect()
    }

    #[test]
    fn every_item_is_in_one_leaf_and_inside_its_ancestors() {
        let line: Vec<Point> = (0..500).map(|i| Point::new(1.5_f32.powi(i % 60), 0.0, 0.0)).collect();
        let same = vec![Point::new(1.0, 2.0, 3.0); 999];
        for points in [random_points(1, 1), random_points(5, 2), random_points(2000, 3), line, same] {
            with_tree(&points, |bvh, order| {
                let mut seen = vec![0; points.len()];
                bvh.descend(|_, node| {
                    for &item in node.items().into_iter().flat_map(|items| &order[items]) {
                        seen[item as usize] += 1;
                        assert!(node.aabb().contains(&points[item as usize]));
                    }
                    if node.count == 0 {
                        for child in node.children() {
                            let child = bvh.nodes[child as usize].aabb();
                            assert!(node.aabb().contains(&child.min) && node.aabb().contains(&child.max));
                        }
                    }
                    true
                });
                assert!(seen.iter().all(|&count| count == 1));
            });
        }
    }

    #[test]
    fn halving_splits_at_the_median() {
        let points = random_points(101, 4);
        let mut order: Vec<u32> = (0..101).collect();
        let mut items = points.clone();
        items[17] = items[80];
        let middle = halve(&mut order, &mut items, 1, &Meter::unwatched()).unwrap();
        assert_eq!(middle, 50);
        let key = |i: usize| (items[i].y, order[i]);
        assert!((0..50).all(|i| (50..101).all(|j| key(i) < key(j))));
    }
}
