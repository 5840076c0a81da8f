//! Evaluates the cases on several threads and writes each row when it is complete.

use super::case::{Case, Fit};
use super::cause::cause;
use super::loss::Loss;
use super::row::{Failure, Outcome, Row};
use super::search::finds_a_pose;
use super::seen::Seen;
use crate::gallery;
use crate::judge::{Bullet, Judge, Limits, Ode, Scene, World, freedom};
use crate::scan::Spec;
use hangpose::hanging::{HangingPose, Request};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses};
use std::collections::{HashMap, HashSet};
use std::io::{BufRead, Write};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::Instant;

/// Largest number of poses per pair that are predicted and judged.
pub const TOP: usize = 10;

/// Rejection of a pair of which the images show no surface of the object or of the supporter.
const NOTHING_SEEN: &str = "NothingSeen";

/// Engine that judges.
#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
pub enum Engine {
    /// Bullet.
    Bullet,
    /// ODE.
    Ode,
    /// Bullet, and ODE for the best pose in addition.
    Both,
}

/// Options of a run.
pub struct Options<'a> {
    /// Names and constants of the profiles.
    pub profiles: &'a [(String, Params)],
    /// Scans on which every profile predicts; `None` is the exact shapes.
    pub scans: &'a [Option<Spec>],
    /// Engine that judges.
    pub engine: Engine,
    /// Number of threads, each with one pair at a time.
    pub threads: usize,
    /// File to which rows are appended. Rows that it already has are not computed again.
    pub record: &'a Path,
    /// Whether poses after the first success are judged too.
    pub all: bool,
    /// Whether the motions that free the object tell how the best poses of generated pairs hang, as they do for real meshes.
    pub motion: bool,
    /// Folder for pictures of the best poses.
    pub gallery: Option<&'a Path>,
}

/// Predicts and judges every case under every profile on every scan. Returns all rows, including those of the record.
/// `tell` is called with the number of finished rows and the total.
pub fn run(
    cases: &[Case],
    options: &Options,
    tell: impl Fn(usize, usize) + Sync,
) -> std::io::Result<Vec<Row>> {
    let Options { profiles, scans, record, .. } = *options;
    let mut rows = read(record)?;
    let key = |r: &Row| (r.pair.clone(), r.profile.clone(), r.scan.clone());
    let done: HashSet<_> = rows.iter().map(key).collect();
    let file = Mutex::new(std::fs::File::options().create(true).append(true).open(record)?);
    // Each pair is searched only once for all profiles.
    let mut searched: HashMap<&str, OnceLock<bool>> =
        cases.iter().map(|case| (case.name.as_str(), OnceLock::new())).collect();
    for row in &rows {
        searched.insert(&row.pair, row.fits.into());
    }
    let text = |scan: &Option<Spec>| scan.as_ref().map(Spec::to_string);
    let methods: Vec<(&(String, Params), &Option<Spec>)> =
        scans.iter().flat_map(|scan| profiles.iter().map(move |profile| (profile, scan))).collect();
    let jobs: Vec<(&Case, &(String, Params), &Option<Spec>)> = cases
        .iter()
        .flat_map(|case| methods.iter().map(move |&(profile, scan)| (case, profile, scan)))
        .filter(|(case, profile, scan)| !done.contains(&(case.name.clone(), profile.0.clone(), text(scan))))
        .collect();
    let (next, finished, new) = (AtomicUsize::new(0), AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..options.threads {
            scope.spawn(|| {
                while let Some((case, (profile, params), scan)) =
                    jobs.get(next.fetch_add(1, Ordering::Relaxed))
                {
                    let fits = match case.fit {
                        Fit::Yes => true,
                        Fit::No => false,
                        Fit::Unknown => *searched[case.name.as_str()]
                            .get_or_init(|| finds_a_pose(&case.object, &case.supporter, case.seed)),
                    };
                    let doubtful = case.fit == Fit::Unknown && !fits;
                    let row = Row { fits, doubtful, ..judge(case, profile, params, scan, options) };
                    let line = serde_json::to_string(&row).expect("a row has no maps") + "\n";
                    let written = file.lock().expect("no thread panics").write_all(line.as_bytes());
                    if let Err(error) = written {
                        eprintln!("{}: {error}", record.display());
                    }
                    new.lock().expect("no thread panics").push(row);
                    tell(finished.fetch_add(1, Ordering::Relaxed) + 1, jobs.len());
                }
            });
        }
    });
    rows.extend(new.into_inner().expect("no thread panics"));
    let names: HashSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    rows.retain(|row| {
        names.contains(row.pair.as_str())
            && profiles.iter().any(|p| p.0 == row.profile)
            && scans.iter().any(|scan| text(scan) == row.scan)
    });
    rows.sort_by(|a, b| (&a.profile, &a.pair).cmp(&(&b.profile, &b.pair)));
    Ok(rows)
}

