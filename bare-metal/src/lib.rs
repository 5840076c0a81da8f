//! A complete prediction on a microcontroller: static memory, no allocator, no unwinding.
#![no_std]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use hangpose_core::geometry::{Cloud, Mesh};
use hangpose_core::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose_core::memory::Limits;
use hangpose_core::{Candidates, Monitor, Params};

/// The largest inputs that this program accepts.
const LIMITS: Limits =
    Limits { vertices: 1000, triangles: 2000, samples: 2000, voxels: 20_000, points: 2000 };
const PARAMS: Params = Params {
    samples: LIMITS.samples,
    voxels: LIMITS.voxels,
    candidates: Candidates::Contacts,
    settle: true,
    settle_attempts: 192,
    firm_enough: 1,
    ..Params::paper()
};

/// Whether the memory below is in use.
static IS_BUSY: AtomicBool = AtomicBool::new(false);
static mut OBJECT: [u8; Object::bytes(&LIMITS)] = [0; Object::bytes(&LIMITS)];
static mut SUPPORTER: [u8; Supporter::bytes(&LIMITS)] = [0; Supporter::bytes(&LIMITS)];
static mut WORKING: [u8; predict_bytes(&LIMITS)] = [0; predict_bytes(&LIMITS)];

/// Writes the release position of the best pose of a mesh on a cloud to `position`: x, y, z, metres, in the coordinates
/// of the cloud. Returns the number of poses, or -1 if an input is invalid or larger than `LIMITS`, or if another call
/// is running.
///
/// # Safety
///
/// Each array pointer leads to as many elements as its count says, and `position` leads to three floats.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_demo(
    vertices: *const [f32; 3],
    vertex_count: usize,
    triangles: *const [u32; 3],
    triangle_count: usize,
    points: *const [f32; 3],
    point_count: usize,
    position: *mut [f32; 3],
) -> i32 {
    if IS_BUSY.swap(true, Ordering::Acquire) {
        return -1;
    }
    // SAFETY: the caller vouches for the pointers, and nobody else uses the statics until IS_BUSY is cleared.
    let (vertices, triangles, points, position, memory) = unsafe {
        (
            core::slice::from_raw_parts(vertices, vertex_count),
            core::slice::from_raw_parts(triangles, triangle_count),
            core::slice::from_raw_parts(points, point_count),
            &mut *position,
            (&mut *&raw mut OBJECT, &mut *&raw mut SUPPORTER, &mut *&raw mut WORKING),
        )
    };
    let count = best(vertices, triangles, points, position, (memory.0, memory.1, memory.2));
    IS_BUSY.store(false, Ordering::Release);
    count.map_or(-1, |count| count as i32)
}

fn best(
    vertices: &[[f32; 3]],
    triangles: &[[u32; 3]],
    points: &[[f32; 3]],
    position: &mut [f32; 3],
    (object_memory, supporter_memory, working): (&mut [u8], &mut [u8], &mut [u8]),
) -> Option<usize> {
    let monitor = Monitor::new();
    let mesh = Mesh::new(vertices, triangles).ok()?;
    let object = Object::analyze(&mesh, &PARAMS, object_memory, &monitor).ok()?;
    let cloud = Cloud::new(points, None).ok()?;
    let supporter = Supporter::analyze(&cloud, &PARAMS, supporter_memory, &monitor).ok()?;
    let mut poses = [HangingPose::default(); 1];
    let prediction = predict(&object, &supporter, &Request::ANY, &PARAMS, &mut poses, working, &monitor).ok()?;
    if let Some(best) = prediction.poses.first() {
        *position = best.pose.translation.vector.into();
    }
    Some(prediction.poses.len())
}

/// Set when a panic has stopped the program; visible in a debugger.
#[unsafe(no_mangle)]
pub static HANGPOSE_PANICKED: AtomicBool = AtomicBool::new(false);

#[panic_handler]
fn stop(_: &PanicInfo) -> ! {
    HANGPOSE_PANICKED.store(true, Ordering::Relaxed);
    loop {
        core::hint::spin_loop();
    }
}
