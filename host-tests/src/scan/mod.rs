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
