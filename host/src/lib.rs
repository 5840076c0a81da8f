//! Predicts hanging poses of unknown objects on unknown supporters, on a computer with files and a heap.
//!
//! This crate re-exports the core, [`hangpose_core`]. It adds readers of [`files`] and allocates the [`memory`] that
//! the core takes from its caller. The command `hangpose` is built on it.
//!
//! ```no_run
//! use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files, hanging, predict_poses};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (params, monitor) = (Params::default(), Monitor::new());
//! let (mug, hook) = (files::read_mesh("samples/mug.obj".as_ref())?, files::read_cloud("samples/hook.ply".as_ref())?);
//! let (mut memory, mut more_memory) = (Vec::new(), Vec::new());
//! let object = analyze_object(&mug.mesh()?, &params, &mut memory, &monitor)?;
//! let supporter = analyze_supporter(&hook.cloud()?, &params, &mut more_memory, &monitor)?;
//! let mut poses = [hanging::HangingPose::default(); 10];
//! let prediction = predict_poses(&object, &supporter, &hanging::Request::ANY, &params, &mut poses, &monitor)?;
//! # Ok(())
//! # }
//! ```

mod analyze;
pub mod files;
pub mod parry;
mod scan;
mod threads;
pub mod view;

pub use analyze::{LIMITS, TooLarge, analyze_object, analyze_supporter, predict_poses, sample_supporter};
pub use hangpose_core::*;
pub use scan::{
    CLOUD_VOXEL, FAIR_AGREEMENT, FuseError, ScannedCloud, ScannedMesh, complete_scan, scan, scan_cloud,
    suggested_voxel,
};
pub use threads::ScopedThreads;

/// Compiles the Rust code of the book.
#[cfg(doctest)]
#[doc = include_str!("../../docs/book/rust.md")]
struct Book;
