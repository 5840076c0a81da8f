//! Writes clouds.

use crate::files::ply::viewpoint_comments;

/// A point cloud as binary PLY: `points`, each with one of `normals`, and the positions of the cameras as comments, which
/// [`read_cloud`](super::read_cloud) reads.
pub fn ply(points: &[[f32; 3]], normals: &[[f32; 3]], viewpoints: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\n{}element vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n",
        viewpoint_comments(viewpoints),
        points.len()
    )
    .into_bytes();
    let numbers = points.iter().zip(normals).flat_map(|(point, normal)| point.iter().chain(normal));
    bytes.extend(numbers.flat_map(|x| x.to_le_bytes()));
    bytes
}
