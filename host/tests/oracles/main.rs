//! Compares the core's queries with brute force and with parry3d in double precision, which sees the same `f32`
//! vertices but rounds 2^29 times finer. A difference is an error of the core.
//!
//! The unit of errors is a rounding: `f32::EPSILON` times the largest coordinate or distance in the computation. This
//! is the resolution of `f32` there, so that one bound of a few roundings holds at every scale and offset.

mod field;
mod files;
mod points;
mod random;
mod rays;
mod sampling;
mod shapes;
mod surface;
mod truth;
