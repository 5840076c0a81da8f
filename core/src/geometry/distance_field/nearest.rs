//! How far the nodes of the bricks are from the mesh, and which triangle is nearest.
//!
//! Every triangle is asked by the nodes close to it, so that what those get is exact. From them the nearest triangles
//! spread to their neighbours, a layer at a time: a node asks the triangles that its neighbours found nearest. That may
//! miss the nearest of many small triangles, by less than one of them.

use super::super::{Surface, Vector};
use super::brick::{
    ACROSS, ALL, BESIDE, BLOCK, BRICK_NODES, DIAGONAL, HIGH, LOW, Nodes, SIDE, coordinates, dilate, each,
};
use super::frame::Frame;
use super::layout::{Layout, REACH};
use super::{Entry, raster};
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// No node is further than this from its neighbours across edges and corners, in voxels.
const DIAGONAL_STEP: f32 = 1.733;
/// The nodes of a brick closer than this know their nearest triangle before any other asks.
pub(super) const EXACT: f32 = 1.0;

/// The nearest triangle of every node of every brick.
pub(super) struct Nearest<'s> {
    /// Distance in voxels, without a sign; its square while it is searched for.
    pub(super) distances: &'s mut [[f32; BRICK_NODES]],
    /// Which triangle.
    pub(super) triangles: &'s mut [[u32; BRICK_NODES]],
    /// The nodes of each brick that are known.
    known: &'s mut [Nodes],
}

/// Bytes for `bricks`.
pub(super) const fn bytes(bricks: usize) -> usize {
    array_bytes::<f32>(bricks.saturating_mul(BRICK_NODES))
        .saturating_add(array_bytes::<u32>(bricks.saturating_mul(BRICK_NODES)))
        .saturating_add(array_bytes::<Nodes>(bricks))
        .saturating_add(array_bytes::<u32>(bricks))
}

impl<'s> Nearest<'s> {
    /// Nothing known yet; and the block of each brick.
    pub(super) fn new(
        grid: &[u32],
        bricks: usize,
        scratch: &mut Arena<'s>,
    ) -> Result<(Self, &'s [u32]), OutOfMemory> {
        let (distances, _) = scratch.slice::<f32>(bricks * BRICK_NODES)?.as_chunks_mut();
        let (triangles, _) = scratch.slice::<u32>(bricks * BRICK_NODES)?.as_chunks_mut();
        let known = scratch.slice::<Nodes>(bricks)?;
        let places = scratch.slice::<u32>(bricks)?;
        distances.as_flattened_mut().fill(f32::INFINITY);
        for (block, &entry) in grid.iter().enumerate() {
            if let Entry::Brick(brick) = Entry::unpack(entry) {
                places[brick] = block as u32;
            }
        }
        Ok((Self { distances, triangles, known }, places))
    }

    /// Asks every triangle for the nodes within [`EXACT`] of it.
    pub(super) fn seed(&mut self, surface: &Surface, layout: &Layout, grid: &[u32], frames: &[Frame]) {
        for (triangle, (corners, frame)) in surface.triangles().iter().zip(frames).enumerate() {
            let corners = layout.local(corners);
            let min = corners[0].inf(&corners[1]).inf(&corners[2]).add_scalar(-EXACT);
            let max = corners[0].sup(&corners[1]).sup(&corners[2]).add_scalar(EXACT);
            raster::visit_blocks(&corners, REACH, &layout.blocks, |place| {
                let Entry::Brick(brick) = Entry::unpack(grid[layout.index(place)]) else { return };
                let first = place.map(|i| (i * BLOCK) as f32);
                let low = [0, 1, 2].map(|i| libm::ceilf((min[i] - first[i]).max(0.0)) as usize);
                let high = [0, 1, 2].map(|i| (max[i] - first[i]).min(BLOCK as f32));
                if high.iter().any(|&x| x < 0.0) {
                    return;
                }
                let high = high.map(|x| x as usize);
                let (distances, triangles) = (&mut self.distances[brick], &mut self.triangles[brick]);
                let mut known = 0;
                for z in low[2]..=high[2] {
                    for y in low[1]..=high[1] {
                        for x in low[0]..=high[0] {
                            let node = x + SIDE * (y + SIDE * z);
                            let point = Vector::from(first) + Vector::new(x as f32, y as f32, z as f32);
                            let height = frame.height(&point);
                            let limit = distances[node].min(EXACT * EXACT);
                            if height * height > limit {
                                continue;
                            }
                            let distance = frame.distance_squared(&point);
                            if distance < distances[node] && distance <= EXACT * EXACT {
                                (distances[node], triangles[node]) = (distance, triangle as u32);
                                known |= 1 << node;
                            }
                        }
                    }
                }
                self.known[brick] |= known;
            });
        }
    }

