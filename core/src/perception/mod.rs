//! From what a sensor or a file gives to what the method works on.

pub(crate) mod cleaning;
pub mod completion;
pub mod depth;
pub mod depth_points;
pub(crate) mod far_side;
pub mod isosurface;
pub mod normals;
mod orientation;
mod plane;
pub mod sampling;
#[cfg(test)]
mod test_views;
pub(crate) mod visibility;
pub mod volume;
