//! What gravity does to an object that is let go: contact, friction, rest, and how firmly it stays.

mod body;
mod clearance;
mod contact;
mod release;
mod settle;
mod solver;
mod tilt;

pub use body::Body;
pub use clearance::is_clear;
pub use contact::{DEBUG, Near, Support};
pub use release::release_pose;
pub use tilt::tilt;
pub use settle::{Fate, Settings, Settled, settle};
