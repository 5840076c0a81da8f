//! `hangpose predict`.

use super::input;
use super::inspect::closedness;
use super::json::{self, MemoryBytes, PerPart, Pose, Reason, Seconds, Stats};
use super::motion::Way;
use super::output::Output;
use super::path::{self, MAX_WAYPOINTS};
use super::planned::Planned;
use super::shown::{Background, Outcome};
use super::source::Source;
use super::terminal::{self, say};
use super::{PredictArguments, progress};
use anyhow::{Result, ensure};
use hangpose::geometry::{Aabb, Cloud, Mesh, Point};
use hangpose::hanging::sites::{Cost, SiteMatch};
use hangpose::hanging::{
    self, HangingPose, Object, Prediction, Rejection, Request, Rest, Stage, Supporter, Watch, predict,
    predict_bytes, predict_many,
};
use hangpose::mechanics::Unseen;
use hangpose::memory::Limits;
use hangpose::motion::{Task, Waypoint, predict_reachable, reachable_bytes};
use hangpose::{Monitor, Params, ScopedThreads};
use std::path::Path;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Exit status when nothing hangs.
const REJECTED: u8 = 3;

pub(crate) fn run(arguments: &PredictArguments) -> Result<ExitCode> {
    let start = Instant::now();
    // The cheapest checks come first, so that a mistake is reported at once: constants, output file, object, supporter.
    let frames = &arguments.files.frames;
    let params = arguments.method.params_for(frames)?;
    arguments.request.check(&params)?;
    if arguments.plan {
        ensure!(
            params.voxels > 0,
            "--plan: without a distance field nothing can be planned; pass --profile default, or voxels in the --params file"
        );
    } else {
        arguments.motion.check_unused()?;
    }
    let result = &arguments.result;
    let count = result.count as usize;
    ensure!(
        params.settle || count == 1,
        "--count: without their release nothing keeps the copies apart; pass --profile default, or settle = true in the --params file"
    );
    let (object_source, supporter_source) = (
        Source::of_object(&arguments.files, &arguments.recording)?,
        Source::of_supporter(&arguments.files, &arguments.recording)?,
    );
    let inputs: Vec<&Path> = object_source
        .files()
        .into_iter()
        .chain(supporter_source.files())
        .chain(arguments.method.params.as_deref())
        .chain(arguments.request.file())
        .chain(arguments.motion.files())
        .collect();
    let prepare = |path: Option<&Path>| path.map(|path| Output::prepare(path, &inputs)).transpose();
    let (output, path_output) = (prepare(result.json.as_deref())?, prepare(arguments.motion.path())?);
    let shown = result.shown.prepare(&inputs)?;
    let is_standard = |output: &Option<Output>| matches!(output, Some(Output::Standard));
    let is_table_shown = !is_standard(&output) && !is_standard(&path_output) && !shown.uses_standard_output();

    let mesh = object_source.object(frames)?.shape;
    let points = supporter_source.supporter(frames, &arguments.cloud, params.seed)?.shape;
    let cloud = input::seen(&points, &arguments.cloud)?;
    let wishes = arguments.request.read(frames, points.origin)?;
    let released = Mutex::new(Vec::new());
    let watch = |pose: &_, fate| released.lock().unwrap_or_else(PoisonError::into_inner).push((*pose, fate));
    let request = &Request { watch: result.shown.has_page().then_some(Watch(&watch)), ..wishes.request()? };
    let way = arguments.plan.then(|| arguments.motion.read(points.origin)).transpose()?;
    let motion = way.as_ref().map(Way::motion).transpose()?;
    let (cloud, params) = (&cloud, &params);
    let mut seconds = Seconds { read: start.elapsed().as_secs_f64(), ..Seconds::default() };

    let mesh = &mesh.mesh()?;
    let limits = Limits { points: cloud.points().len(), ..Object::limits(mesh, params) };
    let memory_bytes = MemoryBytes {
        object: Object::bytes(&limits),
        supporter: Supporter::bytes(&limits),
        prediction: match &motion {
            Some(motion) => reachable_bytes(&limits, request.scene.len(), motion.nodes),
            None => predict_bytes(&limits),
        },
    };
    let prediction_memory = &mut vec![0; memory_bytes.prediction];
    let object_memory = &mut vec![0; memory_bytes.object];
    let supporter_memory = &mut vec![0; memory_bytes.supporter];
    let monitor = || match result.threads {
        ..=1 => Monitor::new(),
        2.. => Monitor::new().with_threads(&ScopedThreads),
    };
    let monitors = [monitor(), monitor(), monitor()];
    let monitors = monitors.each_ref();
    let (object, supporter, found) = progress::show_while(&monitors, || -> Result<_> {
        let analyse_object = || timed(move || Object::analyze(mesh, params, object_memory, monitors[0]));
        let analyse_supporter =
            || timed(move || Supporter::analyze(cloud, params, supporter_memory, monitors[1]));
        let (object, supporter) = if result.threads > 1 {
            std::thread::scope(|scope| {
                let object = scope.spawn(analyse_object);
                let supporter = analyse_supporter();
                (object.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), supporter)
            })
        } else {
            (analyse_object(), analyse_supporter())
        };
        let (object, supporter) = ((object.0?, object.1), (supporter.0?, supporter.1));
        let (found, matching) = timed(|| {
            let models = (&object.0, &supporter.0);
            if let Some(motion) = motion {
                let task = Task { object: models.0, supporter: models.1, request, params, motion };
                Found::reachable(&task, result.top as usize, prediction_memory, monitors[2])
            } else if count > 1 {
                Found::of_copies(models, count, request, params, prediction_memory, monitors[2])
            } else {
                Found::of_one(models, result.top as usize, request, params, prediction_memory, monitors[2])
            }
        });
        (seconds.object, seconds.supporter, seconds.matching) = (object.1, supporter.1, matching);
        Ok((object.0, supporter.0, found?))
    })?;
    seconds.total = start.elapsed().as_secs_f64();

    input::tell_of_cloud(supporter_source.name(), &supporter, cloud);
    if let Some(warning) = warning_of_centre_of_mass(mesh, frames.com) {
        say("warning", format_args!("{}: {warning}", object_source.name().display()));
    }
    let mut text = table(&found, count, (mesh, cloud), &object, &supporter);
    let planned = found.planned.as_ref();
    if let Some(planned) = planned {
        text += &planned.table(&object.centre_of_mass(), points.origin);
    }
    if let Some(path_output) = path_output {
        match planned.and_then(Planned::path) {
            Some(path) => path_output.write(path::csv(&path, points.origin))?,
            None => say("note", "--path: no file was written, because there is no path"),
        }
    }
    if output.is_some() || !shown.is_empty() {
        let document = json::Prediction {
            schema: json::SCHEMA,
            count,
            poses: (1..)
                .zip(&found.poses)
                .map(|(rank, pose)| {
                    let pose = Pose::new(rank, pose, &object, &supporter);
                    match planned {
                        Some(planned) => planned.add_to(pose, rank - 1, points.origin),
                        None => pose,
                    }
                })
                .collect(),
            symmetries: json::symmetries(&object),
            rejection: found.rejection.as_ref().map(Reason::from),
            stats: Stats {
                seconds,
                memory_bytes,
                sites: PerPart { object: object.sites().len(), supporter: supporter.sites().len() },
                contacts: PerPart { object: object.contacts().len(), supporter: supporter.contacts().len() },
                counts: found.counts.as_ref().map(Into::into),
            },
            params,
        };
        if !shown.is_empty() {
            let background = Background {
                names: [object_source.name(), supporter_source.name()],
                shapes: (mesh, cloud),
                models: (&object, &supporter),
                request,
                params,
                gripper: motion.and_then(|motion| motion.gripper),
            };
            let released = released.lock().unwrap_or_else(PoisonError::into_inner);
            let outcome = Outcome {
                released: &released,
                counts: found.counts.as_ref(),
                rejection: found.rejection.as_ref(),
            };
            shown.write(&background, &found.poses, json::values(&document.poses), &outcome)?;
        }
        if let Some(output) = output {
            output.write(json::text_in_frame(&document, points.origin))?;
        }
    }
    if is_table_shown {
        terminal::print(&text)?;
    }
    let is_hung = !found.poses.is_empty() && planned.is_none_or(|planned| planned.path().is_some());
    Ok(if is_hung { ExitCode::SUCCESS } else { ExitCode::from(REJECTED) })
}

