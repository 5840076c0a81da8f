//! hangpose for C and C++: the functions and structs of `include/hangpose.h`, over [`hangpose_core`].
//!
//! This crate is the only one with `unsafe`. What C hands over is met here and nowhere else: `border` turns pointers
//! into references or says what is wrong with them, `handle` keeps models in the caller's memory, and every function
//! is a conversion between two calls of these. Names and comments end up in the header, see `examples/header.rs`.
#![no_std]
// The names are those that C sees.
#![allow(non_camel_case_types)]
// What a caller has to see to is the same for every function, and said once, at the top of the header.
#![allow(clippy::missing_safety_doc)]

mod border;
mod cloud;
mod detail;
mod failure;
mod getter;
mod handle;
mod limits;
mod mesh;
mod monitor;
mod object;
#[cfg(feature = "archive")]
mod panic;
mod params;
mod pose;
mod predict;
mod sample;
mod status;
mod supporter;
mod version;

pub use cloud::hangpose_cloud;
pub use detail::{HANGPOSE_FIELD_CHARS, HANGPOSE_MESSAGE_CHARS, HANGPOSE_NO_INDEX, hangpose_detail};
pub use limits::*;
pub use mesh::hangpose_mesh;
pub use monitor::*;
pub use object::*;
pub use params::*;
pub use pose::*;
pub use predict::{hangpose_predict, hangpose_prediction};
pub use sample::{hangpose_mesh_sample, hangpose_sample_bytes};
pub use status::*;
pub use supporter::*;
pub use version::*;
