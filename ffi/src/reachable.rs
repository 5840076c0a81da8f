use crate::border::{
    DETAIL, Region, check, check_size, input, keep_apart, memory as caller_memory, optional_input, output,
    report,
};
use crate::detail::{HANGPOSE_NO_INDEX, hangpose_detail};
use crate::failure::Failure;
use crate::monitor::{self, hangpose_monitor};
use crate::motion::hangpose_motion;
use crate::object::{ObjectHandle, hangpose_object};
use crate::params::hangpose_params;
use crate::plan::{check_waypoints, hangpose_plan, plan_status, write_waypoints};
use crate::plan_failure::{HANGPOSE_PLAN_FOUND, HANGPOSE_PLAN_NOT_TRIED, hangpose_plan_failure};
use crate::pose::hangpose_pose;
use crate::predict::hangpose_prediction;
use crate::request::{HungObjects, hangpose_request};
use crate::slots::{check_room, slot_bytes, slots};
use crate::status::*;
use crate::supporter::{SupporterHandle, hangpose_supporter};
use crate::waypoint::hangpose_waypoint;
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::geometry::Pose;
use hangpose_core::hanging::HangingPose;
use hangpose_core::memory::Limits;
use hangpose_core::motion::{PlanFailure, Reachable, Task, Waypoint, predict_reachable, reachable_bytes};

