//! The surface of a volume as a triangle mesh.
//!
//! Only cells whose eight corners were seen hold triangles. So the mesh is open where it borders on what no camera saw,
//! and there is no surface between free and unknown space. Where everything around a surface was seen, the mesh is
//! closed: each edge has exactly two triangles. [`Volume::complete`] guesses what was not seen.

mod cells;
mod error;
mod table;
#[cfg(test)]
mod tests;

pub use error::IsosurfaceError;

use super::volume::Volume;
use super::volume::blocks::{BLOCK, BLOCK_VOXELS, VOXEL_RANGE};
use super::volume::voxel::Voxel;
use crate::Monitor;
use crate::geometry::MAX_COUNT;
use crate::memory::{Arena, array_bytes, model_bytes};
use crate::monitor::Meter;
use cells::{Surroundings, for_each_cell};
use table::{CASE, EDGES, MAX_TRIANGLES, edge_axis, edge_corner};

/// Words of 64 bits for the edges of a block: one along each axis from each voxel.
const WORDS: usize = 3 * BLOCK_VOXELS / 64;
/// Least distance of a vertex from the ends of its edge, edges. It keeps vertices of different edges apart, so that every
/// triangle has an area.
const END: f32 = 1.0 / 64.0;
/// Blocks between two checks of the monitor, well under a millisecond.
const BLOCKS_A_CHECK: usize = 64;

/// The surface of a volume, counted and ready to be written.
pub struct Isosurface<'v, 'm> {
    volume: &'v Volume<'v>,
    /// Which edges hold a vertex: [`WORDS`] a block.
    marks: &'m [u64],
    /// Number of vertices in the block before each word.
    ranks: &'m [u16],
    /// Number of vertices before each block.
    firsts: &'m [u32],
    vertices: usize,
    triangles: usize,
}

impl<'v, 'm> Isosurface<'v, 'm> {
    /// Bytes of memory for a volume of this many blocks ([`Volume::blocks`]), 244 a block.
    pub const fn bytes(blocks: usize) -> usize {
        let words = blocks.saturating_mul(WORDS);
        model_bytes(
            array_bytes::<u64>(words)
                .saturating_add(array_bytes::<u16>(words))
                .saturating_add(array_bytes::<u32>(blocks)),
        )
    }

