//! Paths to poses: what a C caller is given, and what is wrong with broken calls.

use super::*;
use std::ffi::c_void;

const WAYPOINTS: usize = 400;

/// What a call is given beside the models.
struct Asked {
    motion: hangpose_motion,
    monitor: *mut hangpose_monitor,
    capacity: u32,
    /// Bytes fewer than are needed.
    missing: usize,
}

impl Asked {
    fn new() -> Self {
        // SAFETY: all fields are numbers and pointers, and the call sets them.
        let motion = unsafe {
            let mut motion: hangpose_motion = std::mem::zeroed();
            let status = hangpose_motion_init(&mut motion, size_of::<hangpose_motion>(), null_mut());
            assert_eq!(status, HANGPOSE_OK);
            motion
        };
        Self { motion, monitor: null_mut(), capacity: WAYPOINTS as u32, missing: 0 }
    }
}

/// What a call has written.
struct Planned {
    status: hangpose_status,
    poses: [hangpose_pose; POSES],
    failures: [hangpose_plan_failure; POSES],
    waypoints: [hangpose_waypoint; WAYPOINTS],
    prediction: hangpose_prediction,
    plan: hangpose_plan,
    detail: hangpose_detail,
}

impl Planned {
    fn nothing() -> Self {
        // SAFETY: every bit pattern is valid for these structs.
        let mut planned: Self = unsafe { std::mem::zeroed() };
        planned.prediction.struct_size = size_of::<hangpose_prediction>() as u32;
        planned.plan.struct_size = size_of::<hangpose_plan>() as u32;
        planned.detail.struct_size = size_of::<hangpose_detail>() as u32;
        planned
    }

    /// The waypoints of the object, and those of the gripper.
    fn path(&self) -> (&[hangpose_waypoint], &[hangpose_waypoint]) {
        let (object, rest) = self.waypoints.split_at(self.plan.waypoint_count as usize);
        (object, &rest[..self.plan.gripper_waypoint_count as usize])
    }

    fn message(&self) -> String {
        text(&self.detail.message)
    }

    /// Asserts that there is no path for a reason.
    #[track_caller]
    fn has_none(&self, status: hangpose_status, reason: hangpose_plan_reason) {
        assert_eq!((self.status, self.plan.failure.reason), (status, reason), "{}", self.message());
        assert_eq!((self.plan.has_path, self.plan.waypoint_count), (0, 0));
        assert!(bytes(&self.waypoints).iter().all(|byte| *byte == 0));
    }

    /// Asserts that the call says what is wrong and writes nothing else.
    #[track_caller]
    fn is_refused(&self, status: hangpose_status, field: &str) {
        assert_eq!((self.status, text(&self.detail.field).as_str()), (status, field), "{}", self.message());
        assert!(bytes(&self.waypoints).iter().all(|byte| *byte == 0));
        assert_eq!((self.plan.has_path, self.plan.distance_queries), (0, 0));
    }
}

impl Scene {
    fn limits(&self, asked: &Asked) -> hangpose_limits {
        let (points, poses) = (self.points.len() as u32, POSES as u32);
        hangpose_limits { points, poses, nodes: asked.motion.nodes, waypoints: asked.capacity, ..NO_LIMITS }
    }

    fn predict_reachable(&self, asked: &Asked) -> Planned {
        // SAFETY: the pointer leads to valid limits.
        let size = unsafe { hangpose_reachable_bytes(&self.limits(asked)) } - asked.missing;
        let (mut work, mut planned) = (vec![0_u8; size], Planned::nothing());
        // SAFETY: the pointers lead to valid values.
        planned.status = unsafe {
            hangpose_predict_reachable(
                self.ring.model,
                self.pegs.model,
                null(),
                &self.params,
                &asked.motion,
                work.as_mut_ptr().cast(),
                work.len(),
                asked.monitor,
                planned.poses.as_mut_ptr(),
                size_of::<hangpose_pose>(),
                POSES as u32,
                planned.failures.as_mut_ptr(),
                size_of::<hangpose_plan_failure>(),
                planned.waypoints.as_mut_ptr(),
                size_of::<hangpose_waypoint>(),
                asked.capacity,
                &mut planned.prediction,
                &mut planned.plan,
                &mut planned.detail,
            )
        };
        planned
    }

