//! Signed distance field of a mesh, sampled once, so that a query takes nanoseconds.
//!
//! Space around the mesh is cut into blocks of four voxels a side. A block that the mesh, or a band around it, passes
//! through holds a brick: the distances at its 5 x 5 x 5 nodes, which are interpolated. Any other block holds one
//! distance, a lower bound for all points in it.
//!
//! Built in four steps, a file each: which blocks hold bricks and how fine the voxels are ([`layout`]), how far the
//! nodes are from the mesh ([`nearest`]), on which side of it ([`sign`]), and how far the blocks without bricks are
//! ([`far`]).

mod brick;
mod far;
mod frame;
mod layout;
mod nearest;
mod raster;
mod sign;
#[cfg(test)]
mod tests;

use crate::geometry::{Aabb, Point, Surface, Vector, unit_or};
use crate::memory::{Arena, array_bytes, larger};
use crate::monitor::{Meter, Unfinished};
use brick::{BLOCK, BRICK_NODES};
use core::hint::black_box;
use far::Far;
use frame::Frame;
use layout::{Bricks, Layout};

/// Signed distances to a mesh around it, in object coordinates: an approximation of [`Surface::signed_distance`] by
/// interpolation.
///
/// Within [`band`](Self::band) of the mesh they are off by a few hundredths of a voxel where the mesh is flat or curves over
/// many voxels, and by about half a voxel at sharp edges and where another side is as close. In walls thinner than a voxel
/// it may be the thickness of the wall, and the wall may be lost. Beyond the band they are on the safe side: never further
/// from zero than the distance is.
///
/// [`Surface::is_inside`] defines the inside. Around a closed mesh the sign is right wherever the distance is more
/// than that error. Around an open one the inside ends somewhere in the opening; there the sign may change a block, four
/// voxels, too early or late.
#[derive(Clone, Copy)]
pub struct DistanceField<'m> {
    layout: Layout,
    /// The box around the mesh, in voxels from the origin of the grid. Nothing outside of it is inside of the mesh.
    aabb: Aabb,
    /// One [`Entry`] a block, x fastest.
    grid: &'m [u32],
    /// [`BRICK_NODES`] distances a brick, x fastest, in units of [`QUANTUM`] voxels.
    nodes: &'m [i16],
}

/// Distances within this many voxels of the mesh are interpolated.
const BAND: f32 = 1.0;
/// Constant part by which distances beyond the band are understated, voxels: more than interpolation, or missing the nearest
/// of many small triangles, may overstate them by.
const MARGIN: f32 = 0.3;
/// Relative part by which distances beyond the band are understated.
const MARGIN_PART: f32 = 0.1;
/// Resolution of stored distances, voxels. It fits an `i16`, because no node of a brick is eight voxels off the mesh.
const QUANTUM: f32 = 1.0 / 4096.0;

/// Largest excess of a positive distance over that from the mesh, in voxels: the distances of the eight corners of a voxel exceed that of a
/// point in it by no more than the ways to them, √3/2 in the mean at its middle.
const EXCESS: f32 = 0.867;

/// What a block holds, packed into a `u32`.
enum Entry {
    /// The brick of this index.
    Brick(usize),
    /// No brick. All of the mesh is at least this many voxels from the block's centre; negative inside.
    Far(f32),
}

impl Entry {
    const BRICK: u32 = 1 << 31;

    fn pack(&self) -> u32 {
        match *self {
            Self::Brick(index) => Self::BRICK | index as u32,
            // The sign takes the place of the last bit: a little closer to zero.
            Self::Far(distance) => distance.abs().to_bits() & !1 | u32::from(distance < 0.0),
        }
    }

    #[inline]
    fn unpack(packed: u32) -> Self {
        if packed & Self::BRICK != 0 {
            Self::Brick((packed & !Self::BRICK) as usize)
        } else {
            let distance = f32::from_bits(packed & !1);
            Self::Far(if packed & 1 == 0 { distance } else { -distance })
        }
    }
}

