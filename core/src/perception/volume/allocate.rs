//! Which blocks an image needs: those within the truncation of what its pixels see, along their rays.

use super::blocks::{BLOCK, Blocks, Key, VOXEL_RANGE};
use super::settings::{Extent, TRUNCATIONS};
use super::{VolumeError, VolumeSettings};
use crate::geometry::Vector;
use crate::monitor::Meter;
use crate::perception::depth::{DepthImage, Mask, NOTHING};

/// Greatest distance between two samples of a ray, voxels. A block is twice as wide, so its part near a surface is sampled by
/// the ray of some pixel.
const STEP: f32 = BLOCK as f32 / 2.0;
/// Most samples of a ray.
const MAX_SAMPLES: usize = (2.0 * TRUNCATIONS[1] / STEP) as usize + 1;

/// Pixels of an image.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    /// With a surface in the volume.
    pub(super) surface: usize,
    /// Of these, without a block.
    pub(super) without_block: usize,
}

/// Adds the blocks that the image needs. Where there is no room for a block, it goes on and counts the pixels.
pub(super) fn allocate(
    blocks: &mut Blocks,
    settings: &VolumeSettings,
    extent: &Extent,
    image: &DepthImage,
    mask: Option<Mask>,
    meter: &mut Meter,
) -> Result<Found, VolumeError> {
    let samples = 2 * libm::ceilf(settings.truncation / settings.voxel / STEP) as usize + 1;
    let offset = |sample: usize| {
        settings.truncation * ((2 * sample) as f32 / (samples - 1) as f32 - 1.0) / settings.voxel
    };
    let mut offsets = [0.0; MAX_SAMPLES];
    (0..samples).for_each(|sample| offsets[sample] = offset(sample));
    let offsets = &offsets[..samples];

    let rotation = image.pose().rotation.to_rotation_matrix();
    let to_voxels = 1.0 / settings.voxel;
    let viewpoint = image.viewpoint().coords * to_voxels + Vector::repeat(0.5 + VOXEL_RANGE as f32);
    let [width, height] = image.camera().size();
    // Neighbouring pixels mostly need the same blocks.
    let mut last = [Key::NONE; MAX_SAMPLES];
    let mut found = Found::default();
    for v in 0..height {
        meter.progress(v as f32 / height as f32);
        let before = found.surface;
        let first = v as usize * width as usize;
        for (u, raw) in image.depths()[first..first + width as usize].iter().enumerate() {
            let depth = f32::from(*raw) * image.scale();
            if matches!(*raw, 0 | NOTHING)
                || depth > settings.max_depth
                || mask.is_some_and(|mask| !mask.holds(first + u))
            {
                continue;
            }
            let [x, y] = image.camera().direction([u as f32, v as f32]);
            let direction = rotation * Vector::new(x, y, 1.0);
            let depth = depth * to_voxels;
            let Some(seen) = voxel_at(&(viewpoint + direction * depth), extent) else { continue };
            found.surface += 1;
            let mut has_blocks = true;
            for (offset, last) in offsets.iter().zip(&mut last) {
                let voxel = match *offset {
                    0.0 => Some(seen),
                    offset => voxel_at(&(viewpoint + direction * (depth + offset)), extent),
                };
                let Some(voxel) = voxel else { continue };
                let key = Key::of_voxel(voxel);
                if key != *last {
                    if blocks.insert(key) {
                        *last = key;
                    } else {
                        has_blocks = false;
                    }
                }
            }
            found.without_block += usize::from(!has_blocks);
        }
        meter.rays(found.surface - before)?;
    }
    Ok(found)
}

/// The voxel nearest to a position, which is in voxels, shifted by half a voxel and the index of the origin; `None` outside of
/// the extent.
#[inline]
fn voxel_at(position: &Vector, extent: &Extent) -> Option<[u32; 3]> {
    // The conversion takes negative numbers to zero, which is outside of every extent.
    let voxel = [position.x as u32, position.y as u32, position.z as u32];
    (0..3).all(|i| extent.first[i] <= voxel[i] && voxel[i] <= extent.last[i]).then_some(voxel)
}
