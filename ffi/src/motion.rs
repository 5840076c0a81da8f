use crate::border::{DETAIL, Public, Region, check, check_size, elements, keep_apart, report};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::pose::checked_pose;
use crate::status::*;
use core::ffi::c_void;
use hangpose_core::geometry::{Aabb, Pose};
use hangpose_core::hanging::Distance;
use hangpose_core::motion::{Capsule, Gripper, Motion, Speed};

/// Greatest number of parts of a gripper, hangpose_motion.part_count.
pub const HANGPOSE_MAX_PARTS: usize = 64;

/// A part of a gripper: all points within `radius` of a segment; a ball if both ends are the same. In object coordinates.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_capsule {
    /// x, y, z of one end of the segment, metres, each within +-1,000,000.
    pub from: [f32; 3],
    /// x, y, z of the other end, metres, each within +-1,000,000.
    pub to: [f32; 3],
    /// Radius, metres; 0 to 10.
    pub radius: f32,
    /// x, y, z of the displacement when the gripper opens, metres; zeros for parts that do not move, such as the palm.
    pub opening: [f32; 3],
}

/// Returns 1 if the robot can bring the object to a pose, 0 if not, for hangpose_motion.accepts. `context` is
/// hangpose_motion.context. `position` is x, y, z of the origin of the object, metres, and `quaternion` x, y, z, w of the
/// unit quaternion that rotates object coordinates into supporter coordinates; both are valid until it returns. It must
/// not throw or jump out, and must always give the same answer for the same pose. It may cancel the monitor of the call. It
/// must not write to what the call reads, nor touch what the call writes.
pub type hangpose_accepts =
    Option<unsafe extern "C" fn(context: *mut c_void, position: *const f32, quaternion: *const f32) -> i32>;

/// How an object moves to the pose in which it hangs, or away from it. Set the struct with hangpose_motion_init, then
/// change single fields. The library keeps no pointer after the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_motion {
    /// sizeof(hangpose_motion), set by hangpose_motion_init.
    pub struct_size: u32,
    /// 1 if the next two fields say where the object is grasped, or, to take it off, where it is brought; 0, the default,
    /// for any pose outside of the supporter's bounds.
    pub has_start: u32,
    /// x, y, z of the origin of the object at the start, metres, in supporter coordinates, each within +-1,000,000.
    pub start_position: [f32; 3],
    /// x, y, z, w of the quaternion that rotates object coordinates into supporter coordinates; any length but zero.
    pub start_quaternion: [f32; 4],
    /// 1 if the object is taken off instead of hung: the path begins at the rest pose and leads to the start. Default: 0.
    pub take_off: u32,
    /// Number of parts of the gripper; 0, the default, if none is to be planned, up to HANGPOSE_MAX_PARTS.
    pub part_count: u32,
    /// x, y, z of the displacement with which the opened gripper leaves the object, in object coordinates, metres; up to 10
    /// metres long. If this straight way is blocked, another one is planned; zeros leave all of it to the planner.
    pub retreat: [f32; 3],
    /// 1 if all of the object stays in the box of the next two fields; 0, the default, for no limit. The gripper may leave
    /// it.
    pub has_workspace: u32,
    /// x, y, z of the lower corner of the box, metres, in supporter coordinates.
    pub workspace_low: [f32; 3],
    /// x, y, z of the upper corner, metres, each above that of the lower one.
    pub workspace_high: [f32; 3],
    /// Distance from obstacles that the path keeps where there is room for it, metres; above 0, at most 0.1. At the release
    /// pose, and where the way is narrow, it is less, but never a collision. Default: 0.005.
    pub clearance: f32,
    /// Largest distance of the centres of mass at two waypoints one after the other, metres; 0.0001 to 1.
    /// Default: 0.01.
    pub step_position: f32,
    /// Largest rotation from one to the next, radians; 0.001 to pi. Default: 0.1.
    pub step_rotation: f32,
    /// Largest speed of the centre of mass, m/s; above 0, at most 100. Default: 0.25.
    pub speed: f32,
    /// Largest speed of rotation, rad/s; above 0, at most 100. Default: 1.
    pub angular_speed: f32,
    /// Largest acceleration of the centre of mass, m/s^2; above 0, at most 1000. Default: 0.5.
    pub acceleration: f32,
    /// Largest acceleration of rotation, rad/s^2; above 0, at most 1000. Default: 2.
    pub angular_acceleration: f32,
    /// Number of poses that are sampled at most: the budget of the search; 1 to 10,000,000. Default: 400.
    pub samples: u32,
    /// Capacity of either of the two trees, 64 to 1,000,000; the memory depends on it. Default: 4096.
    pub nodes: u32,
    /// Seed of the samples: the same seed gives the same path. Default: 1.
    pub seed: u64,
    /// Array of part_count parts of the gripper as it holds the object. They may touch the object. May be null if
    /// part_count is 0.
    pub parts: *const hangpose_capsule,
    /// Decides which poses of the object the robot can reach, as its inverse kinematics does; null, the default, for all.
    /// It is asked as late and as seldom as possible: first about the goal and the start, then about the waypoints of paths
    /// without collisions. Called during the call only, by the thread that makes it.
    pub accepts: hangpose_accepts,
    /// What `accepts` is given; the library does not look at it.
    pub context: *mut c_void,
}

