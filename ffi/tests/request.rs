//! Requests of a C caller: what they choose among the poses of a ring on two pegs, and what is wrong with broken ones.

#[path = "request/many.rs"]
mod many;
#[path = "request/plan.rs"]
mod plan;

use hangpose_ffi::*;
use std::ffi::CStr;
use std::ptr::{null, null_mut};

const POSES: usize = 6;
/// Radius of the ring's centre line, metres.
const RADIUS: f32 = 0.03;
/// Distance of either peg from the middle, metres; the pegs run along the y axis from 0 to `LENGTH`.
const APART: f32 = 0.1;
const LENGTH: f32 = 0.08;

/// A model in memory of its own.
struct Made<T> {
    model: *mut T,
    memory: Vec<u8>,
}

struct Mesh {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A ring around the z axis; radius of the centre line and of the tube, metres.
    fn ring(radius: f32, thickness: f32) -> Self {
        const ROWS: u32 = 40;
        const COLUMNS: u32 = 14;
        let vertices = (0..ROWS * COLUMNS).map(|i| {
            let (around, across) = (turn(i / COLUMNS, ROWS), turn(i % COLUMNS, COLUMNS));
            let r = radius + thickness * libm::cosf(across);
            [r * libm::cosf(around), r * libm::sinf(around), thickness * libm::sinf(across)]
        });
        let triangles = (0..ROWS * COLUMNS).flat_map(|i| {
            let at = |row: u32, column: u32| row % ROWS * COLUMNS + column % COLUMNS;
            let (r, k) = (i / COLUMNS, i % COLUMNS);
            let [a, b, c, d] = [at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1)];
            [[a, b, c], [a, c, d]]
        });
        Self { vertices: vertices.collect(), triangles: triangles.collect() }
    }

    fn analyze(&self, params: &hangpose_params) -> Made<hangpose_object> {
        let mesh = hangpose_mesh {
            struct_size: size_of::<hangpose_mesh>() as u32,
            vertex_count: self.vertices.len() as u32,
            triangle_count: self.triangles.len() as u32,
            viewpoint_count: 0,
            vertices: self.vertices.as_ptr().cast(),
            triangles: self.triangles.as_ptr().cast(),
            viewpoints: null(),
        };
        let (mut model, mut limits) = (null_mut(), NO_LIMITS);
        // SAFETY: the pointers lead to valid values, and the memory stays with the model.
        unsafe {
            assert_eq!(hangpose_limits_of(params, &mesh, null(), &mut limits, null_mut()), HANGPOSE_OK);
            let mut memory = vec![0; hangpose_object_bytes(&limits)];
            let (at, size) = (memory.as_mut_ptr().cast(), memory.len());
            let status = hangpose_object_create(at, size, &mesh, params, null_mut(), &mut model, null_mut());
            assert_eq!(status, HANGPOSE_OK);
            Made { model, memory }
        }
    }
}

const NO_LIMITS: hangpose_limits = hangpose_limits {
    struct_size: size_of::<hangpose_limits>() as u32,
    vertices: 0,
    triangles: 0,
    samples: 0,
    voxels: 0,
    points: 0,
    poses: 0,
    scene_points: 0,
    nodes: 0,
    waypoints: 0,
};

fn turn(step: u32, steps: u32) -> f32 {
    std::f32::consts::TAU * step as f32 / steps as f32
}

fn params() -> hangpose_params {
    // SAFETY: all fields are numbers, and the call sets them.
    unsafe {
        let mut params: hangpose_params = std::mem::zeroed();
        let size = size_of::<hangpose_params>();
        let profile = HANGPOSE_PROFILE_DEFAULT;
        assert_eq!(
            hangpose_params_init(&mut params, size, profile, HANGPOSE_ABI_VERSION, null_mut()),
            HANGPOSE_OK
        );
        (params.samples, params.voxels) = (3000, 20_000);
        params
    }
}

fn request() -> hangpose_request {
    // SAFETY: all fields are numbers and pointers, and the call sets them.
    unsafe {
        let mut request: hangpose_request = std::mem::zeroed();
        let status = hangpose_request_init(&mut request, size_of::<hangpose_request>(), null_mut());
        assert_eq!(status, HANGPOSE_OK);
        request
    }
}

/// A ring and two pegs.
struct Scene {
    params: hangpose_params,
    points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    ring: Made<hangpose_object>,
    pegs: Made<hangpose_supporter>,
    predict_bytes: usize,
}

