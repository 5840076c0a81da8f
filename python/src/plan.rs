//! Paths.

use crate::models::{NativeObject, NativeSupporter};
use crate::predict::placed;
use crate::request::{Placed, Wishes};
use crate::{arrays, errors, work};
use hangpose::Monitor;
use hangpose::geometry::{Aabb, Pose};
use hangpose::hanging::{HangingPose, Rest};
use hangpose::memory::Limits;
use hangpose::motion::{
    self, Capsule, Collision, Gripper, Motion, Mover, Obstacle, PlanFailure, Task, Waypoint, plan_bytes,
};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use serde::Deserialize;
use serde_json::{Value, json};

/// Room for the waypoints of a path.
const MAX_WAYPOINTS: usize = 100_000;

#[derive(Deserialize)]
struct Way {
    start: Option<Placed>,
    take_off: bool,
    gripper: Option<Hand>,
    workspace: Option<[[f32; 3]; 2]>,
    clearance: Option<f32>,
    samples: Option<usize>,
    seed: Option<u64>,
}

#[derive(Deserialize)]
struct Hand {
    parts: Vec<Part>,
    retreat: [f32; 3],
}

#[derive(Deserialize)]
struct Part {
    start: [f32; 3],
    end: [f32; 3],
    radius: f32,
    opening: [f32; 3],
}

/// Plans a path to a pose. Returns a dictionary with `path`, or with `failure`.
#[pyfunction]
#[pyo3(signature = (object, supporter, release, rest, way, wishes, hung, scene, accepts, progress))]
#[allow(clippy::too_many_arguments, reason = "they are those of the Python function")]
pub(crate) fn plan<'py>(
    py: Python<'py>,
    object: PyRef<'py, NativeObject>,
    supporter: PyRef<'py, NativeSupporter>,
    release: &Bound<'py, PyAny>,
    rest: Option<&Bound<'py, PyAny>>,
    way: &Bound<'py, PyAny>,
    wishes: &Bound<'py, PyAny>,
    hung: Vec<PyRef<'py, NativeObject>>,
    scene: PyReadonlyArray2<'py, f32>,
    accepts: Option<Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let place = |pose: &Bound<'py, PyAny>| -> PyResult<Pose> { Ok((&depythonize::<Placed>(pose)?).into()) };
    let goal = HangingPose {
        pose: place(release)?,
        rest: rest.map(place).transpose()?.map(Rest::at),
        matched: None,
    };
    let way: Way = depythonize(way)?;
    let wishes: Wishes = depythonize(wishes)?;
    // A copy, since other threads may write to the array during the call.
    let scene = arrays::rows(py, "scene", &scene)?.to_vec();
    let parts: Vec<Capsule> = way.gripper.iter().flat_map(|hand| &hand.parts).map(Capsule::from).collect();
    let samples = way.samples.unwrap_or(Motion::DEFAULT.samples);
    let motion = Motion {
        start: way.start.as_ref().map(Pose::from),
        take_off: way.take_off,
        gripper: way.gripper.as_ref().map(|hand| Gripper { parts: &parts, retreat: hand.retreat }),
        workspace: way.workspace.map(|[min, max]| Aabb { min: min.into(), max: max.into() }),
        clearance: way.clearance.unwrap_or(Motion::DEFAULT.clearance),
        samples,
        nodes: Motion::DEFAULT.nodes.max(2 * samples),
        seed: way.seed.unwrap_or(Motion::DEFAULT.seed),
        ..Motion::DEFAULT
    };
    motion.validate().map_err(|error| errors::motion(py, &error))?;
    let monitor = Monitor::new();
    let accepts = accepts.map(Bound::unbind);
    let answer = wishes.with(py, &hung, &scene, |request| {
        let (object, supporter, params) = (object.object(), supporter.supporter(), &object.params);
        let task = Task { object, supporter, request, params, motion };
        let limits = Limits { points: supporter.limits().points, ..Limits::NONE };
        // An exception of the callback ends the search and is raised.
        let mut raised = None;
        let mut accept = |pose: &Pose| match &accepts {
            None => true,
            Some(accepts) => Python::attach(|py| {
                let answer = pythonize(py, &placed(pose)["matrix"])
                    .map_err(PyErr::from)
                    .and_then(|matrix| accepts.call1(py, (matrix,))?.extract::<bool>(py));
                answer.unwrap_or_else(|error| {
                    monitor.cancel();
                    raised.get_or_insert(error);
                    false
                })
            }),
        };
        let planned = work::run(py, &monitor, progress, || {
            let mut memory = vec![0; plan_bytes(&limits, scene.len(), motion.nodes)];
            let mut waypoints = vec![Waypoint::default(); MAX_WAYPOINTS];
            motion::plan(&task, &goal, &mut waypoints, &mut accept, &mut memory, &monitor)
                .map(|plan| answer_of(plan.path.as_ref()))
        })?;
        match raised {
            Some(error) => Err(error),
            None => planned.map_err(|error| errors::plan(py, &error)),
        }
    })?;
    Ok(pythonize(py, &answer)?)
}

impl From<&Part> for Capsule {
    fn from(&Part { start, end, radius, opening }: &Part) -> Self {
        Self { from: start, to: end, radius, opening }
    }
}

fn answer_of(path: Result<&motion::Path, &PlanFailure>) -> Value {
    let waypoints = |list: &[Waypoint]| {
        let waypoint = |waypoint: &Waypoint| {
            let mut value = placed(&waypoint.pose);
            value["seconds"] = json!(waypoint.seconds);
            value
        };
        list.iter().map(waypoint).collect::<Vec<_>>()
    };
    match path {
        Ok(path) => json!({ "path": {
            "object": waypoints(path.object),
            "release": path.release,
            "gripper": waypoints(path.gripper),
            "clearance": path.clearance,
        }}),
        Err(failure) => json!({ "failure": failure_of(failure) }),
    }
}

fn failure_of(failure: &PlanFailure) -> Value {
    let collision = failure.collision().map(|&Collision { mover, obstacle, at, distance }| {
        let part = match mover {
            Mover::Object => None,
            Mover::Gripper(part) => Some(part),
        };
        let (obstacle, index) = match obstacle {
            Obstacle::Supporter => ("supporter", None),
            Obstacle::Scene(index) => ("scene", Some(index)),
            Obstacle::Hung(index) => ("hung", Some(index)),
            Obstacle::Object => ("object", None),
        };
        json!({ "part": part, "obstacle": obstacle, "index": index, "at": at, "distance": distance })
    });
    json!({ "reason": failure.name(), "message": failure.to_string(), "collision": collision })
}
