//! hangpose for C and C++: the functions and structs of `include/hangpose.h`, over [`hangpose_core`].
//!
//! This crate is the only one with `unsafe`, and the only one that handles arguments from C. `border` converts
//! pointers into references or reports an error, `handle` keeps models in the caller's memory, and every public
//! function is a conversion between calls of these. The names and comments of this crate become the header, see
//! `examples/header`.
#![no_std]
// The names are those of the C interface.
#![allow(non_camel_case_types)]
// The obligations of the caller are the same for every function; the top of the header states them once.
#![allow(clippy::missing_safety_doc)]

mod border;
mod cloud;
mod depth_failure;
mod depth_image;
mod depth_points;
mod detail;
mod failure;
mod getter;
mod goal;
mod handle;
mod kind;
mod limits;
mod many;
mod mesh;
mod monitor;
mod motion;
mod motion_place;
mod object;
#[cfg(feature = "archive")]
mod panic;
mod params;
mod place;
mod plan;
mod plan_failure;
mod pose;
mod predict;
mod reachable;
mod region;
mod request;
mod sample;
mod slots;
mod status;
mod supporter;
mod threads;
mod version;
mod volume;
mod volume_settings;
mod waypoint;

pub use cloud::hangpose_cloud;
pub use depth_image::*;
pub use depth_points::*;
pub use detail::{HANGPOSE_FIELD_CHARS, HANGPOSE_MESSAGE_CHARS, HANGPOSE_NO_INDEX, hangpose_detail};
pub use kind::*;
pub use limits::*;
pub use many::{hangpose_many, hangpose_predict_many};
pub use mesh::hangpose_mesh;
pub use monitor::*;
pub use motion::{
    HANGPOSE_MAX_PARTS, hangpose_accepts, hangpose_capsule, hangpose_motion, hangpose_motion_init,
};
pub use object::*;
pub use params::*;
pub use plan::{hangpose_plan, hangpose_plan_path};
pub use plan_failure::*;
pub use pose::*;
pub use predict::{hangpose_predict, hangpose_prediction};
pub use reachable::hangpose_predict_reachable;
pub use region::*;
pub use request::{
    HANGPOSE_MAX_HUNG, HANGPOSE_MAX_SYMMETRIES, hangpose_hung, hangpose_request, hangpose_request_init,
};
pub use sample::{hangpose_mesh_sample, hangpose_sample_bytes};
pub use status::*;
pub use supporter::*;
pub use threads::*;
pub use version::*;
pub use volume::*;
pub use volume_settings::*;
pub use waypoint::hangpose_waypoint;