    fn plan_path(&self, asked: &Asked, goal: *const hangpose_pose) -> Planned {
        // SAFETY: the pointer leads to valid limits.
        let size = unsafe { hangpose_plan_bytes(&self.limits(asked)) } - asked.missing;
        let (mut work, mut planned) = (vec![0_u8; size], Planned::nothing());
        // SAFETY: the pointers lead to valid values, and the goal is what a test makes it.
        planned.status = unsafe {
            hangpose_plan_path(
                self.ring.model,
                self.pegs.model,
                null(),
                &self.params,
                &asked.motion,
                goal,
                work.as_mut_ptr().cast(),
                work.len(),
                asked.monitor,
                planned.waypoints.as_mut_ptr(),
                size_of::<hangpose_waypoint>(),
                asked.capacity,
                &mut planned.plan,
                &mut planned.detail,
            )
        };
        planned
    }
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt()
}

#[test]
fn a_path_leads_over_the_release_pose_to_just_before_the_rest_pose() {
    let (scene, asked) = (Scene::new(), Asked::new());
    let planned = scene.predict_reachable(&asked);
    assert_eq!(planned.status, HANGPOSE_OK, "{}", planned.message());
    let pose = &planned.poses[planned.plan.pose_index as usize];
    let (object, gripper) = planned.path();
    assert_eq!((planned.plan.has_path, gripper.len()), (1, 0));
    assert!(planned.plan.clearance > 0.0);
    let (release, last) = (&object[planned.plan.release as usize], object.last().unwrap());
    assert!(distance(release.position, pose.position) < 1e-5);
    let left = distance(last.position, pose.rest_position);
    assert!((0.0001..0.0006).contains(&left), "{left}");
    assert_eq!(object[0].seconds, 0.0);
    assert!(object.windows(2).all(|pair| pair[0].seconds < pair[1].seconds));
    for (index, failure) in planned.failures.iter().enumerate() {
        let is_pose = index < planned.prediction.pose_count as usize;
        match index as u32 {
            index if index < planned.plan.pose_index => assert!(failure.reason > HANGPOSE_PLAN_NOT_TRIED),
            index if index == planned.plan.pose_index => assert_eq!(failure.reason, HANGPOSE_PLAN_FOUND),
            _ => assert_eq!((failure.reason, is_pose || failure.part > 0), (HANGPOSE_PLAN_NOT_TRIED, true)),
        }
    }

    // The same path for the pose alone, whose quaternion is normalised again.
    let alone = scene.plan_path(&asked, pose);
    assert_eq!((alone.status, alone.plan.pose_index), (HANGPOSE_OK, 0), "{}", alone.message());
    assert_eq!(alone.path().0.len(), object.len());
    for (one, other) in alone.path().0.iter().zip(object) {
        assert!(distance(one.position, other.position) < 1e-5 && (one.seconds - other.seconds).abs() < 1e-3);
    }

    // Without a rest pose it ends at the release pose.
    let mut released = *pose;
    released.has_rest = 0;
    let released = scene.plan_path(&asked, &released);
    assert_eq!(released.status, HANGPOSE_OK, "{}", released.message());
    assert!(distance(released.path().0.last().unwrap().position, pose.position) < 1e-5);
}

#[test]
fn the_way_back_ends_where_it_is_asked_to() {
    let scene = Scene::new();
    let mut asked = Asked::new();
    (asked.motion.take_off, asked.motion.has_start) = (1, 1);
    asked.motion.start_position = [0.0, -0.2, 0.3];
    // A ball below the ring that opens downwards.
    let part = hangpose_capsule {
        from: [0.0, -0.05, 0.0],
        to: [0.0, -0.05, 0.0],
        radius: 0.015,
        opening: [0.0, -0.01, 0.0],
    };
    (asked.motion.part_count, asked.motion.parts) = (1, &part);
    asked.motion.retreat = [0.0, -0.1, 0.0];
    let planned = scene.predict_reachable(&asked);
    assert_eq!(planned.status, HANGPOSE_OK, "{}", planned.message());
    let pose = &planned.poses[planned.plan.pose_index as usize];
    let (object, gripper) = planned.path();
    let left = distance(object[0].position, pose.rest_position);
    assert!((0.0001..0.0006).contains(&left), "{left}");
    assert!(distance(object[planned.plan.release as usize].position, pose.position) < 1e-5);
    assert!(distance(object.last().unwrap().position, asked.motion.start_position) < 1e-5);
    let arrived = gripper.last().unwrap();
    assert!(arrived.seconds <= object[0].seconds && gripper[0].seconds == 0.0);
    assert!(distance(arrived.position, object[0].position) < 1e-6);
}

