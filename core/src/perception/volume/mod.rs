//! Fusion of depth images into a truncated signed distance volume (Curless and Levoy, "A Volumetric Method for Building
//! Complex Models from Range Images", SIGGRAPH 1996) of sparse blocks that a hash table finds (Niessner et al.,
//! "Real-time 3D Reconstruction at Scale using Voxel Hashing", ACM Transactions on Graphics, 2013).
//!
//! Each voxel holds the mean distance to the surface along the cameras' axes, positive in front of it, cut off at the
//! truncation. A voxel in front of a surface by more than the truncation is free, a voxel behind it by more is not
//! touched, and a voxel that no image touched is unknown.
//!
//! A sparse volume stores the blocks around the surfaces. Beyond them, it cannot tell free from unknown. A dense volume
//! stores all of its crop box, and can.
//!
//! ```
//! use hangpose_core::{Monitor, geometry::{Point, Pose}};
//! use hangpose_core::perception::depth::{DepthCamera, DepthImage};
//! use hangpose_core::perception::{isosurface::Isosurface, volume::*};
//!
//! let camera = DepthCamera::new([64, 48], [60.0; 2], [31.5, 23.5], [0.0; 5])?;
//! let wall = [500; 64 * 48]; // Half a metre away, in millimetres.
//! let image = DepthImage::new(camera, &wall, 0.001, Pose::identity())?;
//!
//! let (settings, limits) = (VolumeSettings::new(0.01), VolumeLimits { blocks: 200 });
//! let mut memory = vec![0; Volume::bytes(&limits)];
//! let mut volume = Volume::new(&settings, &limits, &mut memory)?;
//! volume.integrate(&image, None, &Monitor::new())?;
//! assert!(matches!(volume.space(&Point::new(0.0, 0.0, 0.49)), Space::Surface(d) if (d - 0.01).abs() < 0.001));
//! assert_eq!(volume.space(&Point::new(0.0, 0.0, 0.6)), Space::Unknown);
//!
//! let mut memory = vec![0; Isosurface::bytes(volume.blocks())];
//! let surface = Isosurface::find(&volume, &mut memory, &Monitor::new())?;
//! let (mut vertices, mut triangles) = (vec![[0.0; 3]; surface.vertices()], vec![[0; 3]; surface.triangles()]);
//! surface.write(&mut vertices, &mut triangles)?;
//! assert!(vertices.iter().all(|[_, _, z]| (z - 0.5).abs() < 0.001));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod allocate;
pub(crate) mod blocks;
mod error;
mod fuse;
mod settings;
mod space;
#[cfg(test)]
mod tests;
pub(crate) mod voxel;

pub use error::VolumeError;
pub use settings::{VolumeSettings, VolumeSettingsError};
pub use space::Space;

use super::depth::{DepthImage, Mask};
use crate::Monitor;
use crate::memory::{Arena, array_bytes, model_bytes};
use crate::monitor::Meter;
use blocks::{BLOCK, BLOCK_VOXELS, Blocks, Key, place_in_block};
use fuse::Fusion;
use settings::Extent;
use voxel::Voxel;

/// Largest sizes for which a [`Volume`] reserves memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VolumeLimits {
    /// Blocks of 8 x 8 x 8 voxels, each about 2 KiB.
    pub blocks: usize,
}

/// A truncated signed distance volume in the caller's memory.
pub struct Volume<'m> {
    settings: VolumeSettings,
    extent: Extent,
    blocks: Blocks<'m>,
    /// [`BLOCK_VOXELS`] a block, x fastest.
    voxels: &'m mut [Voxel],
}

/// What fusing an image did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Integrated {
    /// Pixels with the mask's label and a surface within the volume. Zero says that the camera does not see the volume.
    pub pixels: usize,
    /// Blocks that were added.
    pub blocks: usize,
    /// Voxels that the image saw.
    pub voxels: usize,
}

impl<'m> Volume<'m> {
    /// Bytes of memory for a volume of these limits, about 2.1 KiB a block.
    pub const fn bytes(limits: &VolumeLimits) -> usize {
        let voxels = array_bytes::<Voxel>(limits.blocks.saturating_mul(BLOCK_VOXELS));
        model_bytes(Blocks::bytes(limits.blocks).saturating_add(voxels))
    }

