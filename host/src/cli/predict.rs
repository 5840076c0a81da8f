//! `hangpose predict`.

use super::input::{self, Placement};
use super::inspect::closedness;
use super::json::{self, MemoryBytes, PerPart, Pose, Prediction, Reason, Seconds, Stats};
use super::output::Output;
use super::terminal::{self, say};
use super::{PredictArguments, progress};
use anyhow::{Context, Result};
use hangpose::files;
use hangpose::geometry::{Aabb, Cloud, Mesh, Point};
use hangpose::hanging::sites::{Cost, SiteMatch};
use hangpose::hanging::{self, HangingPose, Object, Rest, Stage, Supporter, predict, predict_bytes};
use hangpose::mechanics::Unseen;
use hangpose::memory::Limits;
use hangpose::{CentreOfMass, Monitor};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Exit status when nothing hangs.
const REJECTED: u8 = 3;

pub(crate) fn run(arguments: &PredictArguments) -> Result<ExitCode> {
    let start = Instant::now();
    // The cheapest checks come first, so that a mistake is reported at once: constants, output file, object, supporter.
    let mut params = arguments.method.params()?;
    if let Some(com) = arguments.com {
        params.centre_of_mass = CentreOfMass::Given(com.map(|x| x as f32));
        params.validate().context("--com")?;
    }
    let inputs = [Some(&arguments.object), Some(&arguments.supporter), arguments.method.params.as_ref()];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
    let output = arguments.json.as_deref().map(|path| Output::prepare(path, &inputs)).transpose()?;
    let is_table_shown = !matches!(output, Some(Output::Standard));

    let (scale, up) = (arguments.object_scale, arguments.object_up);
    let placement = Placement { scale, up, scale_option: "--object-scale" };
    let file = files::read_mesh(&arguments.object)?;
    let mesh = input::object(&arguments.object, file, &placement)?.shape;
    let (scale, up) = (arguments.supporter_scale, arguments.supporter_up);
    let placement = Placement { scale, up, scale_option: "--supporter-scale" };
    let file = files::read_supporter(&arguments.supporter)?;
    let points =
        input::supporter(&arguments.supporter, file, &placement, &arguments.cloud, params.seed)?.shape;
    let cloud = input::seen(&points, &arguments.cloud)?;
    let (cloud, params) = (&cloud, &params);
    let mut seconds = Seconds { read: start.elapsed().as_secs_f64(), ..Seconds::default() };

    let mesh = &mesh.mesh()?;
    let limits = Limits { points: cloud.points().len(), ..Object::limits(mesh, params) };
    let memory_bytes = MemoryBytes {
        object: Object::bytes(&limits),
        supporter: Supporter::bytes(&limits),
        prediction: predict_bytes(&limits),
    };
    let prediction_memory = &mut vec![0; memory_bytes.prediction];
    let object_memory = &mut vec![0; memory_bytes.object];
    let supporter_memory = &mut vec![0; memory_bytes.supporter];
    let mut poses = vec![HangingPose::default(); arguments.top as usize];
    let monitors = [Monitor::new(), Monitor::new(), Monitor::new()];
    let monitors = monitors.each_ref();
    let (object, supporter, prediction) = progress::show_while(&monitors, || -> Result<_> {
        let analyse_object = || timed(move || Object::analyze(mesh, params, object_memory, monitors[0]));
        let analyse_supporter =
            || timed(move || Supporter::analyze(cloud, params, supporter_memory, monitors[1]));
        let (object, supporter) = if arguments.threads > 1 {
            std::thread::scope(|scope| {
                let object = scope.spawn(analyse_object);
                let supporter = analyse_supporter();
                (object.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), supporter)
            })
        } else {
            (analyse_object(), analyse_supporter())
        };
        let (object, supporter) = ((object.0?, object.1), (supporter.0?, supporter.1));
        let (prediction, matching) =
            timed(|| predict(&object.0, &supporter.0, params, &mut poses, prediction_memory, monitors[2]));
        (seconds.object, seconds.supporter, seconds.matching) = (object.1, supporter.1, matching);
        Ok((object.0, supporter.0, prediction?))
    })?;
    seconds.total = start.elapsed().as_secs_f64();

    input::tell_of_cloud(&arguments.supporter, &supporter, cloud);
    warn_of_centre_of_mass(mesh, arguments);
    let text = table(&prediction, (mesh, cloud), &object, &supporter);
    if let Some(output) = output {
        let document = Prediction {
            schema: json::SCHEMA,
            poses: (1..)
                .zip(prediction.poses)
                .map(|(rank, pose)| {
                    Pose::new(rank, pose, object.places().sites(), supporter.places().sites())
                })
                .collect(),
            rejection: prediction.rejection.as_ref().map(Reason::from),
            stats: Stats {
                seconds,
                memory_bytes,
                sites: PerPart {
                    object: object.places().sites().len(),
                    supporter: supporter.places().sites().len(),
                },
                contacts: PerPart {
                    object: object.places().contacts().len(),
                    supporter: supporter.places().contacts().len(),
                },
                counts: (&prediction.counts).into(),
            },
            params,
        };
        output.write(json::text_in_frame(&document, points.origin))?;
    }
    if is_table_shown {
        terminal::print(&text)?;
    }
    Ok(if prediction.rejection.is_some() { ExitCode::from(REJECTED) } else { ExitCode::SUCCESS })
}

