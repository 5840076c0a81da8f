//! `hangpose predict`.

use super::input::{self, Placement};
use super::inspect::closedness;
use super::json::{self, MemoryBytes, PerPart, Pose, Prediction, Reason, Seconds, Stats};
use super::output::Output;
use super::recording::Recording;
use super::terminal::{self, say};
use super::{CloudArguments, FileArguments, PredictArguments, progress};
use anyhow::{Context, Result, ensure};
use hangpose::files::{self, CloudFile, MeshFile, SupporterFile};
use hangpose::geometry::{Aabb, Cloud, Mesh, Point};
use hangpose::hanging::sites::{Cost, SiteMatch};
use hangpose::hanging::{
    self, HangingPose, Object, Rejection, Request, Rest, Stage, Supporter, predict, predict_bytes,
    predict_many,
};
use hangpose::mechanics::Unseen;
use hangpose::memory::Limits;
use hangpose::{CentreOfMass, Monitor, Params};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Exit status when nothing hangs.
const REJECTED: u8 = 3;

pub(crate) fn run(arguments: &PredictArguments) -> Result<ExitCode> {
    let start = Instant::now();
    // The cheapest checks come first, so that a mistake is reported at once: constants, output file, object, supporter.
    let mut params = arguments.method.params()?;
    if let Some(com) = arguments.files.com {
        params.centre_of_mass = CentreOfMass::Given(com.map(|x| x as f32));
        params.validate().context("--com")?;
    }
    arguments.request.check(&params)?;
    let result = &arguments.result;
    let count = result.count as usize;
    ensure!(
        params.settle || count == 1,
        "--count: without their release nothing keeps the copies apart; pass --profile default, or settle = true in the --params file"
    );
    let (object_source, supporter_source) = (arguments.object()?, arguments.supporter()?);
    let inputs: Vec<&Path> = object_source
        .files()
        .into_iter()
        .chain(supporter_source.files())
        .chain(arguments.method.params.as_deref())
        .chain(arguments.request.file())
        .collect();
    let output = result.json.as_deref().map(|path| Output::prepare(path, &inputs)).transpose()?;
    let is_table_shown = !matches!(output, Some(Output::Standard));

    let mesh = object_source.object(&arguments.files)?;
    let points = supporter_source.supporter(&arguments.files, &arguments.cloud, params.seed)?;
    let cloud = input::seen(&points, &arguments.cloud)?;
    let wishes = arguments.request.read(&arguments.files, &points)?;
    let request = &wishes.request()?;
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
    let monitors = [Monitor::new(), Monitor::new(), Monitor::new()];
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
            if count > 1 {
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
    warn_of_centre_of_mass(mesh, arguments.files.com, object_source.name());
    let text = table(&found, count, (mesh, cloud), &object, &supporter);
    if let Some(output) = output {
        let document = Prediction {
            schema: json::SCHEMA,
            count,
            poses: (1..)
                .zip(&found.poses)
                .map(|(rank, pose)| {
                    Pose::new(rank, pose, object.places().sites(), supporter.places().sites())
                })
                .collect(),
            symmetries: json::symmetries(&object),
            rejection: found.rejection.as_ref().map(Reason::from),
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
                counts: found.counts.as_ref().map(Into::into),
            },
            params,
        };
        output.write(json::text_in_frame(&document, points.origin))?;
    }
    if is_table_shown {
        terminal::print(&text)?;
    }
    Ok(if found.poses.is_empty() { ExitCode::from(REJECTED) } else { ExitCode::SUCCESS })
}

/// What was found for one object, or for several copies of it at once.
struct Found {
    /// The poses of one object, best first, or of the copies in order.
    poses: Vec<HangingPose>,
    /// Why there are no poses, or not one for each copy.
    rejection: Option<Rejection>,
    /// How much was left after each step of the prediction; `None` for copies, which take several predictions.
    counts: Option<hanging::Counts>,
}

