//! How far the nodes of the bricks are from the mesh, and which triangle is nearest.
//!
//! Nodes close to a triangle measure their distance to it directly, so their distances are exact. From them the nearest
//! triangles spread to their neighbours, a layer at a time: a node measures its distance to the triangles that are nearest
//! to its neighbours. That may miss the nearest of many small triangles, with an error below the size of one of them.

use super::brick::{
    ACROSS, ALL, ALONG, BLOCK, BRICK_NODES, COORDINATES, DIAGONAL, HIGH, LOW, NOWHERE, Nodes, PADDED, SIDE,
    STEP, compare, dilate, each,
};
use super::frame::Frame;
use super::layout::{Bricks, Layout};
use super::{Entry, raster};
use crate::geometry::Vector;
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop};
use core::ops::{Range, RangeInclusive};

/// Nodes whose distances are computed at once.
const LANES: usize = 4;
/// Marks an unknown triangle.
pub(super) const NONE: u32 = u32::MAX;
/// Passes over the neighbours at most; 6 were found to be needed.
const REPAIRS: usize = 16;
/// Distance up to which nodes have their exact nearest triangle before the spreading, voxels. More than one: distances of
/// other nodes may be overstated, but never so that the mesh seems not to pass between two neighbours when it does.
const EXACT: f32 = 1.01;
/// Triangles between two looks at the monitor. A budget: they take less than 0.1 ms unless they are large.
const TRIANGLES_A_CHECK: usize = 64;

/// The nearest triangle of every node of every brick.
pub(super) struct Nearest<'s> {
    /// Distance in voxels, without a sign; its square until all are known.
    pub(super) distances: &'s mut [[f32; PADDED]],
    /// Which triangle.
    pub(super) triangles: &'s mut [[u32; PADDED]],
    /// The nodes of each brick that are known.
    known: &'s mut [Nodes],
    /// Those whose nearest triangle is new.
    fresh: &'s mut [Nodes],
}

/// Bytes for `bricks`.
pub(super) const fn bytes(bricks: usize) -> usize {
    array_bytes::<f32>(bricks.saturating_mul(PADDED))
        .saturating_add(array_bytes::<u32>(bricks.saturating_mul(PADDED)))
        .saturating_add(array_bytes::<Nodes>(bricks).saturating_mul(2))
        .saturating_add(array_bytes::<u32>(bricks))
}

impl<'s> Nearest<'s> {
    /// Nothing known yet; and the block of each brick.
    pub(super) fn new(
        grid: &[u32],
        bricks: usize,
        scratch: &mut Arena<'s>,
    ) -> Result<(Self, &'s [u32]), OutOfMemory> {
        let (distances, _) = scratch.slice::<f32>(bricks * PADDED)?.as_chunks_mut();
        let (triangles, _) = scratch.slice::<u32>(bricks * PADDED)?.as_chunks_mut();
        let (known, fresh) = (scratch.slice::<Nodes>(bricks)?, scratch.slice::<Nodes>(bricks)?);
        let places = scratch.slice::<u32>(bricks)?;
        distances.as_flattened_mut().fill(f32::INFINITY);
        triangles.as_flattened_mut().fill(NONE);
        for (block, &entry) in grid.iter().enumerate() {
            if let Entry::Brick(brick) = Entry::unpack(entry) {
                places[brick] = block as u32;
            }
        }
        Ok((Self { distances, triangles, known, fresh }, places))
    }

    /// Asks every triangle for the nodes within [`EXACT`] of it; a second thread takes half of the bricks.
    pub(super) fn seed(&mut self, on: &Bricks, meter: &mut Meter) -> Result<(), Stop> {
        let Bricks { layout, places, .. } = *on;
        let middle = if meter.has_threads() { places.len() / 2 } else { places.len() };
        // Bricks are numbered by layers of blocks along z.
        let border = places.get(middle).map_or(u32::MAX, |&block| layout.place(block as usize)[2]);
        let (distances, triangles) =
            (self.distances.split_at_mut(middle), self.triangles.split_at_mut(middle));
        let mut front = Part { bricks: 0..middle, layers: 0..=border, nearest: (distances.0, triangles.0) };
        let mut back = Part {
            bricks: middle..places.len(),
            layers: border..=u32::MAX,
            nearest: (distances.1, triangles.1),
        };
        meter.run_both(|meter| front.seed(on, meter), |meter| back.seed(on, meter), |_| false)?;
        for (known, distances) in self.known.iter_mut().zip(self.distances.iter()) {
            *known = compare(distances, 0, |distance, _| distance <= EXACT * EXACT);
        }
        for (to, from) in self.fresh.iter_mut().zip(self.known.iter()) {
            *to = *from;
        }
        Ok(())
    }