/// The result of `work` and its duration in seconds.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

/// Warns of a centre of mass outside the object's bounding box, which is in another unit or another frame.
fn warn_of_centre_of_mass(mesh: &Mesh, arguments: &PredictArguments) {
    let (Some(com), aabb) = (arguments.com, mesh.aabb()) else { return };
    let (offset, half) = (Point::from(com.map(|x| x as f32)) - aabb.centre(), aabb.extents() / 2.0);
    if (0..3).any(|i| offset[i].abs() > half[i]) {
        let warning = "--com is outside the object's bounding box; give metres in the object frame, after scale and up axis";
        say("warning", format_args!("{}: {warning}", arguments.object.display()));
    }
}

/// The poses as a table, or the reason why there are none.
fn table(
    prediction: &hanging::Prediction,
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
        candidates(object.places().sites().len(), "hanging sites", object.places().contacts().len()),
        cloud.points().len(),
        size(&supporter.points().aabb()),
        candidates(supporter.places().sites().len(), "support sites", supporter.places().contacts().len()),
    );
    if let Some(rejection) = &prediction.rejection {
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
    let best = prediction.poses.first();
    if best.is_some_and(|pose| pose.matched.is_some()) {
        text += "rank    total  collision  boundary  contact area         support site, mm         hanging site, mm\n";
    }
    for (rank, pose) in (1..).zip(prediction.poses) {
        if let Some(SiteMatch { cost, object_site, support_site, .. }) = &pose.matched {
            let Cost { collision, boundary, contact_area, total } = cost;
            let on = point(&supporter.places().sites()[*support_site as usize].position);
            let with = point(&object.places().sites()[*object_site as usize].position);
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
    text
}

/// Counts the sites of the published method, or else the contact candidates.
fn candidates(sites: usize, name: &str, contacts: usize) -> String {
    if sites > 0 { format!("{sites} {name}") } else { format!("{contacts} contact candidates") }
}

/// Shares that no camera has seen from which another view would say more.
const MUCH_UNSEEN: f32 = 0.1;

/// What another view would show that was guessed, if it is much.
fn view_that_would_help(unseen: &Unseen) -> Option<&'static str> {
    if unseen.shadow > MUCH_UNSEEN {
        Some("; another view of the object would show whether it has room there for the supporter")
    } else if unseen.supporter > MUCH_UNSEEN {
        Some("; another view of the supporter would show its far side, which was guessed")
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
        "hangs with probability {:.0} %, tolerates a tilt of {at_least}{tilt:.0} degrees or a knock of {:.1} m/s, sinks {:.1} mm after release{at}{guess}",
        100.0 * rest.probability,
        margin.knock_speed,
        1000.0 * rest.sinking,
    )
}
