//! `hangpose plan`.

use super::json::{self, PlanDocument, PlanMemory, PlanSeconds, PlanStats};
use super::output::Output;
use super::path::{self, MAX_WAYPOINTS};
use super::source::Source;
use super::terminal::{self, say};
use super::{PlanArguments, input, pose_file, progress};
use anyhow::{Result, ensure};
use hangpose::Monitor;
use hangpose::hanging::{Object, Request, Supporter};
use hangpose::memory::Limits;
use hangpose::motion::{Plan, Task, Waypoint, plan, plan_bytes};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Exit status when there is no path.
const NO_PATH: u8 = 3;

pub(crate) fn run(arguments: &PlanArguments) -> Result<ExitCode> {
    let start = Instant::now();
    let params = arguments.method.params_for(&arguments.files.frames)?;
    ensure!(
        params.voxels > 0,
        "without a distance field nothing can be planned: pass --profile default, or voxels in the --params file"
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
        .chain(arguments.scene.file())
        .chain(arguments.motion.files())
        .chain([arguments.pose.as_path()])
        .collect();
    let prepare = |path: Option<&Path>| path.map(|path| Output::prepare(path, &inputs)).transpose();
    let (document, table) = (prepare(arguments.json.as_deref())?, prepare(arguments.motion.path())?);
    let is_text_shown =
        ![&document, &table].into_iter().any(|output| matches!(output, Some(Output::Standard)));

    let mesh = object_source.object(&arguments.files.frames)?.shape;
    let points = supporter_source.supporter(&arguments.files.frames, &arguments.cloud, params.seed)?.shape;
    let cloud = points.cloud()?;
    let scene = arguments.scene.read(&arguments.files.frames, points.origin)?;
    let goal = pose_file::hanging_pose(&arguments.pose, arguments.rank, points.origin)?;
    let way = arguments.motion.read(points.origin)?;
    let motion = way.motion()?;
    let request = Request { scene: &scene, ..Request::ANY };
    request.validate()?;
    let mut seconds = PlanSeconds { read: start.elapsed().as_secs_f64(), ..PlanSeconds::default() };

    let mesh = mesh.mesh()?;
    let limits = Limits { points: cloud.points().len(), ..Object::limits(&mesh, &params) };
    let memory = PlanMemory {
        object: Object::bytes(&limits),
        supporter: Supporter::bytes(&limits),
        plan: plan_bytes(&limits, scene.len(), motion.nodes),
    };
    let [mut for_object, mut for_supporter, mut work] =
        [memory.object, memory.supporter, memory.plan].map(|size| vec![0; size]);
    let mut waypoints = vec![Waypoint::default(); MAX_WAYPOINTS];
    let monitors = [Monitor::new(), Monitor::new(), Monitor::new()];
    let monitors = monitors.each_ref();
    let (object, supporter, found) = progress::show_while(&monitors, || -> Result<_> {
        let mut last = Instant::now();
        let mut lap = || std::mem::replace(&mut last, Instant::now()).elapsed().as_secs_f64();
        let object = Object::analyze(&mesh, &params, &mut for_object, monitors[0])?;
        seconds.object = lap();
        let supporter = Supporter::analyze(&cloud, &params, &mut for_supporter, monitors[1])?;
        seconds.supporter = lap();
        let task =
            Task { object: &object, supporter: &supporter, request: &request, params: &params, motion };
        let found = plan(&task, &goal, &mut waypoints, &mut |_| true, &mut work, monitors[2])?;
        seconds.planning = lap();
        Ok((object, supporter, found))
    })?;
    seconds.total = start.elapsed().as_secs_f64();
    input::tell_of_cloud(supporter_source.name(), &supporter, &cloud);
    write(arguments, &found, points.origin, (document, table), PlanStats::new(seconds, memory, &found))?;
    if is_text_shown {
        terminal::print(match &found.path {
            Ok(path) => path::in_words(path, &object.centre_of_mass()) + "\n",
            Err(failure) => format!("no path: {}\n", path::message(failure, points.origin)),
        })?;
    }
    Ok(if found.path.is_ok() { ExitCode::SUCCESS } else { ExitCode::from(NO_PATH) })
}

fn write(
    arguments: &PlanArguments,
    found: &Plan,
    origin: [f64; 3],
    (document, table): (Option<Output>, Option<Output>),
    stats: PlanStats,
) -> Result<()> {
    if let Some(document) = document {
        let content = PlanDocument {
            schema: json::SCHEMA,
            path: found.path.as_ref().ok().map(Into::into),
            path_failure: found.path.as_ref().err().map(|failure| path::Failure::new(failure, origin)),
            stats,
        };
        document.write(json::text_in_frame(&content, origin))?;
    }
    match (table, &found.path) {
        (Some(table), Ok(path)) => table.write(path::csv(path, origin))?,
        (Some(_), Err(_)) => {
            let file = arguments.motion.path().unwrap_or(Path::new("-"));
            say("note", format_args!("{}: was not written, because there is no path", file.display()));
        }
        (None, _) => {}
    }
    Ok(())
}
