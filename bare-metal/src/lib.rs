//! The core on a microcontroller: static memory, no allocator, no unwinding.
#![no_std]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use hangpose_core::geometry::{Point, Vector, hull};

static POINTS: [Point; 4] = [
    Point::new(0.0, 0.0, 0.0),
    Point::new(0.1, 0.0, 0.0),
    Point::new(0.0, 0.1, 0.0),
    Point::new(0.0, 0.0, 0.1),
];

/// Distance in metres from (`x`, `y`, `z`) upwards to the hull of the static points.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_demo(x: f32, y: f32, z: f32) -> f32 {
    hull::exit_distance(&POINTS, Point::new(x, y, z), Vector::z())
}

/// Set when a panic has stopped the program, for the debugger to see.
#[unsafe(no_mangle)]
pub static HANGPOSE_PANICKED: AtomicBool = AtomicBool::new(false);

#[panic_handler]
fn stop(_: &PanicInfo) -> ! {
    HANGPOSE_PANICKED.store(true, Ordering::Relaxed);
    loop {
        core::hint::spin_loop();
    }
}
