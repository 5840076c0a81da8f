//! Errors as exceptions of `hangpose.errors`, with the fields of `hangpose_detail` in C.

use hangpose::files::FileError;
use hangpose::geometry::{CloudError, MAX_COORDINATE, MeshError};
use hangpose::hanging::{AnalysisError, PredictError, RegionError, RequestError};
use hangpose::motion::{MotionError, PlanError};
use hangpose::{FuseError, ParamsError, TooLarge};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What is wrong, where.
#[derive(Default)]
struct Detail<'a> {
    field: &'a str,
    index: Option<usize>,
    value: Option<f64>,
    range: Option<[f64; 2]>,
}

fn raise(py: Python<'_>, class: &str, message: &str, detail: Detail) -> PyErr {
    let build = || -> PyResult<Bound<'_, PyAny>> {
        let fields = PyDict::new(py);
        fields.set_item("field", detail.field)?;
        fields.set_item("index", detail.index)?;
        fields.set_item("value", detail.value)?;
        fields.set_item("minimum", detail.range.map(|[minimum, _]| minimum))?;
        fields.set_item("maximum", detail.range.map(|[_, maximum]| maximum))?;
        py.import("hangpose.errors")?.getattr(class)?.call((message,), Some(&fields))
    };
    build().map_or_else(|error| error, PyErr::from_value)
}

/// An argument that cannot be used.
pub(crate) fn value(py: Python<'_>, field: &str, message: &str) -> PyErr {
    raise(py, "InvalidInput", message, Detail { field, ..Detail::default() })
}

pub(crate) fn element(py: Python<'_>, field: &str, index: Option<usize>, message: &str) -> PyErr {
    raise(py, "InvalidInput", message, Detail { field, index, ..Detail::default() })
}

pub(crate) fn cancelled(py: Python<'_>) -> PyErr {
    raise(py, "Cancelled", "the call was cancelled", Detail::default())
}

pub(crate) fn file(py: Python<'_>, error: &FileError) -> PyErr {
    raise(py, "UnreadableFile", &error.to_string(), Detail::of("path"))
}

/// A file of constants that cannot be used.
pub(crate) fn unreadable(py: Python<'_>, message: &str) -> PyErr {
    raise(py, "UnreadableFile", message, Detail::of("file"))
}

pub(crate) fn params(py: Python<'_>, error: &ParamsError) -> PyErr {
    let text = error.to_string();
    match error {
        ParamsError::OutOfRange { name, value, min, max } => {
            let range = Some([f64::from(*min), f64::from(*max)]);
            let detail = Detail { field: name, index: None, value: Some((*value).into()), range };
            raise(py, "InvalidInput", &text, detail)
        }
        ParamsError::Gravity { .. } => value(py, "gravity", &text),
        ParamsError::CentreOfMass { .. } => value(py, "centre_of_mass", &text),
    }
}

impl<'a> Detail<'a> {
    fn of(field: &'a str) -> Self {
        Self { field, ..Self::default() }
    }

    /// A count that is out of range.
    fn count(self, count: usize, range: [usize; 2]) -> Self {
        Self { value: Some(count as f64), range: Some(range.map(|limit| limit as f64)), ..self }
    }

    /// The first of three numbers of an element that is no coordinate.
    fn coordinate(self, index: usize, position: &[f32; 3]) -> Self {
        let wrong = position.iter().find(|x| x.abs() > MAX_COORDINATE);
        let limit = f64::from(MAX_COORDINATE);
        Self { index: Some(index), value: wrong.map(|x| f64::from(*x)), range: Some([-limit, limit]), ..self }
    }
}

pub(crate) fn too_large(py: Python<'_>, error: &TooLarge) -> PyErr {
    let TooLarge { what, count, limit, .. } = *error;
    raise(py, "InvalidInput", &error.to_string(), Detail::of(what).count(count, [1, limit]))
}

pub(crate) fn mesh(py: Python<'_>, error: &MeshError) -> PyErr {
    let detail = match error {
        MeshError::Coordinate { vertex, position } => Detail::of("vertices").coordinate(*vertex, position),
        MeshError::Viewpoint { viewpoint, position } => {
            Detail::of("viewpoints").coordinate(*viewpoint, position)
        }
        MeshError::Index { triangle, vertex, vertices } => Detail {
            index: Some(*triangle),
            ..Detail::of("triangles").count(*vertex as usize, [0, vertices.saturating_sub(1)])
        },
        MeshError::TooLarge { count, limit } => Detail::of("triangles").count(*count, [1, *limit]),
        MeshError::Empty | MeshError::AllDegenerate { .. } => Detail::of("triangles"),
    };
    raise(py, "InvalidInput", &error.to_string(), detail)
}

