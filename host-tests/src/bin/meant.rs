//! Measures whether the best poses are the same in turned frames, whether their tolerances hold, and whether their
//! probabilities are right. Deterministic for a seed.

use anyhow::{Context, Result};
use clap::{Parser, Subcommand};
use hangpose::geometry::{Cloud, Mesh, Point, Pose, Vector};
use hangpose::hanging::{HangingPose, Request, Rest, predict_bytes, predict_many};
use hangpose::mechanics::{Contact, Kind, Kinds};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, sample_supporter};
use host_tests::judge::{Bullet, Judge, Ode, Scene};
use host_tests::reach::tree::Tree;
use host_tests::shapes::{Bar, Joint, Random, is_daily};
use host_tests::tables::case::{Case, Fit, made};
use host_tests::tables::proportion::wilson;
use host_tests::tables::real::real;
use host_tests::tables::search::finds_a_pose;
use host_tests::{gallery, predicted};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    #[command(subcommand)]
    measure: Measure,
    /// Number of generated pairs that fit.
    #[arg(long, default_value_t = 90, global = true)]
    pairs: usize,
    /// Seed of the sizes and of all changes.
    #[arg(long, default_value_t = 31, global = true)]
    seed: u64,
    /// Number of threads.
    #[arg(long, default_value_t = std::thread::available_parallelism().map_or(1, Into::into), global = true)]
    threads: usize,
}

#[derive(Subcommand)]
enum Measure {
    /// Share of best poses that stay the same when the object and the supporter are turned.
    Turned,
    /// Share of best poses that still hang when they are let go as far off as they tolerate.
    Tolerance,
    /// Draw an example of each kind.
    Pictures {
        /// Folder for the pictures.
        #[arg(long, value_name = "DIR", default_value = "docs/kinds")]
        out: PathBuf,
    },
    /// Share of the pegs of generated mug trees that are filled when as many mugs as pegs are hung at once.
    Many,
    /// Whether poses hang as often as their probabilities say.
    Probability {
        /// Folder of real meshes with a manifest.json, which are judged as well.
        #[arg(long, value_name = "DIR")]
        meshes: Option<PathBuf>,
        /// Largest number of pairs of real meshes.
        #[arg(long, default_value_t = 53)]
        real_pairs: usize,
    },
}

/// Generated pairs that are needed for one pair that a person hangs every day.
const DAILY_IN: usize = 6;

fn main() -> Result<()> {
    let Arguments { measure, pairs, seed, threads } = Arguments::parse();
    match measure {
        Measure::Turned => {
            let mut cases = fitting(DAILY_IN * pairs, seed);
            cases.retain(|case| is_daily(&case.object_kind, &case.supporter_kind));
            cases.truncate(pairs);
            turned(&cases, threads);
        }
        Measure::Pictures { out } => pictures(&fitting(EXAMPLES, seed), &out)?,
        Measure::Many => many(pairs, seed, threads),
        Measure::Tolerance => tolerance(&fitting(pairs, seed), threads),
        Measure::Probability { meshes, real_pairs } => {
            println!("Generated pairs:\n");
            let of_made = told(&fitting(pairs, seed), threads);
            print_probability(&of_made);
            print_other_engine(&of_made);
            if let Some(folder) = meshes {
                println!("\nReal meshes:\n");
                print_probability(&told(&real(&folder, real_pairs)?, threads));
            }
        }
    }
    Ok(())
}

fn fitting(pairs: usize, seed: u64) -> Vec<Case> {
    made(pairs, seed).into_iter().filter(|case| case.fit == Fit::Yes).collect()
}

/// What `measure` gives for each of the cases, in their order.
fn each<C: Sync, T: Send>(cases: &[C], threads: usize, measure: impl Fn(&C) -> T + Sync) -> Vec<T> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { return };
                    let measured = measure(case);
                    found.lock().expect("no thread panics").push((index, measured));
                }
            });
        }
    });
    let mut found = found.into_inner().expect("no thread panics");
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, measured)| measured).collect()
}

