//! One scene for time steps with contact in several engines: a generated pair at its rest pose.

use crate::judge::{Bullet, Judge, Scene, World};
use crate::solid::{Part, Solid};
use crate::tables::case::{Case, made};
use anyhow::{Context, Result};
use hangpose::hanging::{HangingPose, Object, Request, Supporter, watch_release};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses};
use nalgebra::{Isometry3, Vector3};
use serde_json::{Value, json};

/// Kind of the object: one of few parts that the engines have as primitives.
const OBJECT: &str = "ring";
/// Generated pairs of which the first with that object is taken: one of each kind of object.
const PAIRS: usize = 22;
/// Seed of the sizes.
const SEED: u64 = 61;

/// The pair and the pose at which the object rests.
pub struct Resting {
    /// The pair.
    pub case: Case,
    /// Parameters.
    pub params: Params,
    /// The best predicted rest pose.
    pub rest: Isometry3<f32>,
}

impl Resting {
    /// Predicts it.
    pub fn new() -> Result<Self> {
        let case = made(PAIRS, SEED).into_iter().find(|case| case.object_kind == OBJECT);
        let case = case.context("no such pair is generated")?;
        let params = Params::default();
        let mut resting = Self { case, params, rest: Isometry3::identity() };
        resting.rest = resting.with(|object, supporter, params| {
            let mut poses = [HangingPose::default(); 1];
            let monitor = Monitor::new();
            let found = predict_poses(object, supporter, &Request::ANY, params, &mut poses, &monitor)?;
            let best = found.poses.first().context("the pair has no pose")?;
            Ok(best.rest.context("the pose has no rest pose")?.pose)
        })?;
        Ok(resting)
    }

    /// Calls a function with the analysed pair.
    pub fn with<T>(&self, call: impl FnOnce(&Object, &Supporter, &Params) -> Result<T>) -> Result<T> {
        let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
        let (cloud, monitor) = (self.case.supporter_cloud(), Monitor::new());
        let object = analyze_object(&self.case.object.mesh(), &self.params, &mut object_memory, &monitor)?;
        let supporter = analyze_supporter(&cloud.cloud()?, &self.params, &mut supporter_memory, &monitor)?;
        call(&object, &supporter, &self.params)
    }

    /// Releases the object at its rest pose in the core. Returns the number of time steps until its fate is certain.
    pub fn release(&self, object: &Object, supporter: &Supporter, memory: &mut [u8]) -> Result<usize> {
        let (mut steps, monitor) = (0, Monitor::new());
        let mut count = |_: f32, _: &_| steps += 1;
        let ended =
            watch_release((object, supporter), &self.rest, &self.params, memory, &monitor, &mut count)?;
        ended.ok().context("nothing stops it")?;
        Ok(steps)
    }

    /// The scene in Bullet at the core's time step, with the object at its rest pose.
    pub fn bullet(&self) -> World {
        let time_step = f64::from(self.params.time_step);
        let mut world = Bullet { time_step }.world(&self.scene());
        world.release(&self.rest.cast());
        world
    }

    /// The scene for the judges.
    pub fn scene(&self) -> Scene<'_> {
        Scene::new(&self.case.object, &self.case.supporter)
    }

    /// The scene for other engines: parts, mass properties and the rest pose. A quaternion is w, x, y, z.
    pub fn describe(&self) -> Value {
        let scene = self.scene();
        let pose = |pose: &Isometry3<f64>| {
            let q = pose.rotation;
            json!({"position": <[f64; 3]>::from(pose.translation.vector), "quaternion": [q.w, q.i, q.j, q.k]})
        };
        json!({
            "pair": self.case.name,
            "time_step": self.params.time_step,
            "friction": scene.friction,
            "mass": scene.mass.mass,
            "inertia": scene.mass.inertia,
            "frame": pose(&scene.mass.frame),
            "rest": pose(&self.rest.cast()),
            "object": parts(&self.case.object),
            "supporter": parts(&self.case.supporter),
        })
    }

    /// How far the object is from its rest pose, m, after this time in Bullet, s.
    pub fn drift_in_bullet(&self, seconds: f64) -> f64 {
        let mut world = self.bullet();
        let before: Vector3<f64> = world.state().centre;
        world.pass(seconds);
        (world.state().centre - before).norm()
    }
}

fn parts(solid: &Solid) -> Vec<Value> {
    let part = |part: &Part| match part {
        Part::Hull(points) => json!({"hull": points}),
        Part::Capsule { from, to, radius } => json!({"from": from, "to": to, "radius": radius}),
        Part::Cuboid { centre, axes, half_extents } => {
            json!({"centre": centre, "axes": axes, "half_extents": half_extents})
        }
    };
    solid.parts.iter().map(part).collect()
}
