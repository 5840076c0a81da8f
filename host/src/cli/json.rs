//! The JSON output. Lengths are in metres, frames have z up.

use super::counts::{Counts, ObjectCounts, SupporterCounts};
use super::path;
use hangpose::Params;
use hangpose::geometry::{self, MassProperties};
use hangpose::hanging::contacts::{ObjectContact, SupportContact};
use hangpose::hanging::sites::{Cost, HangingSite, SupportSite};
use hangpose::hanging::{HangingPose, Object, Rejection, Stage, Supporter, Tolerance};
use hangpose::mechanics::{Contact, Kind, Margin, Unseen};
use hangpose::motion::{Plan, PlanCounts};
use serde::Serialize;
use serde_json::Value;

/// Version of the schema, raised by every change that a reader of the last version could misread.
pub(super) const SCHEMA: u32 = 2;

#[derive(Serialize)]
pub(super) struct Prediction<'a> {
    pub(super) schema: u32,
    /// Number of copies of the object that shall hang at once. With more than one, each pose is for one of them.
    pub(super) count: usize,
    pub(super) poses: Vec<Pose<'a>>,
    pub(super) symmetries: Vec<Symmetry>,
    pub(super) rejection: Option<Reason>,
    pub(super) stats: Stats,
    pub(super) params: &'a Params,
}

#[derive(Serialize)]
pub(super) struct Pose<'a> {
    rank: usize,
    /// Row-major, object to supporter.
    pose: [f32; 16],
    position: [f32; 3],
    quaternion_xyzw: [f32; 4],
    /// The same as `pose`.
    release_pose: [f32; 16],
    /// Pose in which the object comes to rest; null, like the fields up to `contacts`, without simulation.
    rest_pose: Option<[f32; 16]>,
    kind: Option<Kind>,
    tolerance: Option<Tolerance>,
    sinking: Option<f32>,
    clearance: Option<f32>,
    probability: Option<f32>,
    robustness: Option<f32>,
    unseen: Option<Unseen>,
    margin: Option<Margin>,
    contacts: Option<&'a [Contact]>,
    /// Cost of the published matching; null where poses come from contact candidates.
    cost: Option<Cost>,
    object_site: Option<Site<HangingSite>>,
    supporter_site: Option<Site<SupportSite>>,
    /// Absent where no path was planned, null where none was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<Option<path::Path>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    path_failure: Option<path::Failure>,
}

/// Turns of the object after which it is the same, so that poses that differ by one are one pose.
#[derive(Serialize)]
pub(super) struct Symmetry {
    /// Direction of the axis, in the object frame.
    axis: [f32; 3],
    /// Point on the axis: the centre of mass, in the object frame.
    point: [f32; 3],
    /// Number of turns that make a full one; null for a solid of revolution, which may turn by any angle.
    fold: Option<u32>,
}

/// A site with its index among the sites of the object or the supporter.
#[derive(Serialize)]
pub(super) struct Site<T> {
    pub(super) index: usize,
    #[serde(flatten)]
    pub(super) site: T,
}

#[derive(Serialize)]
pub(super) struct Reason {
    stage: Stage,
    reason: String,
    counts: Counts,
}

#[derive(Serialize)]
pub(super) struct Stats {
    pub(super) seconds: Seconds,
    pub(super) memory_bytes: MemoryBytes,
    pub(super) sites: PerPart,
    pub(super) contacts: PerPart,
    /// Null for several copies, which take several predictions.
    pub(super) counts: Option<Counts>,
}

#[derive(Default, Serialize)]
pub(super) struct Seconds {
    pub(super) read: f64,
    pub(super) object: f64,
    pub(super) supporter: f64,
    pub(super) matching: f64,
    /// From the files to the poses; less than the sum of the stages that ran in parallel.
    pub(super) total: f64,
}

#[derive(Serialize)]
pub(super) struct PerPart {
    pub(super) object: usize,
    pub(super) supporter: usize,
}

#[derive(Serialize)]
pub(super) struct MemoryBytes {
    pub(super) object: usize,
    pub(super) supporter: usize,
    pub(super) prediction: usize,
}