impl<'m> DistanceField<'m> {
    /// Bytes for a field of at most `voxels` nodes.
    pub(crate) const fn bytes(voxels: usize) -> usize {
        array_bytes::<u32>(layout::max_blocks(voxels))
            .saturating_add(array_bytes::<i16>(layout::max_bricks(voxels).saturating_mul(BRICK_NODES)))
    }

    /// Bytes of working memory for building it over `triangles`.
    pub(crate) const fn scratch_bytes(triangles: usize, voxels: usize) -> usize {
        let (bricks, blocks) = (layout::max_bricks(voxels), layout::max_blocks(voxels));
        let in_sign = sign::scratch_bytes(bricks, blocks);
        array_bytes::<Frame>(triangles)
            .saturating_add(nearest::bytes(bricks))
            .saturating_add(array_bytes::<u8>(blocks))
            .saturating_add(larger(in_sign, far::scratch_bytes(blocks)))
    }

    /// Samples the distances to `surface` with at most `voxels` nodes, in voxels as fine as that allows but no finer than
    /// a four-hundredth of the largest extent or 0.3 mm.
    pub(crate) fn build(
        surface: &Surface,
        voxels: usize,
        arena: &mut Arena<'m>,
        meter: &mut Meter,
    ) -> Result<Self, Unfinished> {
        let grid = arena.slice::<u32>(layout::max_blocks(voxels))?;
        let (layout, bricks) = Layout::choose(surface, voxels, grid, meter)?;
        let (grid, _) = grid.split_at_mut(layout.block_count());
        let nodes = arena.slice::<i16>(bricks * BRICK_NODES)?;

        let mut scratch = arena.scratch();
        let frames = scratch.slice::<Frame>(surface.triangles().len())?;
        for (step, (frame, corners)) in frames.iter_mut().zip(surface.triangles()).enumerate() {
            meter.check_at(step)?;
            *frame = Frame::of(&layout.local(corners));
        }
        let (mut nearest, places) = nearest::Nearest::new(grid, bricks, &mut scratch)?;
        let bricks = Bricks { surface, layout: &layout, grid, places, frames };
        nearest.seed(&bricks, meter)?;
        nearest.spread(&bricks, meter)?;

        let far_signs = scratch.slice::<u8>(grid.len())?;
        sign::find(&bricks, &nearest, nodes, far_signs, scratch.scratch(), meter)?;
        Far { layout: &layout, grid, nearest: &nearest, frames, signs: far_signs }.fill(scratch, meter)?;
        let Aabb { min, max } = surface.aabb();
        let aabb = Aabb { min: layout.in_voxels(&min).into(), max: layout.in_voxels(&max).into() };
        Ok(Self { layout, aabb, grid, nodes })
    }

    /// Edge length of a voxel, in metres.
    pub fn voxel_size(&self) -> f32 {
        self.layout.voxel
    }

    /// Up to this distance from the mesh, in metres, [`sample`](Self::sample) and [`distance`](Self::distance) are
    /// interpolated. Further away they are only on the safe side.
    pub fn band(&self) -> f32 {
        BAND * self.layout.voxel
    }

    /// By how much a positive distance may exceed that from the mesh, metres, as in walls that are thinner than a voxel.
    pub(crate) fn excess(&self) -> f32 {
        EXCESS * self.layout.voxel
    }

    /// Signed distance in metres, negative inside, and its gradient, which is of unit length, or zero where there is none.
    pub fn sample(&self, point: &Point) -> (f32, Vector) {
        let local = self.layout.in_voxels(point);
        match self.layout.locate(&local) {
            Some(at) => self.sample_at(&local, at),
            None => self.sample_outside(&local),
        }
    }

    /// The same as [`sample`](Self::sample) where the distance is interpolated, which it is all over the band, or else only a bound of
    /// the distance, in metres: what is looked for at the surface need not know which way it is from afar.
    pub(crate) fn sample_near(&self, point: &Point) -> Result<(f32, Vector), f32> {
        let local = self.layout.in_voxels(point);
        match self.layout.locate(&local) {
            None => Err(self.distance(point)),
            Some(at) => match Entry::unpack(self.grid[at.0]) {
                Entry::Far(distance) => Err(self.bound(&local, distance)),
                Entry::Brick(_) => Ok(self.sample_at(&local, at)),
            },
        }
    }

