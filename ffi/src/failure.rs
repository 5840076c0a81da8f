//! The errors that a caller can make, and their report in a [`hangpose_detail`].
//!
//! [`hangpose_detail`]: crate::hangpose_detail

use crate::motion_place::motion_place;
use crate::place::{Place, Spot};
use crate::status::*;
use core::fmt::{Display, Formatter};
use hangpose_core::ParamsError;
use hangpose_core::geometry::{CloudError, MAX_COORDINATE, MAX_COUNT, MeshError};
use hangpose_core::hanging::{AnalysisError, PredictError, RegionError, RequestError};
use hangpose_core::memory::OutOfMemory;
use hangpose_core::motion::{MotionError, PlanError};
use hangpose_core::perception::sampling::SamplingError;

/// Reason why a call did nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Failure {
    Null { argument: &'static str },
    Misaligned { argument: &'static str, alignment: usize },
    StructSize { argument: &'static str, given: usize, expected: usize },
    Version { given: u32 },
    Memory { argument: &'static str, needed: usize, given: usize },
    Overlap { written: &'static str, other: &'static str },
    Handle { argument: &'static str, maker: &'static str },
    Busy { argument: &'static str },
    Empty { argument: &'static str },
    Choice { field: &'static str, value: u32, most: u32 },
    Count { field: &'static str, count: usize, most: usize },
    Index { argument: &'static str, index: u32, count: usize },
    Mesh(MeshError),
    Cloud(CloudError),
    Params(ParamsError),
    NoDistanceField,
    Request { error: RequestError, spot: Spot },
    Hung { index: usize, fault: HungFault },
    ManyHung { count: u32 },
    Listed { index: usize, fault: ObjectFault },
    NotSettled,
    Motion(MotionError),
    Pose { spot: Spot },
    NoGoal { value: u32 },
    HungWithoutField { index: usize },
    Waypoints { needed: usize, given: usize },
    Cancelled,
}

/// What is wrong with an object that hangs already.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HungFault {
    Object(ObjectFault),
    Position([f32; 3]),
    Quaternion([f32; 4]),
}

/// What is wrong with an object of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ObjectFault {
    Null,
    Handle,
}

/// What a detail says of a call that did nothing.
pub(crate) trait Reason: Display {
    fn status(&self) -> hangpose_status;
    fn place(&self) -> Place;
    /// The two arguments that overlap, the one that is written first, if that is the reason.
    fn overlap(&self) -> Option<[&'static str; 2]>;
}

impl Reason for Failure {
    fn status(&self) -> hangpose_status {
        match self {
            Self::Null { .. }
            | Self::Listed { fault: ObjectFault::Null, .. }
            | Self::Hung { fault: HungFault::Object(ObjectFault::Null), .. } => HANGPOSE_ERROR_NULL,
            Self::Misaligned { .. } => HANGPOSE_ERROR_MISALIGNED,
            Self::StructSize { .. } => HANGPOSE_ERROR_STRUCT_SIZE,
            Self::Version { .. } => HANGPOSE_ERROR_ABI_VERSION,
            Self::Memory { .. } => HANGPOSE_ERROR_MEMORY,
            Self::Overlap { .. } => HANGPOSE_ERROR_OVERLAP,
            Self::Handle { .. }
            | Self::Listed { fault: ObjectFault::Handle, .. }
            | Self::Hung { fault: HungFault::Object(ObjectFault::Handle), .. } => HANGPOSE_ERROR_HANDLE,
            Self::Busy { .. } => HANGPOSE_ERROR_BUSY,
            Self::Empty { .. } => HANGPOSE_ERROR_EMPTY,
            Self::Count { .. }
            | Self::ManyHung { .. }
            | Self::Mesh(MeshError::Empty | MeshError::TooLarge { .. })
            | Self::Cloud(
                CloudError::Empty
                | CloudError::TooLarge { .. }
                | CloudError::NormalCount { .. }
                | CloudError::MarkCount { .. },
            ) => HANGPOSE_ERROR_COUNT,
            Self::Request {
                error:
                    RequestError::On(RegionError::Index { .. }) | RequestError::By(RegionError::Index { .. }),
                ..
            } => HANGPOSE_ERROR_INDEX,
            Self::Choice { .. }
            | Self::NotSettled
            | Self::Motion(_)
            | Self::Pose { .. }
            | Self::NoGoal { .. }
            | Self::Params(_)
            | Self::Request { .. }
            | Self::Hung { fault: HungFault::Position(_) | HungFault::Quaternion(_), .. }
            | Self::Mesh(MeshError::Coordinate { .. } | MeshError::Viewpoint { .. })
            | Self::Cloud(
                CloudError::Coordinate { .. }
                | CloudError::Normal { .. }
                | CloudError::Viewpoint { .. }
                | CloudError::Region { .. },
            ) => HANGPOSE_ERROR_VALUE,
            Self::Index { .. } | Self::Mesh(MeshError::Index { .. }) => HANGPOSE_ERROR_INDEX,
            Self::Mesh(MeshError::AllDegenerate { .. }) => HANGPOSE_ERROR_DEGENERATE,
            Self::NoDistanceField | Self::HungWithoutField { .. } => HANGPOSE_ERROR_NO_DISTANCE_FIELD,
            Self::Waypoints { .. } => HANGPOSE_ERROR_CAPACITY,
            Self::Cancelled => HANGPOSE_CANCELLED,
        }
    }

    fn place(&self) -> Place {
        match *self {
            Self::Null { argument }
            | Self::Misaligned { argument, .. }
            | Self::Handle { argument, .. }
            | Self::Busy { argument }
            | Self::Empty { argument } => Place::of(argument),
            Self::Overlap { written, .. } => Place::of(written),
            Self::StructSize { argument, given, expected } => {
                let range = [expected as f64; 2];
                Place { prefix: argument, ..Place::of(".struct_size") }.value(given as f64).range(range)
            }
            Self::Version { given } => {
                let range = [f64::from(crate::HANGPOSE_ABI_VERSION); 2];
                Place::of("abi_version").value(f64::from(given)).range(range)
            }
            Self::Memory { argument, needed, given } => {
                Place::of(argument).value(given as f64).range([needed as f64, f64::INFINITY])
            }
            Self::Choice { field, value, most } => {
                Place::of(field).value(f64::from(value)).range([0.0, f64::from(most)])
            }
            Self::Count { field, count, most } => {
                Place::of(field).value(count as f64).range([1.0, most as f64])
            }
            Self::Index { argument, index, count } => {
                Place::of(argument).value(f64::from(index)).range([0.0, count as f64 - 1.0])
            }
            Self::Mesh(error) => mesh_place(error),
            Self::Cloud(error) => cloud_place(error),
            Self::Params(error) => params_place(error),
            Self::NoDistanceField => Place::of("object"),
            Self::Request { spot, .. } | Self::Pose { spot } => spot.into(),
            Self::Motion(error) => motion_place(error),
            Self::NoGoal { value } => Place::of("goal.has_pose").value(f64::from(value)).range([1.0; 2]),
            Self::HungWithoutField { index } => {
                Place { index: Some(index), ..Place::of("request.hung.object") }
            }
            Self::Waypoints { needed, given } => {
                Place::of("waypoint_capacity").value(given as f64).range([needed as f64, f64::INFINITY])
            }
            Self::Hung { index, fault } => hung_place(index, fault),
            Self::ManyHung { count } => {
                let range = [0.0, crate::HANGPOSE_MAX_HUNG as f64];
                Place::of("request.hung_count").value(f64::from(count)).range(range)
            }
            Self::Listed { index, .. } => Place { index: Some(index), ..Place::of("objects") },
            Self::NotSettled => Place::of("params.settle").value(0.0).range([1.0; 2]),
            Self::Cancelled => Place::default(),
        }
    }

    fn overlap(&self) -> Option<[&'static str; 2]> {
        match *self {
            Self::Overlap { written, other } => Some([written, other]),
            _ => None,
        }
    }
}

fn mesh_place(error: MeshError) -> Place {
    match error {
        MeshError::Empty => Place::of("mesh.triangle_count").value(0.0).range([1.0, MAX_COUNT as f64]),
        MeshError::TooLarge { count, limit } => {
            Place::of("mesh").value(count as f64).range([1.0, limit as f64])
        }
        MeshError::Coordinate { vertex, position } => {
            Place::of("mesh.vertices").coordinate(Some(vertex), position)
        }
        MeshError::Index { triangle, vertex, vertices } => {
            let place = Place::of("mesh.triangles").value(f64::from(vertex));
            Place { index: Some(triangle), ..place.range([0.0, vertices as f64 - 1.0]) }
        }
        MeshError::Viewpoint { viewpoint, position } => {
            Place::of("mesh.viewpoints").coordinate(Some(viewpoint), position)
        }
        MeshError::AllDegenerate { .. } => Place::of("mesh.triangles"),
    }
}

fn cloud_place(error: CloudError) -> Place {
    match error {
        CloudError::Empty => Place::of("cloud.point_count").value(0.0).range([1.0, MAX_COUNT as f64]),
        CloudError::TooLarge { count, limit } => {
            Place::of("cloud.point_count").value(count as f64).range([1.0, limit as f64])
        }
        CloudError::Coordinate { point, position } => {
            Place::of("cloud.points").coordinate(Some(point), position)
        }
        CloudError::Normal { point, normal } => Place::of("cloud.normals").coordinate(Some(point), normal),
        CloudError::NormalCount { points, normals } => {
            Place::of("cloud.normals").value(normals as f64).range([points as f64; 2])
        }
        CloudError::Viewpoint { viewpoint, position } => {
            Place::of("cloud.viewpoints").coordinate(Some(viewpoint), position)
        }
        CloudError::MarkCount { points, marks } => {
            Place::of("cloud.marks").value(marks as f64).range([points as f64; 2])
        }
        CloudError::Region { low, high } => {
            let bad = (0..3).find(|&i| !(low[i].is_finite() && high[i].is_finite() && low[i] <= high[i]));
            let place = Place::of("cloud.region");
            bad.map_or(place, |i| {
                place.value(f64::from(low[i])).range([f64::NEG_INFINITY, f64::from(high[i])])
            })
        }
    }
}

fn hung_place(index: usize, fault: HungFault) -> Place {
    let at = |field| Place { index: Some(index), ..Place::of(field) };
    match fault {
        HungFault::Object(_) => at("request.hung.object"),
        HungFault::Position(position) => Place::of("request.hung.position").coordinate(Some(index), position),
        HungFault::Quaternion(_) => at("request.hung.quaternion"),
    }
}

fn params_place(error: ParamsError) -> Place {
    match error {
        ParamsError::OutOfRange { name, value, min, max } => Place { prefix: "params.", ..Place::of(name) }
            .value(f64::from(value))
            .range([f64::from(min), f64::from(max)]),
        ParamsError::Gravity { .. } => Place::of("params.gravity"),
        ParamsError::CentreOfMass { point } => {
            Place::of("params.given_centre_of_mass").coordinate(None, point)
        }
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Null { argument } => write!(f, "{argument} is null: pass a valid pointer"),
            Self::Misaligned { argument, alignment } => {
                write!(f, "{argument} is misaligned: its address must be a multiple of {alignment} bytes")
            }
            Self::StructSize { argument, given, expected } => write!(
                f,
                "{argument}: struct_size is {given}, expected {expected}: set it to sizeof the struct, and compile with the library's own header"
            ),
            Self::Version { given } => write!(
                f,
                "the program was compiled for version {given} of the interface, but the library has version {}: compile with the library's own header",
                crate::HANGPOSE_ABI_VERSION
            ),
            Self::Memory { argument, needed, given } => write!(
                f,
                "{argument} has {given} bytes, but {needed} are needed: call the size query with limits that hold the input"
            ),
            Self::Overlap { written, other } => {
                write!(f, "{written} overlaps {other}, which the call would overwrite: pass separate memory")
            }
            Self::Handle { argument, maker } => write!(
                f,
                "{argument} was never created by {maker}, or was moved or overwritten: call {maker} and keep the result in place"
            ),
            Self::Busy { argument } => {
                write!(f, "{argument} is in use by another thread: wait until that call has returned")
            }
            Self::Empty { argument } => {
                write!(f, "{argument} is empty because its last update was cancelled: update it again")
            }
            Self::Choice { field, value, most } => {
                write!(f, "{field} is {value}, but must be one of the values in hangpose.h, 0 to {most}")
            }
            Self::Count { field, count, most } => write!(f, "{field} is {count}, but must be 1 to {most}"),
            Self::Index { argument, index, count: 0 } => {
                write!(f, "{argument} is {index}, but there are no elements")
            }
            Self::Index { argument, index, count } => {
                write!(f, "{argument} is {index}, but must be less than {count}")
            }
            Self::Mesh(error) => error.fmt(f),
            Self::Cloud(error) => error.fmt(f),
            Self::Params(error) => error.fmt(f),
            Self::NoDistanceField => PredictError::NoDistanceField.fmt(f),
            Self::Request { error, .. } => error.fmt(f),
            Self::Hung { index, fault } => {
                write!(f, "object {index} of those that hang already ")?;
                match fault {
                    HungFault::Object(fault) => f.write_str(fault.text()),
                    HungFault::Position(position) => write!(
                        f,
                        "is at {position:?}: every coordinate must be a number of metres within ±{MAX_COORDINATE}"
                    ),
                    HungFault::Quaternion(quaternion) => write!(
                        f,
                        "has the quaternion {quaternion:?}: pass x, y, z, w of a rotation, which are numbers and not all 0"
                    ),
                }
            }
            Self::ManyHung { count } => write!(
                f,
                "request.hung_count is {count}, but must be 0 to {}: pass points of the surfaces of the others as request.scene_points",
                crate::HANGPOSE_MAX_HUNG
            ),
            Self::Listed { index, fault } => write!(f, "objects[{index}] {}", fault.text()),
            Self::NotSettled => f.write_str(
                "params.settle is 0, and without a release nothing keeps the objects apart: analyse the models with settle = 1, and pass those params",
            ),
            Self::Motion(error) => error.fmt(f),
            Self::Pose { spot } => write!(
                f,
                "{} is no part of a pose: pass metres within ±{MAX_COORDINATE} and the quaternion x, y, z, w of a rotation, which are numbers",
                spot.field
            ),
            Self::NoGoal { .. } => {
                f.write_str("the goal has no pose: pass one with has_pose = 1, a position and a quaternion")
            }
            Self::HungWithoutField { index } => PlanError::NoDistanceField { hung: Some(*index) }.fmt(f),
            Self::Waypoints { needed, given } => {
                PlanError::TooManyWaypoints { needed: *needed, given: *given }.fmt(f)
            }
            Self::Cancelled => f.write_str("cancelled"),
        }
    }
}

impl ObjectFault {
    /// Why an object cannot be shared.
    pub(crate) fn of(failure: &Failure) -> Self {
        match failure {
            Failure::Null { .. } => Self::Null,
            _ => Self::Handle,
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Null => "is null: pass an object of hangpose_object_create",
            Self::Handle => {
                "was never created by hangpose_object_create, or was moved or overwritten: create it and keep it in place"
            }
        }
    }
}

impl From<MeshError> for Failure {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error)
    }
}

impl From<CloudError> for Failure {
    fn from(error: CloudError) -> Self {
        Self::Cloud(error)
    }
}

impl From<ParamsError> for Failure {
    fn from(error: ParamsError) -> Self {
        Self::Params(error)
    }
}

impl From<OutOfMemory> for Failure {
    fn from(OutOfMemory { needed, given }: OutOfMemory) -> Self {
        Self::Memory { argument: "memory", needed, given }
    }
}

impl From<AnalysisError> for Failure {
    fn from(error: AnalysisError) -> Self {
        match error {
            AnalysisError::Params(error) => error.into(),
            AnalysisError::OutOfMemory(error) => error.into(),
            AnalysisError::Cancelled => Self::Cancelled,
        }
    }
}

impl From<PredictError> for Failure {
    fn from(error: PredictError) -> Self {
        match error {
            PredictError::Params(error) => error.into(),
            PredictError::OutOfMemory(error) => error.into(),
            PredictError::NoDistanceField => Self::NoDistanceField,
            PredictError::Release => Self::Pose { spot: Place::of("release").into() },
            // A request of a caller was checked before.
            PredictError::Request(error) => Self::Request { error, spot: Place::of("request").into() },
        }
    }
}

impl From<MotionError> for Failure {
    fn from(error: MotionError) -> Self {
        Self::Motion(error)
    }
}

impl From<PlanError> for Failure {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Params(error) => error.into(),
            PlanError::OutOfMemory(error) => error.into(),
            PlanError::Cancelled => Self::Cancelled,
            PlanError::NoDistanceField { hung: None } => Self::NoDistanceField,
            PlanError::NoDistanceField { hung: Some(index) } => Self::HungWithoutField { index },
            PlanError::TooManyWaypoints { needed, given } => Self::Waypoints { needed, given },
            // The request of a caller was checked before.
            PlanError::Request(error) => Self::Request { error, spot: Place::of("request").into() },
            PlanError::Motion(error) => error.into(),
            // Of a caller it is checked field by field before.
            PlanError::Goal => Self::Pose { spot: Place::of("goal").into() },
        }
    }
}

impl From<SamplingError> for Failure {
    fn from(error: SamplingError) -> Self {
        match error {
            SamplingError::TooMany { count, limit } => Self::Count { field: "count", count, most: limit },
            // C passes one count for both arrays.
            SamplingError::Lengths { points, normals } => {
                Self::Count { field: "count", count: normals, most: points }
            }
            SamplingError::OutOfMemory(error) => error.into(),
        }
    }
}
