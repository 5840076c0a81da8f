use crate::border::Public;
use hangpose_core::motion::Waypoint;

/// A pose of a path at a time. Written by hangpose_plan_path and hangpose_predict_reachable.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_waypoint {
    /// sizeof(hangpose_waypoint), set by the library.
    pub struct_size: u32,
    /// Time since the start, seconds.
    pub seconds: f32,
    /// x, y, z of the origin of the object, metres, in supporter coordinates; or, after the gripper has let go, of the
    /// object coordinates in which the gripper is given.
    pub position: [f32; 3],
    /// x, y, z, w of the unit quaternion that rotates object coordinates into supporter coordinates.
    pub quaternion: [f32; 4],
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_waypoint {
    const NAME: &'static str = "waypoints";
}

impl From<&Waypoint> for hangpose_waypoint {
    fn from(&Waypoint { seconds, pose }: &Waypoint) -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            seconds,
            position: pose.translation.vector.into(),
            quaternion: pose.rotation.coords.into(),
        }
    }
}
