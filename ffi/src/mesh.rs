use crate::border::{Public, Region, rows};
use crate::failure::Failure;
use hangpose_core::geometry::{MAX_COUNT, Mesh, MeshError};

/// A triangle mesh in the caller's arrays. Corners are counter-clockwise seen from outside. Open, overlapping and
/// multi-body meshes are valid; degenerate triangles are skipped. The library keeps no pointer to the arrays after
/// the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_mesh {
    /// sizeof(hangpose_mesh), set by the caller.
    pub struct_size: u32,
    /// Number of vertices.
    pub vertex_count: u32,
    /// Number of triangles.
    pub triangle_count: u32,
    /// Number of viewpoints; 0 if the mesh is all of the object.
    pub viewpoint_count: u32,
    /// Array of vertex_count rows of x, y, z: metres, in object coordinates, each within +-1,000,000. For
    /// hangpose_mesh_sample the coordinates are those of the supporter.
    pub vertices: *const f32,
    /// Array of triangle_count rows of three vertex indices, counted from 0.
    pub triangles: *const u32,
    /// Array of viewpoint_count rows of x, y, z: positions of the cameras whose images the mesh was made from, metres, in
    /// object coordinates. What is in the shadow of the mesh for all of them was not seen: the object may be there as well,
    /// and poses that have the supporter there are less probable. May be null if viewpoint_count is 0.
    pub viewpoints: *const f32,
}

// SAFETY: `repr(C)` over numbers and pointers, `struct_size` first.
unsafe impl Public for hangpose_mesh {
    const NAME: &'static str = "mesh";
}

impl hangpose_mesh {
    /// The mesh as the core takes it.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn check(&self) -> Result<Mesh<'_>, Failure> {
        self.check_counts()?;
        // SAFETY: those of this function.
        let (vertices, triangles, viewpoints) = unsafe {
            (
                rows("mesh.vertices", self.vertices, self.vertex_count)?,
                rows("mesh.triangles", self.triangles, self.triangle_count)?,
                rows("mesh.viewpoints", self.viewpoints, self.viewpoint_count)?,
            )
        };
        Ok(Mesh::new(vertices, triangles)?.seen_from(viewpoints)?)
    }

    /// Checks the counts before the arrays are read.
    pub(crate) fn check_counts(&self) -> Result<(), Failure> {
        if self.triangle_count == 0 {
            return Err(MeshError::Empty.into());
        }
        for (field, count) in
            [("mesh.vertex_count", self.vertex_count), ("mesh.triangle_count", self.triangle_count)]
        {
            if count as usize > MAX_COUNT || count == 0 {
                return Err(Failure::Count { field, count: count as usize, most: MAX_COUNT });
            }
        }
        Ok(())
    }

    pub(crate) fn regions(&self) -> [Region; 4] {
        [
            Region::read("mesh", self, 1),
            Region::read("mesh.vertices", self.vertices.cast::<[f32; 3]>(), self.vertex_count as usize),
            Region::read("mesh.triangles", self.triangles.cast::<[u32; 3]>(), self.triangle_count as usize),
            Region::read(
                "mesh.viewpoints",
                self.viewpoints.cast::<[f32; 3]>(),
                self.viewpoint_count as usize,
            ),
        ]
    }
}
