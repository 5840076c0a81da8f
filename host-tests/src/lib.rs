//! Judges predicted poses: shapes of many kinds, dropped in two physics engines.

pub mod shapes;
pub mod solid;