/// The best `count` poses of a pair.
fn best(case: &Case, count: usize) -> Vec<HangingPose> {
    let cloud = case.supporter_cloud();
    let cloud = cloud.cloud().expect("samples are valid");
    predicted(&case.object.mesh(), &cloud, &Request::ANY, &params(case), count)
}

fn params(case: &Case) -> Params {
    Params { seed: case.seed, ..Params::default() }
}

/// Largest distance between the main contacts of two poses at the same place, m.
const SAME_PLACE: f32 = 0.02;
/// Largest difference in radius and length, m, and tilt, rad, of two bars of the same size.
const ALIKE: f32 = 1e-4;
/// Largest coordinate by which a supporter is moved, m.
const MOVED: f64 = 0.3;

/// How a best pose changes in turned frames.
#[derive(Clone, Copy)]
struct Change {
    /// The kinds in the original and in the turned frame; `None` where no pose was found.
    kinds: [Option<Kind>; 2],
    /// The same by construction.
    built: [Option<Kind>; 2],
    /// Distance between the main contacts, m.
    apart: f32,
    /// Whether an opening of the same kind is joined with the same bar or with one of the same size, such as another of a
    /// tree: nothing tells those apart.
    is_same_bar: bool,
}

impl Change {
    fn is_same_kind(&self) -> bool {
        self.kinds[0] == self.kinds[1]
    }

    fn is_built_alike(&self) -> bool {
        self.built[0] == self.built[1]
    }

    fn is_same_place(&self) -> bool {
        self.apart < SAME_PLACE || self.is_same_bar
    }

    fn is_same(&self) -> bool {
        self.is_same_kind() && self.is_same_place()
    }
}

/// Prints the share of best poses that are the same when the object is turned at random and the supporter is turned about
/// the vertical and moved.
fn turned(cases: &[Case], threads: usize) {
    let changes = each(cases, threads, change);
    let found: Vec<_> =
        cases.iter().zip(&changes).filter(|(_, change)| change.kinds != [None, None]).collect();
    let share = |title: &str, holds: &dyn Fn(&Change) -> bool| {
        let count = found.iter().filter(|(_, change)| holds(change)).count();
        println!("{title}: {count} of {}, {} %", found.len(), wilson(count, found.len()));
    };
    println!("{} pairs, {} with a pose in one of the frames", cases.len(), found.len());
    share("the best pose is of the same kind", &Change::is_same_kind);
    share("of the same kind at the same place", &Change::is_same);
    share("of the same kind by construction", &Change::is_built_alike);
    share("of the same kind by construction at the same place", &|change| {
        change.is_built_alike() && change.is_same_place()
    });
    for (frame, title) in
        ["as is meant, in the original frame", "as is meant, in the turned frame"].iter().enumerate()
    {
        let count = found.iter().filter(|(case, change)| change.built[frame] == case.meant).count();
        println!("{title}: {count} of {}, {} %", found.len(), wilson(count, found.len()));
    }
    println!("\nOthers:");
    let name = |kind: Option<Kind>| kind.map_or("none", Kind::name);
    for (case, Change { kinds, built, apart, .. }) in found.iter().filter(|(_, change)| !change.is_same()) {
        println!(
            "{}: {}, turned {}; by construction {}, turned {}; {:.0} mm apart",
            case.name,
            name(kinds[0]),
            name(kinds[1]),
            name(built[0]),
            name(built[1]),
            1000.0 * apart
        );
    }
}