/// What a call has written.
struct Answer {
    status: hangpose_status,
    poses: [hangpose_pose; POSES],
    found: hangpose_prediction,
    detail: hangpose_detail,
}

impl Scene {
    fn new() -> Self {
        const COLUMNS: u32 = 30;
        let params = params();
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for (x, i) in [-APART, APART].into_iter().flat_map(|x| (0..80 * COLUMNS).map(move |i| (x, i))) {
            let angle = turn(i % COLUMNS, COLUMNS);
            let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
            points.push([x + 0.004 * sin, LENGTH / 80.0 * (i / COLUMNS) as f32, 0.004 * cos]);
            normals.push([sin, 0.0, cos]);
        }
        let cloud = hangpose_cloud {
            struct_size: size_of::<hangpose_cloud>() as u32,
            point_count: points.len() as u32,
            viewpoint_count: 0,
            points: points.as_ptr().cast(),
            normals: normals.as_ptr().cast(),
            viewpoints: null(),
            marks: null(),
            region: null(),
        };
        let (mut model, mut limits) = (null_mut(), NO_LIMITS);
        // SAFETY: the pointers lead to valid values, and the memory stays with the model.
        let (pegs, predict_bytes) = unsafe {
            assert_eq!(hangpose_limits_of(&params, null(), &cloud, &mut limits, null_mut()), HANGPOSE_OK);
            limits.poses = POSES as u32;
            let mut memory = vec![0; hangpose_supporter_bytes(&limits)];
            let (at, size) = (memory.as_mut_ptr().cast(), memory.len());
            let status =
                hangpose_supporter_create(at, size, &cloud, &params, null_mut(), &mut model, null_mut());
            assert_eq!(status, HANGPOSE_OK);
            (Made { model, memory }, hangpose_predict_bytes(&limits))
        };
        let ring = Mesh::ring(RADIUS, 0.003).analyze(&params);
        Self { params, points, normals, ring, pegs, predict_bytes }
    }

    fn predict(&self, request: *const hangpose_request) -> Answer {
        self.predict_in(request, &mut vec![0; self.predict_bytes])
    }

    fn predict_in(&self, request: *const hangpose_request, work: &mut [u8]) -> Answer {
        // SAFETY: every bit pattern is valid for these structs.
        let mut answer: Answer = unsafe { std::mem::zeroed() };
        answer.found.struct_size = size_of::<hangpose_prediction>() as u32;
        answer.detail.struct_size = size_of::<hangpose_detail>() as u32;
        // SAFETY: the pointers lead to valid values, and the request is what a test makes it.
        answer.status = unsafe {
            hangpose_predict(
                self.ring.model,
                self.pegs.model,
                request,
                &self.params,
                work.as_mut_ptr().cast(),
                work.len(),
                null_mut(),
                answer.poses.as_mut_ptr(),
                size_of::<hangpose_pose>(),
                POSES as u32,
                &mut answer.found,
                &mut answer.detail,
            )
        };
        answer
    }
}

impl Answer {
    fn poses(&self) -> &[hangpose_pose] {
        &self.poses[..self.found.pose_count as usize]
    }

    /// The places of all contacts, in supporter coordinates.
    fn contacts(&self) -> Vec<[f32; 3]> {
        let of_pose = |pose: &hangpose_pose| pose.contacts[..pose.contact_count as usize].to_vec();
        self.poses().iter().flat_map(of_pose).map(|contact| contact.position).collect()
    }

    #[track_caller]
    fn hangs(&self) {
        assert_eq!(self.status, HANGPOSE_OK, "{}", self.message());
        assert!(!self.contacts().is_empty());
    }

    #[track_caller]
    fn is_rejected(&self, stage: hangpose_stage) {
        assert_eq!((self.status, self.found.stage), (HANGPOSE_REJECTED, stage), "{}", self.message());
        assert_eq!(self.found.pose_count, 0);
    }

    fn message(&self) -> String {
        text(&self.detail.message)
    }
}

fn text(chars: &[std::ffi::c_char]) -> String {
    let bytes: Vec<u8> = chars.iter().map(|c| *c as u8).collect();
    CStr::from_bytes_until_nul(&bytes).unwrap().to_str().unwrap().into()
}

