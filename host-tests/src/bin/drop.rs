//! Simulates the release of an object at its predicted poses in Bullet, replays the path to one of them, prints the
//! verdicts, and draws a picture.

use anyhow::{Context, Result, ensure};
use clap::Parser;
use hangpose::files::read_mesh;
use hangpose::geometry::Pose;
use hangpose::motion::{Path, Waypoint};
use host_tests::film;
use host_tests::gallery::{self, Way};
use host_tests::judge::replay::replay;
use host_tests::judge::{Bullet, Judge, Scene};
use host_tests::solid::Solid;
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use serde::Deserialize;
use std::path::PathBuf;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// The object, in metres with z up.
    #[arg(long, value_name = "MESH")]
    object: PathBuf,
    /// The supporter, in metres with z up.
    #[arg(long, value_name = "MESH")]
    supporter: PathBuf,
    /// Output of `hangpose predict --json`.
    #[arg(long, value_name = "JSON")]
    poses: PathBuf,
    /// File for the picture of the path. Without a path it shows the first pose that hangs, or the best pose if none
    /// does.
    #[arg(long, value_name = "PNG")]
    picture: PathBuf,
    /// File for a moving picture of the path and of the release at its end in Bullet.
    #[arg(long, value_name = "GIF")]
    film: Option<PathBuf>,
}

/// Duration of the release in the moving picture, seconds, and the time between two of its poses.
const RELEASE: (f64, f64) = (1.5, 0.05);

#[derive(Deserialize)]
struct Prediction {
    poses: Vec<PredictedPose>,
}

#[derive(Deserialize)]
struct PredictedPose {
    position: [f32; 3],
    quaternion_xyzw: [f32; 4],
    path: Option<PlannedPath>,
}

/// The path of the object. A gripper is not replayed.
#[derive(Deserialize)]
struct PlannedPath {
    waypoints: Vec<PlannedWaypoint>,
    release: usize,
    clearance: f32,
}

#[derive(Deserialize)]
struct PlannedWaypoint {
    seconds: f32,
    position: [f32; 3],
    quaternion_xyzw: [f32; 4],
}

fn pose(position: [f32; 3], quaternion_xyzw: [f32; 4]) -> Pose {
    let rotation = UnitQuaternion::from_quaternion(Quaternion::from(quaternion_xyzw));
    Pose::from_parts(Translation3::from(position), rotation)
}

impl From<&PlannedWaypoint> for Waypoint {
    fn from(&PlannedWaypoint { seconds, position, quaternion_xyzw }: &PlannedWaypoint) -> Self {
        Self { seconds, pose: pose(position, quaternion_xyzw) }
    }
}

/// The object after its release at a waypoint, simulated in Bullet.
fn released(scene: &Scene, from: &Waypoint) -> Vec<Waypoint> {
    let (duration, step) = RELEASE;
    let mut world = Bullet::default().world(scene);
    world.release(&from.pose.cast());
    let mut after = Vec::new();
    let mut seconds = 0.0;
    while seconds < duration {
        world.pass(step);
        seconds += step;
        let pose = world.state().pose.cast();
        after.push(Waypoint { seconds: from.seconds + seconds as f32, pose });
    }
    after
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let shell = |path: &PathBuf| -> Result<Solid> {
        let mesh = read_mesh(path)?;
        Ok(Solid::shell(mesh.vertices, mesh.triangles))
    };
    let (object, supporter) = (shell(&arguments.object)?, shell(&arguments.supporter)?);
    let at = || arguments.poses.display().to_string();
    let text = std::fs::read_to_string(&arguments.poses).with_context(at)?;
    let prediction: Prediction = serde_json::from_str(&text).with_context(at)?;
    ensure!(!prediction.poses.is_empty(), "{}: has no poses; predict a pair that hangs", at());

    let scene = Scene::new(&object, &supporter);
    let mut best = None;
    for (rank, predicted) in (1..).zip(&prediction.poses) {
        let release = pose(predicted.position, predicted.quaternion_xyzw);
        let verdict = Bullet::default().judge(&scene, &release);
        let words = match (verdict.clear, verdict.holds, verdict.honest, verdict.robust) {
            (false, ..) => "penetrates the supporter",
            (_, false, ..) => "falls",
            (_, _, false, _) => "is stuck in the supporter",
            (.., false) => "hangs, but not under tilted gravity",
            (.., true) => "hangs, also under tilted gravity",
        };
        println!("pose {rank}: {words}; its centre of mass sinks by {:.1} mm", verdict.figures.sank * 1000.0);
        let poses = (release, verdict.figures.rest);
        best.get_or_insert(poses);
        if verdict.success() {
            best = Some(poses);
            break;
        }
    }
    let picture = || arguments.picture.display().to_string();
    let planned =
        (1..).zip(&prediction.poses).find_map(|(rank, predicted)| Some((rank, predicted.path.as_ref()?)));
    if let Some((rank, planned)) = planned {
        let waypoints: Vec<Waypoint> = planned.waypoints.iter().map(Waypoint::from).collect();
        let last = waypoints
            .last()
            .with_context(|| format!("{}: the path to pose {rank} has no waypoints", at()))?;
        let path =
            Path { object: &waypoints, release: planned.release, gripper: &[], clearance: planned.clearance };
        let centre = scene.centre_of_mass();
        let replayed = replay(&scene, &path, None, centre);
        println!(
            "path to pose {rank}: {} waypoints, {:.1} s, clearance {:.1} mm; \
             deepest penetration in the replay {:.2} mm: {}",
            waypoints.len(),
            last.seconds,
            path.clearance * 1000.0,
            replayed.depth() * 1000.0,
            if replayed.passes() { "passes" } else { "does not pass" },
        );
        let poses: Vec<Pose> = waypoints.iter().map(|waypoint| waypoint.pose).collect();
        let way = Way { poses: &poses, centre };
        let rest = replayed.verdict.figures.rest;
        gallery::write_way(&arguments.picture, &object, &supporter, &way, &rest).with_context(picture)?;
        println!("the object along the path and at rest: {}", picture());
        if let Some(film) = &arguments.film {
            // The last waypoints lower the object into contact; here the gripper lets go before.
            let mut poses = waypoints[..=planned.release.min(waypoints.len() - 1)].to_vec();
            poses.extend(released(&scene, &poses[poses.len() - 1]));
            film::write(film, &object, &supporter, &poses, centre)
                .with_context(|| film.display().to_string())?;
            println!("moving picture: {}", film.display());
        }
        ensure!(replayed.passes(), "the path to pose {rank} does not pass the replay");
    } else if let Some((release, rest)) = best {
        gallery::write(&arguments.picture, &object, &supporter, &release, &rest).with_context(picture)?;
        println!("at release and at rest: {}", picture());
    }
    Ok(())
}