impl Found {
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
        Ok(Self { poses, rejection, counts })
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
        Ok(Self { poses: poses.into_iter().flatten().collect(), rejection: found.rejection, counts: None })
    }
}

/// What an object or a supporter is read from.
enum Source<'a> {
    File(&'a Path),
    Images(Recording<'a>),
}

impl PredictArguments {
    fn object(&self) -> Result<Source<'_>> {
        Source::new(self.files.object.as_deref(), self.recording.object()?)
    }

    fn supporter(&self) -> Result<Source<'_>> {
        Source::new(self.files.supporter.as_deref(), self.recording.supporter()?)
    }
}

impl<'a> Source<'a> {
    fn new(file: Option<&'a Path>, images: Option<Recording<'a>>) -> Result<Self> {
        let images = images.map(Self::Images);
        images.or(file.map(Self::File)).context("pass a file or depth images")
    }

    /// What messages call it.
    fn name(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Images(recording) => Path::new(recording.name),
        }
    }

    /// The files that are read, as far as the options name them.
    fn files(&self) -> Vec<&Path> {
        match self {
            Self::File(path) => vec![path],
            Self::Images(recording) => recording.files().into(),
        }
    }

    /// The object in metres with z up.
    fn object(&self, arguments: &FileArguments) -> Result<MeshFile> {
        let (scale, up) = (arguments.object_scale, arguments.object_up);
        let (file, placement) = match self {
            Self::File(path) => {
                (files::read_mesh(path)?, Placement { scale, up, scale_option: Some("--object-scale") })
            }
            Self::Images(images) => (images.object()?, Placement { scale: 1.0, up, scale_option: None }),
        };
        let mut mesh = input::object(self.name(), file, &placement)?.shape;
        if !arguments.object_viewpoint.is_empty() {
            mesh.viewpoints = arguments.object_viewpoint.iter().map(|view| view.map(|x| x as f32)).collect();
            mesh.mesh().context("--object-viewpoint")?;
        }
        Ok(mesh)
    }

    /// The supporter in metres with z up.
    fn supporter(&self, arguments: &FileArguments, points: &CloudArguments, seed: u64) -> Result<CloudFile> {
        let (scale, up) = (arguments.supporter_scale, arguments.supporter_up);
        let (file, placement) = match self {
            Self::File(path) => (
                files::read_supporter(path)?,
                Placement { scale, up, scale_option: Some("--supporter-scale") },
            ),
            Self::Images(images) => {
                (SupporterFile::Cloud(images.supporter()?), Placement { scale: 1.0, up, scale_option: None })
            }
        };
        Ok(input::supporter(self.name(), file, &placement, points, seed)?.shape)
    }
}

/// The result of `work` and its duration in seconds.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

/// Warns of a centre of mass outside the object's bounding box, which is in another unit or another frame.
fn warn_of_centre_of_mass(mesh: &Mesh, com: Option<[f64; 3]>, name: &Path) {
    let (Some(com), aabb) = (com, mesh.aabb()) else { return };
    let (offset, half) = (Point::from(com.map(|x| x as f32)) - aabb.centre(), aabb.extents() / 2.0);
    if (0..3).any(|i| offset[i].abs() > half[i]) {
        let warning = "--com is outside the object's bounding box; give metres in the object frame, after scale and up axis";
        say("warning", format_args!("{}: {warning}", name.display()));
    }
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
        candidates(object.places().sites().len(), "hanging sites", object.places().contacts().len()),
        cloud.points().len(),
        size(&supporter.points().aabb()),
        candidates(supporter.places().sites().len(), "support sites", supporter.places().contacts().len()),
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
        "{}: hangs with probability {:.0} %, tolerates a tilt of {at_least}{tilt:.0} degrees or a knock of {:.1} m/s, sinks {:.1} mm after release{at}{guess}",
        rest.kind,
        100.0 * rest.probability,
        margin.knock_speed,
        1000.0 * rest.sinking,
    )
}
