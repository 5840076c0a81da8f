//! The cells of a block through which the surface passes.

use super::super::volume::Volume;
use super::super::volume::blocks::{BLOCK, BLOCK_VOXELS, Key, place_in_block};
use super::super::volume::voxel::Voxel;

/// Voxels along the edge of a block and the one after.
const NODES: usize = BLOCK as usize + 1;
const ROW: usize = BLOCK as usize;
/// Stands for a block that is not stored.
const NO_BLOCK: usize = usize::MAX;

/// A block and its neighbours towards greater coordinates, by their numbers: bit 0 of the index is a step along x, bit 1
/// along y, bit 2 along z.
pub(super) struct Surroundings([usize; 8]);

impl Surroundings {
    pub(super) fn of(volume: &Volume, block: usize) -> Self {
        let first = volume.block(block).0.first_voxel();
        let mut blocks = [NO_BLOCK; 8];
        blocks[0] = block;
        for (index, number) in blocks.iter_mut().enumerate().skip(1) {
            let step = |i: usize| (index as u32 >> i & 1) * BLOCK;
            let key = Key::of_voxel([0, 1, 2].map(|i| first[i] + step(i)));
            *number = volume.find(key).unwrap_or(NO_BLOCK);
        }
        Self(blocks)
    }

    /// The block and the place in it of a voxel, given by its steps from the first one of the block in the middle: 0 to 8.
    #[inline]
    pub(super) fn locate(&self, steps: [u32; 3]) -> (usize, usize) {
        let index = (steps[0] / BLOCK) | (steps[1] / BLOCK) << 1 | (steps[2] / BLOCK) << 2;
        (self.0[index as usize], place_in_block(steps))
    }
}

/// Nine voxels in a row along x, a bit each.
#[derive(Clone, Copy, Default)]
struct Row {
    known: u16,
    inside: u16,
}

impl Row {
    fn of(voxels: &[Voxel]) -> Self {
        let mut row = Self::default();
        for (i, voxel) in voxels.iter().enumerate() {
            row.known |= u16::from(voxel.is_known()) << i;
            row.inside |= u16::from(voxel.distance < 0) << i;
        }
        row
    }
}

/// Calls `visit` with each cell of the block that has corners inside and outside, all of them known: its first voxel's
/// steps in the block, and its corners inside, as in [`CASE`](super::table::CASE).
#[inline]
pub(super) fn for_each_cell(volume: &Volume, around: &Surroundings, mut visit: impl FnMut([u32; 3], usize)) {
    let mut rows = [[Row::default(); NODES]; NODES];
    for (z, plane) in rows.iter_mut().enumerate() {
        for (y, row) in plane.iter_mut().enumerate() {
            let index = (y / ROW) << 1 | (z / ROW) << 2;
            let place = ROW * (y % ROW + ROW * (z % ROW));
            let voxels = |block: usize, count: usize| match around.0[block] {
                NO_BLOCK => Row::default(),
                number => Row::of(&volume.block(number).1[place..place + count]),
            };
            let (near, far) = (voxels(index, ROW), voxels(index | 1, 1));
            *row = Row { known: near.known | far.known << ROW, inside: near.inside | far.inside << ROW };
        }
    }
    for z in 0..ROW {
        for y in 0..ROW {
            let edges = [rows[z][y], rows[z][y + 1], rows[z + 1][y], rows[z + 1][y + 1]];
            let all = |get: fn(&Row) -> u16| edges.iter().fold(u16::MAX, |bits, row| bits & get(row));
            let (known, inside) = (all(|row| row.known), all(|row| row.inside));
            let some = edges.iter().fold(0, |bits, row| bits | row.inside);
            let mut cells = known & known >> 1 & (some | some >> 1) & !(inside & inside >> 1) & 0xFF;
            while cells != 0 {
                let x = cells.trailing_zeros();
                let corners = (0..4)
                    .fold(0, |corners, i| corners | usize::from(edges[i].inside >> x & 0b11) << (2 * i));
                visit([x, y as u32, z as u32], corners);
                cells &= cells - 1;
            }
        }
    }
}

const _: () = assert!(ROW * ROW * ROW == BLOCK_VOXELS);
