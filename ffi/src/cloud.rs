use crate::border::{Public, Region, elements, rows};
use crate::failure::Failure;
use hangpose_core::geometry::{Cloud, CloudError, MAX_COUNT};

/// A point cloud in the caller's arrays. The library keeps no pointer to the arrays after the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_cloud {
    /// sizeof(hangpose_cloud), set by the caller.
    pub struct_size: u32,
    /// Number of points.
    pub point_count: u32,
    /// Number of viewpoints; 0 if none is known.
    pub viewpoint_count: u32,
    /// Array of point_count rows of x, y, z: metres, in supporter coordinates, each within +-1,000,000.
    pub points: *const f32,
    /// Array of point_count rows of x, y, z: normals that point out of the solid, of any length. Normals that point
    /// into the solid, or whose signs disagree with each other, are reversed. A row of zeros marks an unknown
    /// normal. May be null: no normal is known. Unknown normals are estimated; they follow the known normals
    /// around them.
    pub normals: *const f32,
    /// Array of viewpoint_count rows of x, y, z: positions of the sensor from which the points were seen, metres, in
    /// supporter coordinates. If no normal is known, the estimated normals face them. May be null if
    /// viewpoint_count is 0: the normals are then oriented from point to point, and the pieces of the cloud vote on
    /// their outside with the surfaces opposite to them.
    pub viewpoints: *const f32,
    /// Array of point_count marks: 0 for points on which nothing shall hang, which are obstacles. May be null: an
    /// object may hang on any point.
    pub marks: *const u8,
    /// Two rows of x, y, z: lower and upper corner of the box within which objects may hang, metres, in supporter
    /// coordinates. Points outside are obstacles. May be null: an object may hang anywhere.
    pub region: *const f32,
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
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn check(&self) -> Result<Cloud<'_>, Failure> {
        self.check_count()?;
        // SAFETY: those of this function.
        let points = unsafe { rows("cloud.points", self.points, self.point_count) }?;
        let normals = match self.normals.is_null() {
            true => None,
            // SAFETY: those of this function.
            false => Some(unsafe { rows("cloud.normals", self.normals, self.point_count) }?),
        };
        // SAFETY: those of this function.
        let viewpoints = unsafe { rows("cloud.viewpoints", self.viewpoints, self.viewpoint_count) }?;
        let mut cloud = Cloud::new(points, normals)?.seen_from(viewpoints)?;
        if !self.marks.is_null() {
            // SAFETY: those of this function.
            cloud = cloud.hang_on(unsafe { elements("cloud.marks", self.marks, self.point_count) }?)?;
        }
        if !self.region.is_null() {
            // SAFETY: those of this function.
            let corners = unsafe { rows("cloud.region", self.region, 2) }?;
            cloud = cloud.hang_within(corners[0], corners[1])?;
        }
        Ok(cloud)
    }

    /// Checks the count before the arrays are read.
    pub(crate) fn check_count(&self) -> Result<(), Failure> {
        match self.point_count as usize {
            0 => Err(CloudError::Empty.into()),
            count if count > MAX_COUNT => {
                Err(Failure::Count { field: "cloud.point_count", count, most: MAX_COUNT })
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn regions(&self) -> [Region; 6] {
        let rows = |name, pointer: *const f32, count| Region::read(name, pointer.cast::<[f32; 3]>(), count);
        [
            Region::read("cloud", self, 1),
            rows("cloud.points", self.points, self.point_count as usize),
            rows("cloud.normals", self.normals, self.point_count as usize),
            rows("cloud.viewpoints", self.viewpoints, self.viewpoint_count as usize),
            Region::read("cloud.marks", self.marks, self.point_count as usize),
            rows("cloud.region", self.region, 2),
        ]
    }
}