/// Output of `plan`.
#[derive(Serialize)]
pub(super) struct PlanDocument {
    pub(super) schema: u32,
    pub(super) path: Option<path::Path>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) path_failure: Option<path::Failure>,
    pub(super) stats: PlanStats,
}

#[derive(Serialize)]
pub(super) struct PlanStats {
    seconds: PlanSeconds,
    memory_bytes: PlanMemory,
    /// Poses sampled.
    samples: usize,
    /// Nodes of the trees.
    nodes: usize,
    /// Poses tested for collision.
    poses: usize,
    distance_queries: u64,
}

#[derive(Default, Serialize)]
pub(super) struct PlanSeconds {
    pub(super) read: f64,
    pub(super) object: f64,
    pub(super) supporter: f64,
    pub(super) planning: f64,
    pub(super) total: f64,
}

#[derive(Serialize)]
pub(super) struct PlanMemory {
    pub(super) object: usize,
    pub(super) supporter: usize,
    pub(super) plan: usize,
}

impl PlanStats {
    pub(super) fn new(seconds: PlanSeconds, memory_bytes: PlanMemory, found: &Plan) -> Self {
        let PlanCounts { samples, nodes, poses, asked: _ } = found.counts;
        let distance_queries = found.work.distance_queries;
        Self { seconds, memory_bytes, samples, nodes, poses, distance_queries }
    }
}

/// Output of `inspect` for an object.
#[derive(Serialize)]
pub(super) struct InspectedObject {
    pub(super) schema: u32,
    #[serde(rename = "as")]
    pub(super) role: &'static str,
    pub(super) vertices: usize,
    pub(super) triangles: usize,
    pub(super) extents: [f32; 3],
    /// Warning about an implausible size.
    pub(super) scale_warning: Option<String>,
    pub(super) mass: MassProperties,
    pub(super) centre_of_mass: [f32; 3],
    pub(super) symmetries: Vec<Symmetry>,
    pub(super) counts: ObjectCounts,
    pub(super) sites: Vec<Site<HangingSite>>,
    pub(super) contacts: Vec<ObjectContact>,
    pub(super) seconds: f64,
}

/// Output of `inspect` for a supporter.
#[derive(Serialize)]
pub(super) struct InspectedSupporter {
    pub(super) schema: u32,
    #[serde(rename = "as")]
    pub(super) role: &'static str,
    pub(super) points: usize,
    pub(super) extents: [f32; 3],
    /// Warning about an implausible size.
    pub(super) scale_warning: Option<String>,
    /// Points that were merged with others at the same place.
    pub(super) points_merged: usize,
    /// Points alone in the air, which were dropped.
    pub(super) strays: usize,
    /// Points left on large planes, on which nothing hangs.
    pub(super) points_on_planes: usize,
    pub(super) normals_estimated: usize,
    pub(super) normals_renormalised: usize,
    pub(super) counts: SupporterCounts,
    pub(super) sites: Vec<Site<SupportSite>>,
    pub(super) contacts: Vec<SupportContact>,
    pub(super) seconds: f64,
}

impl<'a> Pose<'a> {
    pub(super) fn new(rank: usize, pose: &'a HangingPose, object: &Object, supporter: &Supporter) -> Self {
        let matrix = |pose: &hangpose::geometry::Pose| {
            let rows = pose.to_homogeneous().transpose();
            core::array::from_fn(|k| rows.as_slice()[k])
        };
        let (rest, matched) = (pose.rest.as_ref(), pose.matched.as_ref());
        Self {
            rank,
            pose: matrix(&pose.pose),
            release_pose: matrix(&pose.pose),
            rest_pose: rest.map(|rest| matrix(&rest.pose)),
            kind: rest.map(|rest| rest.kind),
            tolerance: rest.map(|rest| rest.tolerance),
            sinking: rest.map(|rest| rest.sinking),
            clearance: rest.map(|rest| rest.clearance),
            probability: rest.map(|rest| rest.probability),
            robustness: rest.map(|rest| rest.robustness),
            unseen: rest.map(|rest| rest.unseen),
            margin: rest.map(|rest| rest.margin),
            contacts: rest.map(|rest| rest.contacts()),
            position: pose.pose.translation.vector.into(),
            quaternion_xyzw: pose.pose.rotation.coords.into(),
            cost: matched.map(|matched| matched.cost),
            object_site: matched.and_then(|matched| site(object.sites(), matched.object_site)),
            supporter_site: matched.and_then(|matched| site(supporter.sites(), matched.support_site)),
            path: None,
            path_failure: None,
        }
    }