    /// How far it is at least from `point` to where the distance is interpolated, metres.
    pub(crate) fn way_to_bricks(&self, point: &Point) -> f32 {
        let local = self.layout.in_voxels(point);
        let Some((block, _)) = self.layout.locate(&local) else {
            return (local - self.layout.clamp(&local)).norm() * self.layout.voxel;
        };
        // How far the blocks before, here and behind are along each axis, squared; at the border there are none.
        let squares = [0, 1, 2].map(|axis| {
            let last = self.layout.blocks[axis] - 1;
            let place = local[axis] as u32 / BLOCK;
            let before = local[axis] - (place * BLOCK) as f32;
            let behind = BLOCK as f32 - before;
            let square = |gap: f32, is_none: bool| if is_none { f32::INFINITY } else { gap * gap };
            [square(before, place == 0), 0.0, square(behind, place == last)]
        });
        // Of the next blocks but one nothing is known.
        let mut least = BLOCK as f32 * BLOCK as f32;
        let layer = (self.layout.blocks[0] * self.layout.blocks[1]) as usize;
        for (z, square_z) in squares[2].into_iter().enumerate() {
            for (y, square_y) in squares[1].into_iter().enumerate() {
                for (x, square_x) in squares[0].into_iter().enumerate() {
                    let square = square_x + square_y + square_z;
                    if square < least {
                        let ahead = block + x + y * self.layout.blocks[0] as usize + z * layer;
                        let next = ahead - 1 - self.layout.blocks[0] as usize - layer;
                        if let Entry::Brick(_) = Entry::unpack(self.grid[next]) {
                            least = square;
                        }
                    }
                }
            }
        }
        libm::sqrtf(least) * self.layout.voxel
    }

    /// The same distance as [`sample`](Self::sample) gives, in metres, without the gradient.
    pub fn distance(&self, point: &Point) -> f32 {
        let local = self.layout.in_voxels(point);
        match self.layout.locate(&local) {
            Some(at) => self.distance_at(&local, at),
            None => {
                let on_grid = self.layout.clamp(&local);
                let way = black_box(local - on_grid) * self.layout.voxel;
                let rest = self.layout.locate(&on_grid).map_or(0.0, |at| self.distance_at(&on_grid, at));
                let rest = rest.max(0.0);
                libm::sqrtf(black_box(way).norm_squared() + rest * rest)
            }
        }
    }

    /// [`distance`](Self::distance) in the grid, in a block and a cell of it.
    #[inline]
    fn distance_at(&self, local: &Vector, (block, cell): (usize, usize)) -> f32 {
        match Entry::unpack(self.grid[block]) {
            Entry::Brick(brick) => {
                let t = fractions(local);
                let [x00, x10, x01, x11] = along_x(&self.cell(brick, cell), t[0]);
                let (y0, y1) = (x00 + (x10 - x00) * t[1], x01 + (x11 - x01) * t[1]);
                self.in_metres(y0 + (y1 - y0) * t[2])
            }
            Entry::Far(distance) => self.bound(local, distance),
        }
    }

    /// [`sample`](Self::sample) in the grid, in a block and a cell of it.
    #[inline]
    fn sample_at(&self, local: &Vector, (block, cell): (usize, usize)) -> (f32, Vector) {
        match Entry::unpack(self.grid[block]) {
            Entry::Brick(brick) => {
                let corners = self.cell(brick, cell);
                let t = fractions(local);
                // Along x, then y, then z; and the differences across, each between the two others.
                let [x00, x10, x01, x11] = along_x(&corners, t[0]);
                let (y0, y1) = (x00 + (x10 - x00) * t[1], x01 + (x11 - x01) * t[1]);
                let [d00, d10, d01, d11] = [0, 2, 4, 6].map(|i| corners[i + 1] - corners[i]);
                let (dx0, dx1) = (d00 + (d10 - d00) * t[1], d01 + (d11 - d01) * t[1]);
                let (dy0, dy1) = (x10 - x00, x11 - x01);
                let gradient = Vector::new(dx0 + (dx1 - dx0) * t[2], dy0 + (dy1 - dy0) * t[2], y1 - y0);
                (self.in_metres(y0 + (y1 - y0) * t[2]), unit_or(gradient, Vector::zeros()))
            }
            Entry::Far(distance) => (self.bound(local, distance), self.slope(block)),
        }
    }

