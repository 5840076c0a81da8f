//! The JSON that programs read. Lengths are metres, frames have z up.

use hangpose::Params;
use hangpose::geometry::MassProperties;
use hangpose::hanging::{
    Cost, Counts, HangabilityCounts, HangingPose, HangingSite, Rejection, Stage, SupportSite,
    SupportabilityCounts,
};
use serde::Serialize;

/// Raised when a reader of the last schema could misunderstand the new one.
pub(super) const SCHEMA: u32 = 1;

#[derive(Serialize)]
pub(super) struct Prediction<'a> {
    pub(super) schema: u32,
    pub(super) poses: Vec<Pose<'a>>,
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
    cost: Cost,
    object_site: Site<'a, HangingSite>,
    supporter_site: Site<'a, SupportSite>,
}

/// A site with its place among the sites of the object or the supporter.
#[derive(Serialize)]
pub(super) struct Site<'a, T> {
    pub(super) index: usize,
    #[serde(flatten)]
    pub(super) site: &'a T,
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
    pub(super) memory_bytes: PerPart,
    pub(super) sites: PerPart,
    pub(super) counts: Counts,
}

#[derive(Default, Serialize)]
pub(super) struct Seconds {
    pub(super) read: f64,
    pub(super) object: f64,
    pub(super) supporter: f64,
    pub(super) matching: f64,
    /// From the files to the poses; less than the sum where parts ran side by side.
    pub(super) total: f64,
}

#[derive(Serialize)]
pub(super) struct PerPart {
    pub(super) object: usize,
    pub(super) supporter: usize,
}

/// What `inspect` says of an object.
#[derive(Serialize)]
pub(super) struct InspectedObject<'a> {
    pub(super) schema: u32,
    #[serde(rename = "as")]
    pub(super) role: &'static str,
    pub(super) vertices: usize,
    pub(super) triangles: usize,
    pub(super) extents: [f32; 3],
    /// What is odd about that size.
    pub(super) scale_warning: Option<String>,
    pub(super) mass: MassProperties,
    pub(super) centre_of_mass: [f32; 3],
    pub(super) counts: HangabilityCounts,
    pub(super) sites: Vec<Site<'a, HangingSite>>,
    pub(super) seconds: f64,
}

/// What `inspect` says of a supporter.
#[derive(Serialize)]
pub(super) struct InspectedSupporter<'a> {
    pub(super) schema: u32,
    #[serde(rename = "as")]
    pub(super) role: &'static str,
    pub(super) points: usize,
    pub(super) extents: [f32; 3],
    /// What is odd about that size.
    pub(super) scale_warning: Option<String>,
    pub(super) normals_estimated: usize,
    pub(super) normals_renormalised: usize,
    pub(super) counts: SupportabilityCounts,
    pub(super) sites: Vec<Site<'a, SupportSite>>,
    pub(super) seconds: f64,
}

impl<'a> Pose<'a> {
    pub(super) fn new(
        rank: usize,
        pose: &HangingPose,
        object: &'a [HangingSite],
        supporter: &'a [SupportSite],
    ) -> Self {
        let rows = pose.pose.to_homogeneous().transpose();
        let (i, j) = (pose.object_site as usize, pose.support_site as usize);
        Self {
            rank,
            pose: core::array::from_fn(|k| rows.as_slice()[k]),
            position: pose.pose.translation.vector.into(),
            quaternion_xyzw: pose.pose.rotation.coords.into(),
            cost: pose.cost,
            object_site: Site { index: i, site: &object[i] },
            supporter_site: Site { index: j, site: &supporter[j] },
        }
    }
}

/// All sites, numbered.
pub(super) fn sites<T>(sites: &[T]) -> Vec<Site<'_, T>> {
    sites.iter().enumerate().map(|(index, site)| Site { index, site }).collect()
}

impl From<&Rejection> for Reason {
    fn from(rejection: &Rejection) -> Self {
        Self { stage: rejection.stage, reason: rejection.stage.to_string(), counts: rejection.counts }
    }
}

/// As text with a line break at the end.
pub(super) fn text(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("every key is a string");
    text.push('\n');
    text
}
