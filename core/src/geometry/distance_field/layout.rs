//! How fine the voxels are and which blocks hold bricks.

use super::brick::{BLOCK, BRICK_NODES};
use super::frame::Frame;
use super::{BAND, Entry, raster};
use crate::geometry::{Aabb, Point, Surface, Vector};
use crate::memory::larger;
use crate::monitor::{Meter, Stop};
use core::hint::black_box;

/// The most bricks of a field of `voxels` nodes. One is enough for any mesh.
pub(super) const fn max_bricks(voxels: usize) -> usize {
    let bricks = larger(voxels / BRICK_NODES, 1);
    if bricks < Entry::BRICK as usize { bricks } else { Entry::BRICK as usize }
}

/// The most blocks of a field of `voxels` nodes: as many bytes as the bricks take.
pub(super) const fn max_blocks(voxels: usize) -> usize {
    larger(voxels / 2, 8)
}

/// Largest number of voxels along the largest extent.
const FINEST: f32 = 400.0;
/// Largest number of blocks along an axis: those of the voxels along the largest extent, and what the band and rounding add.
pub(super) const MOST_BLOCKS_ALONG: usize = FINEST as usize / BLOCK as usize + 3;
/// Least voxel size, metres, unless the largest extent then has fewer than `FEWEST` voxels.
const FINEST_METRES: f32 = 0.8e-3;
/// Number of voxels along the largest extent up to which voxels may be finer than `FINEST_METRES`.
const FEWEST: f32 = 100.0;
/// Largest ratio of the largest coordinate to a voxel: `f32` then resolves a hundredth of a voxel.
const FINEST_COORDINATE: f32 = 65_536.0;

/// Distance from the mesh up to which bricks reach, voxels: the band, and a margin for rounding.
pub(super) const REACH: f32 = BAND + 0.01;
/// Voxel sizes tried at most to fill the memory better.
const TRIES: usize = 4;
/// Share of the bricks in use above which the voxel size is not refined.
const FULL: f32 = 0.85;

/// Where the blocks are.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    /// The corner of the first block, in metres.
    origin: Point,
    /// Edge length of a voxel, in metres.
    pub(super) voxel: f32,
    /// One over it.
    inverse: f32,
    /// Number of blocks along each axis.
    pub(super) blocks: [u32; 3],
    /// Number of voxels along each axis.
    cells: [f32; 3],
}

/// A mesh, and which of the blocks around it hold bricks.
#[derive(Clone, Copy)]
pub(super) struct Bricks<'a> {
    pub(super) surface: &'a Surface<'a>,
    pub(super) layout: &'a Layout,
    /// [`Entry`] of each block.
    pub(super) grid: &'a [u32],
    /// The block of each brick.
    pub(super) places: &'a [u32],
    /// Of the triangles of the surface.
    pub(super) frames: &'a [Frame],
}

impl Layout {
    /// Blocks around `aabb`; `None` if they are more than `max_blocks`.
    fn new(aabb: &Aabb, voxel: f32, max_blocks: usize) -> Option<Self> {
        let extents = aabb.extents() / voxel;
        let blocks = [0, 1, 2].map(|axis| {
            let blocks = libm::ceilf((extents[axis] + 2.0 * REACH) / BLOCK as f32);
            if blocks < 1e9 { blocks as u64 } else { u64::MAX }
        });
        let count = blocks.iter().fold(1_u64, |product, &n| product.saturating_mul(n));
        if count > max_blocks as u64 {
            return None;
        }
        debug_assert!(blocks.iter().all(|&n| n <= MOST_BLOCKS_ALONG as u64));
        let blocks = blocks.map(|n| n as u32);
        let cells = blocks.map(|n| (n * BLOCK) as f32);
        let origin = aabb.centre() - Vector::from(cells) * (0.5 * voxel);
        Some(Self { origin, voxel, inverse: 1.0 / voxel, blocks, cells })
    }