/// What was found for one object, or for several copies of it at once.
struct Found {
    /// The poses of one object, best first, or of the copies in order.
    poses: Vec<HangingPose>,
    /// Why there are no poses, or not one for each copy.
    rejection: Option<Rejection>,
    /// How much was left after each step of the prediction; `None` for copies, which take several predictions.
    counts: Option<hanging::Counts>,
    /// Which of the poses can be reached, if that was asked for.
    planned: Option<Planned>,
}

impl Found {
    /// Up to `top` poses of one object, and a path to the best that has one.
    fn reachable(task: &Task, top: usize, memory: &mut [u8], monitor: &Monitor) -> Result<Self> {
        let mut poses = vec![HangingPose::default(); top];
        let (mut failures, mut waypoints) = (vec![None; top], vec![Waypoint::default(); MAX_WAYPOINTS]);
        let anywhere = &mut |_: &_| true;
        let found =
            predict_reachable(task, &mut poses, &mut failures, &mut waypoints, anywhere, memory, monitor)?;
        let Prediction { rejection, counts, poses: best, .. } = found.prediction;
        let left = best.len();
        let planned = Planned::new(failures, &found);
        poses.truncate(left);
        Ok(Self { poses, rejection, counts: Some(counts), planned: Some(planned) })
    }

