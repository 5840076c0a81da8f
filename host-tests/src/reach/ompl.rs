//! OMPL's RRT-Connect (Kuffner and LaValle 2000; Şucan, Moll and Kavraki 2012) as a peer. This file has the unsafe code of it.

use super::row::Peer;
use hangpose::geometry::{Point, Pose};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use std::ffi::c_void;

/// Largest distance that a part of the object moves between two tests, by translation and by rotation each, m.
const RESOLUTION: f64 = 0.001;
/// Time after which it gives up, s.
const SECONDS: f64 = 2.0;

/// Mirrors `ompl.cpp`.
#[repr(C)]
struct Problem {
    start: [f64; 7],
    goal: [f64; 7],
    low: [f64; 3],
    high: [f64; 3],
    reach: f64,
    resolution: f64,
    seconds: f64,
}

type IsFree = unsafe extern "C" fn(*mut c_void, *const f64) -> bool;

unsafe extern "C" {
    fn hangpose_ompl(
        problem: *const Problem,
        is_free: IsFree,
        context: *mut c_void,
        seconds: *mut f64,
    ) -> bool;
}

/// A checker and what it needs, behind the context of the callback.
struct Context<'a> {
    is_free: &'a mut dyn FnMut(&Pose) -> bool,
    centre: Point,
    poses: usize,
}

/// A path from `start` to `goal` by OMPL, with `is_free` as its collision checker. `centre` is the centre of mass and `reach` the
/// distance from there to the farthest point, in object coordinates; `low` and `high` bound the centre of mass.
pub fn peer(
    [start, goal]: [&Pose; 2],
    [low, high]: [[f32; 3]; 2],
    (centre, reach): (Point, f32),
    is_free: &mut dyn FnMut(&Pose) -> bool,
) -> Peer {
    let state = |pose: &Pose| -> [f64; 7] {
        let at = pose * centre;
        // OMPL takes no quaternion that is off by more than a double is.
        let [x, y, z, w]: [f64; 4] = pose.rotation.coords.cast::<f64>().normalize().into();
        [f64::from(at.x), f64::from(at.y), f64::from(at.z), x, y, z, w]
    };
    let problem = Problem {
        start: state(start),
        goal: state(goal),
        low: low.map(f64::from),
        high: high.map(f64::from),
        reach: f64::from(reach),
        resolution: RESOLUTION,
        seconds: SECONDS,
    };
    let mut context = Context { is_free, centre, poses: 0 };
    let mut seconds = 0.0;
    // SAFETY: the problem, the context and the time outlive the call, which keeps no pointer to them; `ask` takes such a context.
    let is_solved = unsafe { hangpose_ompl(&problem, ask, (&raw mut context).cast(), &mut seconds) };
    Peer { is_solved, seconds, poses: context.poses }
}

/// Asks the checker about a state.
///
/// # Safety
///
/// `context` points to a [`Context`] and `state` to seven numbers.
unsafe extern "C" fn ask(context: *mut c_void, state: *const f64) -> bool {
    // SAFETY: the caller promises both; nothing else uses the context during the call.
    let (context, state) = unsafe { (&mut *context.cast::<Context>(), *state.cast::<[f64; 7]>()) };
    let [x, y, z, i, j, k, w] = state.map(|x| x as f32);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
    let at = Point::new(x, y, z) - rotation * context.centre;
    context.poses += 1;
    (context.is_free)(&Isometry3::from_parts(Translation3::from(at), rotation))
}
