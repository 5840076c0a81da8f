//! The mesh of an object from depth images.

use super::{sheet, volume};
use hangpose::perception::depth::DepthImage;

/// A triangle mesh, open where no image saw the surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Vertices in world coordinates, m.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of the triangles, counter-clockwise seen from the cameras.
    pub triangles: Vec<[u32; 3]>,
}

/// The surface that the images show: the pixels of a single image as they are, the fused distances of several.
pub fn fuse(images: &[DepthImage]) -> Surface {
    match images {
        [one] => sheet::sheet(one),
        _ => volume::fused(images),
    }
}