/// The bytes of structs that have no padding.
fn bytes<T>(of: &[T]) -> &[u8] {
    // SAFETY: the structs consist of numbers, without padding.
    unsafe { std::slice::from_raw_parts(of.as_ptr().cast(), size_of_val(of)) }
}

/// What is within `radius` of points.
fn near(points: &[[f32; 3]], radius: f32) -> hangpose_region {
    hangpose_region {
        shape: HANGPOSE_REGION_POINTS,
        point_count: points.len() as u32,
        points: points.as_ptr().cast(),
        radius,
        ..request().on
    }
}

/// Points on a grid of 2 mm in a level plane below both pegs.
fn floor(z: f32) -> Vec<[f32; 3]> {
    let at = |i: usize| 0.002 * i as f32;
    (0..200).flat_map(|i| (0..100).map(move |k| [at(i) - 0.2, at(k) - 0.06, z])).collect()
}

#[test]
fn no_request_and_the_default_request_give_the_same_bits() {
    let scene = Scene::new();
    let (none, default) = (scene.predict(null()), scene.predict(&request()));
    none.hangs();
    assert_eq!(bytes(&none.poses), bytes(&default.poses));
    assert_eq!(none.found.settling_released, default.found.settling_released);
    assert_eq!(none.found.distance_queries, default.found.distance_queries);
    for pose in none.poses() {
        assert_eq!(pose.kind, HANGPOSE_KIND_THREADED);
        assert!(pose.tolerance_position > 0.0 && pose.tolerance_position <= pose.clearance);
        assert!(pose.tolerance_rotation > 0.0 && pose.tolerance_rotation < 0.5);
    }
    assert_eq!(none.found.settling_firm_as_preferred, none.found.settling_firm);
    assert_eq!(none.found.settling_other_kind, 0);
    let sides = none.contacts().iter().map(|x| x[0] < 0.0).collect::<std::collections::HashSet<_>>();
    assert_eq!(sides.len(), 2, "both pegs carry the ring");
}

#[test]
fn contacts_are_in_the_region_of_the_supporter() {
    let scene = Scene::new();
    let here = [[-APART, 0.04, 0.0]];
    let below_zero: Vec<u32> =
        (0..scene.points.len() as u32).filter(|&i| scene.points[i as usize][0] < 0.0).collect();
    let square = [[-APART, 0.0, 0.0], [-APART, LENGTH, 0.0], [-APART, LENGTH, 0.004], [APART, 0.0, 0.0]];
    let triangles = [[0, 1, 3], [0, 1, 2]];
    let regions = [
        near(&here, 0.03),
        hangpose_region { shape: HANGPOSE_REGION_BOX, low: [-1.0; 3], high: [0.0, 1.0, 1.0], ..request().on },
        hangpose_region {
            index_count: below_zero.len() as u32,
            indices: below_zero.as_ptr(),
            ..near(&scene.points, 0.01)
        },
        hangpose_region {
            shape: HANGPOSE_REGION_TRIANGLES,
            triangle_count: 2,
            triangles: triangles.as_ptr().cast(),
            index_count: 1,
            indices: &1,
            ..near(&square, 0.006)
        },
    ];
    for on in regions {
        let answer = scene.predict(&hangpose_request { on, ..request() });
        answer.hangs();
        assert!(answer.contacts().iter().all(|contact| contact[0] < 0.0), "shape {}", on.shape);
    }
    let nowhere = near(&[[0.0, 0.04, 0.0]], 0.03);
    let answer = scene.predict(&hangpose_request { on: nowhere, ..request() });
    answer.is_rejected(HANGPOSE_STAGE_OUTSIDE_REGION);
    assert!(answer.found.settling_outside > 0);
}

#[test]
fn contacts_are_in_the_region_of_the_object() {
    let scene = Scene::new();
    let inside = [[0.0, RADIUS, 0.0]];
    let answer = scene.predict(&hangpose_request { by: near(&inside, 0.02), ..request() });
    answer.hangs();
    for pose in answer.poses() {
        // The part by which the ring hangs is above its centre, so its y axis points up.
        let [x, y, z, w] = pose.rest_quaternion;
        assert!(2.0 * (y * z + w * x) > 0.7, "{:?}", pose.rest_quaternion);
    }
}