fn change(case: &Case) -> Change {
    let mut random = Random::named(&case.name, 2);
    let object_turn = Pose::from_parts(Translation3::identity(), random.rotation());
    let yaw = UnitQuaternion::from_axis_angle(&Vector::z_axis(), random.range(0.0, TAU) as f32);
    let moved = [0; 3].map(|_| random.range(-MOVED, MOVED) as f32);
    let supporter_turn = Pose::from_parts(Translation3::from(moved), yaw);

    let place = |pose: &Pose, points: &[[f32; 3]]| -> Vec<[f32; 3]> {
        points.iter().map(|&point| (pose * Point::from(point)).into()).collect()
    };
    let vertices = place(&object_turn, &case.object.vertices);
    let mesh = Mesh::new(&vertices, &case.object.triangles).expect("a turned mesh is valid");
    let cloud = case.supporter_cloud();
    let points = place(&supporter_turn, &cloud.points);
    let normals = cloud.normals.map(|normals| {
        normals.iter().map(|&normal| (yaw * Vector::from(normal)).into()).collect::<Vec<[f32; 3]>>()
    });
    let cloud = Cloud::new(&points, normals.as_deref()).expect("a turned cloud is valid");
    let turned = predicted(&mesh, &cloud, &Request::ANY, &params(case), 1);

    let original = best(case, 1);
    let rest = |poses: &[HangingPose]| poses.first().and_then(|pose| pose.rest);
    let rests = [rest(&original), rest(&turned)];
    let kinds = rests.map(|rest| rest.map(|rest| rest.kind));
    let [Some(original), Some(turned)] = rests else {
        return Change { kinds, built: [None; 2], apart: f32::INFINITY, is_same_bar: false };
    };
    let back = supporter_turn.inverse();
    let apart = (main_contact(&original) - back * main_contact(&turned)).norm();
    let poses = [original.pose, back * turned.pose * object_turn];
    let joints = poses.map(|pose| case.joined(&pose));
    let size = |joint: Joint| {
        let Bar { radius, length, tilt, .. } = case.bars[joint.bar];
        Vector::new(radius, length, tilt)
    };
    let alike = |a, b| (size(a) - size(b)).norm() < ALIKE;
    Change {
        kinds,
        built: poses.map(|pose| Some(case.hangs(&pose))),
        apart,
        is_same_bar: matches!(joints, [Some(a), Some(b)] if a.kind == b.kind && alike(a, b)),
    }
}

/// Position of the contact that carries most.
fn main_contact(rest: &Rest) -> Point {
    let heaviest = |a: &&Contact, b: &&Contact| a.force.total_cmp(&b.force);
    rest.contacts().iter().max_by(heaviest).map_or(Point::origin(), |contact| contact.position)
}

fn any_direction(random: &mut Random) -> Vector {
    Vector::from([0; 3].map(|_| random.gaussian() as f32)).normalize()
}

/// What becomes of a best pose that hangs when it is let go as far off as it tolerates.
struct Off {
    /// Tolerated displacement, m, and rotation, rad.
    tolerance: [f32; 2],
    /// Whether the object hangs after the one and after the other.
    hangs: [bool; 2],
}

/// Prints the share of best poses that still hang at the limit of their tolerance.
fn tolerance(cases: &[Case], threads: usize) {
    let found: Vec<(&Case, Off)> =
        cases.iter().zip(each(cases, threads, off)).filter_map(|(case, off)| Some((case, off?))).collect();
    println!("{} of {} best poses hang", found.len(), cases.len());
    for (which, name, unit, scale) in
        [(0, "displaced", "mm", 1000.0), (1, "rotated", "degrees", 180.0 / std::f32::consts::PI)]
    {
        let hang = found.iter().filter(|(_, off)| off.hangs[which]).count();
        let mut tolerated: Vec<f32> = found.iter().map(|(_, off)| scale * off.tolerance[which]).collect();
        tolerated.sort_by(f32::total_cmp);
        let at = |share: f64| {
            tolerated.get((share * tolerated.len() as f64) as usize).copied().unwrap_or_default()
        };
        println!(
            "{name} by the tolerance: {hang} of {} still hang, {} %; tolerance {:.1} {unit} in the median, {:.1} in a tenth",
            found.len(),
            wilson(hang, found.len()),
            at(0.5),
            at(0.1)
        );
    }
    println!("\nOthers:");
    for (case, Off { tolerance, hangs }) in found.iter().filter(|(_, off)| off.hangs != [true; 2]) {
        let [position, rotation] = *tolerance;
        let falls = |which: usize| if hangs[which] { "hangs" } else { "falls" };
        println!(
            "{}: {} displaced by {:.1} mm, {} rotated by {:.1} degrees",
            case.name,
            falls(0),
            1000.0 * position,
            falls(1),
            rotation.to_degrees()
        );
    }
}

