//! Predicts poses for many pairs, simulates their release, and tabulates the outcomes.

mod calibration;
pub mod case;
pub mod proportion;
pub mod real;
pub mod report;
pub mod row;
pub mod run;
mod search;
