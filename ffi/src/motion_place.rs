use crate::place::Place;
use hangpose_core::motion::MotionError;

/// Where in a motion the error is.
pub(crate) fn motion_place(error: MotionError) -> Place {
    match error {
        // The start was checked before.
        MotionError::Start => Place::of("motion.has_start"),
        MotionError::Part { part } => Place { index: Some(part), ..Place::of("motion.parts") },
        MotionError::NoParts => Place::of("motion.part_count"),
        MotionError::Retreat => Place::of("motion.retreat"),
        MotionError::Workspace => Place::of("motion.workspace_low"),
        MotionError::Value { name, value, min, max } => {
            Place::of(field(name)).value(f64::from(value)).range([f64::from(min), f64::from(max)])
        }
        MotionError::Count { name, value, min, max } => {
            Place::of(field(name)).value(value as f64).range([min as f64, max as f64])
        }
    }
}

/// The field in C for a field of the core.
fn field(name: &str) -> &'static str {
    match name {
        "clearance" => "motion.clearance",
        "step.position" => "motion.step_position",
        "step.rotation" => "motion.step_rotation",
        "speed.linear" => "motion.speed",
        "speed.angular" => "motion.angular_speed",
        "speed.linear_acceleration" => "motion.acceleration",
        "speed.angular_acceleration" => "motion.angular_acceleration",
        "samples" => "motion.samples",
        "nodes" => "motion.nodes",
        _ => "motion",
    }
}
