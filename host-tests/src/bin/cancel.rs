//! Measures how soon each call returns after another thread has cancelled it, at many moments spread over the call: the
//! processor time of its thread until then, so that other programs do not count.
//!
//! Prints the most and the 99th percentile, and when the call is slowest to answer. With `--limit` the command fails where the
//! 99th percentile of a call is larger.

use anyhow::{Context, Result, ensure};
use clap::Parser;
use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::motion::{Motion, Task, Waypoint, plan, plan_bytes};
use hangpose::perception::completion::{Completion, CompletionSettings, room};
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Volume, VolumeLimits, VolumeSettings};
use hangpose::{Monitor, Params, suggested_voxel};
use host_tests::performance::ordinary;
use host_tests::performance::processor_time::ThreadClock;
use host_tests::performance::refine::{Triangles, refine};
use host_tests::performance::room::room as walls;
use host_tests::scan::{Spec, frames};
use host_tests::shapes::Random;
use host_tests::solid::Solid;
use std::sync::Barrier;
use std::time::{Duration, Instant};

/// Waypoints of a path at most.
const WAYPOINTS: usize = 2_000;
/// Greatest depth of the images, metres.
const MAX_DEPTH: f32 = 5.0;

/// Greatest difference between the processor time just before a cancel and just after it. At a greater one, the canceller was
/// interrupted, and the moment does not count.
const MAX_DOUBT: Duration = Duration::from_micros(100);

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Moments at which each call is cancelled.
    #[arg(long, default_value_t = 200)]
    moments: u32,
    /// Largest 99th percentile, ms.
    #[arg(long, value_name = "MS")]
    limit: Option<f64>,
    /// Only calls whose name contains this.
    #[arg(long, value_name = "TEXT", default_value = "")]
    only: String,
}

/// Cancels calls and collects how long they took to return.
struct Probe {
    arguments: Arguments,
    slowest: f64,
}

impl Probe {
    /// Cancels `call`, which is named `name`, at moments spread over its duration.
    fn measure(&mut self, name: &str, mut call: impl FnMut(&Monitor)) {
        if !name.contains(&self.arguments.only) {
            return;
        }
        let clock = ThreadClock::of_this_thread().expect("the system measures the processor time of threads");
        let mut duration = Duration::MAX;
        for _ in 0..2 {
            let start = Instant::now();
            call(&Monitor::new());
            duration = duration.min(start.elapsed());
        }
        let mut answers: Vec<(f64, u32)> = (0..self.arguments.moments)
            .filter_map(|moment| {
                let monitor = Monitor::new();
                let at = duration * moment / self.arguments.moments;
                let both = Barrier::new(2);
                std::thread::scope(|scope| {
                    let canceller = scope.spawn(|| {
                        both.wait();
                        let start = Instant::now();
                        while start.elapsed() < at {
                            std::hint::spin_loop();
                        }
                        let before = clock.now()?;
                        monitor.cancel();
                        let after = clock.now()?;
                        (after - before <= MAX_DOUBT).then_some(before)
                    });
                    both.wait();
                    call(&monitor);
                    let returned = clock.now()?;
                    let used = returned.checked_sub(canceller.join().ok()??)?;
                    Some((used.as_secs_f64() * 1000.0, moment))
                })
            })
            .collect();
        answers.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A call may be over before it is cancelled, but not often.
        assert!(4 * answers.len() > self.arguments.moments as usize, "{name}: too few cancels were measured");
        let Some(&(most, when)) = answers.last() else { return };
        let percentile = answers[(answers.len() - 1) * 99 / 100].0;
        self.slowest = self.slowest.max(percentile);
        println!(
            "| {name} | {:.1} | {:.3} | {percentile:.3} | {most:.3} | {:.0} % |",
            duration.as_secs_f64() * 1000.0,
            answers[answers.len() / 2].0,
            100.0 * f64::from(when) / f64::from(self.arguments.moments)
        );
    }

    fn analyse_object(
        &mut self,
        name: &str,
        (vertices, triangles): &Triangles,
        params: &Params,
    ) -> Result<()> {
        let mesh = Mesh::new(vertices, triangles)?;
        let mut memory = vec![0; Object::bytes(&Object::limits(&mesh, params))];
        self.measure(name, |monitor| {
            let _ = Object::analyze(&mesh, params, &mut memory, monitor);
        });
        Ok(())
    }

    fn analyse_supporter(&mut self, name: &str, cloud: &Cloud, params: &Params) {
        let mut memory = vec![0; Supporter::bytes(&Limits::of_points(cloud.points().len()))];
        self.measure(name, |monitor| {
            let _ = Supporter::analyze(cloud, params, &mut memory, monitor);
        });
    }

