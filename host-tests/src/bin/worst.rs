//! Measures each call on meshes and clouds that are hard for it, beside the same call on an ordinary pair of the same size.
//!
//! With `--limit` the command fails where a call takes more than so many times as long as the same call on the ordinary pair.

use anyhow::ensure;
use clap::Parser;
use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{HangingPose, Object, Request, Supporter, predict, predict_bytes};
use hangpose::memory::Limits;
use hangpose::motion::{Motion, Task, Waypoint, plan, plan_bytes};
use hangpose::{Monitor, Params};
use host_tests::performance::adversarial::{clouds, meshes};
use host_tests::performance::ordinary;
use host_tests::performance::refine::Triangles;
use std::collections::{BTreeMap, HashMap};
use std::time::Instant;

/// Waypoints of a path at most.
const WAYPOINTS: usize = 2_000;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Triangles of each mesh.
    #[arg(long, default_value_t = 20_000)]
    triangles: usize,
    /// Points of each cloud.
    #[arg(long, default_value_t = 10_000)]
    points: usize,
    /// Largest ratio to the ordinary pair.
    #[arg(long, value_name = "TIMES")]
    limit: Option<f64>,
    /// Only inputs whose name contains this.
    #[arg(long, value_name = "TEXT", default_value = "")]
    only: String,
}

/// The ordinary pair and what each call takes with it.
struct Worst {
    ordinary: HashMap<String, f64>,
    /// The largest ratio of each call, its time in milliseconds, and its input.
    largest: BTreeMap<String, (f64, f64, String)>,
}

impl Worst {
    /// Runs `call` and prints how long it took beside the ordinary input, which comes first.
    fn time<T>(
        &mut self,
        input: &str,
        name: &str,
        describe: impl Fn(&T) -> String,
        call: impl FnOnce() -> T,
    ) -> T {
        let start = Instant::now();
        let result = call();
        let took = start.elapsed().as_secs_f64() * 1000.0;
        let usual = *self.ordinary.entry(name.to_owned()).or_insert(took);
        let ratio = took / usual;
        let largest = self.largest.entry(name.to_owned()).or_default();
        if ratio > largest.0 {
            *largest = (ratio, took, input.to_owned());
        }
        println!("| {input} | {name} | {took:.1} | {ratio:.2} | {} |", describe(&result));
        result
    }

    /// Analyses both sides, predicts, and plans a path to the first pose.
    fn pair(&mut self, input: &str, mesh: &Triangles, points: &[[f32; 3]], arguments: &Arguments) {
        if !input.contains(&arguments.only) && input != "ordinary" {
            return;
        }
        let monitor = Monitor::new();
        let (mesh, cloud) = (Mesh::new(&mesh.0, &mesh.1), Cloud::new(points, None));
        let (Ok(mesh), Ok(cloud)) = (&mesh, &cloud) else {
            println!("| {input} | | | | {}, {} |", outcome(&mesh), outcome(&cloud));
            return;
        };
        for (profile, params) in [("default", Params::default()), ("paper", Params::paper())] {
            let limits = Limits { points: points.len(), ..Object::limits(mesh, &params) };
            let (mut a, mut b) = (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
            let object = self.time(input, &format!("object, {profile}"), outcome, || {
                Object::analyze(mesh, &params, &mut a, &monitor)
            });
            let supporter = self.time(input, &format!("supporter, {profile}"), outcome, || {
                Supporter::analyze(cloud, &params, &mut b, &monitor)
            });
            let (Ok(object), Ok(supporter)) = (object, supporter) else { continue };
            let mut memory = vec![0; predict_bytes(&limits)];
            let mut poses = [HangingPose::default(); 10];
            let found = self.time(
                input,
                &format!("predict, {profile}"),
                |found: &Result<(usize, u64), String>| match found {
                    Ok((count, work)) => format!("{count} poses, {work} queries"),
                    Err(error) => error.clone(),
                },
                || {
                    predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &monitor)
                        .map(|found| (found.poses.len(), found.work.rays + found.work.distance_queries))
                        .map_err(|error| error.to_string())
                },
            );
            let goal = poses[0];
            if params.voxels == 0 || !matches!(found, Ok((1.., _))) {
                continue;
            }
            let motion = Motion::default();
            let task = Task {
                object: &object,
                supporter: &supporter,
                request: &Request::ANY,
                params: &params,
                motion,
            };
            let mut memory = vec![0; plan_bytes(&limits, 0, motion.nodes)];
            let mut waypoints = vec![Waypoint::default(); WAYPOINTS];
            let _ = self.time(input, "plan", outcome, || {
                plan(&task, &goal, &mut waypoints, &mut |_| true, &mut memory, &monitor).map(|_| ())
            });
        }
    }
}

fn outcome<T, E: std::fmt::Display>(result: &Result<T, E>) -> String {
    result.as_ref().err().map_or_else(|| "done".to_owned(), ToString::to_string)
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let case = ordinary::ordinary();
    let mug = ordinary::object(&case, arguments.triangles);
    let (hook, _) = ordinary::supporter(&case, arguments.points);
    println!("| input | call | ms | times the ordinary | result |\n|---|---|--:|--:|---|");
    let mut worst = Worst { ordinary: HashMap::new(), largest: BTreeMap::new() };
    worst.pair("ordinary", &mug, &hook, &arguments);
    for (name, mesh) in meshes(arguments.triangles) {
        worst.pair(&format!("mesh: {name}"), &mesh, &hook, &arguments);
    }
    for (name, cloud) in clouds(arguments.points) {
        worst.pair(&format!("cloud: {name}"), &mug, &cloud, &arguments);
    }
    println!("\n| call | slowest input | ms | times the ordinary |\n|---|---|--:|--:|");
    for (name, (ratio, took, input)) in &worst.largest {
        println!("| {name} | {input} | {took:.0} | {ratio:.1} |");
    }
    let ratio = worst.largest.values().map(|largest| largest.0).fold(0.0, f64::max);
    if let Some(limit) = arguments.limit {
        ensure!(
            ratio <= limit,
            "a call takes {ratio:.1} times as long as with the ordinary pair, more than {limit} times"
        );
    }
    Ok(())
}
