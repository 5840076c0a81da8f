//! From what a sensor or a file gives to what the method works on.

pub(crate) mod cleaning;
pub mod depth;
pub mod normals;
mod orientation;
pub mod sampling;
