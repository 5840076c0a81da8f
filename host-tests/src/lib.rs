//! Judges predicted poses: shapes of many kinds, dropped in two physics engines.

pub mod gallery;
pub mod judge;
pub mod shapes;
mod shell;
pub mod solid;
pub mod tables;
pub mod winding;