/// Reads the rows of a record and ignores a last line that an aborted run left incomplete.
fn read(record: &Path) -> std::io::Result<Vec<Row>> {
    match std::fs::File::open(record) {
        Ok(file) => Ok(std::io::BufReader::new(file)
            .lines()
            .map_while(Result::ok)
            .filter_map(|line| serde_json::from_str(&line).ok())
            .collect()),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

fn judge(case: &Case, profile: &str, params: &Params, scan: &Option<Spec>, options: &Options) -> Row {
    let seen = scan.as_ref().map_or_else(|| Seen::exactly(case), |scan| Seen::scanned(case, scan));
    let row = Row {
        pair: case.name.clone(),
        profile: profile.into(),
        scan: scan.as_ref().map(Spec::to_string),
        object: case.object_kind.clone(),
        supporter: case.supporter_kind.clone(),
        fits: case.fit == Fit::Yes,
        doubtful: false,
        meant: case.meant,
        rejection: Some(NOTHING_SEEN.into()),
        centre_error: 0.0,
        seconds: 0.0,
        outcomes: Vec::new(),
        second: None,
        loss: (scan.is_some() && case.fit != Fit::No).then_some(Loss::NotFound),
    };
    let (Ok(mesh), Ok(cloud)) = (seen.mesh(), seen.cloud()) else { return row };
    let params = Params { seed: case.seed, ..params.clone() };
    let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
    let monitor = Monitor::new();
    let start = Instant::now();
    let object = analyze_object(&mesh, &params, &mut object_memory, &monitor).expect("memory is enough");
    let supporter =
        analyze_supporter(&cloud, &params, &mut supporter_memory, &monitor).expect("memory is enough");
    let mut poses = [HangingPose::default(); TOP];
    let prediction = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor)
        .expect("the profile is valid");
    let seconds = start.elapsed().as_secs_f64();

    // For a pair that cannot hang only the rejection counts, unless all poses are judged.
    let poses = if case.fit == Fit::No && !options.all { &[] } else { prediction.poses };
    let scene = Scene::new(&case.object, &case.supporter);
    let drop = |world: &mut World, pose: &HangingPose| {
        let start = Instant::now();
        // A penetrating pose has failed, and its simulation would be slow.
        world.release(&pose.pose.cast());
        let penetration = world.penetration();
        if penetration > Limits::DEFINITION.penetration {
            return (Outcome::unclear(penetration), pose.pose);
        }
        let verdict = world.judge(&scene, &pose.pose);
        (Outcome::new(&verdict, start.elapsed().as_secs_f64()), verdict.figures.rest)
    };
    let (bullet, ode) = (Bullet::default(), Ode::default());
    let first: &dyn Judge = if options.engine == Engine::Ode { &ode } else { &bullet };
    let mut world = first.world(&scene);
    let mut outcomes: Vec<Outcome> = Vec::new();
    let mut loss = row.loss;
    for pose in poses {
        let (outcome, rest) = drop(&mut world, pose);
        let is_made = !case.bars.is_empty();
        let is_moved = outcome.holds && outcomes.is_empty() && (options.motion || !is_made);
        let outcome = Outcome {
            said: pose.rest.as_ref().map(Into::into),
            joined: (outcome.holds && is_made).then(|| case.hangs(&rest)),
            freed: if is_moved { freedom(&scene, &rest.cast()) } else { None },
            ..outcome
        };
        if let Some(folder) = options.gallery.filter(|_| outcomes.is_empty()) {
            let word = outcome.failure().map_or("success", Failure::name);
            let method = scan.map_or_else(|| profile.into(), |scan| format!("{profile} {scan}"));
            let path = folder.join(format!("{method} {word} {}.png", case.name));
            if let Err(error) = gallery::write(&path, &case.object, &case.supporter, &pose.pose, &rest) {
                eprintln!("{}: {error}", path.display());
            }
        }
        if scan.is_some() && outcomes.is_empty() {
            loss = cause(&outcome, &rest, &case.object, &case.supporter, &seen);
        }
        outcomes.push(outcome);
        if outcome.success() && !options.all {
            break;
        }
    }
    let second = poses
        .first()
        .filter(|_| options.engine == Engine::Both)
        .map(|pose| drop(&mut ode.world(&scene), pose).0);
    let rejection = prediction.rejection.map(|rejection| format!("{:?}", rejection.stage));
    let centre_error = object.centre_of_mass_error();
    Row { centre_error, rejection, seconds, outcomes, second, loss, ..row }
}
