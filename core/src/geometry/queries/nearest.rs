//! The nearest neighbours of all points of a tree: points side by side share one descent.

use super::bvh::MAX_DEPTH;
use super::point_tree::{Neighbour, PointTree};
use crate::geometry::{Aabb, Point};
use crate::monitor::{Meter, Stop};
use core::ops::Range;

/// Points that share a descent at most: those of two leaves or a few.
const GROUP: usize = 8;

/// Points after each other in the tree, each with the `K` points found so far that are nearest to it.
pub(super) struct Group<'a, const K: usize> {
    /// All points of the tree.
    points: &'a [Point],
    members: Range<usize>,
    /// Coordinates of the members, a row for each axis.
    coordinates: [[f32; GROUP]; 3],
    /// Neighbours as keys, nearest first; [`NONE`] behind them where there are fewer points.
    nearest: [[u64; K]; GROUP],
    /// Squares of the distances within which points may be among the nearest; less than zero where there is no member.
    limits: [f32; GROUP],
}

/// Behind all neighbours.
const NONE: u64 = u64::MAX;

/// A neighbour as a number that is less for what comes first. Distances are not negative, so that they are ordered like their
/// bits.
fn key(distance_squared: f32, index: usize) -> u64 {
    u64::from(distance_squared.to_bits()) << 32 | index as u64
}

pub(super) fn neighbour(key: u64) -> Neighbour {
    Neighbour { index: key as u32, distance_squared: f32::from_bits((key >> 32) as u32) }
}

/// Calls `visit` with the points of the tree, in order, a group after the other.
pub(super) fn for_each_group<const K: usize>(
    tree: &PointTree,
    meter: &Meter,
    mut visit: impl FnMut(&Group<K>),
) -> Result<(), Stop> {
    let (mut members, mut aabb) = (0..0, Aabb::EMPTY);
    let mut close = |members: Range<usize>, aabb: &Aabb| {
        if !members.is_empty() {
            visit(&Group::find(tree, members, aabb));
        }
    };
    let mut go_on = Ok(());
    tree.bvh().descend(|_, node| {
        go_on = go_on.and_then(|()| meter.check_cancelled());
        if go_on.is_err() {
            return false;
        }
        if let Some(items) = node.items() {
            if items.end - members.start > GROUP {
                close(members.clone(), &aabb);
                (members, aabb) = (items.start..items.start, Aabb::EMPTY);
            }
            members.end = items.end;
            aabb = aabb.union(&node.aabb());
        }
        true
    });
    go_on?;
    close(members, &aabb);
    Ok(())
}

impl<'a, const K: usize> Group<'a, K> {
    fn new(points: &'a [Point], members: Range<usize>) -> Self {
        let (mut coordinates, mut limits) = ([[0.0; GROUP]; 3], [-1.0; GROUP]);
        for (lane, point) in points[members.clone()].iter().enumerate() {
            limits[lane] = f32::INFINITY;
            for (row, x) in coordinates.iter_mut().zip(point.iter()) {
                row[lane] = *x;
            }
        }
        Self { points, members, coordinates, nearest: [[NONE; K]; GROUP], limits }
    }

    /// Finds the nearest points of `members`, which are in this box.
    fn find(tree: &PointTree<'a>, members: Range<usize>, aabb: &Aabb) -> Self {
        let points = tree.points();
        // Those before and behind in the order are mostly near, so that the descent is short.
        let around = members.start.saturating_sub(K)..(members.end + K).min(points.len());
        let mut group = Self::new(points, members);
        group.look_at(around.clone());
        let nodes = tree.bvh().nodes();
        let distance = |node: u32| distance_squared(aabb, &nodes[node as usize].aabb());
        let mut stack = heapless::Vec::<(u32, f32), { MAX_DEPTH + 2 }>::new();
        let mut limit = group.limit();
        let mut next = Some((0, 0.0));
        while let Some((node, at)) = next {
            // Equally far ones may come first by their index.
            if at > limit {
                next = stack.pop();
                continue;
            }
            let node = &nodes[node as usize];
            if let Some(items) = node.items() {
                let before = items.start..items.end.min(around.start);
                let behind = items.start.max(around.end)..items.end;
                for items in [before, behind].into_iter().filter(|items| !items.is_empty()) {
                    group.look_at(items);
                    limit = group.limit();
                }
                next = stack.pop();
            } else {
                let [left, right] = node.children().map(|child| (child, distance(child)));
                let (near, far) = if right.1 < left.1 { (right, left) } else { (left, right) };
                let _ = stack.push(far);
                next = Some(near);
            }
        }
        group
    }

    /// The points of the group with the keys of their neighbours, nearest first.
    pub(super) fn nearest(&self) -> impl Iterator<Item = (usize, &[u64; K])> {
        self.members.clone().zip(&self.nearest)
    }

    /// Square of the distance within which a point may be a neighbour of one of the group.
    fn limit(&self) -> f32 {
        self.limits.iter().copied().fold(0.0, f32::max)
    }

    fn look_at(&mut self, items: Range<usize>) {
        for index in items {
            let [x, y, z] = self.points[index].into();
            let [xs, ys, zs] = &self.coordinates;
            // For all members at once; mostly the point is too far from all.
            let mut squares = [0.0; GROUP];
            let mut near = 0_u32;
            for lane in 0..GROUP {
                let (dx, dy, dz) = (x - xs[lane], y - ys[lane], z - zs[lane]);
                squares[lane] = dx * dx + dy * dy + dz * dz;
                near |= u32::from(squares[lane] <= self.limits[lane]) << lane;
            }
            while near > 0 {
                let lane = near.trailing_zeros() as usize;
                near &= near - 1;
                let nearest = &mut self.nearest[lane];
                insert(nearest, key(squares[lane], index));
                if nearest[K - 1] != NONE {
                    self.limits[lane] = neighbour(nearest[K - 1]).distance_squared;
                }
            }
        }
    }
}

/// Puts a key in its place, and the last one out.
#[inline]
fn insert<const K: usize>(nearest: &mut [u64; K], key: u64) {
    if key < nearest[K - 1] {
        let mut place = K - 1;
        while place > 0 && key < nearest[place - 1] {
            nearest[place] = nearest[place - 1];
            place -= 1;
        }
        nearest[place] = key;
    }
}

/// Square of the distance between two boxes; zero where they overlap.
fn distance_squared(a: &Aabb, b: &Aabb) -> f32 {
    let gap = |i: usize| {
        // By comparisons, which take one instruction each: nothing here is not a number.
        let (behind, before) = (a.min[i] - b.max[i], b.min[i] - a.max[i]);
        let gap = if behind > before { behind } else { before };
        if gap > 0.0 { gap } else { 0.0 }
    };
    (0..3).map(gap).map(|gap| gap * gap).sum()
}
