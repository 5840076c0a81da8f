//! Depth images: the camera that takes them, what it measured, and which pixels show an object.

mod camera;
mod image;
mod mask;

pub use camera::{CameraError, DepthCamera};
pub(crate) use image::NOTHING;
pub use image::{DepthImage, DepthImageError};
pub use mask::Mask;
