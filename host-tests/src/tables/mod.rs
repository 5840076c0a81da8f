//! Predicts poses for many pairs, drops them, and says in tables what became of them.

mod calibration;
pub mod case;
pub mod proportion;
pub mod real;
pub mod report;
pub mod row;
pub mod run;
mod search;