    /// An empty volume in `memory` of at least [`bytes`](Self::bytes).
    pub fn new(
        settings: &VolumeSettings,
        limits: &VolumeLimits,
        memory: &'m mut [u8],
    ) -> Result<Self, VolumeError> {
        let extent = settings.extent()?;
        let needed = settings.dense_blocks().filter(|_| settings.dense);
        if let Some(needed) = needed.filter(|needed| *needed > limits.blocks) {
            return Err(VolumeError::DenseLimit { needed, limit: limits.blocks });
        }
        let mut arena = Arena::new(memory, Self::bytes(limits))?;
        let mut blocks = Blocks::new(limits.blocks, &mut arena)?;
        let voxels = arena.slice(limits.blocks * BLOCK_VOXELS)?;
        if settings.dense {
            let [first, last] = extent.blocks();
            for z in first[2]..=last[2] {
                for y in first[1]..=last[1] {
                    for x in first[0]..=last[0] {
                        blocks.insert(Key::of_block([x, y, z]));
                    }
                }
            }
        }
        Ok(Self { settings: *settings, extent, blocks, voxels })
    }

    /// Fuses an image. Pixels without a depth say nothing, unless [`VolumeSettings::missing_is_free`]. With a `mask`, surfaces are taken only from the pixels of its
    /// label; the others still show where space is free.
    ///
    /// A call that returns an error leaves the volume as it was, and so does one that meets the work limit, of which a pixel
    /// with a surface counts as one ray. A cancelled call may have fused a part of the image, as if a mask hid the rest.
    pub fn integrate(
        &mut self,
        image: &DepthImage,
        mask: Option<Mask>,
        monitor: &Monitor,
    ) -> Result<Integrated, VolumeError> {
        let mut meter = Meter::new(monitor);
        meter.check()?;
        if let Some(mask) = mask.filter(|mask| mask.labels.len() != image.depths().len()) {
            return Err(VolumeError::Mask { labels: mask.labels.len(), pixels: image.depths().len() });
        }
        let used = self.blocks.count();
        let found =
            allocate::allocate(&mut self.blocks, &self.settings, &self.extent, image, mask, &mut meter);
        let found = match found {
            Ok(found) if found.without_block == 0 => found,
            failed => {
                self.blocks.truncate(used);
                let (pixels, of) = failed.map(|found| (found.without_block, found.surface))?;
                return Err(VolumeError::Full { limit: self.blocks.limit(), used, pixels, of });
            }
        };
        let fusion = Fusion::new(&self.settings, &self.extent, image, mask);
        let mut voxels = 0;
        for (block, chunk) in self.voxels.chunks_exact_mut(BLOCK_VOXELS).enumerate().take(self.blocks.count())
        {
            meter.check_cancelled()?;
            voxels += fusion.update(self.blocks.key(block), chunk);
        }
        meter.progress(1.0);
        Ok(Integrated { pixels: found.surface, blocks: self.blocks.count() - used, voxels })
    }

    /// The settings.
    pub fn settings(&self) -> &VolumeSettings {
        &self.settings
    }

    /// Number of blocks in use.
    pub fn blocks(&self) -> usize {
        self.blocks.count()
    }

    /// The blocks in the order in which they were added: their keys and voxels.
    pub(crate) fn block(&self, block: usize) -> (Key, &[Voxel]) {
        (self.blocks.key(block), &self.voxels[block * BLOCK_VOXELS..][..BLOCK_VOXELS])
    }

    /// The first and the last voxel that the volume stores, along each axis.
    pub(crate) fn ends(&self) -> [[u32; 3]; 2] {
        [self.extent.first, self.extent.last]
    }

    /// All voxels, block by block.
    pub(crate) fn voxels(&self) -> &[Voxel] {
        self.voxels
    }

    pub(crate) fn voxels_mut(&mut self) -> &mut [Voxel] {
        self.voxels
    }

    /// Place of a voxel of a dense volume, which stores its blocks in the order of their coordinates.
    #[inline]
    pub(crate) fn dense_place(&self, voxel: [u32; 3]) -> usize {
        let [first, last] = self.extent.blocks();
        let [x, y, z] = [0, 1, 2].map(|i| (voxel[i] / BLOCK - first[i]) as usize);
        let [columns, rows] = [0, 1].map(|i| (last[i] - first[i] + 1) as usize);
        (x + columns * (y + rows * z)) * BLOCK_VOXELS + place_in_block(voxel)
    }

    /// The number of the block with this key.
    pub(crate) fn find(&self, key: Key) -> Option<usize> {
        self.blocks.find(key)
    }

    /// A voxel by its index along each axis, unseen where there is no block.
    fn voxel(&self, voxel: [u32; 3]) -> Voxel {
        match self.blocks.find(Key::of_voxel(voxel)) {
            Some(block) => self.voxels[block * BLOCK_VOXELS + place_in_block(voxel)],
            None => Voxel::default(),
        }
    }
}
