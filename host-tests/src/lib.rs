//! Judges predicted poses: shapes of many kinds, dropped in two physics engines.

pub mod gallery;
pub mod judge;
pub mod shapes;
pub mod solid;
pub mod tables;
