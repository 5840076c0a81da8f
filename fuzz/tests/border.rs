//! Calls of the C interface with the smallest models that it takes, for Miri, which interprets a call a thousand times more
//! slowly than it runs: every way in which the interface turns pointers into references and keeps models in the caller's memory.
//! All other tests have larger models.

use fuzz::calls::second_first;
use fuzz::memory::Block;
use hangpose_ffi::*;
use std::ffi::c_void;
use std::ptr::{null, null_mut};

/// A struct of the interface with its size, and zeros.
fn sized<T: Copy>() -> T {
    // SAFETY: used for structs of numbers and pointers, of which every bit pattern is a value, with the size first.
    unsafe {
        let mut made: T = std::mem::zeroed();
        (&raw mut made).cast::<u32>().write(size_of::<T>() as u32);
        made
    }
}

/// Memory for a call, at an odd address.
fn room(bytes: usize) -> (Block, *mut c_void, usize) {
    assert_ne!(bytes, 0);
    let mut block = Block::new(bytes, 1);
    let pointer = block.memory().as_mut_ptr().cast();
    (block, pointer, bytes)
}

unsafe extern "C" fn accept_all(_: *mut c_void, _: *const f32, _: *const f32) -> i32 {
    1
}

/// Rays and distance queries of a call at most.
const WORK: u64 = 30;
/// Points of the supporter.
const POINTS: usize = 6;
/// Rows of the ring.
const ROWS: usize = 5;

/// A ring of `ROWS x 3` vertices around the z axis.
fn ring() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let turn = |step: usize, steps: usize| std::f32::consts::TAU * (step % steps) as f32 / steps as f32;
    let vertex = |i: usize| {
        let (around, across) = (turn(i / 3, ROWS), turn(i % 3, 3));
        let r = 0.03 + 0.003 * across.cos();
        [r * around.cos(), r * around.sin(), 0.003 * across.sin()]
    };
    let at = |row: usize, column: usize| (row % ROWS * 3 + column % 3) as u32;
    let corners = |i: usize| {
        let (row, column) = (i / 6, i / 2 % 3);
        let (here, opposite) = (at(row, column), at(row + 1, column + 1));
        match i % 2 {
            0 => [here, at(row + 1, column), opposite],
            _ => [here, opposite, at(row, column + 1)],
        }
    };
    ((0..3 * ROWS).map(vertex).collect(), (0..6 * ROWS).map(corners).collect())
}

/// A peg of [`POINTS`], and their normals.
fn peg() -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let at = |i: usize| {
        let angle = std::f32::consts::TAU * (i % 6) as f32 / 6.0;
        ([0.004 * angle.cos(), 0.005 * (i / 6) as f32, 0.004 * angle.sin()], [angle.cos(), 0.0, angle.sin()])
    };
    (0..POINTS).map(at).unzip()
}

/// Params of models that are as small as they may be.
fn params() -> hangpose_params {
    let mut params: hangpose_params = sized();
    // SAFETY: the pointer leads to params.
    let status = unsafe {
        hangpose_params_init(
            &mut params,
            size_of::<hangpose_params>(),
            HANGPOSE_PROFILE_DEFAULT,
            HANGPOSE_ABI_VERSION,
            null_mut(),
        )
    };
    assert_eq!(status, HANGPOSE_OK);
    (params.samples, params.voxels, params.settle_attempts) = (100, 50, 1);
    params
}