pub(crate) fn cloud(py: Python<'_>, error: &CloudError) -> PyErr {
    let detail = match error {
        CloudError::Coordinate { point, position } => Detail::of("points").coordinate(*point, position),
        CloudError::Normal { point, normal } => Detail::of("normals").coordinate(*point, normal),
        CloudError::NormalCount { points, normals } => Detail::of("normals").count(*normals, [*points; 2]),
        CloudError::Viewpoint { viewpoint, position } => {
            Detail::of("viewpoints").coordinate(*viewpoint, position)
        }
        CloudError::MarkCount { points, marks } => Detail::of("marks").count(*marks, [*points; 2]),
        CloudError::Region { .. } => Detail::of("region"),
        CloudError::TooLarge { count, limit } => Detail::of("points").count(*count, [1, *limit]),
        CloudError::Empty => Detail::of("points"),
    };
    raise(py, "InvalidInput", &error.to_string(), detail)
}

pub(crate) fn analysis(py: Python<'_>, error: &AnalysisError) -> PyErr {
    match error {
        AnalysisError::Params(error) => params(py, error),
        AnalysisError::OutOfMemory(error) => value(py, "memory", &error.to_string()),
        AnalysisError::Cancelled => cancelled(py),
    }
}

pub(crate) fn request(py: Python<'_>, error: &RequestError) -> PyErr {
    let at = |region: &RegionError| match region {
        RegionError::Index { index, .. } => Some(*index as usize),
        _ => None,
    };
    let (field, index) = match error {
        RequestError::NothingAllowed => ("allow", None),
        RequestError::On(region) => ("here", at(region)),
        RequestError::By(region) => ("by", at(region)),
        RequestError::Approach => ("approach", None),
        RequestError::Scene { point, .. } => ("scene", Some(*point)),
        RequestError::Hung { index } => ("hung", Some(*index)),
        RequestError::Distinct => ("distinct", None),
        RequestError::Symmetry { index } => ("symmetries", Some(*index)),
    };
    element(py, field, index, &error.to_string())
}

pub(crate) fn predict(py: Python<'_>, error: &PredictError) -> PyErr {
    match error {
        PredictError::Params(error) => params(py, error),
        PredictError::Request(error) => request(py, error),
        PredictError::OutOfMemory(error) => value(py, "memory", &error.to_string()),
        PredictError::Release => value(py, "pose", &error.to_string()),
        PredictError::NoDistanceField => value(py, "object", &error.to_string()),
    }
}

pub(crate) fn motion(py: Python<'_>, error: &MotionError) -> PyErr {
    let text = error.to_string();
    match error {
        MotionError::Start => value(py, "start", &text),
        MotionError::Part { part } => element(py, "gripper.parts", Some(*part), &text),
        MotionError::NoParts => value(py, "gripper.parts", &text),
        MotionError::Retreat => value(py, "gripper.retreat", &text),
        MotionError::Workspace => value(py, "workspace", &text),
        MotionError::Value { name, value, min, max } => {
            let range = Some([f64::from(*min), f64::from(*max)]);
            let detail = Detail { field: name, index: None, value: Some((*value).into()), range };
            raise(py, "InvalidInput", &text, detail)
        }
        MotionError::Count { name, value, min, max } => {
            let range = Some([*min as f64, *max as f64]);
            let detail = Detail { field: name, index: None, value: Some(*value as f64), range };
            raise(py, "InvalidInput", &text, detail)
        }
    }
}

pub(crate) fn plan(py: Python<'_>, error: &PlanError) -> PyErr {
    let text = error.to_string();
    match error {
        PlanError::Params(error) => params(py, error),
        PlanError::Request(error) => request(py, error),
        PlanError::Motion(error) => motion(py, error),
        PlanError::Goal => value(py, "pose", &text),
        PlanError::OutOfMemory(_) => value(py, "memory", &text),
        PlanError::Cancelled => cancelled(py),
        PlanError::NoDistanceField { hung: None } => value(py, "object", &text),
        PlanError::NoDistanceField { hung } => element(py, "hung", *hung, &text),
        PlanError::TooManyWaypoints { .. } => value(py, "samples", &text),
    }
}

pub(crate) fn fuse(py: Python<'_>, error: &FuseError) -> PyErr {
    let (field, index) = match error {
        FuseError::Image { index, .. }
        | FuseError::Volume { index, .. }
        | FuseError::Points { index, .. } => ("depths", Some(*index)),
        FuseError::Convention { .. } => ("poses", None),
        FuseError::Outside { .. } => ("crop", None),
        _ => ("depths", None),
    };
    element(py, field, index, &error.to_string())
}