    /// The pose with its path, or the reason why it has none.
    pub(super) fn with_path(self, path: Option<path::Path>, path_failure: Option<path::Failure>) -> Self {
        Self { path: Some(path), path_failure, ..self }
    }
}

/// The symmetries of an object that were detected.
pub(super) fn symmetries(object: &Object) -> Vec<Symmetry> {
    let point = object.centre_of_mass().into();
    let symmetry = |&geometry::Symmetry { axis, fold }: &geometry::Symmetry| Symmetry {
        axis: axis.into(),
        point,
        fold: (fold > 0).then_some(fold),
    };
    object.symmetries().iter().map(symmetry).collect()
}

/// The site with this index.
fn site<T>(mut sites: impl Iterator<Item = T>, index: u32) -> Option<Site<T>> {
    let index = index as usize;
    sites.nth(index).map(|site| Site { index, site })
}

/// All sites with their indices.
pub(super) fn sites<T>(sites: impl Iterator<Item = T>) -> Vec<Site<T>> {
    sites.enumerate().map(|(index, site)| Site { index, site }).collect()
}

impl From<&Rejection> for Reason {
    fn from(rejection: &Rejection) -> Self {
        Self {
            stage: rejection.stage,
            reason: rejection.stage.to_string(),
            counts: (&rejection.counts).into(),
        }
    }
}

/// A prediction or a plan as indented JSON, its poses and places moved by `origin`, metres, from the supporter's coordinates
/// to those of its file.
pub(super) fn text_in_frame(document: &impl Serialize, origin: [f64; 3]) -> String {
    if origin == [0.0; 3] {
        return text(document);
    }
    let mut document = serde_json::to_value(document).expect("every key is a string");
    shift(&mut document, origin);
    text(&document)
}

/// Moves the poses and places of a prediction or a plan by `origin`, metres.
pub(super) fn shift(document: &mut Value, origin: [f64; 3]) {
    for pose in document.get_mut("poses").and_then(Value::as_array_mut).into_iter().flatten() {
        for matrix in ["pose", "release_pose", "rest_pose"] {
            add(&mut pose[matrix], [3, 7, 11], origin);
        }
        add(&mut pose["position"], [0, 1, 2], origin);
        for contact in pose["contacts"].as_array_mut().into_iter().flatten() {
            add(&mut contact["position"], [0, 1, 2], origin);
        }
        if pose["supporter_site"].is_object() {
            add(&mut pose["supporter_site"]["position"], [0, 1, 2], origin);
        }
        move_path(pose, origin);
    }
    move_path(document, origin);
}

/// The poses of a prediction as values.
pub(super) fn values(poses: &[Pose]) -> Vec<Value> {
    poses.iter().map(|pose| serde_json::to_value(pose).expect("every key is a string")).collect()
}

/// Moves the path of a value, or the place at which it has none.
fn move_path(value: &mut Value, origin: [f64; 3]) {
    for list in ["waypoints", "gripper"] {
        let waypoints = value.pointer_mut(&format!("/path/{list}")).and_then(Value::as_array_mut);
        for waypoint in waypoints.into_iter().flatten() {
            add(&mut waypoint["position"], [0, 1, 2], origin);
        }
    }
    if let Some(at) = value.pointer_mut("/path_failure/at") {
        add(at, [0, 1, 2], origin);
    }
}

/// Adds an offset to the numbers at three places of a list.
fn add(value: &mut Value, places: [usize; 3], origin: [f64; 3]) {
    for (place, offset) in places.into_iter().zip(origin) {
        if let Some(number) = value.get_mut(place)
            && let Some(x) = number.as_f64()
        {
            *number = (x + offset).into();
        }
    }
}

/// The value as indented JSON with a trailing line break.
pub(super) fn text(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("every key is a string");
    text.push('\n');
    text
}
