//! Scans of the true shapes by a simulated depth camera: what a robot would measure of an object and of a supporter.
//!
//! Each shape is scanned alone and cropped: nothing is behind it, and no gripper holds it.

mod cloud;
mod fuse;
mod sensor;
mod spec;
mod views;

pub use cloud::{SeenCloud, cloud};
pub use fuse::{Surface, fuse};
pub use sensor::{Sensor, Shot};
pub use spec::Spec;
pub use views::{Target, front, looking, off_front, sphere, through};

use hangpose::files::depth::{DepthFile, ScanFrame};
use hangpose::perception::depth::DepthImage;
use std::path::PathBuf;

/// The images as a scan from files has them.
pub fn frames(images: &[DepthImage]) -> Vec<ScanFrame> {
    let frame = |image: &DepthImage| ScanFrame {
        depth: DepthFile {
            path: PathBuf::new(),
            size: image.camera().size(),
            depths: image.depths().to_vec(),
        },
        labels: None,
        camera: *image.camera(),
        scale: image.scale(),
        pose: *image.pose(),
    };
    images.iter().map(frame).collect()
}