    /// Finds a near triangle for all other nodes, and takes the roots of the distances.
    pub(super) fn spread(&mut self, on: &Bricks, meter: &Meter) -> Result<(), Stop> {
        let Bricks { surface, layout, grid, places, frames } = *on;
        loop {
            self.share_all(layout, grid, places, meter)?;
            let mut changed = false;
            for (brick, &block) in places.iter().enumerate() {
                meter.check_cancelled()?;
                let known = self.known[brick];
                let fresh = dilate(known) & !known & ALL;
                self.fresh[brick] = fresh;
                if fresh == 0 {
                    continue;
                }
                let first = layout.first_node(block as usize);
                let distances = self.known_distances(brick, known);
                for node in each(fresh) {
                    self.ask_neighbours(brick, first, node, &distances, frames);
                }
                changed = true;
                self.known[brick] |= fresh;
            }
            if !changed {
                break;
            }
        }
        for distance in self.distances.as_flattened_mut() {
            *distance = libm::sqrtf(*distance);
        }
        // What spread the long way round is told by its neighbours, first everywhere, then where that changed anything.
        self.fresh.fill(ALL);
        for _ in 0..REPAIRS {
            let mut changed = false;
            for (brick, &block) in places.iter().enumerate() {
                meter.check_cancelled()?;
                if self.fresh[brick] == 0 {
                    continue;
                }
                let wrong = self.too_far(brick);
                if wrong > 0 {
                    let first = layout.first_node(block as usize);
                    let mut distances = self.known_distances(brick, ALL);
                    for node in each(wrong) {
                        self.distances[brick][node] *= self.distances[brick][node];
                        self.ask_neighbours(brick, first, node, &distances, frames);
                        self.distances[brick][node] = libm::sqrtf(self.distances[brick][node]);
                        distances[node] = self.distances[brick][node];
                    }
                }
                self.fresh[brick] = wrong;
                changed |= wrong != 0;
            }
            if !changed {
                break;
            }
            self.share_all(layout, grid, places, meter)?;
        }
        // A brick that no other leads to: far from the mesh, as only those are that the corners of a triangle were wrongly
        // given.
        for (distances, &block) in self.distances.iter_mut().zip(places) {
            meter.check_cancelled()?;
            for (node, distance) in distances[..BRICK_NODES].iter_mut().enumerate() {
                if distance.is_infinite() {
                    let local = layout.first_node(block as usize)
                        + Vector::from([0, 1, 2].map(|i| COORDINATES[i][node]));
                    let closest = surface.closest_point(&layout.in_object(&local));
                    *distance = (layout.in_voxels(&closest) - local).norm();
                }
            }
        }
        Ok(())
    }

    /// The nodes that are further from their triangle than from a neighbour and on to its triangle.
    fn too_far(&self, brick: usize) -> Nodes {
        let distances = &self.distances[brick];
        let mut all = 0;
        for axis in 0..3 {
            let up = compare(distances, STEP[axis], |from, to| to - from > 1.001);
            let down = compare(distances, STEP[axis], |from, to| from - to > 1.001);
            all |= (up & !HIGH[axis]) << STEP[axis] | down & !HIGH[axis];
        }
        all
    }

    /// Nodes that two bricks have in common take the better of both answers.
    fn share_all(
        &mut self,
        layout: &Layout,
        grid: &[u32],
        places: &[u32],
        meter: &Meter,
    ) -> Result<(), Stop> {
        for axis in 0..3 {
            for (brick, &block) in places.iter().enumerate() {
                meter.check_at(brick)?;
                let Some(next) = layout.beside(layout.place(block as usize), axis, true) else { continue };
                if let Entry::Brick(next) = Entry::unpack(grid[next]) {
                    self.share(brick, next, axis);
                }
            }
        }
        Ok(())
    }

    /// The distances of the known nodes of a brick; infinite for all others.
    fn known_distances(&self, brick: usize, known: Nodes) -> [f32; PADDED] {
        let mut distances = self.distances[brick];
        each(ALL & !known).for_each(|node| distances[node] = f32::INFINITY);
        distances[NOWHERE] = f32::INFINITY;
        distances
    }

    /// Tries the triangles of a node's neighbours in a brick whose first node is at `first`. `known` are the distances of the
    /// known nodes. The node's own distance is squared.
    fn ask_neighbours(
        &mut self,
        brick: usize,
        first: Vector,
        node: usize,
        known: &[f32; PADDED],
        frames: &[Frame],
    ) {
        let triangles = &self.triangles[brick];
        let point = first + Vector::from([0, 1, 2].map(|i| COORDINATES[i][node]));
        let (mut best, mut least) = (triangles[node], self.distances[brick][node]);
        // Down the distances: to the lowest neighbour along an axis, and to the one across from where all three go down.
        let mut lowest = NOWHERE;
        let mut across = node;
        for (step, ends) in STEP.into_iter().zip(&ALONG[node]) {
            let [before, after] = ends.map(usize::from);
            let (end, lower) = match known[after] < known[before] {
                true => (after, across + step),
                false if known[before] < f32::INFINITY => (before, across - step),
                false => continue,
            };
            across = lower;
            lowest = if known[end] < known[lowest] { end } else { lowest };
        }
        if lowest == NOWHERE {
            lowest = each(DIAGONAL[node]).fold(NOWHERE, |a, b| if known[b] < known[a] { b } else { a });
        }
        for near in [lowest, across].into_iter().filter(|&near| known[near] < f32::INFINITY) {
            let triangle = triangles[near];
            if triangle == best || triangle == NONE {
                continue;
            }
            let distance = frames[triangle as usize].distance_squared(&point);
            if distance < least || distance == least && triangle < best {
                (best, least) = (triangle, distance);
            }
        }
        (self.distances[brick][node], self.triangles[brick][node]) = (least, best);
    }

