//! Why a volume cannot be built or cannot take an image.

use super::VolumeSettingsError;
use crate::Stop;
use crate::memory::OutOfMemory;

/// Why a volume cannot be built or an image cannot be fused. The volume is then as it was before the call, unless that was
/// cancelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VolumeError {
    /// The settings are not usable.
    Settings(VolumeSettingsError),
    /// The memory is smaller than [`Volume::bytes`](super::Volume::bytes).
    OutOfMemory(OutOfMemory),
    /// A dense volume has more blocks than the limit.
    DenseLimit {
        /// Blocks that the crop box takes: [`VolumeSettings::dense_blocks`](super::VolumeSettings::dense_blocks).
        needed: usize,
        /// The limit, blocks.
        limit: usize,
    },
    /// The image sees surfaces in more new blocks than are left.
    Full {
        /// The limit, blocks.
        limit: usize,
        /// Blocks that earlier images used.
        used: usize,
        /// Pixels that found no block.
        pixels: usize,
        /// Pixels with a surface in the volume.
        of: usize,
    },
    /// The number of labels is not that of the image's pixels.
    Mask {
        /// Number of labels.
        labels: usize,
        /// Number of pixels.
        pixels: usize,
    },
    /// The monitor stopped the call.
    Stopped(Stop),
}

impl core::fmt::Display for VolumeError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Settings(error) => error.fmt(f),
            Self::OutOfMemory(error) => error.fmt(f),
            Self::DenseLimit { needed, limit } => write!(
                f,
                "the crop box takes {needed} blocks and the limit is {limit}: raise the limit, take a smaller box or larger voxels, or a sparse volume"
            ),
            Self::Full { limit, used, pixels, of } => write!(
                f,
                "the limit of {limit} blocks is used up: {used} were used before this image, and {pixels} of its {of} pixels found none: raise the limit, take a smaller crop box or larger voxels, or give a mask"
            ),
            Self::Mask { labels, pixels } => {
                write!(
                    f,
                    "the mask has {labels} labels and the image {pixels} pixels: give one for each pixel"
                )
            }
            Self::Stopped(Stop::Cancelled) => write!(f, "the fusion was cancelled"),
            Self::Stopped(Stop::WorkLimit) => {
                write!(f, "the image has more pixels with a depth than the work limit: raise the limit")
            }
        }
    }
}

impl core::error::Error for VolumeError {}

impl From<VolumeSettingsError> for VolumeError {
    fn from(error: VolumeSettingsError) -> Self {
        Self::Settings(error)
    }
}

impl From<OutOfMemory> for VolumeError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl From<Stop> for VolumeError {
    fn from(error: Stop) -> Self {
        Self::Stopped(error)
    }
}
