//! A collision-free way of an object to the pose in which it hangs, and away from it.
//!
//! [`plan`] plans for one pose, [`predict_reachable`] walks the ranking of a prediction until a pose has a path. A
//! [`Task`] says what moves among what; the answer is a [`Path`] or a [`PlanFailure`].

mod certify;
mod clearance;
mod enclosed;
mod end;
mod error;
mod exits;
mod failure;
mod gripper;
mod leave;
mod lower;
mod path;
mod permit;
mod placement;
mod plan;
mod pull;
mod reachable;
mod route;
mod sample;
mod search;
mod shorten;
mod slide;
mod space;
mod task;
#[cfg(test)]
mod tests;
mod timing;
mod tree;
mod widen;
mod written;

pub use clearance::Clearance;
pub use error::PlanError;
pub use failure::{Collision, Mover, Obstacle, PlanFailure};
pub use gripper::{Capsule, Gripper};
pub use path::{MAX_CLEARANCE, Path, Plan, PlanCounts, Waypoint};
pub use plan::{plan, plan_bytes};
pub use reachable::{Reachable, predict_reachable, reachable_bytes};
pub use task::{Motion, MotionError, Speed, Task};
