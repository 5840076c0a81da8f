//! Reads depth images, their cameras, poses and masks.
//!
//! | what    | formats |
//! | ------- | ------- |
//! | images  | PNG of 16 bits in one channel; by a pattern, or listed with their times as in TUM's `depth.txt` |
//! | cameras | 3 x 3 matrix as text; `PinholeCameraIntrinsic` and `PinholeCameraParameters` of Open3D; `scene_camera.json` of BOP |
//! | poses   | 4 x 4 matrices, one in each file or all in one; trajectories of Open3D (`.log`) and TUM; `scene_camera.json` of BOP |
//! | masks   | PNG with one label a pixel |

mod bop;
mod camera;
mod error;
mod list;
mod matrix;
mod pairing;
mod png;
mod poses;
mod rigid;
mod tum;

pub use error::ScanError;
pub use png::{DepthFile, MaskFile, read_depth, read_mask};
pub use rigid::of_rows as pose_of_rows;

use std::path::{Path, PathBuf};

use super::text::{number, short};
use camera::{CameraFile, Pinhole};
use hangpose_core::geometry::Pose;
use hangpose_core::perception::depth::{DepthCamera, DepthImage, DepthImageError, Mask};
use pairing::{Paired, Posed, pair};

/// Metres per unit of depth where nothing says otherwise: millimetres.
pub const MILLIMETRES: f32 = 0.001;
/// Least and greatest plausible median depth, metres.
const PLAUSIBLE: [f32; 2] = [0.02, 50.0];

/// Where the files of a scan are. A pattern is a path or has wildcards, as in `scan/*.png`; its files are taken by name.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanSources {
    /// Pattern of the depth images, or a text file that lists their times and paths.
    pub depth: String,
    /// The camera.
    pub camera: PathBuf,
    /// Pattern of the pose files. Without them, poses come from the camera file, and a single image needs none.
    pub poses: Option<String>,
    /// Pattern of the masks, and the label of the object.
    pub masks: Option<(String, u8)>,
    /// Metres per unit of depth; by default what a BOP camera says, otherwise [`MILLIMETRES`].
    pub depth_scale: Option<f32>,
    /// Whether poses map world to camera coordinates instead of camera to world. BOP says itself which.
    pub world_to_camera: bool,
}

/// One depth image of a scan.
#[derive(Clone, Debug)]
pub struct ScanFrame {
    /// The depths.
    pub depth: DepthFile,
    /// Label of each pixel and that of the object.
    pub labels: Option<(Vec<u8>, u8)>,
    /// The camera.
    pub camera: DepthCamera,
    /// Metres per unit of depth.
    pub scale: f32,
    /// Pose of the camera: maps camera to world coordinates.
    pub pose: Pose,
}

impl ScanFrame {
    /// The image as the core takes it.
    pub fn image(&self) -> Result<DepthImage<'_>, DepthImageError> {
        DepthImage::new(self.camera, &self.depth.depths, self.scale, self.pose)
    }

    /// The mask as the core takes it.
    pub fn mask(&self) -> Option<Mask<'_>> {
        self.labels.as_ref().map(|(labels, label)| Mask { labels, label: *label })
    }
}

/// The images of a scan.
#[derive(Clone, Debug)]
pub struct ScanFiles {
    /// At least one, all of the same size.
    pub frames: Vec<ScanFrame>,
    /// What the reader left out, as sentences for the user.
    pub notes: Vec<String>,
}

/// Reads all files of a scan.
pub fn read_scan(sources: &ScanSources) -> Result<ScanFiles, ScanError> {
    let images = list::files(&sources.depth, "depth images")?;
    let camera = camera::read(&sources.camera)?;
    let count = images.len();
    let Paired { images, notes } = pair(images, &camera, sources)?;
    let masks = match &sources.masks {
        None => None,
        Some((pattern, label)) => {
            let masks = list::matching(pattern, "masks")?;
            if masks.len() != count {
                let (count, images) = (masks.len(), count);
                return Err(ScanError::Count { pattern: pattern.clone(), what: "masks", count, images });
            }
            Some((masks, *label))
        }
    };
    let mut frames: Vec<ScanFrame> = Vec::new();
    for Posed { index, path, pose } in images {
        let depth = read_depth(&path)?;
        if let Some(first) = frames.first().filter(|first| first.depth.size != depth.size) {
            return Err(ScanError::MixedSizes {
                path: depth.path,
                size: depth.size,
                first: first.depth.path.clone(),
                first_size: first.depth.size,
            });
        }
        let (intrinsics, scale) = match &camera {
            CameraFile::One(pinhole) => (pinhole.clone(), MILLIMETRES),
            CameraFile::Bop(cameras) => {
                let camera = bop::image_number(&path).and_then(|number| cameras.get(&number));
                let camera = camera.ok_or_else(|| pairing::no_entry(&sources.camera, &path))?;
                (Pinhole { size: None, intrinsics: camera.intrinsics, pose: None }, camera.scale)
            }
        };
        let camera = depth_camera(&sources.camera, &intrinsics, depth.size)?;
        let scale = sources.depth_scale.unwrap_or(scale);
        let labels = match &masks {
            None => None,
            Some((masks, label)) => Some((labels(&masks[index], depth.size)?, *label)),
        };
        let frame = ScanFrame { depth, labels, camera, scale, pose };
        let image = frame.image().map_err(|error| ScanError::Image { path: path.clone(), error })?;
        check_scale(&path, &image)?;
        frames.push(frame);
    }
    if let Some((pattern, label)) = &sources.masks {
        check_label(&frames, pattern, *label)?;
    }
    Ok(ScanFiles { frames, notes })
}