// SAFETY: `repr(C)` over numbers and pointers, `struct_size` first. A function pointer may have any bits as long as it is
// not called.
unsafe impl Public for hangpose_motion {
    const NAME: &'static str = "motion";
}

/// Sets `motion` to the defaults: from anywhere outside of the supporter's bounds, without a gripper and a workspace.
/// `struct_size` is sizeof(hangpose_motion). Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_motion_init(
    motion: *mut hangpose_motion,
    struct_size: usize,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let init = || {
        check_size::<hangpose_motion>(struct_size)?;
        keep_apart(&[Region::written(DETAIL, detail, 1), Region::written("motion", motion, 1)])?;
        check(hangpose_motion::NAME, motion.cast_const())?;
        // SAFETY: not null, aligned, and of the size that the caller vouches for.
        unsafe { motion.write(hangpose_motion::default()) };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, init) }
}

impl Default for hangpose_motion {
    fn default() -> Self {
        let Motion {
            start: _,
            take_off,
            gripper: _,
            workspace: _,
            clearance,
            step,
            speed,
            samples,
            nodes,
            seed,
        } = Motion::DEFAULT;
        Self {
            struct_size: size_of::<Self>() as u32,
            has_start: 0,
            start_position: [0.0; 3],
            start_quaternion: [0.0, 0.0, 0.0, 1.0],
            take_off: u32::from(take_off),
            part_count: 0,
            retreat: [0.0; 3],
            has_workspace: 0,
            workspace_low: [0.0; 3],
            workspace_high: [0.0; 3],
            clearance,
            step_position: step.position,
            step_rotation: step.rotation,
            speed: speed.linear,
            angular_speed: speed.angular,
            acceleration: speed.linear_acceleration,
            angular_acceleration: speed.angular_acceleration,
            samples: samples as u32,
            nodes: nodes as u32,
            seed,
            parts: core::ptr::null(),
            accepts: None,
            context: core::ptr::null_mut(),
        }
    }
}

