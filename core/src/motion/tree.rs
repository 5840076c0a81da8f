//! A tree of placements, and the nearest of them.

use super::placement::Placement;
use crate::memory::{Arena, OutOfMemory, array_bytes};
use bytemuck::{Pod, Zeroable};
use heapless::Vec;

/// A placement and the node before it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Node {
    pub(super) placement: Placement,
    /// The node before; a root is its own.
    pub(super) parent: u32,
    /// Least distance from obstacles on the way from there, metres.
    pub(super) clearance: f32,
    /// 1 if the node must not be used any more.
    is_dead: u32,
}

/// Nodes in the order in which they were added, with an index for the nearest one.
///
/// The index is a forest of balanced k-d trees of 2^k nodes, one for each bit of the number of nodes (Bentley and Saxe,
/// "Decomposable searching problems I", 1980): a node is added in O(log² n) on average, and the nearest found in O(log² n) where the
/// nodes are spread.
pub(super) struct Tree<'s> {
    nodes: &'s mut [Node],
    /// Indices of nodes, tree after tree. The root of a tree is in the middle of its range, and so on.
    order: &'s mut [u32],
    /// Along which axis the node in this place of `order` divides its range.
    axes: &'s mut [u8],
    len: usize,
    metric: Metric,
}

/// Distance between placements: √(|Δcentre|² + (radius · 2 |Δquaternion|)²), where 2 |Δquaternion| is the angle between rotations
/// if it is small.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metric {
    /// What a radian counts, metres.
    pub(super) radius: f32,
}

/// A placement as a point with Euclidean distances.
type Key = [f32; 7];

/// Nodes that are compared one by one.
const FEW: usize = 8;

impl Metric {
    fn key(&self, placement: &Placement, sign: f32) -> Key {
        let [x, y, z] = placement.centre;
        let [i, j, k, w] = placement.rotation.map(|q| q * sign * 2.0 * self.radius);
        [x, y, z, i, j, k, w]
    }

    /// The distance, metres.
    pub(super) fn distance(&self, a: &Placement, b: &Placement) -> f32 {
        let of = |sign| squared(&self.key(a, sign), &self.key(b, 1.0));
        libm::sqrtf(of(1.0).min(of(-1.0)))
    }
}

fn squared(a: &Key, b: &Key) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

impl<'s> Tree<'s> {
    /// Bytes for `nodes`.
    pub(super) const fn bytes(nodes: usize) -> usize {
        array_bytes::<Node>(nodes)
            .saturating_add(array_bytes::<u32>(nodes))
            .saturating_add(array_bytes::<u8>(nodes))
    }

    pub(super) fn new(nodes: usize, arena: &mut Arena<'s>) -> Result<Self, OutOfMemory> {
        let (order, axes) = (arena.unset(nodes)?, arena.unset(nodes)?);
        Ok(Self { nodes: arena.unset(nodes)?, order, axes, len: 0, metric: Metric { radius: 1.0 } })
    }

    /// Drops all nodes.
    pub(super) fn clear(&mut self, metric: Metric) {
        (self.len, self.metric) = (0, metric);
    }

    pub(super) fn metric(&self) -> Metric {
        self.metric
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes[..self.len]
    }

    /// Where a node is.
    pub(super) fn placement(&self, node: usize) -> Placement {
        self.nodes()[node].placement
    }

    pub(super) fn is_full(&self) -> bool {
        self.len == self.nodes.len()
    }

    /// Adds a node after `parent`, or a root. Returns its index, or `None` if the tree is full.
    pub(super) fn add(
        &mut self,
        placement: Placement,
        parent: Option<usize>,
        clearance: f32,
    ) -> Option<usize> {
        let index = self.len;
        let parent = parent.unwrap_or(index) as u32;
        // What comes after a node that is out of use is so, too.
        let is_dead = self.nodes[..index].get(parent as usize).map_or(0, |parent| parent.is_dead);
        *self.nodes.get_mut(index)? = Node { placement, parent, clearance, is_dead };
        self.order[index] = index as u32;
        self.len += 1;
        let joined = 1 << self.len.trailing_zeros();
        self.divide(self.len - joined, self.len);
        Some(index)
    }

    /// Arranges a range of `order` as a balanced tree.
    fn divide(&mut self, first: usize, end: usize) {
        let (nodes, metric) = (&self.nodes, self.metric);
        let key = |index: u32| metric.key(&nodes[index as usize].placement, 1.0);
        let mut waiting = Vec::<(usize, usize), 32>::new();
        let _ = waiting.push((first, end));
        while let Some((first, end)) = waiting.pop() {
            if end - first <= FEW {
                continue;
            }
            let range = &mut self.order[first..end];
            let (mut low, mut high) = (key(range[0]), key(range[0]));
            for key in range.iter().map(|&index| key(index)) {
                for axis in 0..key.len() {
                    (low[axis], high[axis]) = (low[axis].min(key[axis]), high[axis].max(key[axis]));
                }
            }
            let width = |axis: &usize| high[*axis] - low[*axis];
            let axis = (0..low.len()).max_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or(0);
            let half = range.len() / 2;
            // Always: the range has more than `FEW` nodes.
            if half < range.len() {
                range.select_nth_unstable_by(half, |&a, &b| {
                    key(a)[axis].total_cmp(&key(b)[axis]).then(a.cmp(&b))
                });
            }
            self.axes[first + half] = axis as u8;
            // Half of a range each: the stack holds one for each halving.
            let _ = waiting.push((first, first + half));
            let _ = waiting.push((first + half + 1, end));
        }
    }

