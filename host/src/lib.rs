//! Where and how to hang an object that a robot has never seen on a supporter that it has never seen, on a
//! computer with files and a heap.
//!
//! Everything of the core, [`hangpose_core`], is here as well; this crate adds [`files`] and the [`memory`]
//! that the core leaves to its caller. The command `hangpose` is made of it.
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
//! let prediction = predict_poses(&object, &supporter, &params, &mut poses, &monitor)?;
//! # Ok(())
//! # }
//! ```

mod analyze;
pub mod files;
pub mod parry;

pub use analyze::{LIMITS, TooLarge, analyze_object, analyze_supporter, predict_poses, sample_supporter};
pub use hangpose_core::*;

/// The README's Rust must compile.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