    /// Each step from depth images of the object to its mesh.
    fn scan(&mut self, object: &Solid) -> Result<()> {
        let spec: Spec = "3+1".parse().map_err(anyhow::Error::msg)?;
        let shots = spec.shoot_object(object, &[], &mut Random::named("cancel", 1));
        let images: Vec<_> = shots.iter().filter_map(|shot| shot.image()).collect();
        let guess = CompletionSettings::default();
        let voxel = suggested_voxel(&frames(&images), MAX_DEPTH, None);
        let sparse = VolumeSettings { max_depth: MAX_DEPTH, ..VolumeSettings::new(voxel) };
        let margin = sparse.truncation + 2.0 * voxel;
        let crop = room(images.iter().map(|image| (*image, None)), &guess, MAX_DEPTH, margin);
        let settings = VolumeSettings { crop, dense: true, missing_is_free: true, ..sparse };
        let limits = VolumeLimits { blocks: settings.dense_blocks().context("there is a crop box")? };
        let (mut memory, monitor) = (vec![0; Volume::bytes(&limits)], Monitor::new());
        let mut volume = Volume::new(&settings, &limits, &mut memory)?;
        for image in &images {
            volume.integrate(image, None, &monitor)?;
        }
        let image = images.first().context("a scan has images")?;
        self.measure("scan, image", |monitor| {
            let _ = volume.integrate(image, None, monitor);
        });
        // Completing what is complete takes as long.
        let mut memory = vec![0; Completion::bytes(volume.blocks())];
        self.measure("scan, completion", |monitor| {
            let _ = volume.complete(&guess, &mut memory, monitor);
        });
        let mut memory = vec![0; Isosurface::bytes(volume.blocks())];
        self.measure("scan, surface", |monitor| {
            let _ = Isosurface::find(&volume, &mut memory, monitor);
        });
        Ok(())
    }
}

fn main() -> Result<()> {
    let mut probe = Probe { arguments: Arguments::parse(), slowest: 0.0 };
    let case = ordinary::ordinary();
    let (default, paper, monitor) = (Params::default(), Params::paper(), Monitor::new());
    println!("| call | duration | median | 99 % | most, ms | slowest at |\n|---|--:|--:|--:|--:|--:|");

    let object_mesh = ordinary::object(&case, 20_000);
    let fine = refine(object_mesh.clone(), 200_000);
    let mut open = object_mesh.clone();
    open.1.truncate(open.1.len() * 3 / 4);
    probe.analyse_object("object, 20,000 triangles", &object_mesh, &default)?;
    probe.analyse_object("object, 20,000 triangles, paper", &object_mesh, &paper)?;
    probe.analyse_object("object, 200,000 triangles", &fine, &default)?;
    probe.analyse_object("object, open mesh", &open, &default)?;

    let (points, normals) = ordinary::supporter(&case, 10_000);
    let cloud = Cloud::new(&points, Some(&normals))?;
    let bare = Cloud::new(&points, None)?;
    let around = [points.as_slice(), &walls(300_000)].concat();
    probe.analyse_supporter("supporter, 10,000 points", &cloud, &default);
    probe.analyse_supporter("supporter, without normals", &bare, &default);
    probe.analyse_supporter("supporter, paper", &bare, &paper);
    probe.analyse_supporter("supporter, 300,000 points of a room", &Cloud::new(&around, None)?, &default);

    for (profile, params) in [("default", &default), ("paper", &paper)] {
        let mesh = Mesh::new(&object_mesh.0, &object_mesh.1)?;
        let limits = Limits { points: points.len(), ..Object::limits(&mesh, params) };
        let (mut a, mut b) = (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
        let object = Object::analyze(&mesh, params, &mut a, &monitor)?;
        let supporter = Supporter::analyze(&cloud, params, &mut b, &monitor)?;
        let mut memory = vec![0; predict_bytes(&limits)];
        let mut poses = [HangingPose::default(); 10];
        probe.measure(&format!("predict, {profile}"), |monitor| {
            let _ = predict(&object, &supporter, &Request::ANY, params, &mut poses, &mut memory, monitor);
        });
        if params.voxels == 0 {
            continue;
        }
        let found = predict(&object, &supporter, &Request::ANY, params, &mut poses, &mut memory, &monitor)?;
        let goal = *found.poses.first().context("the mug hangs")?;
        let motion = Motion::default();
        let task = Task { object: &object, supporter: &supporter, request: &Request::ANY, params, motion };
        let mut memory = vec![0; plan_bytes(&limits, 0, motion.nodes)];
        let mut waypoints = vec![Waypoint::default(); WAYPOINTS];
        probe.measure("plan", |monitor| {
            let _ = plan(&task, &goal, &mut waypoints, &mut |_| true, &mut memory, monitor);
        });
    }

    probe.scan(&case.object)?;
    if let Some(limit) = probe.arguments.limit {
        ensure!(probe.slowest <= limit, "a call needs {:.3} ms to end, more than {limit} ms", probe.slowest);
    }
    Ok(())
}