    /// The node nearest to a placement; `None` if there is none.
    pub(super) fn nearest(&self, placement: &Placement) -> Option<usize> {
        let mut best = (f32::INFINITY, None::<u32>);
        for sign in [1.0, -1.0] {
            let key = self.metric.key(placement, sign);
            let mut first = 0;
            for bit in (0..usize::BITS).rev().filter(|bit| self.len >> bit & 1 == 1) {
                self.search(&key, first, first + (1 << bit), &mut best);
                first += 1 << bit;
            }
        }
        best.1.map(|index| index as usize)
    }

    fn search(&self, query: &Key, first: usize, end: usize, best: &mut (f32, Option<u32>)) {
        let mut waiting = Vec::<(usize, usize, f32), 32>::new();
        let _ = waiting.push((first, end, 0.0));
        let compare = |place: usize, best: &mut (f32, Option<u32>)| {
            let (index, node) = (self.order[place], &self.nodes[self.order[place] as usize]);
            let key = self.metric.key(&node.placement, 1.0);
            let distance = squared(&key, query);
            let is_nearer =
                distance < best.0 || distance == best.0 && best.1.is_some_and(|other| index < other);
            if is_nearer && node.is_dead == 0 {
                *best = (distance, Some(index));
            }
            key
        };
        while let Some((first, end, least)) = waiting.pop() {
            if least > best.0 {
                continue;
            }
            if end - first <= FEW {
                (first..end).for_each(|place| {
                    compare(place, best);
                });
                continue;
            }
            let middle = first + (end - first) / 2;
            let axis = self.axes[middle] as usize;
            let across = query[axis] - compare(middle, best)[axis];
            let (below, above) = ((first, middle), (middle + 1, end));
            let (near, far) = if across < 0.0 { (below, above) } else { (above, below) };
            let _ = waiting.push((far.0, far.1, across * across));
            let _ = waiting.push((near.0, near.1, least));
        }
    }

    /// Nodes from one to its root.
    pub(super) fn chain(&self, from: usize) -> impl Iterator<Item = usize> + '_ {
        let mut next = Some(from);
        core::iter::from_fn(move || {
            let at = next?;
            let parent = self.nodes[at].parent as usize;
            next = (parent != at).then_some(parent);
            Some(at)
        })
    }

    /// Takes a node and all that come after it out of use.
    pub(super) fn cut_off(&mut self, node: usize) {
        self.nodes[node].is_dead = 1;
        // A node comes after its parent.
        for index in node + 1..self.len {
            let parent = self.nodes[index].parent as usize;
            if self.nodes[parent].is_dead == 1 {
                self.nodes[index].is_dead = 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::memory::model_bytes;
    use crate::random::Random;
    use nalgebra::{Quaternion, UnitQuaternion};

    #[test]
    fn the_nearest_is_that_of_brute_force() {
        let mut random = Random::new(5);
        let mut memory = vec![0; model_bytes(Tree::bytes(700))];
        let mut arena = Arena::new(&mut memory, 0).unwrap();
        let metric = Metric { radius: 0.3 };
        let mut tree = Tree::new(700, &mut arena).unwrap();
        tree.clear(metric);
        let mut placement = |k: usize| {
            let mut next = || random.next_f32() * 2.0 - 1.0;
            let rotation = UnitQuaternion::new_normalize(Quaternion::new(next(), next(), next(), next()));
            // Some on a line, as along a bar.
            let centre = if k.is_multiple_of(3) {
                Point::new(k as f32 * 1e-3, 0.0, 0.0)
            } else {
                Point::new(next(), next(), next())
            };
            Placement::new(centre, if k.is_multiple_of(2) { UnitQuaternion::identity() } else { rotation })
        };
        assert_eq!(tree.nearest(&placement(1)), None);
        let mut dead = Vec::<usize, 8>::new();
        for k in 0..700 {
            assert_eq!(tree.add(placement(k), (k > 0).then_some(k / 2), 0.0), Some(k));
            if k == 400 {
                tree.cut_off(77);
            }
            if k > 400 && tree.nodes[k].parent as usize == 77 {
                let _ = dead.push(k);
            }
            let query = placement(k + 1);
            let brute = (0..=k).filter(|&i| tree.nodes[i].is_dead == 0).min_by(|&a, &b| {
                let distance = |i: usize| metric.distance(&tree.nodes[i].placement, &query);
                distance(a).total_cmp(&distance(b))
            });
            let found = tree.nearest(&query).unwrap();
            let [found, brute] =
                [found, brute.unwrap()].map(|i| metric.distance(&tree.nodes[i].placement, &query));
            assert!((found - brute).abs() < 1e-5, "{k}: {found} {brute}");
        }
        assert!(tree.is_full() && tree.add(placement(0), None, 0.0).is_none());
        assert_eq!(tree.chain(699).last(), Some(0));
        assert_eq!([77, 154, 155, 310].map(|i| tree.nodes[i].is_dead), [1; 4]);
        assert_eq!(tree.nodes[76].is_dead, 0);
        tree.clear(metric);
        tree.add(placement(0), None, 0.0);
        tree.cut_off(0);
        tree.add(placement(1), Some(0), 0.0);
        assert_eq!(tree.nearest(&placement(1)), None);
    }
}