/// The camera, if its intrinsics can be those of images of this size.
fn depth_camera(path: &Path, pinhole: &Pinhole, size: [u32; 2]) -> Result<DepthCamera, ScanError> {
    let wrong = |evidence| Err(ScanError::IntrinsicsSize { path: path.into(), evidence, size });
    if let Some([width, height]) = pinhole.size.filter(|given| *given != size) {
        return wrong(format!("are those of {width} x {height} pixels"));
    }
    let [fx, fy, cx, cy] = pinhole.intrinsics;
    // The principal point is near the middle of a whole image. One that is off by the same factor in x and y, or almost at
    // the border, is that of another resolution.
    let factors = [2.0 * cx / f64::from(size[0]), 2.0 * cy / f64::from(size[1])];
    let is_scaled = (factors[0] / factors[1] - 1.0).abs() < 0.1 && !(0.75..=1.35).contains(&factors[0]);
    if is_scaled || factors.iter().any(|factor| !(0.2..=1.8).contains(factor)) {
        return wrong(format!("have their principal point at {cx}, {cy}"));
    }
    let single = |x: f64| x as f32;
    DepthCamera::new(size, [fx, fy].map(single), [cx, cy].map(single), [0.0; 5])
        .map_err(|error| ScanError::Camera { path: path.into(), error })
}

fn labels(path: &Path, image_size: [u32; 2]) -> Result<Vec<u8>, ScanError> {
    let mask = read_mask(path)?;
    if mask.size != image_size {
        return Err(ScanError::MaskSize { path: mask.path, size: mask.size, image_size });
    }
    Ok(mask.labels)
}

/// Errs if the median of the depths is implausible.
fn check_scale(path: &Path, image: &DepthImage) -> Result<(), ScanError> {
    let mut seen: Vec<u16> = image.depths().iter().copied().filter(|d| !matches!(*d, 0 | u16::MAX)).collect();
    let middle = seen.len() / 2;
    let median = f32::from(*seen.select_nth_unstable(middle).1) * image.scale();
    if (PLAUSIBLE[0]..=PLAUSIBLE[1]).contains(&median) {
        return Ok(());
    }
    let factor = if median > PLAUSIBLE[1] { 0.001 } else { 1000.0 };
    // Rounded, so that 1000 times 1e-6 reads 0.001.
    let suggested = format!("{:.3e}", image.scale() * factor).parse().unwrap_or(MILLIMETRES);
    Err(ScanError::DepthScale { path: path.into(), median, scale: image.scale(), suggested })
}

/// Errs if no mask has the label.
fn check_label(frames: &[ScanFrame], pattern: &str, label: u8) -> Result<(), ScanError> {
    let mut is_used = [false; 256];
    for (labels, _) in frames.iter().filter_map(|frame| frame.labels.as_ref()) {
        labels.iter().for_each(|label| is_used[usize::from(*label)] = true);
    }
    if is_used[usize::from(label)] {
        return Ok(());
    }
    let labels = (1..=255).filter(|label| is_used[usize::from(*label)]).collect();
    Err(ScanError::Label { pattern: pattern.into(), label, labels })
}

/// The numbers of a line in double precision; `Err` is the reason for an error message.
fn numbers(line: &str) -> Result<Vec<f64>, String> {
    let parse = |word: &str| {
        let not_finite = || number(word);
        word.parse()
            .ok()
            .or_else(not_finite)
            .ok_or_else(|| format!("expected a number, not \"{}\"", short(word)))
    };
    line.split_whitespace().map(parse).collect()
}