#[test]
fn only_kinds_that_are_allowed_are_given() {
    let scene = Scene::new();
    let without = HANGPOSE_KIND_ALL & !HANGPOSE_KIND_THREADED;
    let answer = scene.predict(&hangpose_request { allow: without, ..request() });
    answer.is_rejected(HANGPOSE_STAGE_OTHER_KIND);
    assert!(answer.found.settling_other_kind > 0);
    scene.predict(&hangpose_request { allow: HANGPOSE_KIND_THREADED, prefer: 0, ..request() }).hangs();
}

#[test]
fn poses_keep_clear_of_the_scene() {
    let scene = Scene::new();
    let floor_at = |z| {
        let floor = floor(z);
        let (scene_point_count, scene_points) = (floor.len() as u32, floor.as_ptr().cast());
        scene.predict(&hangpose_request { scene_point_count, scene_points, ..request() })
    };
    let answer = floor_at(-RADIUS);
    answer.is_rejected(HANGPOSE_STAGE_IN_SCENE);
    assert!(answer.found.settling_in_scene > 0);
    floor_at(-3.0 * RADIUS).hangs();
}

#[test]
fn poses_keep_clear_of_what_hangs_already() {
    let scene = Scene::new();
    // Nearly a ball around the left peg.
    let ball = Mesh::ring(0.045, 0.04).analyze(&scene.params);
    let quaternion = [0.0, 0.0, 0.0, 2.0];
    let hung = hangpose_hung { object: ball.model, position: [-APART, 0.5 * LENGTH, 0.0], quaternion };
    let blocked = hangpose_request { hung_count: 1, hung: &hung, ..request() };
    let answer = scene.predict(&blocked);
    answer.hangs();
    assert!(answer.contacts().iter().all(|contact| contact[0] > 0.0));
    let on = near(&[[-APART, 0.5 * LENGTH, 0.0]], 0.06);
    scene.predict(&hangpose_request { on, ..blocked }).is_rejected(HANGPOSE_STAGE_IN_SCENE);

    // The ring itself may hang already.
    let first = scene.predict(null()).poses[0];
    let hung = hangpose_hung {
        object: scene.ring.model,
        position: first.rest_position,
        quaternion: first.rest_quaternion,
    };
    let second = scene.predict(&hangpose_request { hung_count: 1, hung: &hung, ..request() });
    second.hangs();
    for pose in second.poses() {
        let away = (0..3).map(|i| (pose.rest_position[i] - first.rest_position[i]).powi(2)).sum::<f32>();
        assert!(away.sqrt() > 0.003, "{:?} is in the ring that hangs already", pose.rest_position);
    }
}

#[test]
fn a_free_way_leads_to_each_pose() {
    let scene = Scene::new();
    let along = |approach_direction| hangpose_request {
        has_approach: 1,
        approach_direction,
        approach_angle: 0.05,
        approach_length: 0.1,
        ..request()
    };
    scene.predict(&along([0.0, 3.0, 0.0])).hangs();
    let answer = scene.predict(&along([0.0, 0.0, -1.0]));
    answer.is_rejected(HANGPOSE_STAGE_NO_APPROACH);
    assert!(answer.found.settling_no_approach > 0);
}

#[test]
fn distinct_poses_differ_by_what_was_asked_for() {
    let scene = Scene::new();
    let far =
        scene.predict(&hangpose_request { distinct_position: 1.0, distinct_rotation: 3.1, ..request() });
    far.hangs();
    assert!(far.found.pose_count < scene.predict(null()).found.pose_count);
}

#[test]
fn a_ring_is_hung_once_whichever_way_it_is_turned() {
    let scene = Scene::new();
    let empty =
        hangpose_symmetry { struct_size: size_of::<hangpose_symmetry>() as u32, fold: 9, axis: [0.0; 3] };
    let symmetry = |index, symmetry: &mut hangpose_symmetry| {
        // SAFETY: the pointers lead to valid values.
        unsafe { hangpose_object_get_symmetry(scene.ring.model, index, symmetry, null_mut()) }
    };
    let mut found = [empty; 2];
    assert_eq!([0, 1].map(|index| symmetry(index as u32, &mut found[index])), [HANGPOSE_OK; 2]);
    assert_eq!(symmetry(2, &mut empty.clone()), HANGPOSE_ERROR_INDEX);
    let axis = |index: usize| found[index].axis.map(|x| libm::roundf(x * 100.0).abs());
    assert_eq!((found[0].fold, axis(0)), (0, [0.0, 0.0, 100.0]));
    assert_eq!((found[1].fold, axis(1)[2]), (2, 0.0));

    let count = |request: hangpose_request| scene.predict(&request).found.pose_count;
    let given = hangpose_request {
        has_symmetries: 1,
        symmetry_count: 2,
        symmetries: found.as_ptr(),
        distinct_rotation: 0.05,
        ..request()
    };
    let detected = count(hangpose_request { has_symmetries: 0, ..given });
    assert_eq!(count(given), detected);
    assert!(count(hangpose_request { symmetry_count: 0, ..given }) > detected);
}