fn off(case: &Case) -> Option<Off> {
    let [pose] = best(case, 1).try_into().ok()?;
    let tolerance = pose.rest?.tolerance;
    let scene = Scene { tilt: false, ..Scene::new(&case.object, &case.supporter) };
    let mut world = Bullet::default().world(&scene);
    let mut hangs = |pose: &Isometry3<f32>| world.judge(&scene, pose).success();
    if !hangs(&pose.pose) {
        return None;
    }
    let mut random = Random::named(&case.name, 3);
    let displaced = Translation3::from(any_direction(&mut random) * tolerance.position) * pose.pose;
    let centre = pose.pose * Point::from(scene.centre_of_mass());
    let turn = UnitQuaternion::new(any_direction(&mut random) * tolerance.rotation);
    let about = Translation3::from(centre.coords);
    let rotated = about * turn * about.inverse() * pose.pose;
    Some(Off {
        tolerance: [tolerance.position, tolerance.rotation],
        hangs: [hangs(&displaced), hangs(&rotated)],
    })
}

/// Number of poses per pair whose probabilities are judged.
const ALL_POSES: usize = 10;
/// Number of bins with equally many poses.
const DECILES: usize = 10;

/// A predicted pose and what became of it.
struct Told {
    /// Probability that it hangs, and that it is robust.
    said: [f32; 2],
    /// Whether it hangs, and whether it hangs robustly.
    came: [bool; 2],
    /// Whether it hangs in ODE, which judges generated pairs only.
    hangs_in_ode: bool,
}

/// The poses of pairs that fit. A pair of real meshes fits if one of its poses hangs or a random search finds one that does.
fn told(cases: &[Case], threads: usize) -> Vec<Told> {
    each(cases, threads, tell).into_iter().flatten().collect()
}

/// Share of the Brier score of the base rate that is saved by a Brier score.
fn brier_skill(brier: f64, base: f64) -> f64 {
    1.0 - brier / (base * (1.0 - base))
}

/// Prints how often poses hang and are robust, by what is said of them.
fn print_probability(told: &[Told]) {
    println!("{} poses", told.len());
    for (which, name) in [(0, "hang"), (1, "robust")] {
        println!("\n| said, % | poses | said mean, % | {name}, % |\n|---|--:|--:|--:|");
        let mut sorted: Vec<&Told> = told.iter().collect();
        sorted.sort_by(|a, b| a.said[which].total_cmp(&b.said[which]));
        for bin in sorted.chunks(told.len().div_ceil(DECILES)) {
            let percent = |told: &Told| 100.0 * told.said[which];
            let mean = bin.iter().map(|told| percent(told)).sum::<f32>() / bin.len() as f32;
            let came = bin.iter().filter(|told| told.came[which]).count();
            let (least, most) = (percent(bin[0]), percent(bin[bin.len() - 1]));
            println!("| {least:.0} to {most:.0} | {} | {mean:.0} | {} |", bin.len(), wilson(came, bin.len()));
        }
        let all = told.len() as f64;
        let base = told.iter().filter(|told| told.came[which]).count() as f64 / all;
        let error =
            |told: &Told| (f64::from(told.said[which]) - f64::from(u8::from(told.came[which]))).powi(2);
        let brier = told.iter().map(error).sum::<f64>() / all;
        println!(
            "\n{name}: base rate {:.1} %, Brier score {brier:.4}, Brier skill {:.3}, area under the ROC curve {:.3}",
            100.0 * base,
            brier_skill(brier, base),
            roc_area(told, which)
        );
    }
}

