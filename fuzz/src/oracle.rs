//! What an answer must be, whatever was asked.

use hangpose::geometry::Pose;
use hangpose::hanging::{HangingPose, Prediction, Rest};
use hangpose::mechanics::Margin;
use hangpose::motion::{MAX_CLEARANCE, Motion, Path, Waypoint};

/// Deviation of the length of a unit vector or quaternion, for the rounding of a product of a thousand rotations.
pub(crate) const UNIT: f32 = 1e-3;

#[track_caller]
fn finite(what: &str, value: f32) {
    assert!(value.is_finite(), "{what} is {value}");
}

#[track_caller]
pub(crate) fn within(what: &str, value: f32, low: f32, high: f32) {
    assert!((low..=high).contains(&value), "{what} is {value}, not {low} to {high}");
}

#[track_caller]
fn unit(what: &str, vector: [f32; 3]) {
    let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
    assert!((length - 1.0).abs() < UNIT, "{what} {vector:?} is no unit vector");
}

#[track_caller]
fn unit_or_zero(what: &str, vector: [f32; 3]) {
    if vector != [0.0; 3] {
        unit(what, vector);
    }
}

/// A rigid motion of numbers.
#[track_caller]
pub(crate) fn is_rigid(what: &str, pose: &Pose) {
    assert!(pose.translation.vector.iter().all(|x| x.is_finite()), "{what} is at {:?}", pose.translation);
    let length = pose.rotation.coords.norm();
    assert!((length - 1.0).abs() < UNIT, "the rotation of {what} has the length {length}");
}

/// All that a prediction says is a number in the documented range.
pub(crate) fn check_prediction(prediction: &Prediction, settles: bool, least: f32) {
    if prediction.stopped.is_none() {
        assert_eq!(prediction.poses.is_empty(), prediction.rejection.is_some());
    }
    for pose in prediction.poses {
        check_pose(pose, settles, least);
    }
}

fn check_pose(pose: &HangingPose, settles: bool, least: f32) {
    is_rigid("a release pose", &pose.pose);
    assert_eq!(pose.rest.is_some(), settles);
    if let Some(rest) = &pose.rest {
        check_rest(rest, least);
    }
    if let Some(matched) = &pose.matched {
        let text = format!("{matched:?}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}

fn check_rest(rest: &Rest, least: f32) {
    is_rigid("a rest pose", &rest.pose);
    finite("the sinking", rest.sinking);
    within("the clearance", rest.clearance, 0.0, 0.01 + 1e-6);
    within("the tolerance of the position", rest.tolerance.position, 0.0, 0.01);
    finite("the tolerance of the rotation", rest.tolerance.rotation);
    within("the probability", rest.probability, least, 1.0);
    within("the robustness", rest.robustness, 0.0, 1.0);
    within("the unseen part of the object", rest.unseen.object, 0.0, 1.0);
    within("the part in the shadow", rest.unseen.shadow, 0.0, 1.0);
    within("the unseen part of the supporter", rest.unseen.supporter, 0.0, 1.0);
    unit_or_zero("the view of the object", rest.unseen.object_view);
    unit_or_zero("the view of the supporter", rest.unseen.supporter_view);
    let margin = &rest.margin;
    for tilt in margin.tilts {
        within("a tilt", tilt, 0.0, Margin::MOST_TILT);
    }
    within("the jolt time", margin.jolt_time, 0.0, Margin::MOST_JOLT_TIME);
    for (what, value) in [
        ("the sinking of a tilted object", margin.tilted_sinking),
        ("the rise of an escape", margin.escape_rise),
        ("the ratio of an escape", margin.escape_ratio),
        ("the speed of a knock", margin.knock_speed),
        ("the radius of the centre of mass", margin.centre_of_mass_radius),
    ] {
        within(what, value, 0.0, f32::MAX);
    }
    for contact in rest.contacts() {
        assert!(contact.position.iter().all(|x| x.is_finite()));
        unit("a contact normal", contact.normal.into());
        within("a contact force", contact.force, 0.0, f32::MAX);
    }
}

/// A path is a sequence of rigid poses in time, with the release pose among them.
pub(crate) fn check_path(path: &Path, motion: &Motion) {
    assert!(path.release < path.object.len());
    assert_eq!(path.gripper.is_empty(), motion.gripper.is_none());
    // Where there is no room it may be next to nothing, but never a penetration.
    within("the clearance of a path", path.clearance, 0.0, MAX_CLEARANCE);
    for list in [path.object, path.gripper] {
        for waypoint in list {
            is_rigid("a waypoint", &waypoint.pose);
            within("the time of a waypoint", waypoint.seconds, 0.0, f32::MAX);
        }
        let is_ordered = |pair: &[Waypoint]| pair[0].seconds <= pair[1].seconds;
        assert!(list.windows(2).all(is_ordered), "the times of a path do not grow");
    }
}
