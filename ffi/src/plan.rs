use crate::border::{
    DETAIL, Public, Region, check, check_size, input, keep_apart, memory as caller_memory, optional_input,
    output, report,
};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::goal::{GOAL, goal as goal_of};
use crate::monitor::{self, hangpose_monitor};
use crate::motion::hangpose_motion;
use crate::object::{ObjectHandle, hangpose_object};
use crate::params::hangpose_params;
use crate::plan_failure::{HANGPOSE_PLAN_FOUND, hangpose_plan_failure};
use crate::pose::hangpose_pose;
use crate::request::{HungObjects, hangpose_request};
use crate::slots::{check_room, slot_bytes, slots};
use crate::status::*;
use crate::supporter::{SupporterHandle, hangpose_supporter};
use crate::waypoint::hangpose_waypoint;
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::geometry::Pose;
use hangpose_core::memory::Limits;
use hangpose_core::motion::{Plan, Task, Waypoint, plan as find_path, plan_bytes};

/// Result of hangpose_plan_path and hangpose_predict_reachable beside the waypoints.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_plan {
    /// sizeof(hangpose_plan), set by the caller.
    pub struct_size: u32,
    /// 1 if there is a path. Else 0, and the fields from waypoint_count to clearance are 0 or NaN.
    pub has_path: u32,
    /// With hangpose_predict_reachable the index of the pose for which the path was planned, HANGPOSE_NO_INDEX if there is
    /// no pose; else 0.
    pub pose_index: u32,
    /// Number of waypoints of the object, at the front of the array: from the start to the release pose, and on towards the rest
    /// pose, to where the object is 0.3 mm from the supporter; with hangpose_motion.take_off the other way.
    pub waypoint_count: u32,
    /// Index of the release pose. The waypoints after it lower the object until it nearly touches.
    pub release: u32,
    /// Number of waypoints of the opened gripper, after those of the object: away from it once it rests; with
    /// hangpose_motion.take_off towards it, before it moves. 0 without a gripper.
    pub gripper_waypoint_count: u32,
    /// Least distance of the object, or of the gripper that holds it, from everything else between start and release pose,
    /// metres: a lower bound, at most 0.05.
    pub clearance: f32,
    /// Why there is no path; its `reason` is HANGPOSE_PLAN_FOUND if there is one.
    pub failure: hangpose_plan_failure,
    /// Number of poses sampled.
    pub samples: u32,
    /// Number of nodes of the trees.
    pub nodes: u32,
    /// Number of poses tested for collision.
    pub tested: u32,
    /// Number of poses that hangpose_motion.accepts was asked about.
    pub asked: u32,
    /// Number of rays cast.
    pub rays: u64,
    /// Number of distance and inside-outside queries.
    pub distance_queries: u64,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_plan {
    const NAME: &'static str = "plan";
}

/// Plans a path of `object` to the pose `goal` on `supporter`, and of the gripper away from it; or, with
/// hangpose_motion.take_off, the other way. Both models must have been analysed with these `params`, the object with
/// hangpose_params.voxels.
///
/// `goal` is a pose of hangpose_predict or one of the caller's, of which struct_size, has_pose = 1, position, quaternion and
/// has_rest are read, and with has_rest = 1 rest_position and rest_quaternion. Of `request` the scene and the
/// objects that hang already are obstacles; it may be null. `motion` may be null: from anywhere, without a gripper.
///
/// `memory` is working memory of at least hangpose_plan_bytes, needed during the call only. `monitor` may be null.
/// `waypoints` is an array of `waypoint_capacity` structs, and `waypoint_size` is sizeof(hangpose_waypoint). Set
/// plan->struct_size before the call. Everything else is as for hangpose_predict.
///
/// Returns HANGPOSE_OK with a path; HANGPOSE_NO_PATH without one, and plan->failure gives the reason; HANGPOSE_CANCELLED or
/// HANGPOSE_WORK_LIMIT if the monitor stopped the search; HANGPOSE_ERROR_CAPACITY if the path has more waypoints than there
/// is room for; or another error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_plan_path(
    object: *const hangpose_object,
    supporter: *const hangpose_supporter,
    request: *const hangpose_request,
    params: *const hangpose_params,
    motion: *const hangpose_motion,
    goal: *const hangpose_pose,
    memory: *mut c_void,
    memory_size: usize,
    monitor: *mut hangpose_monitor,
    waypoints: *mut hangpose_waypoint,
    waypoint_size: usize,
    waypoint_capacity: u32,
    plan: *mut hangpose_plan,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let call = || {
        let (anything, free) = (hangpose_request::any(), hangpose_motion::default());
        // SAFETY: the caller vouches for the pointers.
        let (object, supporter, request, motion) = unsafe {
            (
                ObjectHandle::share(object.cast())?,
                SupporterHandle::share(supporter.cast())?,
                optional_input(request)?.unwrap_or(&anything),
                optional_input(motion)?.unwrap_or(&free),
            )
        };
        // SAFETY: as above.
        let hung = unsafe { HungObjects::of(request) }?;
        check_size::<hangpose_waypoint>(waypoint_size)?;
        let written = [
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("waypoints", waypoints, waypoint_capacity as usize),
            Region::written("plan", plan, 1),
            Region::written("monitor", monitor, 1),
        ];
        keep_apart(&written)?;
        let own = [Region::read("params", params, 1), Region::read(GOAL, goal, 1)];
        let read = own.into_iter().chain(object.regions()).chain(supporter.regions());
        for read in read.chain(request.regions()).chain(hung.regions()).chain(motion.regions()) {
            let [one, two, three, four, five] = written;
            keep_apart(&[one, two, three, four, five, read])?;
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (params, goal, monitor, answer, memory) = unsafe {
            (
                input(params)?.to_core()?,
                goal_of(goal)?,
                monitor::of(monitor)?,
                output(plan)?,
                caller_memory(memory.cast(), memory_size)?,
            )
        };
        check_waypoints(waypoints, waypoint_capacity)?;
        let hung = hung.list();
        // SAFETY: the caller vouches for the arrays, which are apart from what is written.
        let (symmetries, parts) = unsafe { (request.symmetries()?, motion.parts()?) };
        // SAFETY: as above.
        let request = unsafe { request.check(&hung, symmetries.as_deref()) }?;
        let (object, supporter) = (object.model(), supporter.model());
        let moved = motion.check(&parts)?;
        let capacity = waypoint_capacity as usize;
        check_room(memory, plan_needs(&supporter.limits(), request.scene.len(), moved.nodes, capacity))?;
        let (slots, memory) = slots(memory, capacity);
        let task = Task { object, supporter, request: &request, params: &params, motion: moved };
        // SAFETY: the caller vouches for the function pointer.
        let mut accepts = |pose: &Pose| unsafe { motion.accepts(pose) };
        let none = Monitor::new();
        let found = find_path(&task, &goal, slots, &mut accepts, memory, monitor.unwrap_or(&none))?;
        // SAFETY: aligned and not null; the caller vouches for the capacity, and a path has no more waypoints.
        unsafe { write_waypoints(&found, waypoints) };
        *answer = (&found).into();
        Ok(plan_status(&found))
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, call) }
}

