//! Releases random candidate poses in the core, in Bullet and in ODE, and prints how often they agree on which come to
//! rest.

use anyhow::Result;
use clap::Parser;
use hangpose::hanging::{HangingPose, Request, let_go, predict_bytes};
use hangpose::mechanics::Fate;
use hangpose::memory::Limits;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses};
use host_tests::judge::{Bullet, Judge, Ode, Scene};
use host_tests::shapes::Random;
use host_tests::tables::case::{Case, Fit, made};
use host_tests::tables::proportion::wilson;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Number of generated pairs that fit.
    #[arg(long, default_value_t = 250)]
    pairs: usize,
    /// Number of poses per pair.
    #[arg(long, default_value_t = 4)]
    poses: usize,
    /// Seed of the sizes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Outcomes of a pose.
#[derive(Clone, Copy)]
struct Said {
    /// Whether the object comes to rest in the core.
    core: bool,
    /// Whether the object holds in Bullet.
    bullet: bool,
    /// Whether the object holds in ODE.
    ode: bool,
    /// Whether the object touches the supporter at the end in Bullet, but still swings.
    swings: bool,
}

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
    let share = |title: &str, agree: &dyn Fn(&Said) -> bool, of: usize| {
        println!("{title}: {} of {of}, {} %", count(agree), wilson(count(agree), of));
    };
    println!("{} poses of {} pairs", said.len(), cases.len());
    let all = said.len();
    share("the core and Bullet agree", &|s| s.core == s.bullet, all);
    println!(
        "rest in both {}, fall in both {}",
        count(&|s| s.core && s.bullet),
        count(&|s| !s.core && !s.bullet)
    );
    println!(
        "rest in the core only {}, of which {} still swing in Bullet",
        count(&|s| s.core && !s.bullet),
        count(&|s| s.core && s.swings)
    );
    println!("rest in Bullet only {}", count(&|s| !s.core && s.bullet));
    let hangs = |s: &Said| s.core == (s.bullet || s.swings);
    share("the core and Bullet agree if swinging counts as rest", &hangs, all);
    share("ODE and Bullet agree", &|s| s.ode == s.bullet, all);
    share("the core and ODE agree", &|s| s.core == s.ode, all);
    let engines_agree = count(&|s| s.ode == s.bullet);
    share(
        "the core agrees with both engines where these agree",
        &|s| s.ode == s.bullet && s.core == s.ode,
        engines_agree,
    );
    Ok(())
}

fn judge(case: &Case, count: usize) -> Vec<Said> {
    let cloud = case.supporter_cloud();
    let params = Params::default();
    let mesh = case.object.mesh();
    let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
    let monitor = Monitor::new();
    let object = analyze_object(&mesh, &params, &mut object_memory, &monitor).expect("memory is enough");
    let cloud = cloud.cloud().expect("samples are valid");
    let supporter =
        analyze_supporter(&cloud, &params, &mut supporter_memory, &monitor).expect("memory is enough");
    let mut poses = vec![HangingPose::default(); 1000];
    let candidates = Params { settle: false, ..params.clone() };
    let found = predict_poses(&object, &supporter, &Request::ANY, &candidates, &mut poses, &monitor)
        .expect("params are valid");
    let limits = Limits::of_points(cloud.points().len());
    let mut memory = vec![0; predict_bytes(&limits)];
    let mut random = Random::named(&case.name, 1);
    let scene = Scene { tilt: false, ..Scene::new(&case.object, &case.supporter) };
    let chosen = (0..count.min(found.poses.len())).map(|_| found.poses[random.pick(found.poses.len())].pose);
    chosen
        .filter_map(|pose| {
            let verdict = Bullet::default().judge(&scene, &pose);
            // A penetrating pose is not a candidate.
            if !verdict.clear {
                return None;
            }
            let ours = let_go(&object, &supporter, &pose, &params, &mut memory, &monitor);
            let ours = ours.expect("params are valid").expect("nothing cancels it");
            let figures = &verdict.figures;
            Some(Said {
                core: ours.fate == Fate::Rests,
                bullet: verdict.holds,
                ode: Ode::default().judge(&scene, &pose).holds,
                swings: !verdict.holds && figures.touches && figures.fell_after.is_none(),
            })
        })
        .collect()
}
