//! What a volume covers and how finely.

use super::blocks::{BLOCK, VOXEL_RANGE};
use crate::geometry::Aabb;

/// Truncation of [`VolumeSettings::new`], voxels: the noise of a depth camera at arm's length fits into it with voxels of
/// its pixels' size, and walls of that thickness keep both sides.
const TRUNCATION: f32 = 4.0;
/// Depth beyond which [`VolumeSettings::new`] doubts a camera, metres: the noise of structured light and of stereo is
/// several centimetres there.
const MAX_DEPTH: f32 = 5.0;
/// Least and greatest truncation, voxels. Below, a surface may pass between two voxels that see no change of sign; above,
/// the blocks around a surface take more memory than any noise is worth.
pub(super) const TRUNCATIONS: [f32; 2] = [2.0, 32.0];

/// Resolution and extent of a [`Volume`](super::Volume).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeSettings {
    /// Distance between neighbouring voxels, metres. The voxels are at its integer multiples in world coordinates.
    pub voxel: f32,
    /// Distance from the surface at which distances are cut off, metres: 2 to 32 voxels. Larger values bear more noise;
    /// walls thinner than half of it become thicker than they are.
    pub truncation: f32,
    /// Box in world coordinates, metres, outside of which nothing is stored; `None` for everything within 32767 voxels of
    /// the origin.
    pub crop: Option<Aabb>,
    /// Whether all of the crop box is stored, not only the surroundings of the surfaces. Then what the cameras saw free is
    /// known in all of it. It needs [`dense_blocks`](Self::dense_blocks) blocks.
    pub dense: bool,
    /// Depth along the camera's z axis beyond which surfaces are not stored, metres. What is before them is still free.
    pub max_depth: f32,
    /// Whether a camera sees past everything at pixels without a depth, except for gaps of up to 7 pixels between pixels
    /// with one. It holds for an object that is held alone, with nothing behind it within the camera's range. Where a
    /// surface returns no light, because it absorbs or mirrors it or is seen at a grazing angle, it is taken for free space
    /// if no other image shows it.
    pub missing_is_free: bool,
}

/// Why settings do not describe a volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VolumeSettingsError {
    /// The voxel size is not a positive number, or so large that the volume would be infinite.
    Voxel {
        /// Size given, metres.
        voxel: f32,
    },
    /// The truncation is not 2 to 32 voxels.
    Truncation {
        /// Truncation given, metres.
        truncation: f32,
        /// Least and greatest truncation for this voxel size, metres.
        range: [f32; 2],
    },
    /// The crop box has no voxel in it: its corners are swapped, or it is thinner than a voxel.
    EmptyCrop {
        /// Box given, metres.
        crop: Aabb,
    },
    /// A corner of the crop box is not a number or too far from the origin for the voxel size.
    FarCrop {
        /// Box given, metres.
        crop: Aabb,
        /// Greatest absolute coordinate for this voxel size, metres.
        limit: f32,
    },
    /// A dense volume has no crop box.
    DenseWithoutCrop,
    /// The greatest depth is not a positive number.
    MaxDepth {
        /// Depth given, metres.
        max_depth: f32,
    },
}

impl core::fmt::Display for VolumeSettingsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Voxel { voxel } => {
                write!(
                    f,
                    "the voxel size {voxel} must be a positive number of metres below 1e34, such as 0.002"
                )
            }
            Self::Truncation { truncation, range: [least, greatest] } => write!(
                f,
                "the truncation {truncation} m must be 2 to 32 voxels, here {least} to {greatest} m: 4 voxels suit most cameras"
            ),
            Self::EmptyCrop { crop: Aabb { min, max } } => write!(
                f,
                "the crop box from {:?} to {:?} holds no voxel: give the corner with the least coordinates first, and metres",
                <[f32; 3]>::from(*min),
                <[f32; 3]>::from(*max)
            ),
            Self::FarCrop { crop: Aabb { min, max }, limit } => write!(
                f,
                "the crop box from {:?} to {:?} must lie within ±{limit} m with these voxels: move the origin of the world nearer, or take larger voxels",
                <[f32; 3]>::from(*min),
                <[f32; 3]>::from(*max)
            ),
            Self::DenseWithoutCrop => {
                write!(f, "a dense volume needs a crop box: give one, or a sparse volume")
            }
            Self::MaxDepth { max_depth } => {
                write!(f, "the greatest depth {max_depth} must be a positive number of metres")
            }
        }
    }
}

impl core::error::Error for VolumeSettingsError {}

/// Voxels from `first` to `last` along each axis, both included; the origin of the world has the index
/// [`VOXEL_RANGE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    pub(super) first: [u32; 3],
    pub(super) last: [u32; 3],
}

impl Extent {
    /// Coordinates of the blocks at the two ends.
    pub(super) fn blocks(&self) -> [[u32; 3]; 2] {
        [self.first.map(|x| x / BLOCK), self.last.map(|x| x / BLOCK)]
    }
}

impl VolumeSettings {
    /// A sparse volume of voxels of this size, metres, with a truncation of four voxels and without a crop box, for
    /// surfaces up to 5 m away.
    pub const fn new(voxel: f32) -> Self {
        Self {
            voxel,
            truncation: TRUNCATION * voxel,
            crop: None,
            dense: false,
            max_depth: MAX_DEPTH,
            missing_is_free: false,
        }
    }