    /// Finds and counts the vertices and triangles, in `memory` of at least [`bytes`](Self::bytes).
    pub fn find(
        volume: &'v Volume<'v>,
        memory: &'m mut [u8],
        monitor: &Monitor,
    ) -> Result<Self, IsosurfaceError> {
        let meter = Meter::new(monitor);
        let blocks = volume.blocks();
        let mut arena = Arena::new(memory, Self::bytes(blocks))?;
        let marks = arena.slice::<u64>(blocks * WORDS)?;
        let ranks = arena.slice::<u16>(blocks * WORDS)?;
        let firsts = arena.slice::<u32>(blocks)?;
        let mut triangles = 0;
        for block in 0..blocks {
            if block % BLOCKS_A_CHECK == 0 {
                meter.progress(block as f32 / blocks as f32);
                meter.check()?;
            }
            let around = Surroundings::of(volume, block);
            for_each_cell(volume, &around, |cell, inside| {
                let case = &CASE[inside];
                triangles += usize::from(case.count);
                for edge in (0..EDGES).filter(|edge| case.edges >> edge & 1 == 1) {
                    let (word, bit) = edge_mark(&around, cell, edge);
                    marks[word] |= 1 << bit;
                }
            });
        }
        let mut vertices = 0;
        for (block, first) in firsts.iter_mut().enumerate() {
            *first = vertices as u32;
            let mut rank = 0;
            for word in block * WORDS..(block + 1) * WORDS {
                ranks[word] = rank;
                rank += marks[word].count_ones() as u16;
            }
            vertices += usize::from(rank);
        }
        let count = vertices.max(triangles);
        if count > MAX_COUNT {
            return Err(IsosurfaceError::TooLarge { count, limit: MAX_COUNT });
        }
        meter.progress(1.0);
        Ok(Self { volume, marks, ranks, firsts, vertices, triangles })
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Writes [`vertices`](Self::vertices) positions in world coordinates, metres, and [`triangles`](Self::triangles)
    /// triples of indices into them, counter-clockwise seen from free space, to the front of the slices. Every vertex is
    /// used. A slice that is too short is an error, and nothing is written.
    pub fn write(
        &self,
        vertices: &mut [[f32; 3]],
        triangles: &mut [[u32; 3]],
    ) -> Result<(), IsosurfaceError> {
        if vertices.len() < self.vertices {
            return Err(IsosurfaceError::Vertices { needed: self.vertices, limit: vertices.len() });
        }
        if triangles.len() < self.triangles {
            return Err(IsosurfaceError::Triangles { needed: self.triangles, limit: triangles.len() });
        }
        let (mut vertex, mut triangle) = (0, 0);
        for block in 0..self.volume.blocks() {
            let around = Surroundings::of(self.volume, block);
            for word in 0..WORDS {
                let mut marks = self.marks[block * WORDS + word];
                while marks != 0 {
                    let place = word % (WORDS / 3) * 64 + marks.trailing_zeros() as usize;
                    vertices[vertex] = self.position(&around, block, place, word / (WORDS / 3));
                    vertex += 1;
                    marks &= marks - 1;
                }
            }
            for_each_cell(self.volume, &around, |cell, inside| {
                let case = &CASE[inside];
                let mut indices = [0; EDGES];
                for edge in (0..EDGES).filter(|edge| case.edges >> edge & 1 == 1) {
                    indices[edge] = self.index(edge_mark(&around, cell, edge));
                }
                for corners in &case.triangles[..usize::from(case.count).min(MAX_TRIANGLES)] {
                    triangles[triangle] = corners.map(|edge| indices[usize::from(edge)]);
                    triangle += 1;
                }
            });
        }
        Ok(())
    }

    /// Writes for each vertex, in the order of [`write`](Self::write), 1 if images show the surface there and 0 if it is
    /// part of a guess of [`Volume::complete`]. A slice that is too short is an error.
    pub fn write_seen(&self, seen: &mut [u8]) -> Result<(), IsosurfaceError> {
        if seen.len() < self.vertices {
            return Err(IsosurfaceError::Vertices { needed: self.vertices, limit: seen.len() });
        }
        let mut vertex = 0;
        for block in 0..self.volume.blocks() {
            let around = Surroundings::of(self.volume, block);
            for word in 0..WORDS {
                let mut marks = self.marks[block * WORDS + word];
                while marks != 0 {
                    let place = word % (WORDS / 3) * 64 + marks.trailing_zeros() as usize;
                    let [start, end] = self.ends(&around, block, place, word / (WORDS / 3));
                    seen[vertex] = u8::from(start.is_seen() && end.is_seen());
                    vertex += 1;
                    marks &= marks - 1;
                }
            }
        }
        Ok(())
    }

    /// The voxels at the ends of the edge that begins at voxel `place` of a block and runs along an axis.
    fn ends(&self, around: &Surroundings, block: usize, place: usize, axis: usize) -> [Voxel; 2] {
        let mut end = place_steps(place);
        end[axis] += 1;
        let (other, other_place) = around.locate(end);
        [self.volume.block(block).1[place], self.volume.block(other).1[other_place]]
    }

    /// Index of the vertex on a marked edge.
    #[inline]
    fn index(&self, (word, bit): (usize, u32)) -> u32 {
        let before = (self.marks[word] & ((1 << bit) - 1)).count_ones();
        self.firsts[word / WORDS] + u32::from(self.ranks[word]) + before
    }

    /// Where the distance is zero on the edge that begins at voxel `place` of a block and runs along an axis.
    fn position(&self, around: &Surroundings, block: usize, place: usize, axis: usize) -> [f32; 3] {
        let at = place_steps(place);
        let [start, end] = self.ends(around, block, place, axis).map(|voxel| f32::from(voxel.distance));
        let t = (start / (start - end)).clamp(END, 1.0 - END);
        let first = self.volume.block(block).0.first_voxel();
        [0, 1, 2].map(|i| {
            let along = if i == axis { t } else { 0.0 };
            ((first[i] + at[i]) as f32 - VOXEL_RANGE as f32 + along) * self.volume.settings().voxel
        })
    }
}

/// Steps of a voxel from the first one of its block.
#[inline]
fn place_steps(place: usize) -> [u32; 3] {
    [0, 1, 2].map(|i| place as u32 >> (3 * i) & (BLOCK - 1))
}

/// The word and the bit that mark an edge of a cell.
#[inline]
fn edge_mark(around: &Surroundings, cell: [u32; 3], edge: usize) -> (usize, u32) {
    let corner = edge_corner(edge) as u32;
    let (block, place) = around.locate([0, 1, 2].map(|i| cell[i] + (corner >> i & 1)));
    (block * WORDS + edge_axis(edge) * (WORDS / 3) + place / 64, place as u32 % 64)
}