/// Does what hangpose_predict does, then plans a path to one pose after another, best first, until one has a path, as
/// hangpose_plan_path does. The models must have been analysed with hangpose_params.voxels.
///
/// `failures` is an array of `pose_capacity` structs, or null: for each of `poses` whether it has a path, and if not, why.
/// `failure_size` is sizeof(hangpose_plan_failure). `plan` and `waypoints` are those of the last pose for which a path was
/// planned, whose index is plan->pose_index. `memory` is working memory of at least hangpose_reachable_bytes. Set
/// prediction->struct_size and plan->struct_size before the call. A work limit of `monitor` holds for the prediction and
/// for each of the plans.
///
/// Returns HANGPOSE_OK with a path; HANGPOSE_NO_PATH with poses none of which has one; HANGPOSE_REJECTED without poses;
/// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with what was found so far, possibly with a path; HANGPOSE_ERROR_CAPACITY if
/// the path has more waypoints than there is room for; or another error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_predict_reachable(
    object: *const hangpose_object,
    supporter: *const hangpose_supporter,
    request: *const hangpose_request,
    params: *const hangpose_params,
    motion: *const hangpose_motion,
    memory: *mut c_void,
    memory_size: usize,
    monitor: *mut hangpose_monitor,
    poses: *mut hangpose_pose,
    pose_size: usize,
    pose_capacity: u32,
    failures: *mut hangpose_plan_failure,
    failure_size: usize,
    waypoints: *mut hangpose_waypoint,
    waypoint_size: usize,
    waypoint_capacity: u32,
    prediction: *mut hangpose_prediction,
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
        check_size::<hangpose_pose>(pose_size)?;
        check_size::<hangpose_plan_failure>(failure_size)?;
        check_size::<hangpose_waypoint>(waypoint_size)?;
        let written = [
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("poses", poses, pose_capacity as usize),
            Region::written("failures", failures, pose_capacity as usize),
            Region::written("waypoints", waypoints, waypoint_capacity as usize),
            Region::written("prediction", prediction, 1),
            Region::written("plan", plan, 1),
            Region::written("monitor", monitor, 1),
        ];
        keep_apart(&written)?;
        let own = [Region::read("params", params, 1)];
        let read = own.into_iter().chain(object.regions()).chain(supporter.regions());
        for read in read.chain(request.regions()).chain(hung.regions()).chain(motion.regions()) {
            let [one, two, three, four, five, six, seven, eight] = written;
            keep_apart(&[one, two, three, four, five, six, seven, eight, read])?;
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (params, monitor, prediction, answer, memory) = unsafe {
            (
                input(params)?.to_core()?,
                monitor::of(monitor)?,
                output(prediction)?,
                output(plan)?,
                caller_memory(memory.cast(), memory_size)?,
            )
        };
        check("poses", poses.cast_const())?;
        if pose_capacity == 0 {
            return Err(Failure::Count { field: "pose_capacity", count: 0, most: u32::MAX as usize });
        }
        if !failures.is_null() {
            check("failures", failures.cast_const())?;
        }
        check_waypoints(waypoints, waypoint_capacity)?;
        let hung = hung.list();
        // SAFETY: the caller vouches for the arrays, which are apart from what is written.
        let (symmetries, parts) = unsafe { (request.symmetries()?, motion.parts()?) };
        // SAFETY: as above.
        let request = unsafe { request.check(&hung, symmetries.as_deref()) }?;
        let (object, supporter) = (object.model(), supporter.model());
        let moved = motion.check(&parts)?;
        let (count, capacity) = (pose_capacity as usize, waypoint_capacity as usize);
        let needed = reachable_needs(&supporter.limits(), request.scene.len(), moved.nodes, count, capacity);
        check_room(memory, needed)?;
        let (pose_slots, memory) = slots(memory, count);
        let (failure_slots, memory) = slots(memory, count);
        let (waypoint_slots, memory) = slots(memory, capacity);
        let task = Task { object, supporter, request: &request, params: &params, motion: moved };
        // SAFETY: the caller vouches for the function pointer.
        let mut accepts = |pose: &Pose| unsafe { motion.accepts(pose) };
        let none = Monitor::new();
        let found = predict_reachable(
            &task,
            pose_slots,
            failure_slots,
            waypoint_slots,
            &mut accepts,
            memory,
            monitor.unwrap_or(&none),
        )?;
        for (index, pose) in found.prediction.poses.iter().enumerate() {
            // SAFETY: aligned, not null, and `index` is below the capacity that the caller vouches for.
            unsafe { poses.add(index).write(pose.into()) };
        }
        if !failures.is_null() {
            for (index, failure) in failure_slots.iter().enumerate() {
                let failure = failure_at(&found, index, failure.as_ref());
                // SAFETY: aligned, not null, and `index` is below the capacity that the caller vouches for.
                unsafe { failures.add(index).write(failure) };
            }
        }
        if let Some(plan) = &found.plan {
            // SAFETY: aligned and not null; the caller vouches for the capacity, and a path has no more waypoints.
            unsafe { write_waypoints(plan, waypoints) };
        }
        *prediction = (&found.prediction).into();
        *answer = match &found.plan {
            Some(plan) => hangpose_plan { pose_index: found.planned as u32 - 1, ..plan.into() },
            None => hangpose_plan {
                pose_index: HANGPOSE_NO_INDEX,
                ..hangpose_plan::without_path(hangpose_plan_failure::of(HANGPOSE_PLAN_NOT_TRIED))
            },
        };
        Ok(match (found.prediction.stopped, &found.plan) {
            (Some(stop), _) => stopped(Some(stop)),
            (None, None) => HANGPOSE_REJECTED,
            (None, Some(plan)) => plan_status(plan),
        })
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, call) }
}

/// Bytes of working memory for a prediction with a path, with the poses, their failures and the waypoints.
pub(crate) fn reachable_needs(
    limits: &Limits,
    scene: usize,
    nodes: usize,
    poses: usize,
    waypoints: usize,
) -> usize {
    slot_bytes::<HangingPose>(poses)
        .saturating_add(slot_bytes::<Option<PlanFailure>>(poses))
        .saturating_add(slot_bytes::<Waypoint>(waypoints))
        .saturating_add(reachable_bytes(limits, scene, nodes))
}

/// Whether the pose with this index has a path, and if not, why.
fn failure_at(found: &Reachable, index: usize, failure: Option<&PlanFailure>) -> hangpose_plan_failure {
    match failure {
        Some(failure) => failure.into(),
        None if index < found.planned => hangpose_plan_failure::of(HANGPOSE_PLAN_FOUND),
        None => hangpose_plan_failure::of(HANGPOSE_PLAN_NOT_TRIED),
    }
}
