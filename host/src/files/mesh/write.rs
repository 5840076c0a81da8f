//! Writes meshes.

use crate::files::ply::viewpoint_comments;

/// A mesh as binary PLY: `vertices`, `triangles` of indices into them, and the positions of the cameras that it was made from
/// as comments, which [`read_mesh`](super::read_mesh) reads.
pub fn ply(vertices: &[[f32; 3]], triangles: &[[u32; 3]], viewpoints: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\n{}element vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        viewpoint_comments(viewpoints),
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    bytes.reserve(12 * vertices.len() + 13 * triangles.len());
    bytes.extend(vertices.iter().flatten().flat_map(|x| x.to_le_bytes()));
    for triangle in triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}
