//! Where and how to hang an object that a robot has never seen on a supporter that it has never seen.
//!
//! The core of hangpose: no heap, no operating system, no training data, no `unsafe`. All memory is the
//! caller's; inputs and outputs are `f32` in SI units, and the same inputs give the same bytes on every machine.
//!
//! Data flows one way:
//!
//! ```text
//! Mesh  ──► hanging::Object    ──┐
//!                                ├─► hanging::predict ─► HangingPose, best first, or a Rejection
//! Cloud ──► hanging::Supporter ──┘
//!
//! HangingPose ──► motion::plan ─► Path, or a PlanFailure
//! ```
//!
//! An [`Object`](hanging::Object) and a [`Supporter`](hanging::Supporter) are analysed once, immutable, and
//! may be shared between threads and matched as often as needed.
//!
//! ```
//! use hangpose_core::{Monitor, Params, geometry::{Cloud, Mesh}, hanging::*, memory::Limits};
//! # fn turn(step: u32, steps: u32) -> (f32, f32) {
//! #     (std::f32::consts::TAU * step as f32 / steps as f32).sin_cos()
//! # }
//! # let (rows, columns) = (48, 16);
//! # // A ring of 3 cm radius, 6 mm thick.
//! # let vertices: Vec<[f32; 3]> = (0..rows * columns).map(|i| {
//! #     let ((s, c), (u, v)) = (turn(i / columns, rows), turn(i % columns, columns));
//! #     let radius = 0.03 + 0.003 * v;
//! #     [radius * c, radius * s, 0.003 * u]
//! # }).collect();
//! # let triangles: Vec<[u32; 3]> = (0..rows * columns).flat_map(|i| {
//! #     let at = |row: u32, column: u32| row % rows * columns + column % columns;
//! #     let (r, k) = (i / columns, i % columns);
//! #     let [a, b, c, d] = [at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1)];
//! #     [[a, b, c], [a, c, d]]
//! # }).collect();
//! # // A peg of 4 mm radius along y, 8 cm long.
//! # let normals: Vec<[f32; 3]> = (0..2400).map(|i| {
//! #     let (s, c) = turn(i % 30, 30);
//! #     [s, 0.0, c]
//! # }).collect();
//! # let points: Vec<[f32; 3]> = normals.iter().zip(0..)
//! #     .map(|(n, i)| [0.004 * n[0], 0.001 * (i / 30) as f32, 0.004 * n[2]]).collect();
//!
//! let params = Params::default();
//! let monitor = Monitor::new();
//!
//! let mesh = Mesh::new(&vertices, &triangles)?;
//! let limits = Limits {
//!     vertices: vertices.len(),
//!     triangles: triangles.len(),
//!     samples: params.samples,
//!     voxels: params.voxels,
//!     points: points.len(),
//! };
//! let mut memory = vec![0; Object::bytes(&limits)];
//! let object = Object::analyze(&mesh, &params, &mut memory, &monitor)?;
//!
//! let cloud = Cloud::new(&points, Some(&normals))?;
//! let mut memory = vec![0; Supporter::bytes(&limits)];
//! let supporter = Supporter::analyze(&cloud, &params, &mut memory, &monitor)?;
//!
//! let mut poses = [HangingPose::default(); 10];
//! let mut memory = vec![0; predict_bytes(&limits)];
//! let prediction = predict(&object, &supporter, &Request::ANY, &params, &mut poses, &mut memory, &monitor)?;
//! assert!(prediction.rejection.is_none());
//! println!("best: {}", poses[0].pose);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! "The paper" in these pages is *I Get the Hang of It! A Learning-Free Method to Predict Hanging Poses for
//! Previously Unseen Objects*, IEEE Robotics and Automation Letters, 2024, doi:10.1109/LRA.2024.3368297.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod best;
mod disjoint_sets;
pub mod geometry;
pub mod hanging;
mod heap;
pub mod mechanics;
pub mod memory;
mod monitor;
pub mod motion;
mod params;
pub mod perception;
mod random;
mod sort;
#[cfg(test)]
mod test_shapes;

pub use monitor::{Monitor, Stop, Threads, Work};
pub use params::{Candidates, CentreOfMass, Params, ParamsError};
