//! Shapes for display: fewer triangles and points than were read.

use crate::geometry::{Cloud, Mesh};
use meshopt::{SimplifyOptions, VertexDataAdapter};

/// Most triangles of a mesh that is shown: 0.7 MB in the page, and an edge of about 2 mm on a mug.
const MAX_TRIANGLES: usize = 30_000;
/// Most points of a cloud that are shown, with normals: 1 MB in the page.
pub(super) const MAX_POINTS: usize = 30_000;

/// A mesh with at most [`MAX_TRIANGLES`].
pub(super) struct ShownMesh {
    pub(super) vertices: Vec<[f32; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl ShownMesh {
    pub(super) fn of(mesh: &Mesh) -> Self {
        let vertices: Vec<[f32; 3]> = mesh.vertices().iter().map(|&vertex| vertex.into()).collect();
        let indices = mesh.triangles().as_flattened();
        let kept = if mesh.triangles().len() > MAX_TRIANGLES {
            decimated(indices, &vertices)
        } else {
            indices.to_vec()
        };
        // Only the vertices that are used.
        let (count, remap) = meshopt::generate_vertex_remap(&vertices, Some(&kept));
        let kept = meshopt::remap_index_buffer(Some(&kept), kept.len(), &remap);
        let vertices = meshopt::remap_vertex_buffer(&vertices, count, &remap);
        Self { vertices, triangles: kept.as_chunks().0.to_vec() }
    }
}

/// Fewer triangles of about the same shape. Where too many remain because the surface has holes or parts that must not
/// merge, vertices merge that are close.
fn decimated(indices: &[u32], vertices: &[[f32; 3]]) -> Vec<u32> {
    let adapter = VertexDataAdapter::new(meshopt::typed_to_bytes(vertices), size_of::<[f32; 3]>(), 0)
        .expect("three numbers each");
    let target = 3 * MAX_TRIANGLES;
    let kept = meshopt::simplify(indices, &adapter, target, f32::MAX, SimplifyOptions::Prune, None);
    if kept.len() > target {
        meshopt::simplify_sloppy(indices, &adapter, target, f32::MAX, None)
    } else {
        kept
    }
}

/// Indices of at most `most` of `count` things, spread evenly over their order.
pub(super) fn thinned(count: usize, most: usize) -> impl Iterator<Item = usize> + Clone {
    let kept = count.min(most);
    (0..kept).map(move |index| index * count / kept)
}

/// The points of a cloud that are shown, and their normals if all of them are given.
pub(super) fn shown_points(cloud: &Cloud) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let points = cloud.points();
    let kept = thinned(points.len(), MAX_POINTS);
    let normals = cloud.normals().map(|normals| kept.clone().map(|index| normals[index]).collect());
    (kept.map(|index| points[index].into()).collect(), normals.unwrap_or_default())
}
