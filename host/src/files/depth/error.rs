//! Why the files of a scan do not fit together.

use std::path::PathBuf;

use thiserror::Error;

use crate::files::FileError;
use hangpose_core::perception::depth::{CameraError, DepthImageError};

/// Why a scan could not be read.
///
/// The message states what is wrong, where, and how to mend it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ScanError {
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A pattern matches nothing or is none.
    #[error("{pattern}: {what}: {reason}; give a path, or a pattern in quotes such as 'scan/*.png'")]
    Pattern {
        /// The pattern.
        pattern: String,
        /// Which files it is for.
        what: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// An image has another size than the first.
    #[error(
        "{path}: has {} x {} pixels and {} {} x {}; give images of one camera and resolution, or scan twice",
        size[0], size[1], first.display(), first_size[0], first_size[1]
    )]
    MixedSizes {
        /// The image.
        path: PathBuf,
        /// Its width and height, pixels.
        size: [u32; 2],
        /// The first image.
        first: PathBuf,
        /// Its width and height, pixels.
        first_size: [u32; 2],
    },
    /// The intrinsics belong to images of another resolution.
    #[error(
        "{path}: the intrinsics {} and the images have {} x {} pixels; give intrinsics of that resolution, or scale fx, fy, cx and cy like the images",
        evidence, size[0], size[1]
    )]
    IntrinsicsSize {
        /// The camera file.
        path: PathBuf,
        /// What tells the resolution.
        evidence: String,
        /// Width and height of the images, pixels.
        size: [u32; 2],
    },
    /// The intrinsics are not usable.
    #[error("{path}: {error}")]
    Camera {
        /// The camera file.
        path: PathBuf,
        /// What is wrong.
        error: CameraError,
    },
    /// A camera or pose file by number does not have an image.
    #[error("{path}: says nothing of image {image}; its entries are named by the number in the image's name")]
    NoEntry {
        /// The camera or pose file.
        path: PathBuf,
        /// The image.
        image: PathBuf,
    },
    /// The numbers of poses or masks and of images differ.
    #[error(
        "{pattern}: there are {count} {what} and {images} images; give one for each image, in the same order"
    )]
    Count {
        /// Where they are.
        pattern: String,
        /// Poses or masks.
        what: &'static str,
        /// Number of them.
        count: usize,
        /// Number of images.
        images: usize,
    },
    /// Several images have no poses.
    #[error("there are {images} images and no poses; give one for each image")]
    NoPoses {
        /// Number of images.
        images: usize,
    },
    /// A trajectory by time and an image without one.
    #[error(
        "{image}: has no time, but {pattern} gives poses by time; name images by their time, or give a list of times and images such as TUM's depth.txt"
    )]
    NoTime {
        /// The image.
        image: PathBuf,
        /// The trajectory.
        pattern: String,
    },
    /// No image has a pose that is near in time.
    #[error(
        "{pattern}: no image has a pose within {limit} s, the nearest is {nearest} s away; check that times are those of the same clock"
    )]
    Times {
        /// The trajectory.
        pattern: String,
        /// Greatest time between an image and its pose, seconds.
        limit: f64,
        /// Least time between an image and a pose, seconds.
        nearest: f64,
    },
    /// The image is not usable.
    #[error("{path}: {error}")]
    Image {
        /// The image.
        path: PathBuf,
        /// What is wrong.
        error: DepthImageError,
    },
    /// Depths are implausible, probably in another unit.
    #[error(
        "{path}: half of the depths are {} {median:.3} m with a depth scale of {scale}; {} to {} m is plausible: give a depth scale of {suggested}, metres per unit",
        if *median > super::PLAUSIBLE[1] { "beyond" } else { "below" }, super::PLAUSIBLE[0], super::PLAUSIBLE[1]
    )]
    DepthScale {
        /// The image.
        path: PathBuf,
        /// Median depth, metres.
        median: f32,
        /// Metres per unit of depth.
        scale: f32,
        /// A scale that gives plausible depths.
        suggested: f32,
    },
    /// A mask has another size than its image.
    #[error("{path}: has {} x {} pixels and its image {} x {}; give a mask of the image's size", size[0], size[1], image_size[0], image_size[1])]
    MaskSize {
        /// The mask.
        path: PathBuf,
        /// Its width and height, pixels.
        size: [u32; 2],
        /// Width and height of the image, pixels.
        image_size: [u32; 2],
    },
    /// No mask has the label.
    #[error("{pattern}: no mask has a pixel of label {label}; {}", if labels.is_empty() { "all are 0".into() } else { format!("there are {labels:?}") })]
    Label {
        /// The masks.
        pattern: String,
        /// The label.
        label: u8,
        /// Other labels but 0.
        labels: Vec<u8>,
    },
}