unsafe extern "C" fn refuse(_: *mut c_void, _: *const f32, _: *const f32) -> i32 {
    0
}

/// Cancels the monitor that it is given, and accepts the pose.
unsafe extern "C" fn cancel(monitor: *mut c_void, _: *const f32, _: *const f32) -> i32 {
    // SAFETY: the context is a monitor.
    unsafe { hangpose_monitor_cancel(monitor.cast()) };
    1
}

/// Counts in its context, and accepts what is a pose.
unsafe extern "C" fn count(asked: *mut c_void, position: *const f32, quaternion: *const f32) -> i32 {
    // SAFETY: the context is a number, the others lead to three and four numbers.
    let (asked, position, quaternion) = unsafe {
        (
            &mut *asked.cast::<u32>(),
            std::slice::from_raw_parts(position, 3),
            std::slice::from_raw_parts(quaternion, 4),
        )
    };
    *asked += 1;
    let norm: f32 = quaternion.iter().map(|x| x * x).sum();
    i32::from(position.iter().all(|x| x.abs() < 10.0) && (norm - 1.0).abs() < 1e-4)
}

#[test]
fn the_caller_decides_what_can_be_reached() {
    let scene = Scene::new();
    let mut asked = Asked::new();
    let mut calls = 0_u32;
    asked.motion.accepts = Some(count);
    asked.motion.context = (&raw mut calls).cast();
    let best = scene.predict_reachable(&asked);
    assert_eq!(best.status, HANGPOSE_OK, "{}", best.message());
    assert!(calls > 2 && best.plan.asked <= calls, "{calls}");

    asked.motion.accepts = Some(refuse);
    let none = scene.predict_reachable(&asked);
    none.has_none(HANGPOSE_NO_PATH, HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE);
    let count = none.prediction.pose_count as usize;
    assert_eq!(none.plan.pose_index as usize, count - 1, "all poses were tried");
    let reasons = none.failures.map(|failure| failure.reason);
    assert!(reasons[..count].iter().all(|reason| *reason == HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE));
    let one = scene.plan_path(&asked, &best.poses[0]);
    one.has_none(HANGPOSE_NO_PATH, HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE);
    assert_eq!(one.plan.asked, 1, "it is asked as seldom as possible");
}

#[test]
fn the_callback_may_cancel() {
    let scene = Scene::new();
    // SAFETY: all fields are numbers, and the call sets them.
    let mut monitor: hangpose_monitor = unsafe { std::mem::zeroed() };
    let mut start = || {
        // SAFETY: the pointer leads to a monitor that no call uses.
        unsafe {
            let size = size_of::<hangpose_monitor>();
            hangpose_monitor_init(&mut monitor, size, HANGPOSE_NO_WORK_LIMIT, null_mut())
        };
        &raw mut monitor
    };
    let mut asked = Asked { monitor: start(), ..Asked::new() };
    asked.motion.accepts = Some(cancel);
    asked.motion.context = asked.monitor.cast();
    let planned = scene.predict_reachable(&asked);
    planned.has_none(HANGPOSE_CANCELLED, HANGPOSE_PLAN_STOPPED);
    assert_eq!(planned.plan.failure.stopped, HANGPOSE_CANCELLED);
    assert!(planned.prediction.pose_count > 0 && planned.plan.pose_index == 0);
    start();
    let one = scene.plan_path(&asked, &planned.poses[0]);
    one.has_none(HANGPOSE_CANCELLED, HANGPOSE_PLAN_STOPPED);
}