/// Prints how well the verdict of a second engine tells what becomes of a pose in the first: the skill of the best probability
/// that follows from it, which is the share that hangs of the poses with the same verdict.
fn print_other_engine(told: &[Told]) {
    let share = |of: &[&Told]| of.iter().filter(|told| told.came[0]).count() as f64 / of.len() as f64;
    let base = share(&told.iter().collect::<Vec<_>>());
    let (mut brier, mut shares) = (0.0, Vec::new());
    for hangs_in_ode in [true, false] {
        let same: Vec<&Told> = told.iter().filter(|told| told.hangs_in_ode == hangs_in_ode).collect();
        if same.is_empty() {
            continue;
        }
        let hang = share(&same);
        brier += hang * (1.0 - hang) * same.len() as f64 / told.len() as f64;
        let verdict = if hangs_in_ode { "hang" } else { "do not hang" };
        shares.push(format!("of {} that {verdict} in ODE {:.1} % hang in Bullet", same.len(), 100.0 * hang));
    }
    println!("\n{}: Brier skill {:.3}", shares.join(", "), brier_skill(brier, base));
}

/// Share of the pairs of a pose that comes true and one that does not in which the first is said to be more probable;
/// equal probabilities count half.
fn roc_area(told: &[Told], which: usize) -> f64 {
    let of = |wanted: bool| {
        told.iter().filter(move |told| told.came[which] == wanted).map(|told| told.said[which])
    };
    let wins: f64 = of(true)
        .flat_map(|yes| {
            of(false).map(move |no| if yes > no { 1.0 } else { 0.5 * f64::from(u8::from(yes == no)) })
        })
        .sum();
    wins / (of(true).count() * of(false).count()) as f64
}

fn tell(case: &Case) -> Vec<Told> {
    let scene = Scene::new(&case.object, &case.supporter);
    let mut world = Bullet::default().world(&scene);
    // As in the tables, ODE judges generated pairs alone.
    let steady = Scene { tilt: false, ..scene };
    let mut ode = (case.fit == Fit::Yes).then(|| Ode::default().world(&steady));
    let poses = best(case, ALL_POSES);
    let told: Vec<Told> = poses
        .iter()
        .filter_map(|pose| {
            let verdict = world.judge(&scene, &pose.pose);
            let hangs = verdict.success();
            Some(Told {
                said: [pose.rest?.probability, pose.rest?.robustness],
                came: [hangs, hangs && verdict.robust],
                hangs_in_ode: ode.as_mut().is_some_and(|ode| ode.judge(&steady, &pose.pose).success()),
            })
        })
        .collect();
    let fits = case.fit == Fit::Yes
        || case.fit == Fit::Unknown
            && (told.iter().any(|told| told.came[0])
                || finds_a_pose(&case.object, &case.supporter, case.seed));
    if fits { told } else { Vec::new() }
}

/// Generated pairs among which examples of the kinds are looked for.
const EXAMPLES: usize = 400;

/// Draws the most probable pose of each kind of an object that shows it well, at release and at rest.
fn pictures(cases: &[Case], folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    let examples = [
        (Kind::Threaded, "mug", "mug tree"),
        (Kind::Hooked, "clothes hanger", "rod"),
        (Kind::Capped, "cap", "mug tree"),
        (Kind::Balanced, "picture frame", "peg"),
    ];
    for (kind, object, supporter) in examples {
        let is_wanted = |case: &&Case| case.object_kind == object && case.supporter_kind == supporter;
        let request = Request { allow: Kinds::of(&[kind]), ..Request::ANY };
        let found = cases.iter().filter(is_wanted).find_map(|case| {
            let cloud = case.supporter_cloud();
            let cloud = cloud.cloud().expect("samples are valid");
            let poses = predicted(&case.object.mesh(), &cloud, &request, &params(case), ALL_POSES);
            let mut rests = poses.iter().filter_map(|pose| Some((case, pose.pose, pose.rest?.pose)));
            rests.find(|(case, _, rest)| case.hangs(rest) == kind)
        });
        let (case, release, rest) =
            found.with_context(|| format!("no {object} is {kind} on a {supporter}"))?;
        let path = folder.join(format!("{kind}.png"));
        gallery::write(&path, &case.object, &case.supporter, &release, &rest)?;
        println!("{}: {}", path.display(), case.name);
    }
    Ok(())
}

