//! `cargo bench -p hangpose-ffi`: overhead of a call through the C interface relative to the same call in Rust, on the
//! samples. The two calls alternate, so that both run under the same load. Fails if the median overhead is above 1 %.

use hangpose::hanging::{HangingPose, Object, Request, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files};
use hangpose_ffi::*;
use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::ptr::{null, null_mut};
use std::time::Instant;

const ROUNDS: usize = 60;
const POSES: usize = 10;
const MOST: f64 = 0.01;

fn main() -> ExitCode {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mesh_file = files::read_mesh(&samples.join("mug.obj")).expect("the sample is there");
    let cloud_file = files::read_cloud(&samples.join("hook.ply")).expect("the sample is there");
    let (mesh, cloud) = (mesh_file.mesh().expect("a mesh"), cloud_file.cloud().expect("a cloud"));
    let (params, monitor) = (Params::default(), Monitor::new());

    let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
    let object = analyze_object(&mesh, &params, &mut object_memory, &monitor).expect("an object");
    let supporter = analyze_supporter(&cloud, &params, &mut supporter_memory, &monitor).expect("a supporter");
    let mut poses = [HangingPose::default(); POSES];
    let limits = Limits { points: cloud.points().len(), ..Object::limits(&mesh, &params) };
    let mut work = vec![0; predict_bytes(&limits)];
    let mut rust_predict = || {
        let found = predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut work, &monitor);
        black_box(found.expect("a prediction"));
    };
    let mut memory = vec![0; Object::bytes(&limits)];
    let mut rust_analyze = || {
        black_box(Object::analyze(&mesh, &params, &mut memory, &monitor).expect("an object"));
    };

    let c = C::new(&mesh_file, &cloud_file);
    let mut c_memory = vec![0_u8; c.sizes[0]];
    let mut c_work = vec![0_u8; c.sizes[2]];
    println!("C over Rust, mug on hook, median of {ROUNDS} rounds");
    let is_little = [
        overhead("hangpose_object_create", &mut rust_analyze, &mut || {
            black_box(c.create(&mut c_memory));
        }),
        overhead("hangpose_predict", &mut rust_predict, &mut || c.predict(&mut c_work)),
    ];
    if is_little == [true; 2] { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The same inputs and models as C structs.
struct C {
    params: hangpose_params,
    mesh: hangpose_mesh,
    object: *mut hangpose_object,
    supporter: *mut hangpose_supporter,
    sizes: [usize; 3],
    _memory: [Vec<u8>; 2],
}

impl C {
    fn new(mesh: &files::MeshFile, cloud: &files::CloudFile) -> Self {
        let normals = cloud.normals.as_ref().expect("the sample has normals");
        let mesh = hangpose_mesh {
            struct_size: size_of::<hangpose_mesh>() as u32,
            vertex_count: mesh.vertices.len() as u32,
            triangle_count: mesh.triangles.len() as u32,
            viewpoint_count: 0,
            vertices: mesh.vertices.as_ptr().cast(),
            triangles: mesh.triangles.as_ptr().cast(),
            viewpoints: null(),
        };
        let cloud = hangpose_cloud {
            struct_size: size_of::<hangpose_cloud>() as u32,
            point_count: cloud.points.len() as u32,
            points: cloud.points.as_ptr().cast(),
            normals: normals.as_ptr().cast(),
            viewpoint_count: 0,
            viewpoints: null(),
            marks: null(),
            region: null(),
        };
        // SAFETY: all fields are numbers, and the calls below set them.
        let mut params: hangpose_params = unsafe { std::mem::zeroed() };
        // SAFETY: as above.
        let mut limits: hangpose_limits = unsafe { std::mem::zeroed() };
        limits.struct_size = size_of::<hangpose_limits>() as u32;
        let mut supporter = null_mut();
        // SAFETY: every pointer leads to a valid value of its type; the memory stays with the models in `Self`.
        let (sizes, memory) = unsafe {
            let size = size_of::<hangpose_params>();
            let profile = HANGPOSE_PROFILE_DEFAULT;
            assert_eq!(
                hangpose_params_init(&mut params, size, profile, HANGPOSE_ABI_VERSION, null_mut()),
                HANGPOSE_OK
            );
            assert_eq!(hangpose_limits_of(&params, &mesh, &cloud, &mut limits, null_mut()), HANGPOSE_OK);
            limits.poses = POSES as u32;
            let sizes = [
                hangpose_object_bytes(&limits),
                hangpose_supporter_bytes(&limits),
                hangpose_predict_bytes(&limits),
            ];
            let mut memory = [vec![0_u8; sizes[0]], vec![0_u8; sizes[1]]];
            let at = memory[1].as_mut_ptr().cast();
            let made = hangpose_supporter_create(
                at,
                sizes[1],
                &cloud,
                &params,
                null_mut(),
                &mut supporter,
                null_mut(),
            );
            assert_eq!(made, HANGPOSE_OK);
            (sizes, memory)
        };
        let mut made = Self { params, mesh, object: null_mut(), supporter, sizes, _memory: memory };
        let (at, size) = (made._memory[0].as_mut_ptr(), made._memory[0].len());
        // SAFETY: the memory stays with the model in `Self`.
        made.object = made.create(unsafe { std::slice::from_raw_parts_mut(at, size) });
        made
    }

    fn create(&self, memory: &mut [u8]) -> *mut hangpose_object {
        let mut object = null_mut();
        let (at, size) = (memory.as_mut_ptr().cast(), memory.len());
        // SAFETY: every pointer leads to a valid value of its type.
        let status = unsafe {
            hangpose_object_create(at, size, &self.mesh, &self.params, null_mut(), &mut object, null_mut())
        };
        assert_eq!(status, HANGPOSE_OK);
        object
    }

    fn predict(&self, work: &mut [u8]) {
        // SAFETY: plain numbers, and the call sets them.
        let (mut poses, mut found): ([hangpose_pose; POSES], hangpose_prediction) =
            unsafe { std::mem::zeroed() };
        found.struct_size = size_of::<hangpose_prediction>() as u32;
        // SAFETY: every pointer leads to a valid value of its type, and the models are in `self`.
        let status = unsafe {
            hangpose_predict(
                self.object,
                self.supporter,
                null(),
                &self.params,
                work.as_mut_ptr().cast(),
                work.len(),
                null_mut(),
                poses.as_mut_ptr(),
                size_of::<hangpose_pose>(),
                POSES as u32,
                &mut found,
                null_mut(),
            )
        };
        assert_eq!(status, HANGPOSE_OK);
        black_box((&poses, &found));
    }
}

/// Prints the overhead of `c` relative to `rust` and returns whether it is below `MOST`.
fn overhead(name: &str, rust: &mut dyn FnMut(), c: &mut dyn FnMut()) -> bool {
    let time = |call: &mut dyn FnMut()| {
        let start = Instant::now();
        call();
        start.elapsed().as_secs_f64()
    };
    let mut ratios = Vec::new();
    let mut times = Vec::new();
    for round in 0..ROUNDS {
        // The second call finds warm caches, so the order alternates too.
        let (in_rust, in_c) = if round % 2 == 0 {
            (time(rust), time(c))
        } else {
            let in_c = time(c);
            (time(rust), in_c)
        };
        ratios.push(in_c / in_rust - 1.0);
        times.push(in_rust);
    }
    ratios.sort_by(f64::total_cmp);
    times.sort_by(f64::total_cmp);
    let median = ratios[ROUNDS / 2];
    println!("{name:24} {:+.2} % of {:.2} ms", 100.0 * median, 1000.0 * times[ROUNDS / 2]);
    median < MOST
}