    /// Up to `top` poses of one object.
    fn of_one(
        (object, supporter): (&Object, &Supporter),
        top: usize,
        request: &Request,
        params: &Params,
        memory: &mut [u8],
        monitor: &Monitor,
    ) -> Result<Self> {
        let mut poses = vec![HangingPose::default(); top];
        let found = predict(object, supporter, request, params, &mut poses, memory, monitor)?;
        let (rejection, counts, left) = (found.rejection, Some(found.counts), found.poses.len());
        poses.truncate(left);
        Ok(Self { poses, rejection, counts, planned: None })
    }

    /// One pose for each of `count` copies. If there is no room for one, there is none for those after it.
    fn of_copies<'o>(
        (object, supporter): (&'o Object<'o>, &Supporter),
        count: usize,
        request: &Request<'o>,
        params: &Params,
        memory: &mut [u8],
        monitor: &Monitor,
    ) -> Result<Self> {
        let mut poses = vec![None; count];
        let copies = vec![object; count];
        let found = predict_many(&copies, supporter, request, params, &mut poses, memory, monitor)?;
        Ok(Self {
            poses: poses.into_iter().flatten().collect(),
            rejection: found.rejection,
            counts: None,
            planned: None,
        })
    }
}

/// The result of `work` and its duration in seconds.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

/// A warning of a centre of mass outside the object's bounding box, which is in another unit or another frame.
pub(super) fn warning_of_centre_of_mass(mesh: &Mesh, com: Option<[f64; 3]>) -> Option<&'static str> {
    let (com, aabb) = (com?, mesh.aabb());
    let (offset, half) = (Point::from(com.map(|x| x as f32)) - aabb.centre(), aabb.extents() / 2.0);
    (0..3).any(|i| offset[i].abs() > half[i]).then_some(
        "--com is outside the object's bounding box; give metres in the object frame, after scale and up axis",
    )
}

