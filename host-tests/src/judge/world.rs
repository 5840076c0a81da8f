//! A rigid body among fixed shapes in a physics engine. This file has all unsafe code of the judges.

use super::buried::Buried;
use super::overlap::Overlap;
use super::{GRAVITY, Mass, Scene, Verdict, verdict};
use crate::solid::{Part, Solid};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use std::ffi::c_void;

// The types below mirror engine.h.

#[repr(C)]
struct Setup {
    mass: f64,
    inertia: [f64; 3],
    friction: f64,
    time_step: f64,
    damping: f64,
}

#[repr(C)]
#[derive(Default)]
struct RawState {
    position: [f64; 3],
    rotation: [f64; 4],
    velocity: [f64; 3],
    spin: [f64; 3],
}

type Handle = *mut c_void;
type AddHull = unsafe extern "C" fn(Handle, bool, *const f64, usize);
type AddMesh = unsafe extern "C" fn(Handle, bool, *const f64, usize, *const u32, usize);

#[repr(C)]
pub(super) struct Engine {
    create: unsafe extern "C" fn(*const Setup) -> Handle,
    add_hull: Option<AddHull>,
    add_capsule: unsafe extern "C" fn(Handle, bool, *const f64, *const f64, f64),
    add_box: unsafe extern "C" fn(Handle, bool, *const f64, *const f64, *const f64),
    add_mesh: Option<AddMesh>,
    place: unsafe extern "C" fn(Handle, *const RawState),
    pull: unsafe extern "C" fn(Handle, *const f64),
    step: unsafe extern "C" fn(Handle, u32) -> u32,
    read: unsafe extern "C" fn(Handle, *mut RawState),
    penetration: unsafe extern "C" fn(Handle) -> f64,
    destroy: unsafe extern "C" fn(Handle),
}

unsafe extern "C" {
    // SAFETY: a constant of the shim with the type that engine.h declares; it is only read.
    safe static hangpose_bullet: Engine;
    // SAFETY: as above.
    safe static hangpose_ode: Engine;
}

pub(super) static BULLET: &Engine = &hangpose_bullet;
pub(super) static ODE: &Engine = &hangpose_ode;

/// Pose and velocity of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Pose, which maps object to supporter coordinates.
    pub pose: Isometry3<f64>,
    /// Centre of mass in supporter coordinates, m.
    pub centre: Vector3<f64>,
    /// Velocity of the centre of mass, m/s.
    pub velocity: Vector3<f64>,
    /// Angular velocity in supporter coordinates, rad/s.
    pub spin: Vector3<f64>,
}

/// One scene in one engine. It belongs to the thread that created it; each thread may have its own.
pub struct World {
    engine: &'static Engine,
    handle: Handle,
    time_step: f64,
    frame: Isometry3<f64>,
    buried: Option<Buried>,
    overlap: Option<Overlap>,
}

impl World {
    pub(super) fn new(engine: &'static Engine, scene: &Scene, time_step: f64) -> Self {
        let Mass { mass, inertia, frame } = scene.mass;
        let setup = Setup { mass, inertia, friction: scene.friction, time_step, damping: scene.damping };
        // SAFETY: `setup` outlives the call, which keeps no pointer to it.
        let handle = unsafe { (engine.create)(&setup) };
        let mut world = Self { engine, handle, time_step, frame, buried: None, overlap: None };
        if scene.object.is_shell || scene.supporter.is_shell {
            world.overlap = Some(Overlap::new(scene));
        }
        world.pull(Vector3::new(0.0, 0.0, -GRAVITY));
        world
    }

    /// Adds a part to the body, with `into_body` from object to body coordinates, or to the fixed shapes if that is
    /// `None`.
    pub(super) fn add_part(&mut self, part: &Part, into_body: Option<&Isometry3<f64>>) {
        let body = into_body.is_some();
        let pose = into_body.copied().unwrap_or_default();
        let place = |point: &[f32; 3]| (pose * Point3::from(*point).cast::<f64>()).coords;
        match part {
            Part::Hull(points) => {
                let points: Vec<f64> =
                    points.iter().flat_map(|point| <[f64; 3]>::from(place(point))).collect();
                if let Some(add_hull) = self.engine.add_hull {
                    // SAFETY: the handle is alive; `points` has three numbers for each of the counted points.
                    unsafe { add_hull(self.handle, body, points.as_ptr(), points.len() / 3) }
                }
            }
            Part::Capsule { from, to, radius } => {
                let (from, to) = (place(from), place(to));
                // SAFETY: the handle is alive; both arrays have three numbers.
                unsafe {
                    (self.engine.add_capsule)(
                        self.handle,
                        body,
                        from.as_ptr(),
                        to.as_ptr(),
                        f64::from(*radius),
                    );
                }
            }
            Part::Cuboid { centre, axes, half_extents } => {
                let centre = place(centre);
                let axes = axes.map(|axis| <[f64; 3]>::from(pose * Vector3::from(axis).cast::<f64>()));
                let half_extents = half_extents.map(f64::from);
                let axes = axes.as_flattened();
                // SAFETY: the handle is alive; the arrays have three, nine and three numbers.
                unsafe {
                    (self.engine.add_box)(
                        self.handle,
                        body,
                        centre.as_ptr(),
                        axes.as_ptr(),
                        half_extents.as_ptr(),
                    );
                }
            }
        }
    }

