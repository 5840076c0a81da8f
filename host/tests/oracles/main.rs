//! The core's queries against parry3d in double precision, which sees the same `f32` vertices but rounds 2^29 times
//! finer, and against brute force. A difference is the core's error.
//!
//! Errors are stated in roundings: `f32::EPSILON` times the largest coordinate or distance that takes part. That is
//! what `f32` can tell apart there, so a bound of a few holds at every scale and offset.

mod field;
mod files;
mod points;
mod random;
mod rays;
mod sampling;
mod shapes;
mod surface;
mod truth;
