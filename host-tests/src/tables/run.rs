//! Works through the cases on both cores, and writes each row as it comes.

use super::case::Case;
use super::row::{Outcome, Row};
use crate::judge::{Bullet, Judge, Ode, Scene};
use hangpose::geometry::Mesh;
use hangpose::hanging::{HangingPose, predict};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, sample_supporter};
use std::collections::HashSet;
use std::io::{BufRead, Write};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Poses that are dropped at most, until one succeeds.
pub const TOP: usize = 10;
/// Points that a supporter is seen as.
const POINTS: usize = 10_000;

/// Which engines judge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engines {
    /// Whether ODE judges the best pose too.
    pub ode: bool,
}

/// Predicts and judges every case under every profile on `threads`, appends the rows to `record`, and returns all
/// rows that the record then holds for these cases. Rows that are in the record already are not made again.
pub fn run(
    cases: &[Case],
    profiles: &[(String, Params)],
    engines: Engines,
    threads: usize,
    record: &Path,
    tell: impl Fn(usize, usize) + Sync,
) -> std::io::Result<Vec<Row>> {
    let mut rows = read(record)?;
    let done: HashSet<(String, String)> = rows.iter().map(|r| (r.pair.clone(), r.profile.clone())).collect();
    let file = Mutex::new(std::fs::File::options().create(true).append(true).open(record)?);
    let jobs: Vec<(&Case, &(String, Params))> = cases
        .iter()
        .flat_map(|case| profiles.iter().map(move |profile| (case, profile)))
        .filter(|(case, profile)| !done.contains(&(case.name.clone(), profile.0.clone())))
        .collect();
    let (next, finished, new) = (AtomicUsize::new(0), AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((case, (profile, params))) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let row = judge(case, profile, params, engines);
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
    rows.retain(|row| names.contains(row.pair.as_str()) && profiles.iter().any(|p| p.0 == row.profile));
    rows.sort_by(|a, b| (&a.profile, &a.pair).cmp(&(&b.profile, &b.pair)));
    Ok(rows)
}

/// The rows of a record; a last line that a kill cut short is left out.
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

/// The supporter as a camera sees it: samples of its surface without those that lie inside another of its bodies.
fn cloud_of(case: &Case) -> hangpose::files::CloudFile {
    let mesh = Mesh::new(&case.supporter.vertices, &case.supporter.triangles).expect("shapes are valid");
    sample_supporter(&mesh, POINTS, case.seed)
}

fn judge(case: &Case, profile: &str, params: &Params, engines: Engines) -> Row {
    let cloud = cloud_of(case);
    let params = Params { seed: case.seed, ..params.clone() };
    let mesh = Mesh::new(&case.object.vertices, &case.object.triangles).expect("shapes are valid");
    let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
    let monitor = Monitor::new();
    let start = Instant::now();
    let object = analyze_object(&mesh, &params, &mut object_memory, &monitor).expect("memory is enough");
    let supporter = analyze_supporter(
        &cloud.cloud().expect("samples are valid"),
        &params,
        &mut supporter_memory,
        &monitor,
    )
    .expect("memory is enough");
    let mut poses = [HangingPose::default(); TOP];
    let prediction =
        predict(&object, &supporter, &params, &mut poses, &monitor).expect("the profile is valid");
    let seconds = start.elapsed().as_secs_f64();

    let scene = Scene::new(&case.object, &case.supporter);
    let mut bullet = Vec::new();
    // A pair that cannot hang is judged by whether anything is predicted at all.
    if case.fits {
        for pose in prediction.poses {
            let outcome = Outcome::from(&Bullet::default().judge(&scene, &pose.pose));
            bullet.push(outcome);
            if outcome.success() {
                break;
            }
        }
    }
    let best = prediction.poses.first().filter(|_| engines.ode && case.fits);
    let ode = best.map(|pose| Outcome::from(&Ode::default().judge(&scene, &pose.pose)));
    Row {
        pair: case.name.clone(),
        profile: profile.into(),
        object: case.object_kind.clone(),
        supporter: case.supporter_kind.clone(),
        fits: case.fits,
        rejection: prediction.rejection.map(|rejection| format!("{:?}", rejection.stage)),
        seconds,
        bullet,
        ode,
    }
}