/// Bytes of working memory for a plan, with its waypoints.
pub(crate) fn plan_needs(limits: &Limits, scene: usize, nodes: usize, waypoints: usize) -> usize {
    slot_bytes::<Waypoint>(waypoints).saturating_add(plan_bytes(limits, scene, nodes))
}

/// Checks an array for waypoints.
pub(crate) fn check_waypoints(waypoints: *mut hangpose_waypoint, capacity: u32) -> Result<(), Failure> {
    check("waypoints", waypoints.cast_const())?;
    if capacity == 0 {
        return Err(Failure::Count { field: "waypoint_capacity", count: 0, most: u32::MAX as usize });
    }
    Ok(())
}

/// Writes the waypoints of the object, then those of the gripper.
///
/// # Safety
///
/// `waypoints` is aligned and has room for them.
pub(crate) unsafe fn write_waypoints(found: &Plan, waypoints: *mut hangpose_waypoint) {
    let Ok(path) = found.path else { return };
    for (index, waypoint) in path.object.iter().chain(path.gripper).enumerate() {
        // SAFETY: those of this function.
        unsafe { waypoints.add(index).write(waypoint.into()) };
    }
}

/// What a call returns that ends with this plan.
pub(crate) fn plan_status(found: &Plan) -> hangpose_status {
    match (found.stopped(), &found.path) {
        (Some(stop), _) => stopped(Some(stop)),
        (None, Ok(_)) => HANGPOSE_OK,
        (None, Err(_)) => HANGPOSE_NO_PATH,
    }
}

impl hangpose_plan {
    /// No path, for a reason, and no work.
    pub(crate) fn without_path(failure: hangpose_plan_failure) -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            has_path: 0,
            pose_index: 0,
            waypoint_count: 0,
            release: 0,
            gripper_waypoint_count: 0,
            clearance: f32::NAN,
            failure,
            samples: 0,
            nodes: 0,
            tested: 0,
            asked: 0,
            rays: 0,
            distance_queries: 0,
        }
    }
}

impl From<&Plan<'_>> for hangpose_plan {
    fn from(found: &Plan) -> Self {
        let answer = match &found.path {
            Err(failure) => Self::without_path(failure.into()),
            Ok(path) => Self {
                has_path: 1,
                waypoint_count: path.object.len() as u32,
                release: path.release as u32,
                gripper_waypoint_count: path.gripper.len() as u32,
                clearance: path.clearance,
                ..Self::without_path(hangpose_plan_failure::of(HANGPOSE_PLAN_FOUND))
            },
        };
        Self {
            samples: found.counts.samples as u32,
            nodes: found.counts.nodes as u32,
            tested: found.counts.poses as u32,
            asked: found.counts.asked as u32,
            rays: found.work.rays,
            distance_queries: found.work.distance_queries,
            ..answer
        }
    }
}
