//! From depth images to the mesh or the point cloud of what they show.

mod agreement;
mod cloud;
mod extent;

pub use cloud::{CLOUD_VOXEL, ScannedCloud, scan_cloud};
pub use extent::suggested_voxel;

use crate::files::depth::ScanFrame;
use hangpose_core::Monitor;
use hangpose_core::geometry::{Aabb, Pose};
use hangpose_core::perception::completion::{Completion, CompletionError, CompletionSettings, room};
use hangpose_core::perception::depth::{DepthImage, DepthImageError};
use hangpose_core::perception::depth_points::DepthPointsError;
use hangpose_core::perception::isosurface::{Isosurface, IsosurfaceError};
use hangpose_core::perception::volume::{Volume, VolumeError, VolumeLimits, VolumeSettings};

/// Blocks of the first attempt, about 9 MB.
const FIRST_BLOCKS: usize = 1 << 12;
/// Most blocks that are tried, about 1.1 GB.
const MOST_BLOCKS: usize = 1 << 19;
/// Part of the points of an image that should reappear at least in the next, where the two overlap.
pub const FAIR_AGREEMENT: f32 = 0.3;

/// The surface that depth images show.
#[derive(Clone, Debug)]
pub struct ScannedMesh {
    /// Positions in world coordinates, metres.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices, counter-clockwise seen from free space.
    pub triangles: Vec<[u32; 3]>,
    /// For each vertex 1 if an image shows the surface there, 0 if it was guessed.
    pub seen: Vec<u8>,
    /// Positions of the cameras in world coordinates, metres.
    pub viewpoints: Vec<[f32; 3]>,
    /// Pixels that were fused, of all images.
    pub pixels: usize,
    /// Memory of the volume, bytes.
    pub volume_bytes: usize,
    /// Part of the points of an image that reappear in the next; `None` for a single image.
    pub agreement: Option<f32>,
}