#[test]
fn models_and_what_is_found_with_them() {
    let params = params();
    let ((vertices, triangles), (points, normals)) = (ring(), peg());
    let mesh = hangpose_mesh {
        vertices: vertices.as_ptr().cast(),
        vertex_count: vertices.len() as u32,
        triangles: triangles.as_ptr().cast(),
        triangle_count: triangles.len() as u32,
        ..sized()
    };
    let cloud = hangpose_cloud {
        points: points.as_ptr().cast(),
        normals: normals.as_ptr().cast(),
        point_count: points.len() as u32,
        ..sized()
    };
    let (mut detail, mut limits): (hangpose_detail, hangpose_limits) = (sized(), sized());
    // SAFETY: all pointers lead to values that live until the end of this block, of the size that goes with them; the object is
    // a model where it is one, and memory that was never one elsewhere.
    unsafe {
        assert_eq!(hangpose_limits_of(&params, &mesh, &cloud, &mut limits, &mut detail), HANGPOSE_OK);
        (limits.poses, limits.nodes, limits.waypoints) = (2, 64, 200);

        // A monitor with a second thread; so little work that Miri is done soon.
        let (mut monitor, mut threads): (hangpose_monitor, hangpose_threads) = (sized(), sized());
        threads.join = Some(second_first);
        let monitor = &raw mut monitor;
        let threads = &raw const threads;
        assert_eq!(
            hangpose_monitor_init(monitor, size_of::<hangpose_monitor>(), WORK, &mut detail),
            HANGPOSE_OK
        );
        assert_eq!(hangpose_monitor_use_threads(monitor, threads, &mut detail), HANGPOSE_OK);

        let (block, memory, size) = room(hangpose_object_bytes(&limits));
        let mut object = null_mut();
        let status = hangpose_object_create(memory, size, &mesh, &params, monitor, &mut object, &mut detail);
        assert_eq!(status, HANGPOSE_WORK_LIMIT);
        block.check();
        let (peg_block, memory, size) = room(hangpose_supporter_bytes(&limits));
        let mut supporter = null_mut();
        let status =
            hangpose_supporter_create(memory, size, &cloud, &params, null_mut(), &mut supporter, &mut detail);
        assert_eq!(status, HANGPOSE_OK);
        peg_block.check();

        let (mut info, mut about): (hangpose_object_info, hangpose_supporter_info) = (sized(), sized());
        assert_eq!(hangpose_object_get_info(object, &mut info, &mut detail), HANGPOSE_OK);
        assert_eq!(hangpose_supporter_get_info(supporter, &mut about, &mut detail), HANGPOSE_OK);
        assert_eq!((info.is_closed, about.points), (1, POINTS as u32));
        let mut contact: hangpose_object_contact = sized();
        // The work limit left none.
        let status = hangpose_object_get_contact(object, 0, &mut contact, &mut detail);
        assert_eq!(status, HANGPOSE_ERROR_INDEX);

        let (mut work_block, work, work_size) = room(hangpose_predict_bytes(&limits));
        let (mut poses, mut found): ([hangpose_pose; 2], hangpose_prediction) = ([sized(); 2], sized());
        let at = poses.as_mut_ptr();
        let row = size_of::<hangpose_pose>();
        let status = hangpose_predict(
            object,
            supporter,
            null(),
            &params,
            work,
            work_size,
            monitor,
            at,
            row,
            2,
            &mut found,
            &mut detail,
        );
        assert!(status >= 0, "{status}");
        work_block.check();
        // Two objects, the same one twice, beside one that hangs already.
        let hung = hangpose_hung { object, position: [1.0, 0.0, 0.0], quaternion: [0.0, 0.0, 0.0, 1.0] };
        let mut request: hangpose_request = sized();
        assert_eq!(
            hangpose_request_init(&mut request, size_of::<hangpose_request>(), &mut detail),
            HANGPOSE_OK
        );
        (request.hung, request.hung_count) = (&raw const hung, 1);
        let objects = [object.cast_const(); 2];
        let mut many: hangpose_many = sized();
        let status = hangpose_predict_many(
            objects.as_ptr(),
            2,
            supporter,
            &request,
            &params,
            work,
            work_size,
            monitor,
            at,
            row,
            &mut many,
            &mut detail,
        );
        assert!(status >= 0, "{status}");
        work_block.check();

        // A path, with a callback of the caller's.
        let mut motion: hangpose_motion = sized();
        assert_eq!(hangpose_motion_init(&mut motion, size_of::<hangpose_motion>(), &mut detail), HANGPOSE_OK);
        (motion.nodes, motion.samples) = (64, 4);
        motion.accepts = Some(accept_all);
        let (plan_block, plan_work, plan_size) = room(hangpose_plan_bytes(&limits));
        let goal = hangpose_pose {
            has_pose: 1,
            position: [0.3, 0.0, 0.3],
            quaternion: [0.0, 0.0, 0.0, 1.0],
            ..sized()
        };
        let (mut waypoints, mut plan): ([hangpose_waypoint; 200], hangpose_plan) = ([sized(); 200], sized());
        let status = hangpose_plan_path(
            object,
            supporter,
            &request,
            &params,
            &motion,
            &goal,
            plan_work,
            plan_size,
            monitor,
            waypoints.as_mut_ptr(),
            size_of::<hangpose_waypoint>(),
            200,
            &mut plan,
            &mut detail,
        );
        assert!(status >= 0, "{status}");
        plan_block.check();
        let (reach_block, reach_work, reach_size) = room(hangpose_reachable_bytes(&limits));
        let mut failures: [hangpose_plan_failure; 2] = [sized(); 2];
        let status = hangpose_predict_reachable(
            object,
            supporter,
            &request,
            &params,
            &motion,
            reach_work,
            reach_size,
            monitor,
            at,
            row,
            2,
            failures.as_mut_ptr(),
            size_of::<hangpose_plan_failure>(),
            waypoints.as_mut_ptr(),
            size_of::<hangpose_waypoint>(),
            200,
            &mut found,
            &mut plan,
            &mut detail,
        );
        assert!(status >= 0, "{status}");
        reach_block.check();

        // Calls that must refuse what they are given: overlapping memory, and memory in which no model was made.
        let inside = (&raw mut found).cast::<c_void>();
        let status = hangpose_predict(
            object,
            supporter,
            null(),
            &params,
            inside,
            64,
            monitor,
            at,
            row,
            2,
            &mut found,
            &mut detail,
        );
        assert_eq!(status, HANGPOSE_ERROR_OVERLAP);
        work_block.memory().fill(0);
        let never = work_block.memory().as_mut_ptr();
        let never = never.add(never.align_offset(16)).cast::<hangpose_object>();
        assert_eq!(hangpose_object_get_info(never, &mut info, &mut detail), HANGPOSE_ERROR_HANDLE);
        hangpose_monitor_cancel(monitor);
        assert_eq!(hangpose_monitor_is_cancelled(monitor), 1);
        assert_eq!(
            hangpose_supporter_update(supporter, &cloud, &params, monitor, &mut detail),
            HANGPOSE_CANCELLED
        );
        assert_eq!(hangpose_monitor_progress(monitor), 0.0);
    }
}