    /// Outside of the grid: all of the mesh is beyond the closest point of the grid, and no closer to it than the field
    /// says there. The way there and the way on from there are at a right angle or more.
    #[cold]
    fn sample_outside(&self, local: &Vector) -> (f32, Vector) {
        let on_grid = self.layout.clamp(local);
        let way = (local - on_grid) * self.layout.voxel;
        let Some(at) = self.layout.locate(&on_grid) else { return (way.norm(), Vector::zeros()) };
        let (rest, slope) = self.sample_at(&on_grid, at);
        let rest = rest.max(0.0);
        (libm::sqrtf(way.norm_squared() + rest * rest), unit_or(way + slope * rest, Vector::zeros()))
    }

    /// The eight corners of a cell, x fastest.
    #[inline]
    fn cell(&self, brick: usize, cell: usize) -> [f32; 8] {
        let first = brick * BRICK_NODES + cell;
        let nodes = &self.nodes[first..first + 32];
        [0, 1, 5, 6, 25, 26, 30, 31].map(|i| f32::from(nodes[i]))
    }

    /// An interpolated value in metres, understated where it is beyond the band.
    #[inline]
    fn in_metres(&self, value: f32) -> f32 {
        let value = value * QUANTUM;
        let size = value.abs();
        let size = if size > BAND { understated(size).max(BAND) } else { size };
        size.copysign(value) * self.layout.voxel
    }

    /// What is certain of the distance in a block without a brick, in metres.
    #[inline]
    fn bound(&self, local: &Vector, distance: f32) -> f32 {
        const HALF: f32 = BLOCK as f32 / 2.0;
        let off_centre =
            [0, 1, 2].map(|axis| local[axis] - (local[axis] as u32 / BLOCK * BLOCK) as f32 - HALF);
        let square =
            off_centre[0] * off_centre[0] + off_centre[1] * off_centre[1] + off_centre[2] * off_centre[2];
        let off_centre = libm::sqrtf(square);
        let size = (distance.abs() - off_centre).max(BAND) * self.layout.voxel;
        // A block that is inside may reach out of the box, through the opening of an open mesh.
        if distance < 0.0 && self.aabb.contains(&Point::from(*local)) { -size } else { size }
    }

    /// Which way distances grow around a block without a brick.
    fn slope(&self, block: usize) -> Vector {
        let place = self.layout.place(block);
        let value = |axis: usize, step: i32| {
            let mut place = place;
            place[axis] = place[axis].saturating_add_signed(step).min(self.layout.blocks[axis] - 1);
            match Entry::unpack(self.grid[self.layout.index(place)]) {
                Entry::Brick(index) => f32::from(self.nodes[index * BRICK_NODES + BRICK_NODES / 2]) * QUANTUM,
                Entry::Far(distance) => distance,
            }
        };
        let slope = Vector::from([0, 1, 2].map(|axis| value(axis, 1) - value(axis, -1)));
        unit_or(slope, Vector::zeros())
    }
}

/// What is certain of a distance beyond the band, in voxels.
#[inline]
fn understated(distance: f32) -> f32 {
    distance - MARGIN - MARGIN_PART * distance
}

/// Interpolates between the corners of a cell along its four edges in x.
#[inline]
fn along_x(corners: &[f32; 8], t: f32) -> [f32; 4] {
    [0, 2, 4, 6].map(|i| corners[i] + (corners[i + 1] - corners[i]) * t)
}

/// How far into its cell a point is, along each axis; `local` is not negative.
#[inline]
fn fractions(local: &Vector) -> [f32; 3] {
    [0, 1, 2].map(|axis| local[axis] - (local[axis] as u32) as f32)
}

const _: () = assert!(BLOCK == 4 && BRICK_NODES == 125);