    /// Adds a surface, with the same `into_body` as [`World::add_part`].
    pub(super) fn add_mesh(&mut self, solid: &Solid, into_body: Option<&Isometry3<f64>>) {
        let pose = into_body.copied().unwrap_or_default();
        let place = |point: &[f32; 3]| <[f64; 3]>::from((pose * Point3::from(*point).cast::<f64>()).coords);
        let vertices: Vec<f64> = solid.vertices.iter().flat_map(place).collect();
        let corners = solid.triangles.as_flattened();
        assert!(
            corners.iter().all(|&corner| (corner as usize) < solid.vertices.len()),
            "a triangle uses a vertex that does not exist"
        );
        if let Some(add_mesh) = self.engine.add_mesh {
            // SAFETY: the handle is alive; the counts are those of the slices, and every index is of a vertex.
            unsafe {
                add_mesh(
                    self.handle,
                    into_body.is_some(),
                    vertices.as_ptr(),
                    solid.vertices.len(),
                    corners.as_ptr(),
                    solid.triangles.len(),
                );
            }
        }
    }

    /// Makes [`World::penetration`] also detect shapes wholly inside the object.
    pub(super) fn look_inside(&mut self, scene: &Scene) {
        self.buried = Some(Buried::new(scene));
    }

    /// Sets pose and velocities of the body and discards all contacts. `state.centre` is ignored; it follows from the
    /// pose.
    pub fn place(&mut self, state: &State) {
        let body = state.pose * self.frame;
        let raw = RawState {
            position: body.translation.vector.into(),
            rotation: body.rotation.coords.into(),
            velocity: state.velocity.into(),
            spin: state.spin.into(),
        };
        // SAFETY: the handle is alive; `raw` outlives the call, which keeps no pointer to it.
        unsafe { (self.engine.place)(self.handle, &raw) }
    }

    /// Puts the body at a pose with zero velocity.
    pub fn release(&mut self, pose: &Isometry3<f64>) {
        let still = Vector3::zeros();
        self.place(&State { pose: *pose, centre: still, velocity: still, spin: still });
    }

    /// Sets the gravitational acceleration, m/s².
    pub fn pull(&mut self, gravity: Vector3<f64>) {
        // SAFETY: the handle is alive; the vector is three numbers.
        unsafe { (self.engine.pull)(self.handle, gravity.as_ptr()) }
    }

    /// Simulates for `seconds`, rounded to at least one whole step. Returns the fraction of the steps in which a
    /// contact carried load; grazing contacts do not count.
    pub fn pass(&mut self, seconds: f64) -> f64 {
        let steps = (seconds / self.time_step).round().max(1.0) as u32;
        // SAFETY: the handle is alive.
        let loaded = unsafe { (self.engine.step)(self.handle, steps) };
        f64::from(loaded) / f64::from(steps)
    }

    /// Current state of the body.
    pub fn state(&self) -> State {
        let mut raw = RawState::default();
        // SAFETY: the handle is alive; `raw` is written within the call only.
        unsafe { (self.engine.read)(self.handle, &mut raw) }
        let rotation = UnitQuaternion::from_quaternion(Quaternion::from(raw.rotation));
        let body = Isometry3::from_parts(Translation3::from(raw.position), rotation);
        State {
            pose: body * self.frame.inverse(),
            centre: raw.position.into(),
            velocity: raw.velocity.into(),
            spin: raw.spin.into(),
        }
    }

    /// Verdict on the release of the body at `release`. `scene` must be the scene of this world.
    pub fn judge(&mut self, scene: &Scene, release: &Isometry3<f32>) -> Verdict {
        verdict::examine(self, scene, &release.cast())
    }

    /// Penetration depth at the current pose, m; 0 without overlap.
    pub fn penetration(&mut self) -> f64 {
        if let Some(overlap) = &self.overlap {
            return overlap.depth(&self.state().pose);
        }
        // SAFETY: the handle is alive.
        let depth = unsafe { (self.engine.penetration)(self.handle) };
        let pose = self.state().pose;
        self.buried.as_ref().map_or(depth, |buried| buried.depth(&pose).max(depth))
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: the handle came from `create` and is not used again.
        unsafe { (self.engine.destroy)(self.handle) }
    }
}
