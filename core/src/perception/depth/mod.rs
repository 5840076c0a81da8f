//! Depth images: the camera that takes them and what it measured.

mod camera;
mod image;

pub use camera::{CameraError, DepthCamera};
pub use image::{DepthImage, DepthImageError};