    /// Finds a near triangle for all other nodes, and takes the roots of the distances.
    pub(super) fn spread(&mut self, layout: &Layout, grid: &[u32], places: &[u32], frames: &[Frame]) {
        loop {
            let mut changed = false;
            let mut complete = true;
            for (brick, &block) in places.iter().enumerate() {
                let known = self.known[brick];
                let next = dilate(known) & !known & ALL;
                for node in each(next) {
                    self.ask_neighbours(brick, block, node, known, layout, frames);
                }
                changed |= next != 0;
                self.known[brick] |= next;
                complete &= self.known[brick] == ALL;
            }
            // Nodes that two bricks share take the better of both answers.
            for axis in 0..3 {
                for (brick, &block) in places.iter().enumerate() {
                    let Some(other) = layout.beside(layout.place(block as usize), axis, true) else {
                        continue;
                    };
                    if let Entry::Brick(other) = Entry::unpack(grid[other]) {
                        changed |= self.share(brick, other, axis);
                    }
                }
            }
            if complete || !changed {
                break;
            }
        }
        for distance in self.distances.as_flattened_mut() {
            *distance = libm::sqrtf(*distance);
        }
        debug_assert!(self.known.iter().all(|&known| known == ALL));
    }

    /// Tries the triangles of a node's known neighbours.
    fn ask_neighbours(
        &mut self,
        brick: usize,
        block: u32,
        node: usize,
        known: Nodes,
        layout: &Layout,
        frames: &[Frame],
    ) {
        let (distances, triangles) = (&self.distances[brick], &self.triangles[brick]);
        let place = layout.place(block as usize);
        let at = coordinates(node);
        let point = Vector::from([0, 1, 2].map(|i| (place[i] * BLOCK) as f32 + at[i] as f32));
        let (mut best, mut least) = (u32::MAX, f32::INFINITY);
        for near in [BESIDE[node] & known, DIAGONAL[node] & known] {
            let mut last = u32::MAX;
            for other in each(near) {
                let triangle = triangles[other];
                // The node cannot be closer to this triangle than its neighbour is, less the way between.
                let bound = libm::sqrtf(distances[other]) - DIAGONAL_STEP;
                if triangle == best || triangle == last || bound > 0.0 && bound * bound > least {
                    continue;
                }
                last = triangle;
                let distance = frames[triangle as usize].distance_squared(&point);
                if distance < least || distance == least && triangle < best {
                    (best, least) = (triangle, distance);
                }
            }
        }
        (self.distances[brick][node], self.triangles[brick][node]) = (least, best);
    }

    /// Lets a brick and the next one along `axis` agree on their common nodes; returns whether that changed any.
    fn share(&mut self, brick: usize, next: usize, axis: usize) -> bool {
        let face = (self.known[brick] & HIGH[axis]) >> ACROSS[axis] | self.known[next] & LOW[axis];
        let mut changed = false;
        for there in each(face) {
            let here = there + ACROSS[axis];
            let (a, b) = (self.distances[brick][here], self.distances[next][there]);
            if a == b {
                continue;
            }
            changed = true;
            if a < b {
                self.distances[next][there] = a;
                self.triangles[next][there] = self.triangles[brick][here];
            } else {
                self.distances[brick][here] = b;
                self.triangles[brick][here] = self.triangles[next][there];
            }
        }
        self.known[brick] |= face << ACROSS[axis];
        self.known[next] |= face;
        changed
    }
}