#[test]
fn samples_volumes_and_depth_images() {
    let (vertices, triangles) = ring();
    let mesh = hangpose_mesh {
        vertices: vertices.as_ptr().cast(),
        vertex_count: vertices.len() as u32,
        triangles: triangles.as_ptr().cast(),
        triangle_count: triangles.len() as u32,
        ..sized()
    };
    let mut detail: hangpose_detail = sized();
    // A plate, half a metre in front of the camera.
    let mut depths = [0_u16; 48];
    (0..48).filter(|i| (2..6).contains(&(i % 8)) && (1..5).contains(&(i / 8))).for_each(|i| depths[i] = 500);
    let camera =
        hangpose_camera { width: 8, height: 6, focal: [50.0; 2], centre: [3.5, 2.5], distortion: [0.0; 5] };
    let image = hangpose_depth_image {
        depths: depths.as_ptr(),
        depth_count: 48,
        scale: 0.001,
        camera,
        quaternion: [0.0, 0.0, 0.0, 1.0],
        ..sized()
    };
    // SAFETY: all pointers lead to values that live until the end of this block, of the size that goes with them.
    unsafe {
        let (block, memory, size) = room(hangpose_sample_bytes(5));
        let (mut drawn, mut facing) = ([[f32::NAN; 3]; 5], [[f32::NAN; 3]; 5]);
        let [drawn_at, facing_at] = [&mut drawn, &mut facing].map(|rows| rows.as_mut_ptr().cast());
        let status = hangpose_mesh_sample(&mesh, 1, memory, size, drawn_at, facing_at, 5, &mut detail);
        assert_eq!(status, HANGPOSE_OK);
        assert!(drawn.as_flattened().iter().chain(facing.as_flattened()).all(|x| x.is_finite()));
        block.check();

        let mut settings: hangpose_volume_settings = sized();
        let bytes = size_of::<hangpose_volume_settings>();
        assert_eq!(hangpose_volume_settings_init(&mut settings, bytes, 0.02, &mut detail), HANGPOSE_OK);
        settings.dense = 1;
        let mut crop = [[0.0_f32; 3]; 2];
        assert_eq!(
            hangpose_volume_room(&image, 1, &settings, crop.as_mut_ptr().cast(), &mut detail),
            HANGPOSE_OK
        );
        settings.crop = crop.as_ptr().cast();
        let blocks = hangpose_volume_blocks(&settings);
        let (block, memory, size) = room(hangpose_volume_bytes(blocks));
        let mut volume = null_mut();
        let status = hangpose_volume_create(memory, size, &settings, blocks, &mut volume, &mut detail);
        assert_eq!(status, HANGPOSE_OK);
        let mut pixels = 0;
        let status = hangpose_volume_integrate(volume, &image, null_mut(), &mut pixels, &mut detail);
        assert_eq!((status, pixels), (HANGPOSE_OK, 16));
        let (work, memory, size) = room(hangpose_complete_bytes(blocks));
        // Completed it would take Miri minutes.
        let mut monitor: hangpose_monitor = sized();
        let monitor = &raw mut monitor;
        let bytes = size_of::<hangpose_monitor>();
        assert_eq!(hangpose_monitor_init(monitor, bytes, HANGPOSE_NO_WORK_LIMIT, &mut detail), HANGPOSE_OK);
        hangpose_monitor_cancel(monitor);
        let status = hangpose_volume_complete(volume, memory, size, monitor, &mut detail);
        assert_eq!(status, HANGPOSE_CANCELLED);
        work.check();
        let (work, memory, size) = room(hangpose_surface_bytes(blocks));
        let (mut rows, mut corners, mut seen) =
            (vec![[0.0_f32; 3]; 500], vec![[0_u32; 3]; 500], vec![9_u8; 500]);
        let mut found: hangpose_mesh = sized();
        let (rows_at, corners_at) = (rows.as_mut_ptr().cast(), corners.as_mut_ptr().cast());
        let status = hangpose_volume_surface(
            volume,
            memory,
            size,
            null_mut(),
            rows_at,
            500,
            corners_at,
            500,
            seen.as_mut_ptr(),
            &mut found,
            &mut detail,
        );
        assert_eq!(status, HANGPOSE_OK);
        assert!(found.triangle_count > 0 && seen[0] < 2);
        work.check();
        block.check();

        let mut how: hangpose_points_settings = sized();
        let bytes = size_of::<hangpose_points_settings>();
        assert_eq!(hangpose_points_settings_init(&mut how, bytes, &mut detail), HANGPOSE_OK);
        let (mut points, mut normals, mut viewpoint) = ([[0.0_f32; 3]; 48], [[0.0_f32; 3]; 48], [0.0_f32; 3]);
        let [points_at, normals_at] = [&mut points, &mut normals].map(|rows| rows.as_mut_ptr().cast());
        let mut cloud: hangpose_cloud = sized();
        let status = hangpose_depth_points(
            &image,
            1,
            &how,
            points_at,
            normals_at,
            48,
            viewpoint.as_mut_ptr(),
            &mut cloud,
            &mut detail,
        );
        assert_eq!(status, HANGPOSE_OK);
        assert!(cloud.point_count > 0 && points[0][2] > 0.4);
    }
}
