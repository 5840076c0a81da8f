//! The page of a prediction.

use crate::models::{NativeObject, NativeSupporter};
use crate::predict::NativePrediction;
use crate::request::Placed;
use crate::{errors, work};
use hangpose::Monitor;
use hangpose::geometry::Pose;
use hangpose::hanging::Request;
use hangpose::motion::{Path, Waypoint};
use hangpose::view::{self, Scene, ShownPose};
use pyo3::prelude::*;
use pythonize::depythonize;
use serde::Deserialize;

/// A path to the pose of this rank.
#[derive(Deserialize)]
struct PathTo {
    rank: usize,
    object: Vec<At>,
    release: usize,
    gripper: Vec<At>,
    clearance: f32,
}

#[derive(Deserialize)]
struct At {
    seconds: f32,
    #[serde(flatten)]
    pose: Placed,
}

/// The page: HTML that needs nothing else.
#[pyfunction]
#[pyo3(signature = (object, supporter, prediction, names, paths))]
pub(crate) fn page<'py>(
    py: Python<'py>,
    object: PyRef<'py, NativeObject>,
    supporter: PyRef<'py, NativeSupporter>,
    prediction: PyRef<'py, NativePrediction>,
    names: [String; 2],
    paths: &Bound<'py, PyAny>,
) -> PyResult<String> {
    let paths: Vec<PathTo> = depythonize(paths)?;
    let (Some(mesh), Some(cloud)) = (object.mesh(), supporter.cloud()) else {
        return Err(errors::value(py, "prediction", "its object or its supporter has no shape"));
    };
    let waypoints = |list: &[At]| {
        list.iter().map(|at| Waypoint { seconds: at.seconds, pose: Pose::from(&at.pose) }).collect::<Vec<_>>()
    };
    let shown = |(index, pose)| {
        let shown = ShownPose::new(index + 1, pose);
        match paths.iter().find(|path| path.rank == index + 1) {
            Some(path) => shown.with_path(&Path {
                object: &waypoints(&path.object),
                release: path.release,
                gripper: &waypoints(&path.gripper),
                clearance: path.clearance,
            }),
            None => shown,
        }
    };
    let poses: Vec<ShownPose> = prediction.poses.iter().enumerate().map(shown).collect();
    let request = Request { scene: &prediction.scene, ..Request::ANY };
    let monitor = Monitor::new();
    let scene = Scene {
        object_name: &names[0],
        mesh: &mesh,
        object: object.object(),
        supporter_name: &names[1],
        cloud: &cloud,
        supporter: supporter.supporter(),
        request: &request,
        params: &object.params,
        poses: &poses,
        released: &prediction.released,
        counts: Some(&prediction.counts),
        rejection: prediction.rejection.as_ref(),
        gripper: None,
        monitor: &monitor,
    };
    work::run(py, &monitor, None, || view::page(&scene))?.map_err(|error| errors::predict(py, &error))
}
