//! Several objects at once: the same bits as in Rust, and what is wrong with broken calls.

use super::*;
use hangpose::hanging::{self, HangingPose, Object, Region, Request, Supporter};
use hangpose::memory::Limits;
use hangpose::{Monitor, Params};

const COPIES: usize = 3;

/// What a call has written.
struct Written {
    status: hangpose_status,
    poses: [hangpose_pose; COPIES],
    many: hangpose_many,
    detail: hangpose_detail,
}

impl Scene {
    fn predict_many(&self, objects: &[*const hangpose_object], request: &hangpose_request) -> Written {
        self.predict_many_with(objects, request, &self.params, &mut vec![0; self.predict_bytes])
    }

    fn predict_many_with(
        &self,
        objects: &[*const hangpose_object],
        request: &hangpose_request,
        params: &hangpose_params,
        work: &mut [u8],
    ) -> Written {
        // SAFETY: every bit pattern is valid for these structs.
        let mut written: Written = unsafe { std::mem::zeroed() };
        written.many.struct_size = size_of::<hangpose_many>() as u32;
        written.detail.struct_size = size_of::<hangpose_detail>() as u32;
        // SAFETY: the pointers lead to valid values, and the objects are what a test makes them.
        written.status = unsafe {
            hangpose_predict_many(
                objects.as_ptr(),
                objects.len() as u32,
                self.pegs.model,
                request,
                params,
                work.as_mut_ptr().cast(),
                work.len(),
                null_mut(),
                written.poses.as_mut_ptr(),
                size_of::<hangpose_pose>(),
                &mut written.many,
                &mut written.detail,
            )
        };
        written
    }
}

impl Written {
    /// Asserts that the call says what is wrong and writes nothing else.
    #[track_caller]
    fn is_refused(&self, (status, field, index): (hangpose_status, &str, u32)) {
        let message = text(&self.detail.message);
        assert_eq!(self.status, status, "{message}");
        assert_eq!((text(&self.detail.field).as_str(), self.detail.index), (field, index), "{message}");
        assert!(bytes(&self.poses).iter().all(|byte| *byte == 0));
        assert_eq!((self.many.placed, self.many.distance_queries), (0, 0));
    }
}

