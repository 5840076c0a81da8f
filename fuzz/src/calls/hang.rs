//! Calls about objects, supporters, poses and paths.

use super::given::{self, Sized, check_pose, reached};
use super::{HANDLE, Model, Program, accepts};
use crate::shapes;
use hangpose_ffi::*;
use std::ffi::c_void;
use std::ptr::{null, null_mut};

/// Most models of a kind that a program keeps.
const MOST_MODELS: usize = 3;

/// Arrays that a request and a motion point to.
struct Arrays {
    points: Vec<[f32; 3]>,
    triangle: [[u32; 3]; 1],
    indices: Vec<u32>,
    scene: Vec<[f32; 3]>,
    hung: Vec<hangpose_hung>,
    symmetries: Vec<hangpose_symmetry>,
    parts: Vec<hangpose_capsule>,
    beyond: f32,
}

impl Program<'_> {
    pub(super) fn create_object(&mut self) {
        let drawn = shapes::mesh(&mut self.draw);
        let mesh = given::mesh(&drawn, &mut self.draw);
        let Some(limits) = self.limits(&mesh, null()) else { return };
        let needed = self.bytes_for(&limits, hangpose_object_bytes);
        let (mut block, is_enough) = self.memory(needed);
        let (memory, size) = (block.memory().as_mut_ptr().cast::<c_void>(), block.size());
        let (params, monitor) = (self.params, self.monitor());
        let mut object = null_mut();
        // SAFETY: the pointers lead to valid values, and the memory is that of the block.
        let status = self.call("object_create", |_, detail| unsafe {
            hangpose_object_create(memory, size, &mesh, &params, monitor, &mut object, detail)
        });
        let is_made = matches!(status, HANGPOSE_OK | HANGPOSE_WORK_LIMIT);
        assert!(is_enough || !is_made, "an object was made in too little memory");
        assert_eq!(object.is_null(), !is_made);
        block.check();
        if is_made {
            self.objects.truncate(MOST_MODELS - 1);
            self.objects.insert(0, Model { block, handle: object, count: 0 });
        }
    }

    pub(super) fn create_supporter(&mut self) {
        let drawn = shapes::cloud(&mut self.draw);
        let cloud = given::cloud(&drawn, &mut self.draw);
        let Some(mut limits) = self.limits(null(), &cloud) else { return };
        limits.points += self.draw.pick(&[0, 0, 100]);
        let needed = self.bytes_for(&limits, hangpose_supporter_bytes);
        let (mut block, is_enough) = self.memory(needed);
        let (memory, size) = (block.memory().as_mut_ptr().cast::<c_void>(), block.size());
        let (params, monitor) = (self.params, self.monitor());
        let mut supporter = null_mut();
        // SAFETY: the pointers lead to valid values, and the memory is that of the block.
        let status = self.call("supporter_create", |_, detail| unsafe {
            hangpose_supporter_create(memory, size, &cloud, &params, monitor, &mut supporter, detail)
        });
        let is_made = matches!(status, HANGPOSE_OK | HANGPOSE_WORK_LIMIT);
        assert!(
            is_enough || !is_made || limits.points > cloud.point_count,
            "a supporter was made in too little memory"
        );
        assert_eq!(supporter.is_null(), !is_made);
        block.check();
        if is_made {
            self.supporters.truncate(MOST_MODELS - 1);
            self.supporters.insert(0, Model { block, handle: supporter, count: limits.points });
        }
    }

    pub(super) fn update_supporter(&mut self) {
        let drawn = shapes::cloud(&mut self.draw);
        let cloud = given::cloud(&drawn, &mut self.draw);
        let mut copy = Vec::new();
        let (supporter, count) = Self::choose(&mut self.draw, &self.supporters, HANDLE, &mut copy);
        let (params, monitor) = (self.params, self.monitor());
        // SAFETY: the pointers lead to valid values or are null.
        let status = self.call("supporter_update", |_, detail| unsafe {
            hangpose_supporter_update(supporter, &cloud, &params, monitor, detail)
        });
        if cloud.point_count > count {
            assert!(status < 0, "a supporter took more points than its memory holds");
        }
    }

    /// What a request and a motion point to, with any numbers.
    fn arrays(&mut self) -> Arrays {
        let draw = &mut self.draw;
        let symmetry = |draw: &mut crate::draw::Draw| hangpose_symmetry {
            fold: draw.pick(&[0, 2, 3, 360, 361, 1]),
            axis: draw.place(1.0),
            ..hangpose_symmetry::sized()
        };
        let mut hung = Vec::new();
        if !self.objects.is_empty() && draw.one_in(4) {
            let object = self.objects[draw.below(self.objects.len())].handle;
            let object = given::or_null(object, draw);
            hung.push(hangpose_hung {
                object,
                position: draw.place(0.2),
                quaternion: [draw.share(), 0.0, 0.0, draw.or_number(1.0)],
            });
        }
        Arrays {
            points: (0..4).map(|_| draw.place(0.1)).collect(),
            triangle: [[0; 3].map(|_: u32| draw.below(5) as u32)],
            indices: (0..2).map(|_| draw.below(4) as u32).collect(),
            scene: (0..draw.below(30)).map(|_| draw.place(0.2)).collect(),
            hung,
            symmetries: (0..draw.below(3)).map(|_| symmetry(draw)).collect(),
            parts: (0..draw.below(3))
                .map(|_| hangpose_capsule {
                    from: draw.place(0.1),
                    to: draw.place(0.1),
                    radius: draw.up_to(0.02),
                    opening: draw.place(0.05),
                })
                .collect(),
            beyond: draw.share(),
        }
    }

    fn request(&mut self, arrays: &Arrays) -> hangpose_request {
        let mut request = hangpose_request::sized();
        // SAFETY: the pointer leads to a request.
        let status = self.call("request_init", |_, detail| unsafe {
            hangpose_request_init(&mut request, size_of::<hangpose_request>(), detail)
        });
        if status != HANGPOSE_OK {
            request.struct_size = 0;
            return request;
        }
        let draw = &mut self.draw;
        // All before the counts of arrays.
        given::spoil(&mut request, core::mem::offset_of!(hangpose_request, scene_point_count), draw);
        let region = |draw: &mut crate::draw::Draw| {
            let shape = draw.pick(&[
                HANGPOSE_REGION_EVERYWHERE,
                HANGPOSE_REGION_EVERYWHERE,
                HANGPOSE_REGION_EVERYWHERE,
                HANGPOSE_REGION_BOX,
                HANGPOSE_REGION_POINTS,
                HANGPOSE_REGION_TRIANGLES,
                7,
            ]);
            hangpose_region {
                shape,
                low: draw.place(0.1),
                high: draw.place(0.2),
                radius: draw.up_to(0.05),
                point_count: draw.below(5) as u32,
                triangle_count: draw.below(2) as u32,
                index_count: draw.below(3) as u32,
                points: arrays.points.as_ptr().cast(),
                triangles: arrays.triangle.as_ptr().cast(),
                indices: if draw.one_in(2) { arrays.indices.as_ptr() } else { null() },
            }
        };
        if draw.one_in(3) {
            request.on = region(draw);
        }
        if draw.one_in(3) {
            request.by = region(draw);
        }
        if draw.one_in(3) {
            request.scene_point_count = arrays.scene.len() as u32;
            request.scene_points = given::or_null(arrays.scene.as_ptr().cast(), draw);
        }
        if draw.one_in(2) {
            request.hung_count = arrays.hung.len() as u32;
            request.hung = arrays.hung.as_ptr();
        }
        if draw.one_in(4) {
            request.has_symmetries = draw.below(3) as u32;
            request.symmetry_count = arrays.symmetries.len() as u32;
            request.symmetries = arrays.symmetries.as_ptr();
        }
        request
    }

    fn motion(&mut self, arrays: &Arrays) -> hangpose_motion {
        let mut motion = hangpose_motion::sized();
        // SAFETY: the pointer leads to a motion.
        let status = self.call("motion_init", |_, detail| unsafe {
            hangpose_motion_init(&mut motion, size_of::<hangpose_motion>(), detail)
        });
        if status != HANGPOSE_OK {
            motion.struct_size = 0;
            return motion;
        }
        let draw = &mut self.draw;
        (motion.samples, motion.nodes) = (1 + draw.below(100) as u32, 64 + draw.below(100) as u32);
        if draw.one_in(3) {
            motion.has_start = 1;
            motion.start_position = draw.place(0.3);
        }
        motion.take_off = u32::from(draw.one_in(4));
        given::spoil(&mut motion, core::mem::offset_of!(hangpose_motion, seed), draw);
        // Far more samples than a work limit allows are only slow.
        motion.samples = motion.samples.min(400);
        motion.part_count = if draw.one_in(3) { arrays.parts.len() as u32 } else { 0 };
        motion.parts = given::or_null(arrays.parts.as_ptr(), draw);
        if draw.one_in(2) {
            motion.accepts = Some(accepts);
            motion.context = (&raw const arrays.beyond).cast_mut().cast();
        }
        motion
    }

    pub(super) fn predict(&mut self) {
        let arrays = self.arrays();
        let request = self.request(&arrays);
        let (mut object_copy, mut supporter_copy) = (Vec::new(), Vec::new());
        let (object, _) = Self::choose(&mut self.draw, &self.objects, HANDLE, &mut object_copy);
        let (supporter, points) = Self::choose(&mut self.draw, &self.supporters, HANDLE, &mut supporter_copy);
        let capacity = self.draw.below(4) as u32;
        let limits = hangpose_limits { points, poses: capacity, ..hangpose_limits::sized() };
        let needed = self.bytes_for(&limits, hangpose_predict_bytes);
        let (mut work, _) = self.memory(needed);
        let (memory, size) = (work.memory().as_mut_ptr().cast(), work.size());
        let (params, monitor) = (self.params, self.monitor());
        let request = if self.draw.one_in(3) { null() } else { &raw const request };
        let mut poses = vec![hangpose_pose::sized(); 4];
        let before = given::bytes(&poses).to_vec();
        let mut found = hangpose_prediction::sized();
        let pose_size = size_of::<hangpose_pose>() + if self.draw.one_in(32) { 4 } else { 0 };
        // SAFETY: the pointers lead to valid values or are null.
        let status = self.call("predict", |_, detail| unsafe {
            let poses = poses.as_mut_ptr();
            hangpose_predict(
                object, supporter, request, &params, memory, size, monitor, poses, pose_size, capacity,
                &mut found, detail,
            )
        });
        work.check();
        if status < 0 {
            assert_eq!(
                (given::bytes(&poses) == before, found.pose_count),
                (true, 0),
                "a call that failed wrote poses"
            );
            return;
        }
        let count = found.pose_count as usize;
        assert!(count <= capacity as usize);
        assert!(status != HANGPOSE_OK || count > 0);
        assert_eq!(status == HANGPOSE_REJECTED, count == 0 && found.stopped == HANGPOSE_OK);
        assert_eq!(status == HANGPOSE_REJECTED, found.stage != HANGPOSE_STAGE_NONE);
        poses[..count].iter().for_each(check_pose);
        self.record(&poses[..count]);
        self.record(&[found]);
        if count > 0 {
            self.pose = poses[0];
        }
    }

    pub(super) fn predict_many(&mut self) {
        let arrays = self.arrays();
        let request = self.request(&arrays);
        let (mut object_copy, mut supporter_copy) = (Vec::new(), Vec::new());
        let (first, _) = Self::choose(&mut self.draw, &self.objects, HANDLE, &mut object_copy);
        let others = self.objects.iter().map(|model| model.handle);
        let objects: Vec<_> = [first].into_iter().chain(others).map(|object| object.cast_const()).collect();
        let (supporter, points) = Self::choose(&mut self.draw, &self.supporters, HANDLE, &mut supporter_copy);
        let count = self.draw.below(objects.len() + 1) as u32;
        let limits = hangpose_limits { points, poses: count, ..hangpose_limits::sized() };
        let needed = self.bytes_for(&limits, hangpose_predict_bytes);
        let (mut work, _) = self.memory(needed);
        let (memory, size) = (work.memory().as_mut_ptr().cast(), work.size());
        let (params, monitor) = (self.params, self.monitor());
        let mut poses = vec![hangpose_pose::sized(); objects.len()];
        let before = given::bytes(&poses).to_vec();
        let mut many = hangpose_many::sized();
        let pose_size = size_of::<hangpose_pose>();
        // SAFETY: the pointers lead to valid values or are null.
        let status = self.call("predict_many", |_, detail| unsafe {
            let (objects, poses) = (objects.as_ptr(), poses.as_mut_ptr());
            hangpose_predict_many(
                objects, count, supporter, &request, &params, memory, size, monitor, poses, pose_size,
                &mut many, detail,
            )
        });
        work.check();
        if status < 0 {
            assert_eq!(
                (given::bytes(&poses) == before, many.placed),
                (true, 0),
                "a call that failed wrote poses"
            );
            return;
        }
        let poses = &poses[..count as usize];
        assert_eq!(poses.iter().filter(|pose| pose.has_pose == 1).count(), many.placed as usize);
        poses.iter().for_each(check_pose);
        self.record(poses);
        self.record(&[many]);
    }

    /// Checks what a plan says of its waypoints.
    fn check_plan(&mut self, plan: &hangpose_plan, waypoints: &[hangpose_waypoint]) {
        let count = (plan.waypoint_count + plan.gripper_waypoint_count) as usize;
        if plan.has_path == 0 {
            assert_eq!(count, 0);
            assert!(plan.failure.reason != HANGPOSE_PLAN_FOUND);
        } else {
            assert_eq!(plan.failure.reason, HANGPOSE_PLAN_FOUND);
            assert!(plan.release < plan.waypoint_count && plan.clearance >= 0.0);
            for waypoint in &waypoints[..count] {
                assert_eq!(waypoint.struct_size as usize, size_of::<hangpose_waypoint>());
                reached(&waypoint.position, &waypoint.quaternion);
                assert!(waypoint.seconds >= 0.0);
            }
            self.record(&waypoints[..count]);
        }
        self.record(&[*plan]);
    }

    pub(super) fn plan(&mut self) {
        let arrays = self.arrays();
        let (request, motion) = (self.request(&arrays), self.motion(&arrays));
        let (mut object_copy, mut supporter_copy) = (Vec::new(), Vec::new());
        let (object, _) = Self::choose(&mut self.draw, &self.objects, HANDLE, &mut object_copy);
        let (supporter, points) = Self::choose(&mut self.draw, &self.supporters, HANDLE, &mut supporter_copy);
        let capacity = self.draw.pick(&[300, 60, 3, 0]);
        let limits = hangpose_limits {
            points,
            scene_points: request.scene_point_count,
            nodes: motion.nodes,
            waypoints: capacity,
            ..hangpose_limits::sized()
        };
        let needed = self.bytes_for(&limits, hangpose_plan_bytes);
        let (mut work, _) = self.memory(needed);
        let (memory, size) = (work.memory().as_mut_ptr().cast(), work.size());
        let (params, monitor) = (self.params, self.monitor());
        let mut goal = self.pose;
        if self.draw.one_in(3) {
            (goal.has_pose, goal.position, goal.has_rest) = (1, self.draw.place(0.3), 0);
            goal.quaternion = [self.draw.share(), self.draw.share(), 0.0, self.draw.or_number(1.0)];
        }
        let mut waypoints = vec![hangpose_waypoint::sized(); 300];
        let mut plan = hangpose_plan::sized();
        // SAFETY: the pointers lead to valid values or are null.
        let status = self.call("plan_path", |_, detail| unsafe {
            let (place, row) = (waypoints.as_mut_ptr(), size_of::<hangpose_waypoint>());
            hangpose_plan_path(
                object, supporter, &request, &params, &motion, &goal, memory, size, monitor, place, row,
                capacity, &mut plan, detail,
            )
        });
        work.check();
        assert!(status != HANGPOSE_OK || plan.has_path == 1);
        match status {
            0.. => self.check_plan(&plan, &waypoints),
            _ => assert_eq!((plan.has_path, plan.waypoint_count), (0, 0)),
        }
    }

    pub(super) fn reach(&mut self) {
        let arrays = self.arrays();
        let (request, motion) = (self.request(&arrays), self.motion(&arrays));
        let (mut object_copy, mut supporter_copy) = (Vec::new(), Vec::new());
        let (object, _) = Self::choose(&mut self.draw, &self.objects, HANDLE, &mut object_copy);
        let (supporter, points) = Self::choose(&mut self.draw, &self.supporters, HANDLE, &mut supporter_copy);
        let (capacity, poses_capacity) = (self.draw.pick(&[300, 60, 3, 0]), self.draw.below(4) as u32);
        let limits = hangpose_limits {
            points,
            poses: poses_capacity,
            scene_points: request.scene_point_count,
            nodes: motion.nodes,
            waypoints: capacity,
            ..hangpose_limits::sized()
        };
        let needed = self.bytes_for(&limits, hangpose_reachable_bytes);
        let (mut work, _) = self.memory(needed);
        let (memory, size) = (work.memory().as_mut_ptr().cast(), work.size());
        let (params, monitor) = (self.params, self.monitor());
        let mut poses = vec![hangpose_pose::sized(); 4];
        let mut failures = vec![hangpose_plan_failure::sized(); 4];
        let failures = if self.draw.one_in(4) { null_mut() } else { failures.as_mut_ptr() };
        let mut waypoints = vec![hangpose_waypoint::sized(); 300];
        let (mut found, mut plan) = (hangpose_prediction::sized(), hangpose_plan::sized());
        // SAFETY: the pointers lead to valid values or are null.
        let status = self.call("predict_reachable", |_, detail| unsafe {
            hangpose_predict_reachable(
                object,
                supporter,
                &request,
                &params,
                &motion,
                memory,
                size,
                monitor,
                poses.as_mut_ptr(),
                size_of::<hangpose_pose>(),
                poses_capacity,
                failures,
                size_of::<hangpose_plan_failure>(),
                waypoints.as_mut_ptr(),
                size_of::<hangpose_waypoint>(),
                capacity,
                &mut found,
                &mut plan,
                detail,
            )
        });
        work.check();
        if status >= 0 {
            poses[..found.pose_count as usize].iter().for_each(check_pose);
            self.check_plan(&plan, &waypoints);
            self.record(&[found]);
        }
    }

    pub(super) fn look_at_models(&mut self) {
        let (mut object_copy, mut supporter_copy) = (Vec::new(), Vec::new());
        let (object, _) = Self::choose(&mut self.draw, &self.objects, HANDLE, &mut object_copy);
        let (supporter, _) = Self::choose(&mut self.draw, &self.supporters, HANDLE, &mut supporter_copy);
        let index = self.draw.pick(&[0, 1, 2, 3, 100, u32::MAX]);
        let wrong = if self.draw.one_in(24) { 4 } else { 0 };
        macro_rules! look {
            ($function:ident, $kind:ty, $model:expr $(, $index:expr)?) => {
                let mut found = <$kind>::sized();
                found.struct_size += wrong;
                // SAFETY: the pointers lead to valid values or are null.
                let status = self.call(stringify!($function), |_, detail| unsafe {
                    $function($model, $($index,)? &mut found, detail)
                });
                if status == HANGPOSE_OK {
                    self.record(&[found]);
                }
            };
        }
        look!(hangpose_object_get_info, hangpose_object_info, object);
        look!(hangpose_object_get_site, hangpose_object_site, object, index);
        look!(hangpose_object_get_contact, hangpose_object_contact, object, index);
        look!(hangpose_object_get_symmetry, hangpose_symmetry, object, index);
        look!(hangpose_supporter_get_info, hangpose_supporter_info, supporter);
        look!(hangpose_supporter_get_site, hangpose_supporter_site, supporter, index);
        look!(hangpose_supporter_get_contact, hangpose_supporter_contact, supporter, index);
    }

    pub(super) fn sample(&mut self) {
        let drawn = shapes::mesh(&mut self.draw);
        let mesh = given::mesh(&drawn, &mut self.draw);
        let count = if self.draw.one_in(8) { self.draw.word() } else { self.draw.below(400) as u32 };
        let (mut block, _) = self.memory(hangpose_sample_bytes(count));
        let (memory, size) = (block.memory().as_mut_ptr().cast(), block.size());
        // The arrays are as long as it says: a count for which there is no room is not valid.
        let count = count.min(500_001);
        let (mut points, mut normals) =
            (vec![[0.0_f32; 3]; count as usize], vec![[0.0_f32; 3]; count as usize]);
        // SAFETY: the pointers lead to valid values, and the counts are those of the arrays.
        let status = self.call("mesh_sample", |_, detail| unsafe {
            hangpose_mesh_sample(
                &mesh,
                3,
                memory,
                size,
                points.as_mut_ptr().cast(),
                normals.as_mut_ptr().cast(),
                count,
                detail,
            )
        });
        block.check();
        if status == HANGPOSE_OK {
            for (point, normal) in points.iter().zip(&normals) {
                let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
                assert!(
                    point.iter().all(|x| x.is_finite()) && (length - 1.0).abs() < 1e-3,
                    "{point:?} {normal:?}"
                );
            }
        }
    }
}
