//! Predicts poses for many pairs, simulates their release, and tabulates the outcomes.

mod calibration;
pub mod case;
mod cause;
mod kinds;
mod loss;
pub mod proportion;
pub mod real;
pub mod report;
pub mod row;
pub mod run;
pub mod scans;
pub mod search;
mod seen;