/// What is wrong with a request: the status, the field, the index and the value.
type Wrong = (hangpose_status, &'static str, u32, f64);

/// Checks that the call says what is wrong, and writes neither poses nor the prediction.
#[track_caller]
fn refuses(scene: &Scene, request: *const hangpose_request, (status, field, index, value): Wrong) {
    let answer = scene.predict(request);
    assert_eq!(answer.status, status, "{}", answer.message());
    assert_eq!(text(&answer.detail.field), field, "{}", answer.message());
    assert_eq!(answer.detail.index, index, "{}", answer.message());
    let is_equal = answer.detail.value == value || answer.detail.value.is_nan() && value.is_nan();
    assert!(is_equal, "{} is not {value}: {}", answer.detail.value, answer.message());
    assert!(!answer.message().is_empty());
    assert!(bytes(&answer.poses).iter().all(|byte| *byte == 0));
    assert_eq!((answer.found.pose_count, answer.found.settling_released), (0, 0));
}

const ANY: u32 = HANGPOSE_NO_INDEX;
const NONE: f64 = f64::NAN;

#[test]
fn broken_numbers_are_named() {
    let scene = Scene::new();
    let (value, tall, count) = (HANGPOSE_ERROR_VALUE, 1e7_f32, HANGPOSE_ERROR_COUNT);
    let good = request();
    let refuse = |request: hangpose_request, wrong: Wrong| refuses(&scene, &request, wrong);
    refuse(hangpose_request { allow: 0, ..good }, (value, "request.allow", ANY, 0.0));
    refuse(hangpose_request { allow: 16, ..good }, (value, "request.allow", ANY, 16.0));
    refuse(hangpose_request { prefer: 32, ..good }, (value, "request.prefer", ANY, 32.0));
    refuse(hangpose_request { has_approach: 2, ..good }, (value, "request.has_approach", ANY, 2.0));
    let approach = hangpose_request { has_approach: 1, approach_direction: [0.0, 0.0, -1.0], ..good };
    refuse(
        hangpose_request { approach_direction: [0.0; 3], ..approach },
        (value, "request.approach_direction", ANY, NONE),
    );
    refuse(hangpose_request { approach_angle: 4.0, ..approach }, (value, "request.approach_angle", ANY, 4.0));
    refuse(
        hangpose_request { approach_length: f32::NAN, ..approach },
        (value, "request.approach_length", ANY, NONE),
    );
    refuse(
        hangpose_request { distinct_position: -1.0, ..good },
        (value, "request.distinct_position", ANY, -1.0),
    );
    refuse(
        hangpose_request { distinct_rotation: f32::INFINITY, ..good },
        (value, "request.distinct_rotation", ANY, f64::INFINITY),
    );
    refuse(hangpose_request { has_symmetries: 2, ..good }, (value, "request.has_symmetries", ANY, 2.0));
    let fine = hangpose_symmetry {
        struct_size: size_of::<hangpose_symmetry>() as u32,
        fold: 0,
        axis: [0.0, 0.0, 2.0],
    };
    let turns = |second: hangpose_symmetry, wrong| {
        let both = [fine, second];
        let symmetries = both.as_ptr();
        refuse(hangpose_request { has_symmetries: 1, symmetry_count: 2, symmetries, ..good }, wrong);
    };
    turns(hangpose_symmetry { fold: 1, ..fine }, (value, "request.symmetries.fold", 1, 1.0));
    turns(hangpose_symmetry { axis: [0.0; 3], ..fine }, (value, "request.symmetries.axis", 1, NONE));
    turns(
        hangpose_symmetry { struct_size: 0, ..fine },
        (HANGPOSE_ERROR_STRUCT_SIZE, "symmetry.struct_size", ANY, 0.0),
    );
    refuse(
        hangpose_request { has_symmetries: 1, symmetry_count: 9, symmetries: &fine, ..good },
        (count, "request.symmetry_count", ANY, 9.0),
    );
    let points = [[0.0; 3], [0.0, f32::NAN, 0.0]];
    refuse(
        hangpose_request { scene_point_count: 2, scene_points: points.as_ptr().cast(), ..good },
        (value, "request.scene_points", 1, NONE),
    );
    refuse(
        hangpose_request { hung_count: 33, hung: &0_u64 as *const u64 as _, ..good },
        (count, "request.hung_count", ANY, 33.0),
    );

    let on = |on: hangpose_region, wrong| refuse(hangpose_request { on, ..good }, wrong);
    on(hangpose_region { shape: 4, ..good.on }, (value, "request.on.shape", ANY, 4.0));
    let in_box = hangpose_region { shape: HANGPOSE_REGION_BOX, high: [1.0; 3], ..good.on };
    on(hangpose_region { low: [0.0, 2.0, 0.0], ..in_box }, (value, "request.on.low", ANY, 2.0));
    on(
        hangpose_region { low: [0.0, 0.0, -tall], ..in_box },
        (value, "request.on.low", ANY, f64::from(-tall)),
    );
    on(hangpose_region { high: [1.0, f32::NAN, 1.0], ..in_box }, (value, "request.on.high", ANY, NONE));
    on(near(&points, 0.1), (value, "request.on.points", 1, NONE));
    let here = near(&points[..1], 0.1);
    on(hangpose_region { radius: -0.5, ..here }, (value, "request.on.radius", ANY, -0.5));
    on(hangpose_region { point_count: 0, ..here }, (count, "request.on.point_count", ANY, 0.0));
    let indices = [0, 7];
    let some = hangpose_region { indices: indices.as_ptr(), ..here };
    on(some, (count, "request.on.index_count", ANY, 0.0));
    on(hangpose_region { index_count: 2, ..some }, (HANGPOSE_ERROR_INDEX, "request.on.indices", 1, 7.0));
    let triangles = [[0, 0, 0], [0, 9, 0]];
    let face = hangpose_region {
        shape: HANGPOSE_REGION_TRIANGLES,
        triangle_count: 2,
        triangles: triangles.as_ptr().cast(),
        index_count: 1,
        indices: &1,
        ..here
    };
    let by = |by: hangpose_region, wrong| refuse(hangpose_request { by, ..good }, wrong);
    by(face, (HANGPOSE_ERROR_INDEX, "request.by.triangles", 1, 9.0));
    by(hangpose_region { indices: &2, ..face }, (HANGPOSE_ERROR_INDEX, "request.by.indices", 0, 2.0));
    by(hangpose_region { triangle_count: 0, ..face }, (count, "request.by.triangle_count", ANY, 0.0));
    by(hangpose_region { index_count: 0, ..face }, (count, "request.by.index_count", ANY, 0.0));
}

#[test]
fn broken_pointers_are_named() {
    let scene = Scene::new();
    let good = request();
    let refuse = |request: hangpose_request, wrong: Wrong| refuses(&scene, &request, wrong);
    let null_error = HANGPOSE_ERROR_NULL;
    let odd = |points: &[[f32; 3]]| points.as_ptr().cast::<f32>().wrapping_byte_add(1);
    let points = [[0.0; 3]; 2];
    refuse(
        hangpose_request { struct_size: 0, ..good },
        (HANGPOSE_ERROR_STRUCT_SIZE, "request.struct_size", ANY, 0.0),
    );
    let misaligned = (&raw const good).wrapping_byte_add(1);
    refuses(&scene, misaligned, (HANGPOSE_ERROR_MISALIGNED, "request", ANY, NONE));
    refuse(
        hangpose_request { scene_point_count: 1, ..good },
        (null_error, "request.scene_points", ANY, NONE),
    );
    refuse(
        hangpose_request { scene_point_count: 1, scene_points: odd(&points), ..good },
        (HANGPOSE_ERROR_MISALIGNED, "request.scene_points", ANY, NONE),
    );
    refuse(hangpose_request { hung_count: 1, ..good }, (null_error, "request.hung", ANY, NONE));
    refuse(
        hangpose_request { has_symmetries: 1, symmetry_count: 1, ..good },
        (null_error, "request.symmetries", ANY, NONE),
    );
    let here = near(&points, 0.1);
    let by = |by: hangpose_region, wrong| refuse(hangpose_request { by, ..good }, wrong);
    by(hangpose_region { points: null(), ..here }, (null_error, "request.by.points", ANY, NONE));
    by(hangpose_region { index_count: 1, ..here }, (null_error, "request.by.indices", ANY, NONE));
    let face = hangpose_region { shape: HANGPOSE_REGION_TRIANGLES, triangle_count: 1, ..here };
    by(face, (null_error, "request.by.triangles", ANY, NONE));
    let face = hangpose_region { triangles: [0; 3].as_ptr(), ..face };
    by(hangpose_region { index_count: 1, ..face }, (null_error, "request.by.indices", ANY, NONE));
}

#[test]
fn broken_objects_that_hang_already_are_named() {
    let scene = Scene::new();
    let fine = hangpose_hung {
        object: scene.ring.model,
        position: [0.0, 0.0, 1.0],
        quaternion: [0.0, 0.0, 0.0, 1.0],
    };
    let hang = |second: hangpose_hung, wrong| {
        let both = [fine, second];
        refuses(&scene, &hangpose_request { hung_count: 2, hung: both.as_ptr(), ..request() }, wrong);
    };
    let at = |z| [0.0, 0.0, z];
    hang(hangpose_hung { object: null(), ..fine }, (HANGPOSE_ERROR_NULL, "request.hung.object", 1, NONE));
    let moved = [0_u64; 64];
    hang(
        hangpose_hung { object: moved.as_ptr().cast(), ..fine },
        (HANGPOSE_ERROR_HANDLE, "request.hung.object", 1, NONE),
    );
    hang(
        hangpose_hung { position: at(f32::INFINITY), ..fine },
        (HANGPOSE_ERROR_VALUE, "request.hung.position", 1, f64::INFINITY),
    );
    hang(
        hangpose_hung { quaternion: [0.0; 4], ..fine },
        (HANGPOSE_ERROR_VALUE, "request.hung.quaternion", 1, NONE),
    );
    hang(
        hangpose_hung { quaternion: [0.0, f32::NAN, 0.0, 1.0], ..fine },
        (HANGPOSE_ERROR_VALUE, "request.hung.quaternion", 1, NONE),
    );
}

#[test]
fn what_is_written_must_be_apart_from_the_request() {
    let scene = Scene::new();
    let mut work = vec![0_u64; scene.predict_bytes.div_ceil(8)];
    let inside = work.as_ptr();
    // SAFETY: the words are bytes.
    let work = unsafe { std::slice::from_raw_parts_mut(work.as_mut_ptr().cast::<u8>(), scene.predict_bytes) };
    let mut refuse = |request: hangpose_request, other: &str| {
        let answer = scene.predict_in(&request, work);
        assert_eq!(answer.status, HANGPOSE_ERROR_OVERLAP, "{}", answer.message());
        assert_eq!(text(&answer.detail.field), "memory");
        assert!(answer.message().contains(&format!("{other},")), "{}", answer.message());
        assert!(bytes(&answer.poses).iter().all(|byte| *byte == 0));
    };
    let good = request();
    refuse(
        hangpose_request { scene_point_count: 1, scene_points: inside.cast(), ..good },
        "request.scene_points",
    );
    refuse(
        hangpose_request { has_symmetries: 1, symmetry_count: 1, symmetries: inside.cast(), ..good },
        "request.symmetries",
    );
    let on = hangpose_region { points: inside.cast(), ..near(&[[0.0; 3]], 0.1) };
    refuse(hangpose_request { on, ..good }, "request.on.points");
    let by = hangpose_region { index_count: 1, indices: inside.cast(), ..near(&[[0.0; 3]], 0.1) };
    refuse(hangpose_request { by, ..good }, "request.by.indices");
    let mut other = Mesh::ring(RADIUS, 0.003).analyze(&scene.params);
    let (position, quaternion) = ([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
    let hung = hangpose_hung { object: other.model, position, quaternion };
    let answer =
        scene.predict_in(&hangpose_request { hung_count: 1, hung: &hung, ..good }, &mut other.memory);
    assert_eq!(answer.status, HANGPOSE_ERROR_OVERLAP);
    assert!(answer.message().contains("request.hung.object,"), "{}", answer.message());
}

#[test]
fn kinds_have_names() {
    // SAFETY: the text is static.
    let name = |kind| unsafe { CStr::from_ptr(hangpose_kind_string(kind)) };
    assert_eq!(name(HANGPOSE_KIND_HOOKED), c"hooked");
    assert_eq!(name(0), c"no kind");
}
