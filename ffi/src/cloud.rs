use crate::border::{Public, Region, rows};
use crate::failure::Failure;
use hangpose_core::geometry::{Cloud, CloudError, MAX_COUNT};

/// A point cloud in the caller's arrays, in metres. Nothing is kept after the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_cloud {
    /// sizeof(hangpose_cloud), set by the caller.
    pub struct_size: u32,
    /// How many points there are.
    pub point_count: u32,
    /// point_count rows of x, y, z; metres, in supporter coordinates, each within 1,000,000.
    pub points: *const f32,
    /// point_count rows of x, y, z, out of the solid, of any length; zeros where a normal is not known; or null, and
    /// they are estimated.
    pub normals: *const f32,
    /// x, y, z from where the points were seen, metres, which estimated normals face; or null.
    pub viewpoint: *const f32,
}

// SAFETY: `repr(C)` over numbers and pointers, `struct_size` first.
unsafe impl Public for hangpose_cloud {
    const NAME: &'static str = "cloud";
}

impl hangpose_cloud {
    /// The cloud as the core takes it.
    ///
    /// # Safety
    ///
    /// What the caller vouches for, see `border`.
    pub(crate) unsafe fn check(&self) -> Result<Cloud<'_>, Failure> {
        self.check_count()?;
        // SAFETY: as this function's.
        let points = unsafe { rows("cloud.points", self.points, self.point_count) }?;
        let normals = match self.normals.is_null() {
            true => None,
            // SAFETY: as this function's.
            false => Some(unsafe { rows("cloud.normals", self.normals, self.point_count) }?),
        };
        let cloud = Cloud::new(points, normals)?;
        if self.viewpoint.is_null() {
            return Ok(cloud);
        }
        // SAFETY: as this function's.
        let viewpoint = unsafe { rows("cloud.viewpoint", self.viewpoint, 1) }?;
        Ok(cloud.seen_from(viewpoint[0])?)
    }

    /// Checks the count before anything is read that may not be there.
    pub(crate) fn check_count(&self) -> Result<(), Failure> {
        match self.point_count as usize {
            0 => Err(CloudError::Empty.into()),
            count if count > MAX_COUNT => {
                Err(Failure::Count { field: "cloud.point_count", count, most: MAX_COUNT })
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn regions(&self) -> [Region; 4] {
        let rows = |name, pointer: *const f32, count| Region::read(name, pointer.cast::<[f32; 3]>(), count);
        [
            Region::read("cloud", self, 1),
            rows("cloud.points", self.points, self.point_count as usize),
            rows("cloud.normals", self.normals, self.point_count as usize),
            rows("cloud.viewpoint", self.viewpoint, 1),
        ]
    }
}
