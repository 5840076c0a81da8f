//! Time, memory and work of each stage of a prediction on one thread.

use anyhow::Result;
use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::{Monitor, Params, Work};
use serde::Serialize;
use std::time::Instant;

/// Stages that are measured.
pub const STAGES: [&str; 3] = ["object", "supporter", "matching"];

/// Figures of a prediction.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Triangles of the object.
    pub triangles: usize,
    /// Points of the supporter.
    pub points: usize,
    /// Least duration of each stage, ms: what else the machine does can only add to it.
    pub milliseconds: [f64; STAGES.len()],
    /// Memory of the object, of the supporter and for the prediction, bytes.
    pub bytes: [usize; STAGES.len()],
    /// Rays of each stage.
    pub rays: [u64; STAGES.len()],
    /// Distance queries of each stage.
    pub distance_queries: [u64; STAGES.len()],
    /// Poses found, of at most ten.
    pub poses: usize,
    /// Candidates that were released.
    pub released: usize,
}

impl Figures {
    /// Duration of all stages, ms.
    pub fn total(&self) -> f64 {
        self.milliseconds.iter().sum()
    }
}

/// Predicts `runs` times in the same memory. A function of its own also when compiled, for `scripts/profile.sh`.
#[inline(never)]
pub fn measure(mesh: &Mesh, cloud: &Cloud, params: &Params, runs: usize) -> Result<Figures> {
    let monitor = Monitor::new();
    let limits = Limits { points: cloud.points().len(), ..Object::limits(mesh, params) };
    let bytes = [Object::bytes(&limits), Supporter::bytes(&limits), predict_bytes(&limits)];
    let mut memory = bytes.map(|size| vec![0; size]);
    let mut milliseconds = [f64::INFINITY; STAGES.len()];
    let (mut work, mut counts) = ([Work::default(); STAGES.len()], [0; 2]);
    for _ in 0..runs {
        let [object_memory, supporter_memory, scratch] = &mut memory;
        let mut poses = [HangingPose::default(); 10];
        let start = Instant::now();
        let object = Object::analyze(mesh, params, object_memory, &monitor)?;
        let after_object = Instant::now();
        let supporter = Supporter::analyze(cloud, params, supporter_memory, &monitor)?;
        let after_supporter = Instant::now();
        let prediction = predict(&object, &supporter, &Request::ANY, params, &mut poses, scratch, &monitor)?;
        let stages = [after_object - start, after_supporter - after_object, after_supporter.elapsed()];
        counts = [prediction.poses.len(), prediction.counts.settling.released];
        work = [object.work(), supporter.work(), prediction.work];
        for (least, stage) in milliseconds.iter_mut().zip(stages) {
            *least = least.min(stage.as_secs_f64() * 1000.0);
        }
    }
    let [poses, released] = counts;
    Ok(Figures {
        triangles: mesh.triangles().len(),
        points: cloud.points().len(),
        milliseconds,
        bytes,
        rays: work.map(|work| work.rays),
        distance_queries: work.map(|work| work.distance_queries),
        poses,
        released,
    })
}
