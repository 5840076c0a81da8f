//! The page and the picture that show a prediction.

use super::output::Output;
use anyhow::{Context, Result};
use clap::Args;
use hangpose::geometry::{Cloud, Mesh, Pose};
use hangpose::hanging::{Counts, HangingPose, Object, Rejection, Request, Supporter};
use hangpose::mechanics::Fate;
use hangpose::motion::Gripper;
use hangpose::view::{self, Scene, ShownPose};
use hangpose::{Monitor, Params};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// How the result is shown.
#[derive(Args)]
pub(super) struct ShownArguments {
    /// File for a page that shows the result in a browser: HTML that needs no network; - for standard output.
    #[arg(long, value_name = "FILE")]
    view: Option<PathBuf>,
    /// File for a picture of the best pose, or of the first one with a path.
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
}

/// Where the page and the picture go.
pub(super) struct Shown {
    page: Option<Output>,
    picture: Option<Output>,
}

/// What is shown, without the poses.
pub(super) struct Background<'a> {
    pub(super) names: [&'a Path; 2],
    pub(super) shapes: (&'a Mesh<'a>, &'a Cloud<'a>),
    pub(super) models: (&'a Object<'a>, &'a Supporter<'a>),
    pub(super) request: &'a Request<'a>,
    pub(super) params: &'a Params,
    pub(super) gripper: Option<Gripper<'a>>,
}

/// What the prediction says beside its poses.
#[derive(Default)]
pub(super) struct Outcome<'a> {
    pub(super) released: &'a [(Pose, Fate)],
    pub(super) counts: Option<&'a Counts>,
    pub(super) rejection: Option<&'a Rejection>,
}

impl ShownArguments {
    /// Whether candidates shall be collected for the page.
    pub(super) fn has_page(&self) -> bool {
        self.view.is_some()
    }

    /// Checks that the files can be written.
    pub(super) fn prepare(&self, inputs: &[&Path]) -> Result<Shown> {
        let prepare =
            |path: &Option<PathBuf>| path.as_deref().map(|path| Output::prepare(path, inputs)).transpose();
        Ok(Shown { page: prepare(&self.view)?, picture: prepare(&self.png)? })
    }
}

impl Shown {
    /// Whether one of the files is standard output.
    pub(super) fn uses_standard_output(&self) -> bool {
        [&self.page, &self.picture].into_iter().any(|output| matches!(output, Some(Output::Standard)))
    }

    /// Whether nothing is to be written.
    pub(super) fn is_empty(&self) -> bool {
        self.page.is_none() && self.picture.is_none()
    }

    /// Writes the page and the picture of `poses`, of which `details` is the list in the JSON.
    pub(super) fn write(
        self,
        background: &Background,
        poses: &[HangingPose],
        details: Vec<Value>,
        outcome: &Outcome,
    ) -> Result<()> {
        let Background { names, shapes, models, request, params, gripper } = background;
        let [object_name, supporter_name] =
            names.map(|path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
        let has_path = |pose: &Value| pose.get("path").is_some_and(Value::is_object);
        let pictured = details.iter().position(has_path).unwrap_or(0);
        let poses: Vec<ShownPose> =
            poses.iter().zip(details).map(|(pose, details)| shown(pose, details)).collect();
        let scene = Scene {
            object_name: &object_name,
            mesh: shapes.0,
            object: models.0,
            supporter_name: &supporter_name,
            cloud: shapes.1,
            supporter: models.1,
            request,
            params,
            poses: &poses,
            released: outcome.released,
            counts: outcome.counts,
            rejection: outcome.rejection,
            gripper: *gripper,
            monitor: &Monitor::new(),
        };
        if let Some(picture) = self.picture {
            picture.write(view::snapshot(&scene, pictured))?;
        }
        if let Some(page) = self.page {
            page.write(view::page(&scene).context("--view")?)?;
        }
        Ok(())
    }
}

/// A pose with what the JSON says of it, without the pose itself.
fn shown(pose: &HangingPose, details: Value) -> ShownPose {
    let mut details = match details {
        Value::Object(details) => details,
        _ => Default::default(),
    };
    for name in ["pose", "position", "quaternion_xyzw", "release_pose", "rest_pose"] {
        details.remove(name);
    }
    ShownPose::from_details(pose.pose, pose.rest.map(|rest| rest.pose), details)
}
