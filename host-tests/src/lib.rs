//! Evaluates predicted poses: generates objects and supporters of many kinds and simulates the release in two physics
//! engines.

pub mod film;
pub mod gallery;
pub mod judge;
pub mod performance;
mod predicted;
pub mod reach;
pub mod scan;
pub mod shapes;
mod shell;
pub mod solid;
pub mod tables;
pub mod winding;

pub use predicted::predicted;
