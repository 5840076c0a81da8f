use hangpose_core::hanging::HangingPose;

/// A pose in which the object should hang, and what it costs; less is better.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_pose {
    /// sizeof(hangpose_pose), set by the library.
    pub struct_size: u32,
    /// Index of the hanging site, for hangpose_object_site.
    pub object_site: u32,
    /// Index of the support site, for hangpose_supporter_site.
    pub support_site: u32,
    /// 1 where the object's hanging direction is laid against the supporter's, 0 where it is laid along it.
    pub is_reversed: u32,
    /// x, y, z of the object's origin, metres, in supporter coordinates.
    pub position: [f32; 3],
    /// x, y, z, w of the unit quaternion that turns object coordinates into supporter coordinates.
    pub quaternion: [f32; 4],
    /// S_c: points of the supporter inside the object, eq. (8).
    pub collision: u32,
    /// S_b: how far the hanging position is from the middle of the supporter, from 0.5 to 1, eq. (9).
    pub boundary: f32,
    /// S_a: how small the contact area is against the object's largest, from 0 to 1, eq. (10).
    pub contact_area: f32,
    /// S_total: the weighted sum of the three, eq. (11).
    pub total: f32,
}

impl From<&HangingPose> for hangpose_pose {
    fn from(pose: &HangingPose) -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            object_site: pose.object_site,
            support_site: pose.support_site,
            is_reversed: u32::from(pose.is_reversed),
            position: pose.pose.translation.vector.into(),
            quaternion: pose.pose.rotation.coords.into(),
            collision: pose.cost.collision,
            boundary: pose.cost.boundary,
            contact_area: pose.cost.contact_area,
            total: pose.cost.total,
        }
    }
}
