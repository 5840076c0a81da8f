//! Simulates the release of an object at its predicted poses in Bullet, prints the verdicts, and draws a picture.

use anyhow::{Context, Result, ensure};
use clap::Parser;
use hangpose::files::read_mesh;
use hangpose::geometry::Pose;
use host_tests::gallery;
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
    /// File for the picture of the first pose that hangs, or of the best pose if none does.
    #[arg(long, value_name = "PNG")]
    picture: PathBuf,
}

#[derive(Deserialize)]
struct Prediction {
    poses: Vec<PredictedPose>,
}

#[derive(Deserialize)]
struct PredictedPose {
    position: [f32; 3],
    quaternion_xyzw: [f32; 4],
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
        let rotation = UnitQuaternion::from_quaternion(Quaternion::from(predicted.quaternion_xyzw));
        let release = Pose::from_parts(Translation3::from(predicted.position), rotation);
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
    if let Some((release, rest)) = best {
        gallery::write(&arguments.picture, &object, &supporter, &release, &rest)
            .with_context(|| arguments.picture.display().to_string())?;
        println!("at release and at rest: {}", arguments.picture.display());
    }
    Ok(())
}
