//! Nearest neighbours of points.

use super::bvh::{Bvh, Node};
use super::nearest;
use crate::geometry::{Aabb, Point};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};

/// Points arranged for neighbour queries. Queries name points by their position in [`points`](Self::points),
/// which is the tree's order and not the caller's.
#[derive(Clone, Copy)]
pub struct PointTree<'m> {
    points: &'m [Point],
    order: &'m [u32],
    bvh: Bvh<'m>,
}

/// A point found by a query: its position in the tree's order and the square of its distance, m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Neighbour {
    /// Position in the tree's order.
    pub index: u32,
    /// Square of the distance, m².
    pub distance_squared: f32,
}

/// Memory for a tree, which can be filled again with fewer points.
pub(crate) struct PointTreeSlots<'m> {
    points: &'m mut [Point],
    order: &'m mut [u32],
    nodes: &'m mut [Node],
    /// Points and nodes in use.
    used: [usize; 2],
}

impl<'m> PointTreeSlots<'m> {
    /// Memory for at most `points` points.
    pub(crate) fn new(points: usize, arena: &mut Arena<'m>) -> Result<Self, OutOfMemory> {
        Ok(Self {
            order: arena.unset(points)?,
            points: arena.unset(points)?,
            nodes: arena.unset(Bvh::max_nodes(points))?,
            used: [0; 2],
        })
    }

    /// Memory for other use, for as many points: what the tree held is forgotten.
    pub(crate) fn lend(&mut self, points: usize) -> &mut [Point] {
        self.used = [0; 2];
        self.points.get_mut(..points).unwrap_or_default()
    }

    /// Arranges `points`, at least one, instead of those before.
    pub(crate) fn fill(&mut self, points: &[Point], meter: &Meter) -> Result<(), Stop> {
        let (order, sorted) = (&mut self.order[..points.len()], &mut self.points[..points.len()]);
        for (slot, index) in order.iter_mut().zip(0..) {
            *slot = index;
        }
        sorted.copy_from_slice(points);
        let bvh = Bvh::build(order, sorted, self.nodes, meter)?;
        self.used = [points.len(), bvh.nodes().len()];
        Ok(())
    }

    /// Names the points by other indices: `names` has one for each point that the tree was filled with.
    pub(crate) fn rename(&mut self, names: &[u32]) {
        for index in &mut self.order[..self.used[0]] {
            *index = names[*index as usize];
        }
    }

    /// The tree as it is now.
    pub(crate) fn tree(&self) -> PointTree<'_> {
        PointTree::view(self.points, self.order, self.nodes, self.used)
    }

    /// The tree for as long as the memory lives.
    pub(crate) fn into_tree(self) -> PointTree<'m> {
        PointTree::view(self.points, self.order, self.nodes, self.used)
    }
}

/// The nearest of the points that it was shown, nearest first.
pub(crate) struct Nearest<'f> {
    found: &'f mut [Neighbour],
    count: usize,
}

impl<'f> Nearest<'f> {
    /// Room for as many points as `found` has.
    pub(crate) fn new(found: &'f mut [Neighbour]) -> Self {
        Self { found, count: 0 }
    }

    pub(crate) fn is_full(&self) -> bool {
        self.count == self.found.len()
    }

    /// Keeps a point if it is among the nearest.
    pub(crate) fn offer(&mut self, candidate: Neighbour) {
        if self.is_full() && self.found.last().is_none_or(|last| !candidate.is_before(last)) {
            return;
        }
        self.count = (self.count + 1).min(self.found.len());
        let mut place = self.count - 1;
        while place > 0 && candidate.is_before(&self.found[place - 1]) {
            self.found[place] = self.found[place - 1];
            place -= 1;
        }
        self.found[place] = candidate;
    }

    /// What was found.
    pub(crate) fn into_slice(self) -> &'f [Neighbour] {
        &self.found[..self.count]
    }
}

impl Neighbour {
    fn is_before(&self, other: &Self) -> bool {
        self.distance_squared.total_cmp(&other.distance_squared).then(self.index.cmp(&other.index)).is_lt()
    }
}

impl<'m> PointTree<'m> {
    /// Bytes of a tree over `points`.
    pub(crate) const fn bytes(points: usize) -> usize {
        array_bytes::<u32>(points).saturating_add(array_bytes::<Point>(points)).saturating_add(array_bytes::<
            Node,
        >(
            Bvh::max_nodes(points),
        ))
    }

    /// Arranges `points`, at least one.
    pub(crate) fn build(points: &[Point], arena: &mut Arena<'m>, meter: &Meter) -> Result<Self, Unfinished> {
        let mut slots = PointTreeSlots::new(points.len(), arena)?;
        slots.fill(points, meter)?;
        Ok(slots.into_tree())
    }

    fn view(points: &'m [Point], order: &'m [u32], nodes: &'m [Node], used: [usize; 2]) -> Self {
        let [count, nodes_used] = used;
        Self { points: &points[..count], order: &order[..count], bvh: Bvh::of(&nodes[..nodes_used]) }
    }

