use crate::border::{Public, Region, rows};
use crate::failure::Failure;
use hangpose_core::geometry::{MAX_COUNT, Mesh, MeshError};

/// A triangle mesh in the caller's arrays, in metres, corners counter-clockwise seen from outside. Open, overlapping and
/// multi-body meshes are fine, and so are degenerate triangles, which are passed over. Nothing is kept after the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_mesh {
    /// sizeof(hangpose_mesh), set by the caller.
    pub struct_size: u32,
    /// How many vertices there are.
    pub vertex_count: u32,
    /// How many triangles there are.
    pub triangle_count: u32,
    /// vertex_count rows of x, y, z; metres, in object coordinates, each within 1,000,000.
    pub vertices: *const f32,
    /// triangle_count rows of three indices of vertices.
    pub triangles: *const u32,
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
    /// What the caller vouches for, see `border`.
    pub(crate) unsafe fn check(&self) -> Result<Mesh<'_>, Failure> {
        self.check_counts()?;
        // SAFETY: as this function's.
        let (vertices, triangles) = unsafe {
            (
                rows("mesh.vertices", self.vertices, self.vertex_count)?,
                rows("mesh.triangles", self.triangles, self.triangle_count)?,
            )
        };
        Ok(Mesh::new(vertices, triangles)?)
    }

    /// Checks the counts before anything is read that may not be there.
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

    pub(crate) fn regions(&self) -> [Region; 3] {
        [
            Region::read("mesh", self, 1),
            Region::read("mesh.vertices", self.vertices.cast::<[f32; 3]>(), self.vertex_count as usize),
            Region::read("mesh.triangles", self.triangles.cast::<[u32; 3]>(), self.triangle_count as usize),
        ]
    }
}