/// Why depth images give neither a mesh nor a cloud.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FuseError {
    /// There are no images.
    #[error("there are no images: give at least one")]
    Empty,
    /// An image is not usable.
    #[error("image {index} (counted from 0): {error}")]
    Image {
        /// Index of the image.
        index: usize,
        /// What is wrong.
        error: DepthImageError,
    },
    /// The poses map the wrong way.
    #[error(
        "the images do not fit together: {:.0} % of the points of an image reappear in the next, but {:.0} % with inverted poses, so the poses probably map the other way between camera and world",
        100.0 * given, 100.0 * inverted
    )]
    Convention {
        /// Part that reappears with the poses as given.
        given: f32,
        /// Part that reappears with inverted poses.
        inverted: f32,
    },
    /// No image shows a surface within the volume.
    #[error(
        "no image shows a surface within the crop box and the greatest depth of {max_depth} m; the images show {} to {}: check the crop box, the depth scale, the poses and the mask",
        seen.min, seen.max
    )]
    Outside {
        /// Greatest depth of the settings, metres.
        max_depth: f32,
        /// Box around what the images show, world coordinates, metres.
        seen: Aabb,
    },
    /// The volume does not fit into the memory that a scan may use.
    #[error("image {index} (counted from 0): {error}")]
    Volume {
        /// Index of the image.
        index: usize,
        /// What is wrong.
        error: VolumeError,
    },
    /// An image does not give points.
    #[error("image {index} (counted from 0): {error}")]
    Points {
        /// Index of the image.
        index: usize,
        /// What is wrong.
        error: DepthPointsError,
    },
    /// What the images do not show cannot be guessed.
    #[error(transparent)]
    Completion(#[from] CompletionError),
    /// The settings are not usable, or the call was cancelled.
    #[error(transparent)]
    Settings(#[from] VolumeError),
    /// The surface is too large, or the call was cancelled.
    #[error(transparent)]
    Surface(#[from] IsosurfaceError),
}

/// Fuses the images in a volume of these settings and returns its surface. The volume grows up to about 1.1 GB. The mesh
/// is open where no image shows the surface.
pub fn scan(
    frames: &[ScanFrame],
    settings: &VolumeSettings,
    monitor: &Monitor,
) -> Result<ScannedMesh, FuseError> {
    fuse(frames, settings, None, monitor)
}

/// Fuses images of an object that is held alone and guesses what they do not show, see
/// [`completion`](hangpose_core::perception::completion). The mesh is closed. The volume is dense, pixels without a depth
/// show free space, and without a crop box it is the [`room`] of the object.
pub fn complete_scan(
    frames: &[ScanFrame],
    settings: &VolumeSettings,
    guess: &CompletionSettings,
    monitor: &Monitor,
) -> Result<ScannedMesh, FuseError> {
    let shown = frames.iter().filter_map(|frame| Some((frame.image().ok()?, frame.mask())));
    let margin = settings.truncation + 2.0 * settings.voxel;
    let crop = settings.crop.or_else(|| room(shown, guess, settings.max_depth, margin));
    let settings = VolumeSettings { crop, dense: crop.is_some(), missing_is_free: true, ..*settings };
    if let Some(needed) = settings.dense_blocks().filter(|needed| *needed > MOST_BLOCKS) {
        return Err(VolumeError::DenseLimit { needed, limit: MOST_BLOCKS }.into());
    }
    fuse(frames, &settings, Some(guess), monitor)
}

/// The images, of which there is at least one, and the part of the points of an image that reappear in the next. Poses that
/// map the wrong way are an error.
fn checked(frames: &[ScanFrame]) -> Result<(Vec<DepthImage<'_>>, Option<f32>), FuseError> {
    let image = |(index, frame): (usize, &'_ ScanFrame)| {
        frame.image().map(drop).map_err(|error| FuseError::Image { index, error })
    };
    frames.iter().enumerate().try_for_each(image)?;
    let images: Vec<DepthImage> = frames.iter().filter_map(|frame| frame.image().ok()).collect();
    if images.is_empty() {
        return Err(FuseError::Empty);
    }
    let agreement = agreement::of(&images, |pose| *pose);
    let inverted = agreement::of(&images, Pose::inverse);
    if let (Some(given), Some(inverted)) = (agreement, inverted)
        && inverted > FAIR_AGREEMENT
        && inverted > 2.0 * given
    {
        return Err(FuseError::Convention { given, inverted });
    }
    Ok((images, agreement))
}

/// Fuses the images in a volume that is large enough.
fn fuse(
    frames: &[ScanFrame],
    settings: &VolumeSettings,
    guess: Option<&CompletionSettings>,
    monitor: &Monitor,
) -> Result<ScannedMesh, FuseError> {
    let (images, agreement) = checked(frames)?;
    let mut blocks = settings.dense_blocks().filter(|_| settings.dense).unwrap_or(FIRST_BLOCKS);
    loop {
        match attempt(frames, &images, settings, blocks, guess, monitor) {
            Err(FuseError::Volume { error: VolumeError::Full { .. }, .. }) if 2 * blocks <= MOST_BLOCKS => {
                blocks *= 2;
            }
            result => return result.map(|mesh| ScannedMesh { agreement, ..mesh }),
        }
    }
}

/// Fuses the images in a volume of so many blocks.
fn attempt(
    frames: &[ScanFrame],
    images: &[DepthImage],
    settings: &VolumeSettings,
    blocks: usize,
    guess: Option<&CompletionSettings>,
    monitor: &Monitor,
) -> Result<ScannedMesh, FuseError> {
    let limits = VolumeLimits { blocks };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let volume_bytes = memory.len();
    let mut volume = Volume::new(settings, &limits, &mut memory)?;
    let mut pixels = 0;
    for (index, (image, frame)) in images.iter().zip(frames).enumerate() {
        let done = volume.integrate(image, frame.mask(), monitor);
        pixels += done.map_err(|error| FuseError::Volume { index, error })?.pixels;
    }
    if pixels == 0 {
        return Err(FuseError::Outside { max_depth: settings.max_depth, seen: extent::of(frames) });
    }
    if let Some(guess) = guess {
        let mut scratch = vec![0; Completion::bytes(volume.blocks())];
        volume.complete(guess, &mut scratch, monitor)?;
    }
    let mut scratch = vec![0; Isosurface::bytes(volume.blocks())];
    let surface = Isosurface::find(&volume, &mut scratch, monitor)?;
    let (mut vertices, mut triangles) =
        (vec![[0.0; 3]; surface.vertices()], vec![[0; 3]; surface.triangles()]);
    surface.write(&mut vertices, &mut triangles)?;
    let mut seen = vec![0; surface.vertices()];
    surface.write_seen(&mut seen)?;
    let viewpoints = images.iter().map(|image| image.viewpoint().into()).collect();
    Ok(ScannedMesh { vertices, triangles, seen, viewpoints, pixels, volume_bytes, agreement: None })
}