/// Number of points that a tree is sampled to.
const TREE_POINTS: usize = 10_000;

/// What became of the mugs of one tree.
struct Filled {
    pegs: usize,
    /// Mugs that have a pose.
    placed: usize,
    /// Of them, those that hang in Bullet beside the others, which are fixed at rest.
    hang: usize,
    seconds: f64,
}

/// Prints the share of the pegs of mug trees that are filled: the mugs are of different shapes, each hangs by its handle
/// alone, and none is larger than the distance between neighbouring pegs.
fn many(trees: usize, seed: u64, threads: usize) {
    let seeds: Vec<u64> = (0..trees as u64).map(|k| seed.wrapping_mul(10_007).wrapping_add(k)).collect();
    let filled = each(&seeds, threads, |seed| fill(*seed));
    let sum = |count: fn(&Filled) -> usize| filled.iter().map(count).sum::<usize>();
    let (pegs, placed, hang) = (sum(|f| f.pegs), sum(|f| f.placed), sum(|f| f.hang));
    println!("{trees} trees with {pegs} pegs");
    println!("mugs with a pose: {placed}, {} % of the pegs", wilson(placed, pegs));
    println!("that hang beside the others: {hang}, {} % of the pegs", wilson(hang, pegs));
    let seconds: f64 = filled.iter().map(|filled| filled.seconds).sum();
    println!("{:.2} s a tree for the poses, on one thread", seconds / trees as f64);
}

fn fill(seed: u64) -> Filled {
    let Tree { tree, mugs, .. } = Tree::new(seed);
    let pegs = tree.bars.len();
    let params = Params { seed, ..Params::default() };
    let cloud = sample_supporter(&tree.solid.mesh(), TREE_POINTS, seed);
    let (monitor, mut memory) = (Monitor::new(), Vec::new());
    let supporter =
        analyze_supporter(&cloud.cloud().expect("samples are valid"), &params, &mut memory, &monitor)
            .expect("the memory is enough");
    let mut memories: Vec<Vec<u8>> = mugs.iter().map(|_| Vec::new()).collect();
    let objects: Vec<_> = mugs
        .iter()
        .zip(&mut memories)
        .map(|(mug, memory)| {
            analyze_object(&mug.solid.mesh(), &params, memory, &monitor).expect("the memory is enough")
        })
        .collect();
    let objects: Vec<_> = objects.iter().collect();
    let mut poses = vec![None; pegs];
    let mut memory = vec![0; predict_bytes(&supporter.limits())];
    let start = Instant::now();
    let found = predict_many(&objects, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &monitor)
        .expect("the params are valid");
    let seconds = start.elapsed().as_secs_f64();
    let rest = |pose: &HangingPose| pose.rest.map_or(pose.pose, |rest| rest.pose);
    let hangs = |index: usize| {
        let others = mugs.iter().zip(&poses).enumerate().filter(|(other, _)| *other != index);
        let fixed = others.filter_map(|(_, (mug, pose))| Some((&mug.solid, rest(pose.as_ref()?))));
        let supporter = tree.solid.with(fixed);
        let scene = Scene { tilt: false, ..Scene::new(&mugs[index].solid, &supporter) };
        let pose = poses[index].as_ref();
        pose.is_some_and(|pose| Bullet::default().world(&scene).judge(&scene, &pose.pose).success())
    };
    Filled { pegs, placed: found.placed, hang: (0..pegs).filter(|index| hangs(*index)).count(), seconds }
}