    /// The points, in tree order.
    pub fn points(&self) -> &'m [Point] {
        self.points
    }

    /// For each point in tree order, its index in the slice that the tree was built from; in the tree of a supporter, that
    /// of a point of the caller's cloud, of which strays and duplicates were left out.
    pub fn order(&self) -> &'m [u32] {
        self.order
    }

    /// The box around all points.
    pub fn aabb(&self) -> Aabb {
        self.bvh.aabb()
    }

    pub(crate) fn bvh(&self) -> &Bvh<'m> {
        &self.bvh
    }

    /// The point closest to `query`; of equally close ones the first.
    pub fn nearest(&self, query: &Point) -> Neighbour {
        let mut nearest = [Neighbour { index: 0, distance_squared: f32::INFINITY }];
        self.k_nearest(query, &mut nearest);
        nearest[0]
    }

    /// The `found.len()` points closest to `query`, nearest first, fewer if there are not as many.
    pub fn k_nearest<'f>(&self, query: &Point, found: &'f mut [Neighbour]) -> &'f [Neighbour] {
        let mut nearest = Nearest::new(found);
        if !nearest.is_full() {
            self.bvh.visit_near(query, f32::INFINITY, |items, mut limit| {
                for index in items {
                    let distance_squared = (self.points[index] - query).norm_squared();
                    nearest.offer(Neighbour { index: index as u32, distance_squared });
                    if let (true, Some(last)) = (nearest.is_full(), nearest.found.last()) {
                        limit = last.distance_squared;
                    }
                }
                limit
            });
        }
        nearest.into_slice()
    }

    /// Calls `visit` for each point, in tree order, with the `K` points closest to it as [`k_nearest`](Self::k_nearest) finds
    /// them: faster for all points than one by one.
    pub(crate) fn for_each_k_nearest<const K: usize>(
        &self,
        meter: &Meter,
        mut visit: impl FnMut(usize, &[Neighbour]),
    ) -> Result<(), Stop> {
        let mut found = [Neighbour::default(); K];
        nearest::for_each_group(self, meter, |group: &nearest::Group<K>| {
            for (index, keys) in group.nearest() {
                for (found, &key) in found.iter_mut().zip(keys) {
                    *found = nearest::neighbour(key);
                }
                visit(index, &found[..K.min(self.points.len())]);
            }
        })
    }

    /// Calls `visit` for each point within `radius` of `query`, in no particular but a repeatable order.
    pub fn for_each_within(&self, query: &Point, radius: f32, mut visit: impl FnMut(Neighbour)) {
        self.bvh.visit_near(query, radius * radius, |items, limit| {
            for index in items {
                let distance_squared = (self.points[index] - query).norm_squared();
                if distance_squared <= limit {
                    visit(Neighbour { index: index as u32, distance_squared });
                }
            }
            limit
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;

    fn with_tree(points: &[Point], check: impl Fn(&PointTree)) {
        let needed = model_bytes(PointTree::bytes(points.len()));
        let mut memory = vec![0xAA; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        check(&PointTree::build(points, &mut arena, &Meter::unwatched()).unwrap());
    }

    #[test]
    fn nearest_of_all_points_are_those_of_each() {
        let mut random = Random::new(6);
        let mut next = |scale: f32| (random.next_f32() - 0.5) * scale;
        let mut uniform = |scale: f32| Point::new(next(scale), next(scale), next(scale));
        // A cube, a clump, a point far away, and duplicates.
        let mut points: Vec<Point> = (0..600).map(|_| uniform(1.0)).collect();
        points.extend((0..300).map(|_| uniform(0.001)));
        points.push(Point::new(500.0, 0.0, 0.0));
        points.extend_from_within(..100);
        points.extend([points[7]; 30]);
        fn check<const K: usize>(points: &[Point]) {
            with_tree(points, |tree| {
                let mut next = 0;
                tree.for_each_k_nearest::<K>(&Meter::unwatched(), |index, nearest| {
                    assert_eq!(index, next);
                    next += 1;
                    let mut found = [Neighbour::default(); K];
                    assert_eq!(nearest, tree.k_nearest(&tree.points()[index], &mut found));
                })
                .unwrap();
                assert_eq!(next, points.len());
            });
        }
        for count in [1, 2, 5, 9, 40, points.len()] {
            check::<1>(&points[..count]);
            check::<5>(&points[..count]);
            check::<16>(&points[..count]);
        }
    }

    /// Uniform, clumped and duplicated points against brute force.
    #[test]
    fn queries_agree_with_brute_force() {
        let mut random = Random::new(5);
        let mut uniform = |scale: f32| Point::from([(); 3].map(|()| random.next_f32() * scale));
        let mut points: Vec<Point> = (0..700).map(|_| uniform(1.0)).collect();
        points.extend((0..200).map(|_| uniform(0.01)));
        points.extend_from_within(..100);
        let queries: Vec<Point> =
            (0..100).map(|_| uniform(1.2)).chain(points[..50].iter().copied()).collect();

        let needed = model_bytes(PointTree::bytes(points.len()));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let tree = PointTree::build(&points, &mut arena, &Meter::unwatched()).unwrap();
        assert!(tree.order().iter().zip(tree.points()).all(|(&i, p)| points[i as usize] == *p));

        for query in &queries {
            let mut brute: Vec<Neighbour> = (0..tree.points().len() as u32)
                .map(|index| Neighbour {
                    index,
                    distance_squared: (tree.points()[index as usize] - query).norm_squared(),
                })
                .collect();
            brute.sort_by(|a, b| {
                a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index))
            });
            assert_eq!(tree.nearest(query), brute[0]);
            for k in [0, 1, 7, 30, 2000] {
                let mut found = vec![brute[0]; k];
                assert_eq!(tree.k_nearest(query, &mut found), &brute[..k.min(brute.len())]);
            }
            for radius in [0.0, 0.05, 0.4] {
                let mut within = Vec::new();
                tree.for_each_within(query, radius, |n| within.push(n));
                within.sort_by(|a, b| {
                    a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index))
                });
                let expected = brute.iter().filter(|n| n.distance_squared <= radius * radius).count();
                assert_eq!(within, &brute[..expected]);
            }
        }
    }
}
