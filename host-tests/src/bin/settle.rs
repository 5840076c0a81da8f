//! Lets random candidate poses go in the core and in Bullet and says how often both agree on what rests.

use anyhow::Result;
use clap::Parser;
use hangpose::geometry::Mesh;
use hangpose::hanging::{HangingPose, let_go, predict_bytes};
use hangpose::mechanics::Fate;
use hangpose::memory::Limits;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses, sample_supporter};
use host_tests::judge::{Bullet, Judge, Scene};
use host_tests::shapes::Random;
use host_tests::tables::case::{Case, Fit, made};
use host_tests::tables::report::wilson;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Pairs that fit, made by the shape library.
    #[arg(long, default_value_t = 250)]
    pairs: usize,
    /// Poses of each.
    #[arg(long, default_value_t = 4)]
    poses: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// What both say of a pose: whether it rests in the core and in Bullet, and whether it hangs and still swings there.
type Said = [bool; 3];

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let cases = made(arguments.pairs, arguments.seed);
    let cases: Vec<&Case> = cases.iter().filter(|case| case.fit == Fit::Yes).collect();
    let (next, said) = (AtomicUsize::new(0), Mutex::new(Vec::<Said>::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, Into::into) {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let both = judge(case, arguments.poses);
                    said.lock().expect("no thread panics").extend(both);
                }
            });
        }
    });
    let said = said.into_inner()?;
    let count = |holds: &dyn Fn(&Said) -> bool| said.iter().filter(|said| holds(said)).count();
    println!("{} poses of {} pairs", said.len(), cases.len());
    println!("agree, %: {}", wilson(count(&|[ours, bullet, _]| ours == bullet), said.len()));
    println!("both rest {}, both fall {}", count(&|s| s[0] && s[1]), count(&|s| !s[0] && !s[1]));
    println!(
        "rests in the core only {}, of these still swinging in Bullet {}",
        count(&|s| s[0] && !s[1]),
        count(&|s| s[0] && s[2])
    );
    println!("rests in Bullet only {}", count(&|s| !s[0] && s[1]));
    println!(
        "agree on whether it hangs, swinging or not, %: {}",
        wilson(count(&|[ours, bullet, swings]| *ours == (*bullet || *swings)), said.len())
    );
    Ok(())
}

fn judge(case: &Case, count: usize) -> Vec<Said> {
    let cloud_of = Mesh::new(&case.supporter.vertices, &case.supporter.triangles).expect("shapes are valid");
    let cloud = sample_supporter(&cloud_of, 10_000, case.seed);
    let params = Params::default();
    let mesh = Mesh::new(&case.object.vertices, &case.object.triangles).expect("shapes are valid");
    let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
    let monitor = Monitor::new();
    let object = analyze_object(&mesh, &params, &mut object_memory, &monitor).expect("memory is enough");
    let cloud = cloud.cloud().expect("samples are valid");
    let supporter =
        analyze_supporter(&cloud, &params, &mut supporter_memory, &monitor).expect("memory is enough");
    let mut poses = vec![HangingPose::default(); 1000];
    let candidates = Params { settle: false, ..params.clone() };
    let found =
        predict_poses(&object, &supporter, &candidates, &mut poses, &monitor).expect("params are valid");
    let limits = Limits { points: cloud.points().len(), ..Limits::NONE };
    let mut memory = vec![0; predict_bytes(&limits)];
    let mut random = Random::named(&case.name, 1);
    let scene = Scene { tilt: false, ..Scene::new(&case.object, &case.supporter) };
    let chosen = (0..count.min(found.poses.len())).map(|_| found.poses[random.pick(found.poses.len())].pose);
    chosen
        .filter_map(|pose| {
            let verdict = Bullet::default().judge(&scene, &pose);
            let ours = let_go(&object, &supporter, &pose, &params, &mut memory, &monitor);
            let ours = ours.expect("params are valid").expect("nothing stops it").fate == Fate::Rests;
            let figures = &verdict.figures;
            let swings = !verdict.holds && figures.touches && figures.fell_after.is_none();
            // What runs through the supporter is no candidate.
            verdict.clear.then_some([ours, verdict.holds, swings])
        })
        .collect()
}
