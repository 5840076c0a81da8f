//! Predictions.

use crate::models::{NativeObject, NativeSupporter};
use crate::request::Wishes;
use crate::{arrays, errors, work};
use hangpose::geometry::Pose;
use hangpose::hanging::{Counts, HangingPose, Rejection, Request, Watch};
use hangpose::mechanics::Fate;
use hangpose::{Monitor, predict_poses};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::Serialize;
use serde_json::{Value, json};
use std::sync::{Mutex, PoisonError};

/// A prediction with what its page shows.
#[pyclass(frozen, module = "hangpose._hangpose")]
pub(crate) struct NativePrediction {
    pub(crate) poses: Vec<HangingPose>,
    pub(crate) rejection: Option<Rejection>,
    pub(crate) counts: Counts,
    pub(crate) released: Vec<(Pose, Fate)>,
    pub(crate) scene: Vec<[f32; 3]>,
}

#[derive(Serialize)]
struct Summary {
    poses: Vec<Value>,
    /// The stage that left nothing, and why in words.
    rejection: Option<(Value, String)>,
    /// "cancelled" or "work_limit".
    stopped: Option<String>,
    counts: Value,
}

/// Predicts poses. Returns the prediction as a dictionary, and as it is.
#[pyfunction]
#[pyo3(signature = (object, supporter, wishes, hung, scene, top, work_limit, progress))]
#[allow(clippy::too_many_arguments, reason = "they are those of the Python function")]
pub(crate) fn predict<'py>(
    py: Python<'py>,
    object: PyRef<'py, NativeObject>,
    supporter: PyRef<'py, NativeSupporter>,
    wishes: &Bound<'py, PyAny>,
    hung: Vec<PyRef<'py, NativeObject>>,
    scene: PyReadonlyArray2<'py, f32>,
    top: usize,
    work_limit: Option<u64>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyAny>, NativePrediction)> {
    let wishes: Wishes = depythonize(wishes)?;
    // A copy, since other threads may write to the array during the call.
    let scene = arrays::rows(py, "scene", &scene)?.to_vec();
    let monitor = work_limit.map_or_else(Monitor::new, Monitor::with_work_limit);
    let released = Mutex::new(Vec::new());
    let watch =
        |pose: &Pose, fate| released.lock().unwrap_or_else(PoisonError::into_inner).push((*pose, fate));
    let mut poses = vec![HangingPose::default(); top];
    let (count, rejection, stopped, counts) = wishes.with(py, &hung, &scene, |request| {
        let request = &Request { watch: Some(Watch(&watch)), ..*request };
        let (object, supporter, params) = (object.object(), supporter.supporter(), &object.params);
        let found = work::run(py, &monitor, progress, || {
            predict_poses(object, supporter, request, params, &mut poses, &monitor)
                .map(|found| (found.poses.len(), found.rejection, found.stopped, found.counts))
        })?;
        found.map_err(|error| errors::predict(py, &error))
    })?;
    poses.truncate(count);
    let summary = Summary {
        poses: poses.iter().map(pose_of).collect(),
        rejection: rejection.map(|rejection| (json!(rejection.stage), rejection.stage.to_string())),
        stopped: stopped.map(|stop| match stop {
            hangpose::Stop::Cancelled => "cancelled".into(),
            hangpose::Stop::WorkLimit => "work_limit".into(),
        }),
        counts: json!(counts.settling),
    };
    let released = released.into_inner().unwrap_or_else(PoisonError::into_inner);
    let native = NativePrediction { poses, rejection, counts, released, scene };
    Ok((pythonize(py, &summary)?, native))
}

pub(crate) fn placed(pose: &Pose) -> Value {
    let (position, quaternion): ([f32; 3], [f32; 4]) =
        (pose.translation.vector.into(), pose.rotation.coords.into());
    let rows = pose.to_homogeneous().transpose();
    json!({ "position": position, "quaternion": quaternion, "matrix": rows.as_slice() })
}

fn pose_of(pose: &HangingPose) -> Value {
    let rest = pose.rest.as_ref();
    json!({
        "release": placed(&pose.pose),
        "rest": rest.map(|rest| placed(&rest.pose)),
        "kind": rest.map(|rest| rest.kind),
        "probability": rest.map(|rest| rest.probability),
        "robustness": rest.map(|rest| rest.robustness),
        "sinking": rest.map(|rest| rest.sinking),
        "clearance": rest.map(|rest| rest.clearance),
        "tolerance": rest.map(|rest| rest.tolerance),
        "unseen": rest.map(|rest| rest.unseen),
        "margin": rest.map(|rest| rest.margin),
        "contacts": rest.map(|rest| rest.contacts()),
        "cost": pose.matched.as_ref().map(|matched| matched.cost.total),
    })
}