    /// Checks all values.
    pub fn validate(&self) -> Result<(), VolumeSettingsError> {
        self.extent().map(|_| ())
    }

    /// Number of blocks of 8 x 8 x 8 voxels that a dense volume takes; `None` without a usable crop box.
    pub fn dense_blocks(&self) -> Option<usize> {
        let [first, last] = self.extent().ok().filter(|_| self.crop.is_some())?.blocks();
        // At most 2^39, more than 32 bits can address.
        let count = (0..3).map(|i| u64::from(last[i] - first[i] + 1)).product::<u64>();
        Some(usize::try_from(count).unwrap_or(usize::MAX))
    }

    /// The voxels that the volume stores.
    pub(super) fn extent(&self) -> Result<Extent, VolumeSettingsError> {
        let Self { voxel, truncation, crop, dense, max_depth, .. } = *self;
        // The whole range of voxels has a size in metres, so that neither a truncation nor a corner can be infinite.
        let span = VOXEL_RANGE as f32 * voxel;
        if !(voxel.is_normal() && voxel > 0.0 && (1.0 / voxel).is_normal() && span.is_finite()) {
            return Err(VolumeSettingsError::Voxel { voxel });
        }
        let range = TRUNCATIONS.map(|t| t * voxel);
        if !(range[0] <= truncation && truncation <= range[1]) {
            return Err(VolumeSettingsError::Truncation { truncation, range });
        }
        if max_depth.is_nan() || max_depth <= 0.0 {
            return Err(VolumeSettingsError::MaxDepth { max_depth });
        }
        let Some(crop) = crop else {
            if dense {
                return Err(VolumeSettingsError::DenseWithoutCrop);
            }
            // The very first voxel is left out, so that every voxel has neighbours on both sides.
            return Ok(Extent { first: [1; 3], last: [2 * VOXEL_RANGE - 2; 3] });
        };
        let limit = (VOXEL_RANGE - 2) as f32 * voxel;
        let is_near = |x: &f32| x.abs() <= limit;
        if !crop.min.iter().chain(crop.max.iter()).all(is_near) {
            return Err(VolumeSettingsError::FarCrop { crop, limit });
        }
        let index = |x: f32| (x + VOXEL_RANGE as f32) as u32;
        let extent = Extent {
            first: [0, 1, 2].map(|i| index(libm::ceilf(crop.min[i] / voxel))),
            last: [0, 1, 2].map(|i| index(libm::floorf(crop.max[i] / voxel))),
        };
        if (0..3).any(|i| extent.first[i] > extent.last[i]) {
            return Err(VolumeSettingsError::EmptyCrop { crop });
        }
        Ok(extent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    fn cropped(min: f32, max: f32) -> VolumeSettings {
        let crop = Some(Aabb { min: Point::new(min, min, min), max: Point::new(max, max, max) });
        VolumeSettings { crop, dense: true, ..VolumeSettings::new(0.002) }
    }

    #[test]
    fn a_box_of_sixteen_voxels_at_a_block_border_takes_eight_blocks() {
        assert_eq!(cropped(0.0, 0.0301).dense_blocks(), Some(8));
        assert_eq!(cropped(-0.0001, 0.0301).dense_blocks(), Some(8));
        assert_eq!(cropped(-0.0021, 0.0301).dense_blocks(), Some(27));
        assert_eq!(VolumeSettings::new(0.002).dense_blocks(), None);
    }

    #[test]
    fn names_what_is_broken() {
        use VolumeSettingsError as Error;
        let fine = VolumeSettings::new(0.002);
        assert_eq!(fine.validate(), Ok(()));
        for voxel in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-40, 1e37] {
            let error = VolumeSettings { voxel, ..fine }.validate().unwrap_err();
            assert!(matches!(error, Error::Voxel { .. }), "{voxel}");
        }
        let (largest, crop) =
            (f32::INFINITY, Some(Aabb { min: [-f32::INFINITY; 3].into(), max: [f32::INFINITY; 3].into() }));
        for settings in [
            VolumeSettings { truncation: largest, ..VolumeSettings::new(1.1e37) },
            VolumeSettings { crop, dense: true, ..VolumeSettings::new(1e35) },
        ] {
            assert!(matches!(settings.validate(), Err(Error::Voxel { .. })), "{settings:?}");
        }
        for truncation in [0.0, 0.0039, 0.065, f32::INFINITY, f32::NAN] {
            let error = VolumeSettings { truncation, ..fine }.validate().unwrap_err();
            assert!(matches!(error, Error::Truncation { .. }), "{truncation}");
        }
        let max_depth = VolumeSettings { max_depth: f32::NAN, ..fine }.validate();
        assert!(matches!(max_depth, Err(Error::MaxDepth { .. })));
        assert_eq!(VolumeSettings { dense: true, ..fine }.validate(), Err(Error::DenseWithoutCrop));
        assert!(matches!(cropped(0.1, 0.0).validate(), Err(Error::EmptyCrop { .. })));
        assert!(matches!(cropped(0.0001, 0.0019).validate(), Err(Error::EmptyCrop { .. })));
        assert!(matches!(cropped(0.0, 65.6).validate(), Err(Error::FarCrop { .. })));
        assert!(matches!(cropped(0.0, f32::NAN).validate(), Err(Error::FarCrop { .. })));
    }
}