/// The poses as a table, or the reason why there are none, or none for the last of `count` copies.
fn table(
    found: &Found,
    count: usize,
    (mesh, cloud): (&Mesh, &Cloud),
    object: &Object,
    supporter: &Supporter,
) -> String {
    let size = |aabb: &Aabb| {
        let [x, y, z] = <[f32; 3]>::from(aabb.extents()).map(|x| 1000.0 * x);
        format!("{x:.0} x {y:.0} x {z:.0} mm")
    };
    let mut text = format!(
        "object: {} triangles, {}, {}, {}; supporter: {} points, {}, {}\n",
        mesh.triangles().len(),
        closedness(object.mass()),
        size(&mesh.aabb()),
        candidates(object.sites().len(), "hanging sites", object.contacts().len()),
        cloud.points().len(),
        size(&supporter.aabb()),
        candidates(supporter.sites().len(), "support sites", supporter.contacts().len()),
    );
    if let (Some(rejection), []) = (&found.rejection, &found.poses[..]) {
        text += &format!("nothing hangs: {}\n", rejection.stage);
        if rejection.stage == Stage::NoSupport {
            text += "is up z in the supporter's frame? If not, pass --supporter-up or --gravity\n";
        }
        return text;
    }
    let point = |p: &Point| {
        let [x, y, z] = [p.x, p.y, p.z].map(|x| 1000.0 * x);
        format!("{x:8.1} {y:7.1} {z:7.1}")
    };
    let best = found.poses.first();
    if best.is_some_and(|pose| pose.matched.is_some()) {
        text += "rank    total  collision  boundary  contact area         support site, mm         hanging site, mm\n";
    }
    for (rank, pose) in (1..).zip(&found.poses) {
        if let Some(SiteMatch { cost, object_site, support_site, .. }) = &pose.matched {
            let Cost { collision, boundary, contact_area, total } = cost;
            let on = supporter
                .sites()
                .nth(*support_site as usize)
                .map_or_else(Point::origin, |site| site.position);
            let with =
                object.sites().nth(*object_site as usize).map_or_else(Point::origin, |site| site.position);
            let (on, with) = (point(&on), point(&with));
            text += &format!(
                "{rank:4} {total:8.3} {collision:10} {boundary:9.3} {contact_area:13.3} {on} {with}\n"
            );
        }
        if let Some(rest) = &pose.rest {
            text += &format!("{rank:4}  {}\n", in_words(rest));
        } else if pose.matched.is_none() {
            text +=
                &format!("{rank:4}  object origin at{} mm\n", point(&pose.pose.translation.vector.into()));
        }
    }
    if count > 1
        && let Some(rejection) = &found.rejection
    {
        for copy in found.poses.len() + 1..=count {
            text += &format!("{copy:4}  no room beside the others: {}\n", rejection.stage);
        }
    }
    text
}

/// Counts the sites of the published method, or else the contact candidates.
fn candidates(sites: usize, name: &str, contacts: usize) -> String {
    if sites > 0 { format!("{sites} {name}") } else { format!("{contacts} contact candidates") }
}

/// Shares that no camera has seen from which another view would say more.
const MUCH_UNSEEN: f32 = 0.1;

/// What another view would show that was guessed, if it is much.
fn view_that_would_help(unseen: &Unseen) -> Option<String> {
    let from = |[x, y, z]: [f32; 3]| format!("from the direction ({x:.1}, {y:.1}, {z:.1}) of its frame");
    if unseen.shadow > MUCH_UNSEEN {
        let from = from(unseen.object_view);
        Some(format!("; a view of the object {from} would show whether it has room there for the supporter"))
    } else if unseen.supporter > MUCH_UNSEEN {
        let from = from(unseen.supporter_view);
        Some(format!("; a view of the supporter {from} would show its far side, which was guessed"))
    } else {
        None
    }
}

/// How firmly an object hangs, in words.
fn in_words(rest: &Rest) -> String {
    let margin = &rest.margin;
    let tilt = margin.least_tilt().to_degrees();
    let at_least =
        if margin.least_tilt() >= hangpose::mechanics::Margin::MOST_TILT { "at least " } else { "" };
    let at = rest.contacts().iter().max_by(|a, b| a.force.total_cmp(&b.force)).map_or(String::new(), |c| {
        let [x, y, z] = [c.position.x, c.position.y, c.position.z].map(|x| 1000.0 * x);
        format!(", main contact at ({x:.0}, {y:.0}, {z:.0}) mm")
    });
    let guess = view_that_would_help(&rest.unseen).unwrap_or_default();
    format!(
        "{}: hangs with probability {:.1} %, tolerates a tilt of {at_least}{tilt:.0} degrees or a knock of {:.1} m/s, sinks {:.1} mm after release{at}{guess}",
        rest.kind,
        100.0 * rest.probability,
        margin.knock_speed,
        1000.0 * rest.sinking,
    )
}