impl hangpose_motion {
    /// The parts of the gripper as the core takes them.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn parts(&self) -> Result<heapless::Vec<Capsule, HANGPOSE_MAX_PARTS>, Failure> {
        let count = self.part_count as usize;
        if count == 0 {
            return Ok(heapless::Vec::new());
        }
        if count > HANGPOSE_MAX_PARTS {
            return Err(Failure::Count { field: "motion.part_count", count, most: HANGPOSE_MAX_PARTS });
        }
        // SAFETY: those of this function.
        let parts = unsafe { elements(PARTS, self.parts, self.part_count) }?;
        let to_core =
            |&hangpose_capsule { from, to, radius, opening }: &_| Capsule { from, to, radius, opening };
        Ok(parts.iter().map(to_core).collect())
    }

    /// The motion as the core takes it, each value checked. `parts` is what [`parts`](Self::parts) gives for it.
    pub(crate) fn check<'a>(&self, parts: &'a [Capsule]) -> Result<Motion<'a>, Failure> {
        let is_chosen = |field, value| match value {
            0 => Ok(false),
            1 => Ok(true),
            value => Err(Failure::Choice { field, value, most: 1 }),
        };
        let start = match is_chosen("motion.has_start", self.has_start)? {
            true => Some(checked_pose(
                ("motion.start_position", self.start_position),
                ("motion.start_quaternion", self.start_quaternion),
            )?),
            false => None,
        };
        let (min, max) = (self.workspace_low.into(), self.workspace_high.into());
        let motion = Motion {
            start,
            take_off: is_chosen("motion.take_off", self.take_off)?,
            gripper: (!parts.is_empty()).then_some(Gripper { parts, retreat: self.retreat }),
            workspace: is_chosen("motion.has_workspace", self.has_workspace)?.then_some(Aabb { min, max }),
            clearance: self.clearance,
            step: Distance { position: self.step_position, rotation: self.step_rotation },
            speed: Speed {
                linear: self.speed,
                angular: self.angular_speed,
                linear_acceleration: self.acceleration,
                angular_acceleration: self.angular_acceleration,
            },
            samples: self.samples as usize,
            nodes: self.nodes as usize,
            seed: self.seed,
        };
        match motion.validate() {
            Ok(()) => Ok(motion),
            Err(error) => Err(error.into()),
        }
    }

    /// Whether the object may be at a pose.
    ///
    /// # Safety
    ///
    /// The caller vouches for the function pointer.
    pub(crate) unsafe fn accepts(&self, pose: &Pose) -> bool {
        let Some(accepts) = self.accepts else { return true };
        let (position, quaternion): ([f32; 3], [f32; 4]) =
            (pose.translation.vector.into(), pose.rotation.coords.into());
        // SAFETY: those of this function; both arrays outlive the call.
        unsafe { accepts(self.context, position.as_ptr(), quaternion.as_ptr()) != 0 }
    }

    /// The struct and its array.
    pub(crate) fn regions(&self) -> [Region; 2] {
        let parts = Region::read(PARTS, self.parts, self.part_count as usize);
        [Region::read(Self::NAME, self, 1), parts]
    }
}

/// Name of the array of parts in messages.
const PARTS: &str = "motion.parts";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::Reason;

    #[test]
    fn the_defaults_are_those_of_the_core() {
        assert_eq!(hangpose_motion::default().check(&[]), Ok(Motion::DEFAULT));
    }

    /// The core checks the ranges in the comments above.
    #[test]
    fn what_is_out_of_range_is_named() {
        let right = hangpose_motion::default();
        let named = |motion: hangpose_motion| {
            let failure = motion.check(&[]).unwrap_err();
            assert_eq!(failure.status(), HANGPOSE_ERROR_VALUE);
            failure.place().field
        };
        assert_eq!(named(hangpose_motion { clearance: 0.0, ..right }), "motion.clearance");
        assert_eq!(named(hangpose_motion { step_position: f32::NAN, ..right }), "motion.step_position");
        assert_eq!(named(hangpose_motion { step_position: 1e-12, ..right }), "motion.step_position");
        assert_eq!(named(hangpose_motion { step_rotation: 4.0, ..right }), "motion.step_rotation");
        assert_eq!(named(hangpose_motion { speed: -1.0, ..right }), "motion.speed");
        assert_eq!(named(hangpose_motion { angular_speed: 101.0, ..right }), "motion.angular_speed");
        assert_eq!(named(hangpose_motion { acceleration: 0.0, ..right }), "motion.acceleration");
        assert_eq!(
            named(hangpose_motion { angular_acceleration: 0.0, ..right }),
            "motion.angular_acceleration"
        );
        assert_eq!(named(hangpose_motion { samples: 0, ..right }), "motion.samples");
        assert_eq!(named(hangpose_motion { nodes: 63, ..right }), "motion.nodes");
        assert_eq!(named(hangpose_motion { has_start: 2, ..right }), "motion.has_start");
        assert_eq!(named(hangpose_motion { take_off: 2, ..right }), "motion.take_off");
        assert_eq!(named(hangpose_motion { has_workspace: 2, ..right }), "motion.has_workspace");
        assert_eq!(named(hangpose_motion { has_workspace: 1, ..right }), "motion.workspace_low");
        let far = hangpose_motion { has_start: 1, start_position: [0.0, 1e7, 0.0], ..right };
        assert_eq!(named(far), "motion.start_position");
        let flat = hangpose_motion { has_start: 1, start_quaternion: [0.0; 4], ..right };
        assert_eq!(named(flat), "motion.start_quaternion");
    }
}
