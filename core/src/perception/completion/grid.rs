//! The voxels of a dense volume as one array, and what is known of each.

use crate::perception::volume::Volume;
use crate::perception::volume::voxel::Voxel;

/// What is known of a voxel, and what is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Nothing is known: it is to be guessed.
    Unknown,
    /// Seen in front of all surfaces, or at the border of the volume.
    Outside,
    /// Seen behind a surface, too deep to be certain: it is to be guessed.
    Behind,
    /// Seen just behind a surface.
    Surface,
}

impl State {
    const ALL: [Self; 4] = [Self::Unknown, Self::Outside, Self::Behind, Self::Surface];

    pub(super) fn of(number: u8) -> Self {
        Self::ALL[usize::from(number) % Self::ALL.len()]
    }
}

/// The voxels of a dense volume, numbered with the x index the fastest.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    first: [u32; 3],
    pub(super) size: [usize; 3],
}

impl Grid {
    pub(super) fn of(volume: &Volume) -> Self {
        let [first, last] = volume.ends();
        Self { first, size: [0, 1, 2].map(|i| (last[i] - first[i] + 1) as usize) }
    }

    pub(super) fn count(&self) -> usize {
        self.size.iter().product()
    }

    /// The steps of a voxel from the first one along each axis.
    #[inline]
    pub(super) fn steps(&self, index: usize) -> [usize; 3] {
        // At least one voxel stands along each axis, which the compiler cannot see.
        let [x, y, _] = self.size.map(|count| count.max(1));
        [index % x, index / x % y, index / x / y]
    }

    /// Whether a voxel has six neighbours.
    #[inline]
    pub(super) fn is_within(&self, steps: [usize; 3]) -> bool {
        (0..3).all(|i| steps[i] > 0 && steps[i] + 1 < self.size[i])
    }

    /// How far the numbers of neighbours along each axis are apart.
    #[inline]
    pub(super) fn strides(&self) -> [usize; 3] {
        [1, self.size[0], self.size[0] * self.size[1]]
    }

    /// The way from one voxel to another, voxels.
    #[inline]
    pub(super) fn way(&self, from: usize, to: usize) -> [f32; 3] {
        let (from, to) = (self.steps(from), self.steps(to));
        [0, 1, 2].map(|i| to[i] as f32 - from[i] as f32)
    }

    /// Distance between two voxels, voxels.
    #[inline]
    pub(super) fn distance(&self, from: usize, to: usize) -> f32 {
        let way = self.way(from, to);
        libm::sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2])
    }

    /// The place of a voxel in the volume.
    #[inline]
    pub(super) fn place(&self, volume: &Volume, index: usize) -> usize {
        let steps = self.steps(index);
        volume.dense_place([0, 1, 2].map(|i| self.first[i] + steps[i] as u32))
    }

    #[inline]
    pub(super) fn voxel(&self, volume: &Volume, index: usize) -> Voxel {
        volume.voxels()[self.place(volume, index)]
    }

    /// The six neighbours of a voxel that has them.
    #[inline]
    pub(super) fn neighbours(&self, index: usize) -> [usize; 6] {
        let [x, y, z] = self.strides();
        [index - x, index + x, index - y, index + y, index - z, index + z]
    }
}