#[test]
fn a_work_limit_stops_the_search() {
    let scene = Scene::new();
    let best = scene.predict_reachable(&Asked::new()).poses[0];
    // SAFETY: all fields are numbers, and the call sets them.
    let mut monitor: hangpose_monitor = unsafe { std::mem::zeroed() };
    // SAFETY: the pointer leads to a monitor that no call uses.
    unsafe { hangpose_monitor_init(&mut monitor, size_of::<hangpose_monitor>(), 10, null_mut()) };
    let planned = scene.plan_path(&Asked { monitor: &mut monitor, ..Asked::new() }, &best);
    planned.has_none(HANGPOSE_WORK_LIMIT, HANGPOSE_PLAN_STOPPED);
    assert_eq!(planned.plan.failure.stopped, HANGPOSE_WORK_LIMIT);
}

#[test]
fn too_little_room_is_an_error_that_says_how_much_is_needed() {
    let scene = Scene::new();
    let planned = scene.predict_reachable(&Asked { capacity: 3, ..Asked::new() });
    planned.is_refused(HANGPOSE_ERROR_CAPACITY, "waypoint_capacity");
    assert!(planned.detail.value == 3.0 && planned.detail.minimum > 3.0);
    let best = scene.predict_reachable(&Asked { capacity: planned.detail.minimum as u32, ..Asked::new() });
    assert_eq!(best.status, HANGPOSE_OK, "{}", best.message());
    let none = Asked { capacity: 0, ..Asked::new() };
    scene.predict_reachable(&none).is_refused(HANGPOSE_ERROR_COUNT, "waypoint_capacity");
    let tight = Asked { missing: 1, ..Asked::new() };
    scene.predict_reachable(&tight).is_refused(HANGPOSE_ERROR_MEMORY, "memory");
    scene.plan_path(&tight, &best.poses[0]).is_refused(HANGPOSE_ERROR_MEMORY, "memory");
}

#[test]
fn goals_that_are_no_poses_are_named() {
    let (scene, asked) = (Scene::new(), Asked::new());
    let good = scene.predict_reachable(&asked).poses[0];
    let refused =
        |goal: hangpose_pose, status, field| scene.plan_path(&asked, &goal).is_refused(status, field);
    scene.plan_path(&asked, null()).is_refused(HANGPOSE_ERROR_NULL, "goal");
    refused(hangpose_pose { struct_size: 4, ..good }, HANGPOSE_ERROR_STRUCT_SIZE, "goal.struct_size");
    refused(hangpose_pose { has_pose: 0, ..good }, HANGPOSE_ERROR_VALUE, "goal.has_pose");
    refused(hangpose_pose { has_rest: 2, ..good }, HANGPOSE_ERROR_VALUE, "goal.has_rest");
    let nowhere = [0.0, f32::NAN, 0.0];
    refused(hangpose_pose { position: nowhere, ..good }, HANGPOSE_ERROR_VALUE, "goal.position");
    refused(hangpose_pose { rest_position: nowhere, ..good }, HANGPOSE_ERROR_VALUE, "goal.rest_position");
    refused(hangpose_pose { quaternion: [0.0; 4], ..good }, HANGPOSE_ERROR_VALUE, "goal.quaternion");
    refused(
        hangpose_pose { rest_quaternion: [0.0; 4], ..good },
        HANGPOSE_ERROR_VALUE,
        "goal.rest_quaternion",
    );
}

#[test]
fn broken_motions_are_named() {
    let scene = Scene::new();
    let parts = [hangpose_capsule { from: [0.0; 3], to: [0.0; 3], radius: -1.0, opening: [0.0; 3] }; 2];
    let refused = |change: &dyn Fn(&mut hangpose_motion), status, field| {
        let mut asked = Asked::new();
        change(&mut asked.motion);
        let planned = scene.predict_reachable(&asked);
        planned.is_refused(status, field);
        planned.detail.index
    };
    let value = HANGPOSE_ERROR_VALUE;
    refused(&|motion| motion.clearance = 0.0, value, "motion.clearance");
    let index =
        refused(&|motion| (motion.part_count, motion.parts) = (2, parts.as_ptr()), value, "motion.parts");
    assert_eq!(index, 0);
    refused(&|motion| motion.part_count = 1, HANGPOSE_ERROR_NULL, "motion.parts");
    refused(
        &|motion| (motion.part_count, motion.parts) = (65, parts.as_ptr()),
        HANGPOSE_ERROR_COUNT,
        "motion.part_count",
    );
    refused(&|motion| motion.struct_size = 3, HANGPOSE_ERROR_STRUCT_SIZE, "motion.struct_size");
}
