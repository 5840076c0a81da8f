//! Problems of motion, whose answers are known by construction, and what the planner makes of them.

pub mod enclosed;
pub mod grip;
pub mod ompl;
pub mod problem;
pub mod report;
pub mod row;
pub mod run;
pub mod surroundings;
pub mod tree;