    /// The finest layout whose bricks are few enough, and how many those are. Writes the entries of the bricks to `grid`;
    /// all others are zero.
    pub(super) fn choose(
        surface: &Surface,
        voxels: usize,
        grid: &mut [u32],
        meter: &Meter,
    ) -> Result<(Self, usize), Stop> {
        let (max_bricks, max_blocks) = (max_bricks(voxels), max_blocks(voxels));
        let aabb = surface.aabb();
        let largest = aabb.extents().max();
        let farthest = aabb.min.coords.abs().max().max(aabb.max.coords.abs().max());
        let finest =
            (largest / FINEST).max(FINEST_METRES.min(largest / FEWEST)).max(farthest / FINEST_COORDINATE);
        // A plane at a random angle meets 3/2 blocks for each that would tile it, and the band adds to that.
        let area: f32 =
            surface.triangles().iter().map(|t| crate::geometry::scaled_normal(t).norm() * 0.5).sum();
        let side = BLOCK as f32;
        let an_area = (1.5 + 2.0 * REACH / side) / (side * side);
        let mut voxel = libm::sqrtf(area * an_area / max_bricks as f32).max(finest);
        // The finest that fits, and the coarsest that does not.
        let mut best = None::<(Self, usize)>;
        let mut too_fine = 0.0_f32;
        for round in 0.. {
            let found = match Self::new(&aabb, voxel, max_blocks) {
                Some(layout) => Some((layout, layout.mark(surface, grid, meter)?)),
                None => None,
            };
            let fill = found.map_or(1.2, |(_, bricks)| bricks as f32 / max_bricks as f32);
            let next = (voxel * libm::sqrtf(fill.max(0.1)) * 1.02).max(finest);
            if fill > 1.0 {
                too_fine = too_fine.max(voxel);
            } else {
                best = found;
                if voxel <= finest || fill > FULL || round >= TRIES {
                    break;
                }
            }
            voxel = match best {
                // Of bodies far apart, voxels that are a little coarser need no fewer bricks.
                None => next.max(if round < TRIES { voxel } else { voxel * 1.5 }),
                Some((best, _)) if round >= TRIES || best.voxel < 1.05 * too_fine => break,
                // What is known not to fit is not tried again.
                Some((best, _)) if next <= too_fine || next >= best.voxel => 0.5 * (best.voxel + too_fine),
                Some(_) => next,
            };
        }
        // Always found: voxels as large as the mesh need one block.
        let (layout, bricks) = best.unwrap_or((
            Self { origin: aabb.min, voxel, inverse: 1.0 / voxel, blocks: [1; 3], cells: [BLOCK as f32; 3] },
            0,
        ));
        if too_fine == voxel || layout.voxel != voxel {
            layout.mark(surface, grid, meter)?;
        }
        Ok((layout, bricks))
    }

    /// Gives every block that comes close to the mesh a brick, numbered in the order of the blocks, and returns how many
    /// they are.
    fn mark(&self, surface: &Surface, grid: &mut [u32], meter: &Meter) -> Result<usize, Stop> {
        let grid = &mut grid[..self.block_count()];
        grid.fill(0);
        for (step, corners) in surface.triangles().iter().enumerate() {
            meter.check_at(step)?;
            raster::visit_blocks(&self.local(corners), REACH, &self.blocks, |place| {
                grid[self.index(place)] = Entry::BRICK;
            });
        }
        let mut bricks = 0;
        for entry in grid {
            if *entry != 0 {
                *entry = Entry::Brick(bricks).pack();
                bricks += 1;
            }
        }
        Ok(bricks)
    }

    pub(super) fn block_count(&self) -> usize {
        self.blocks.iter().map(|&n| n as usize).product()
    }

    /// The index of the block at `place`.
    #[inline]
    pub(super) fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        (z as usize * self.blocks[1] as usize + y as usize) * self.blocks[0] as usize + x as usize
    }

    /// The place of the block of an index.
    pub(super) fn place(&self, block: usize) -> [u32; 3] {
        // At least one block stands along each axis, which the compiler cannot see.
        let (nx, ny) = (self.blocks[0].max(1) as usize, self.blocks[1].max(1) as usize);
        [(block % nx) as u32, (block / nx % ny) as u32, (block / nx / ny) as u32]
    }

    /// The block next to the one at `place`, along `axis` or against it; `None` at the end of the grid.
    pub(super) fn beside(&self, place: [u32; 3], axis: usize, forward: bool) -> Option<usize> {
        let mut place = place;
        place[axis] = place[axis].checked_add_signed(if forward { 1 } else { -1 })?;
        (place[axis] < self.blocks[axis]).then(|| self.index(place))
    }

    /// Where the first node of a block is, in voxels.
    pub(super) fn first_node(&self, block: usize) -> Vector {
        Vector::from(self.place(block).map(|i| (i * BLOCK) as f32))
    }

    /// The centre of a block, in voxels.
    pub(super) fn centre(&self, block: usize) -> Vector {
        self.first_node(block).add_scalar(BLOCK as f32 / 2.0)
    }

    /// Corners in voxels, from the origin of the grid.
    pub(super) fn local(&self, corners: &[Point; 3]) -> [Vector; 3] {
        corners.map(|corner| self.in_voxels(&corner))
    }

    #[inline]
    pub(super) fn in_voxels(&self, point: &Point) -> Vector {
        // Kept from becoming a vector whose spare lanes hold what was in the register: where that is no normal number, as an integer is
        // none, multiplying takes far longer.
        black_box(point - self.origin) * self.inverse
    }

    pub(super) fn in_object(&self, local: &Vector) -> Point {
        self.origin + local * self.voxel
    }

    /// The block that a point is in, and the first node of its cell in the brick; `None` outside of the grid.
    #[inline]
    pub(super) fn locate(&self, local: &Vector) -> Option<(usize, usize)> {
        if !(0..3).all(|axis| local[axis] >= 0.0 && local[axis] < self.cells[axis]) {
            return None;
        }
        let [x, y, z] = [0, 1, 2].map(|axis| local[axis] as u32);
        let block = self.index([x / BLOCK, y / BLOCK, z / BLOCK]);
        let cell = (x % BLOCK) + 5 * (y % BLOCK) + 25 * (z % BLOCK);
        Some((block, cell as usize))
    }

    /// The closest point that [`locate`](Self::locate) finds; all in voxels.
    pub(super) fn clamp(&self, local: &Vector) -> Vector {
        // Not a number counts as zero.
        Vector::from([0, 1, 2].map(|axis| local[axis].max(0.0).min(self.cells[axis] - 1e-3)))
    }
}