    /// Lets a brick and the next one along `axis` agree on their common nodes.
    fn share(&mut self, brick: usize, next: usize, axis: usize) {
        let face = (self.fresh[brick] & HIGH[axis]) >> ACROSS[axis] | self.fresh[next] & LOW[axis];
        for there in each(face) {
            let here = there + ACROSS[axis];
            let (a, b) = (self.distances[brick][here], self.distances[next][there]);
            if a < b {
                self.distances[next][there] = a;
                self.triangles[next][there] = self.triangles[brick][here];
                self.fresh[next] |= 1 << there;
            } else if b < a {
                self.distances[brick][here] = b;
                self.triangles[brick][here] = self.triangles[next][there];
                self.fresh[brick] |= 1 << here;
            }
        }
        self.known[brick] |= face << ACROSS[axis];
        self.known[next] |= face;
    }
}

/// Some of the bricks.
struct Part<'a> {
    bricks: Range<usize>,
    /// Layers of blocks along z that hold them.
    layers: RangeInclusive<u32>,
    /// Square distances and triangles of their nodes.
    nearest: (&'a mut [[f32; PADDED]], &'a mut [[u32; PADDED]]),
}

impl Part<'_> {
    /// Asks every triangle for the nodes of these bricks.
    fn seed(&mut self, on: &Bricks, meter: &Meter) -> Result<(), Stop> {
        let Bricks { surface, layout, grid, frames, .. } = *on;
        let Self { bricks, layers, nearest: (distances, triangles) } = self;
        if distances.is_empty() {
            return Ok(());
        }
        let layer = |z: f32| (z.max(0.0) as u32 / BLOCK).min(layout.blocks[2] - 1);
        for (triangle, (corners, frame)) in surface.triangles().iter().zip(frames).enumerate() {
            if triangle % TRIANGLES_A_CHECK == 0 {
                meter.check_cancelled()?;
            }
            let corners = layout.local(corners);
            let min = corners[0].inf(&corners[1]).inf(&corners[2]).add_scalar(-EXACT);
            let max = corners[0].sup(&corners[1]).sup(&corners[2]).add_scalar(EXACT);
            if layer(max.z) < *layers.start() || layer(min.z) > *layers.end() {
                continue;
            }
            raster::visit_blocks(&corners, EXACT, &layout.blocks, |place| {
                let Entry::Brick(brick) = Entry::unpack(grid[layout.index(place)]) else { return };
                if !bricks.contains(&brick) {
                    return;
                }
                let brick = brick - bricks.start;
                let first = place.map(|i| (i * BLOCK) as f32);
                // The rows of nodes in the box around the triangle, and all of each.
                let low = [1, 2].map(|i| ((min[i] - first[i]).max(0.0) as usize).min(SIDE - 1));
                let high = [1, 2].map(|i| ((max[i] - first[i]).max(0.0) as usize).min(SIDE - 1));
                let (distances, triangles) = (&mut distances[brick], &mut triangles[brick]);
                for z in low[1]..=high[1] {
                    let from = SIDE * (low[0] + SIDE * z);
                    let count = (SIDE * (high[0] - low[0] + 1)).next_multiple_of(LANES);
                    // The middle of the run, and how far its ends are from it.
                    let half = 0.5 * (high[0] - low[0]) as f32;
                    let middle =
                        Vector::new(first[0] + 2.0, first[1] + low[0] as f32 + half, first[2] + z as f32);
                    if frame.height(&middle).abs() > EXACT + frame.slope(2.0, half) {
                        continue;
                    }
                    ask(frame, triangle as u32, first, from..from + count, distances, triangles);
                }
            });
        }
        Ok(())
    }
}

/// Asks one triangle for a run of nodes, a multiple of [`LANES`], of the brick whose first node is at `first`.
#[inline]
fn ask(
    frame: &Frame,
    triangle: u32,
    first: [f32; 3],
    run: Range<usize>,
    distances: &mut [f32; PADDED],
    triangles: &mut [u32; PADDED],
) {
    let [xs, ys, zs] = [0, 1, 2].map(|axis| &COORDINATES[axis][run.clone()]);
    let nodes = distances[run.clone()].iter_mut().zip(&mut triangles[run]);
    for (((least, best), x), (y, z)) in nodes.zip(xs).zip(ys.iter().zip(zs)) {
        let point = Vector::new(first[0] + x, first[1] + y, first[2] + z);
        let distance = frame.distance_squared(&point);
        let is_less = distance < *least;
        *least = if is_less { distance } else { *least };
        *best = if is_less { triangle } else { *best };
    }
}