/// The same call in Rust: the poses and how many there are.
fn in_rust(scene: &Scene, on: Region) -> ([Option<HangingPose>; COPIES], hanging::Many) {
    let params = Params { samples: 3000, voxels: 20_000, ..Params::default() };
    let mesh = Mesh::ring(RADIUS, 0.003);
    let mesh = hangpose::geometry::Mesh::new(&mesh.vertices, &mesh.triangles).unwrap();
    let cloud = hangpose::geometry::Cloud::new(&scene.points, Some(&scene.normals)).unwrap();
    let limits = Limits { points: scene.points.len(), ..Object::limits(&mesh, &params) };
    let monitor = Monitor::new();
    let (mut for_object, mut for_supporter) =
        (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
    let ring = Object::analyze(&mesh, &params, &mut for_object, &monitor).unwrap();
    let pegs = Supporter::analyze(&cloud, &params, &mut for_supporter, &monitor).unwrap();
    let mut poses = [None; COPIES];
    let mut work = vec![0; hanging::predict_bytes(&limits)];
    let request = Request { on, ..Request::ANY };
    let many =
        hanging::predict_many(&[&ring; COPIES], &pegs, &request, &params, &mut poses, &mut work, &monitor);
    (poses, many.unwrap())
}

#[test]
fn several_rings_hang_as_in_rust() {
    let scene = Scene::new();
    let rings = [scene.ring.model.cast_const(); COPIES];
    let written = scene.predict_many(&rings, &request());
    assert_eq!(written.status, HANGPOSE_OK, "{}", text(&written.detail.message));
    let (poses, many) = in_rust(&scene, Region::Everywhere);
    assert_eq!(written.many.placed as usize, many.placed);
    assert!(many.placed > 1, "{many:?}");
    assert_eq!(written.many.distance_queries, many.work.distance_queries);
    assert_eq!(written.many.rays, many.work.rays);
    for (c, rust) in written.poses.iter().zip(poses) {
        let Some(rust) = rust else {
            assert_eq!((c.has_pose, c.has_rest), (0, 0));
            continue;
        };
        let rest = rust.rest.unwrap();
        assert_eq!((c.has_pose, c.has_rest), (1, 1));
        assert_eq!(c.position, <[f32; 3]>::from(rust.pose.translation.vector));
        assert_eq!(c.quaternion, <[f32; 4]>::from(rust.pose.rotation.coords));
        assert_eq!(c.rest_position, <[f32; 3]>::from(rest.pose.translation.vector));
        assert_eq!(c.rest_quaternion, <[f32; 4]>::from(rest.pose.rotation.coords));
        assert_eq!(c.probability, rest.probability);
    }
}

#[test]
fn an_object_without_room_has_no_pose() {
    let scene = Scene::new();
    // A region in the air: nothing hangs at all.
    let nowhere = [[0.0, 0.04, 0.0]];
    let on = near(&nowhere, 0.03);
    let rings = [scene.ring.model.cast_const(); COPIES];
    let written = scene.predict_many(&rings, &hangpose_request { on, ..request() });
    assert_eq!((written.status, written.many.placed), (HANGPOSE_REJECTED, 0));
    assert_eq!(written.many.stage, HANGPOSE_STAGE_OUTSIDE_REGION);
    for pose in &written.poses {
        assert_eq!((pose.struct_size as usize, pose.has_pose), (size_of::<hangpose_pose>(), 0));
        assert!(pose.position.iter().chain(&pose.rest_position).all(|x| x.is_nan()));
        assert_eq!((pose.kind, pose.contact_count, pose.object_site), (0, 0, HANGPOSE_NO_INDEX));
    }
    // Room for one: what hangs already counts.
    let first = scene.predict(null()).poses[0];
    let hung = hangpose_hung {
        object: scene.ring.model,
        position: first.rest_position,
        quaternion: first.rest_quaternion,
    };
    let full = vec![hung; HANGPOSE_MAX_HUNG - 1];
    let almost = hangpose_request { hung_count: full.len() as u32, hung: full.as_ptr(), ..request() };
    let written = scene.predict_many(&rings, &almost);
    assert_eq!((written.status, written.many.placed), (HANGPOSE_OK, 1));
    assert_eq!(written.poses.map(|pose| pose.has_pose), [1, 0, 0]);
}

#[test]
fn broken_calls_are_named() {
    let scene = Scene::new();
    let ring = scene.ring.model.cast_const();
    let refuse = |objects: &[*const hangpose_object], wrong| {
        scene.predict_many(objects, &request()).is_refused(wrong);
    };
    refuse(&[], (HANGPOSE_ERROR_COUNT, "object_count", ANY));
    refuse(&[ring; HANGPOSE_MAX_HUNG + 1], (HANGPOSE_ERROR_COUNT, "object_count", ANY));
    refuse(&[ring, null()], (HANGPOSE_ERROR_NULL, "objects", 1));
    refuse(&[ring, ring, scene.pegs.model.cast()], (HANGPOSE_ERROR_HANDLE, "objects", 2));
    let broken = hangpose_request { allow: 0, ..request() };
    scene.predict_many(&[ring], &broken).is_refused((HANGPOSE_ERROR_VALUE, "request.allow", ANY));

    let with = |params: &hangpose_params, work: &mut [u8]| {
        scene.predict_many_with(&[ring; COPIES], &request(), params, work)
    };
    let loose = hangpose_params { settle: 0, ..scene.params };
    let unsettled = with(&loose, &mut vec![0; scene.predict_bytes]);
    unsettled.is_refused((HANGPOSE_ERROR_VALUE, "params.settle", ANY));
    let too_little = size_of::<hangpose_pose>() * POSES;
    let small = with(&scene.params, &mut vec![0; scene.predict_bytes - too_little]);
    small.is_refused((HANGPOSE_ERROR_MEMORY, "memory", ANY));

    let mut other = Mesh::ring(RADIUS, 0.003).analyze(&scene.params);
    let objects = [ring, other.model.cast_const()];
    let over = scene.predict_many_with(&objects, &request(), &scene.params, &mut other.memory);
    over.is_refused((HANGPOSE_ERROR_OVERLAP, "memory", ANY));
    assert!(text(&over.detail.message).contains("objects,"), "{}", text(&over.detail.message));
}

#[test]
fn a_work_limit_gives_what_was_found() {
    let scene = Scene::new();
    let (mut poses, mut many): ([hangpose_pose; COPIES], hangpose_many);
    // SAFETY: every bit pattern is valid for these structs.
    (poses, many) = unsafe { std::mem::zeroed() };
    many.struct_size = size_of::<hangpose_many>() as u32;
    let (objects, mut work) = ([scene.ring.model.cast_const(); COPIES], vec![0_u8; scene.predict_bytes]);
    // SAFETY: the pointers lead to valid values.
    unsafe {
        let mut monitor: hangpose_monitor = std::mem::zeroed();
        assert_eq!(
            hangpose_monitor_init(&mut monitor, size_of::<hangpose_monitor>(), 10, null_mut()),
            HANGPOSE_OK
        );
        let status = hangpose_predict_many(
            objects.as_ptr(),
            COPIES as u32,
            scene.pegs.model,
            null(),
            &scene.params,
            work.as_mut_ptr().cast(),
            work.len(),
            &mut monitor,
            poses.as_mut_ptr(),
            size_of::<hangpose_pose>(),
            &mut many,
            null_mut(),
        );
        assert_eq!((status, many.stopped), (HANGPOSE_WORK_LIMIT, HANGPOSE_WORK_LIMIT));
    }
    assert_eq!(poses.iter().filter(|pose| pose.has_pose == 1).count(), many.placed as usize);
}
