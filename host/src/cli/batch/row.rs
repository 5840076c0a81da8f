//! Rows of the result: one for each pose, or one without a pose for a pair that has none.

use super::pairs::Pair;
use hangpose::geometry::Pose;
use hangpose::hanging::{HangingPose, Rejection};
use serde::{Deserialize, Serialize};

/// A row. Lengths are metres, angles radians. Poses map object to supporter coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Row {
    /// Number of the pair in its table, from 1.
    pub(super) pair: u64,
    pub(super) id: String,
    pub(super) object: String,
    pub(super) supporter: String,
    /// Rank of the pose, from 1.
    pub(super) rank: Option<u64>,
    /// Position and quaternion of the release pose.
    x: Option<f64>,
    y: Option<f64>,
    z: Option<f64>,
    qx: Option<f64>,
    qy: Option<f64>,
    qz: Option<f64>,
    qw: Option<f64>,
    /// Position and quaternion of the rest pose.
    rest_x: Option<f64>,
    rest_y: Option<f64>,
    rest_z: Option<f64>,
    rest_qx: Option<f64>,
    rest_qy: Option<f64>,
    rest_qz: Option<f64>,
    rest_qw: Option<f64>,
    kind: Option<String>,
    probability: Option<f64>,
    robustness: Option<f64>,
    tolerance_position: Option<f64>,
    tolerance_rotation: Option<f64>,
    sinking: Option<f64>,
    clearance: Option<f64>,
    /// The least of the tilts of the margin.
    tilt: Option<f64>,
    knock_speed: Option<f64>,
    jolt_time: Option<f64>,
    escape_rise: Option<f64>,
    unseen_object: Option<f64>,
    unseen_shadow: Option<f64>,
    unseen_supporter: Option<f64>,
    /// Cost of the published matching.
    cost: Option<f64>,
    /// Stage that left nothing, as the JSON of `predict` names it.
    pub(super) rejection: Option<String>,
    /// The same in words.
    reason: Option<String>,
    /// What is odd about the input.
    warning: Option<String>,
    /// Why the pair could not be predicted.
    pub(super) error: Option<String>,
}

/// Type of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Type {
    Integer,
    Number,
    Text,
}

/// Number of the first columns that every row has a value in.
pub(super) const REQUIRED: usize = 4;

/// The columns in order. A test compares them with [`Row`].
pub(super) const COLUMNS: [(&str, Type); 38] = [
    ("pair", Type::Integer),
    ("id", Type::Text),
    ("object", Type::Text),
    ("supporter", Type::Text),
    ("rank", Type::Integer),
    ("x", Type::Number),
    ("y", Type::Number),
    ("z", Type::Number),
    ("qx", Type::Number),
    ("qy", Type::Number),
    ("qz", Type::Number),
    ("qw", Type::Number),
    ("rest_x", Type::Number),
    ("rest_y", Type::Number),
    ("rest_z", Type::Number),
    ("rest_qx", Type::Number),
    ("rest_qy", Type::Number),
    ("rest_qz", Type::Number),
    ("rest_qw", Type::Number),
    ("kind", Type::Text),
    ("probability", Type::Number),
    ("robustness", Type::Number),
    ("tolerance_position", Type::Number),
    ("tolerance_rotation", Type::Number),
    ("sinking", Type::Number),
    ("clearance", Type::Number),
    ("tilt", Type::Number),
    ("knock_speed", Type::Number),
    ("jolt_time", Type::Number),
    ("escape_rise", Type::Number),
    ("unseen_object", Type::Number),
    ("unseen_shadow", Type::Number),
    ("unseen_supporter", Type::Number),
    ("cost", Type::Number),
    ("rejection", Type::Text),
    ("reason", Type::Text),
    ("warning", Type::Text),
    ("error", Type::Text),
];

impl Row {
    /// A row without a pose.
    fn empty(pair: &Pair) -> Self {
        Self {
            pair: pair.name.number,
            id: pair.name.id.clone(),
            object: pair.name.object.clone(),
            supporter: pair.name.supporter.clone(),
            ..Self::default()
        }
    }

    /// The row of a pair that could not be predicted.
    pub(super) fn failed(pair: &Pair, error: &str) -> Self {
        Self { error: Some(error.into()), ..Self::empty(pair) }
    }

    /// The row of a pair that has no pose. Without a rejection the search was stopped, which a batch never does.
    pub(super) fn rejected(pair: &Pair, rejection: Option<&Rejection>, warning: Option<&str>) -> Self {
        Self {
            rejection: rejection.map(|rejection| name(&rejection.stage)),
            reason: rejection.map(|rejection| rejection.stage.to_string()),
            warning: warning.map(String::from),
            ..Self::empty(pair)
        }
    }

    /// The row of a pose. The supporter's coordinates begin at `origin` in those of its file.
    pub(super) fn hung(
        pair: &Pair,
        rank: u64,
        pose: &HangingPose,
        origin: [f64; 3],
        warning: Option<&str>,
    ) -> Self {
        let rest = pose.rest.as_ref();
        let [x, y, z, qx, qy, qz, qw] = seven(Some(&pose.pose), origin);
        let [rest_x, rest_y, rest_z, rest_qx, rest_qy, rest_qz, rest_qw] =
            seven(rest.map(|rest| &rest.pose), origin);
        Self {
            rank: Some(rank),
            x,
            y,
            z,
            qx,
            qy,
            qz,
            qw,
            rest_x,
            rest_y,
            rest_z,
            rest_qx,
            rest_qy,
            rest_qz,
            rest_qw,
            kind: rest.map(|rest| name(&rest.kind)),
            probability: rest.and_then(|rest| number(rest.probability)),
            robustness: rest.and_then(|rest| number(rest.robustness)),
            tolerance_position: rest.and_then(|rest| number(rest.tolerance.position)),
            tolerance_rotation: rest.and_then(|rest| number(rest.tolerance.rotation)),
            sinking: rest.and_then(|rest| number(rest.sinking)),
            clearance: rest.and_then(|rest| number(rest.clearance)),
            tilt: rest.and_then(|rest| number(rest.margin.least_tilt())),
            knock_speed: rest.and_then(|rest| number(rest.margin.knock_speed)),
            jolt_time: rest.and_then(|rest| number(rest.margin.jolt_time)),
            escape_rise: rest.and_then(|rest| number(rest.margin.escape_rise)),
            unseen_object: rest.and_then(|rest| number(rest.unseen.object)),
            unseen_shadow: rest.and_then(|rest| number(rest.unseen.shadow)),
            unseen_supporter: rest.and_then(|rest| number(rest.unseen.supporter)),
            cost: pose.matched.and_then(|matched| number(matched.cost.total)),
            warning: warning.map(String::from),
            ..Self::empty(pair)
        }
    }
}

/// Position and quaternion, as the JSON of `predict` has them.
fn seven(pose: Option<&Pose>, origin: [f64; 3]) -> [Option<f64>; 7] {
    let Some(pose) = pose else { return [None; 7] };
    let [x, y, z] = <[f32; 3]>::from(pose.translation.vector);
    let [qx, qy, qz, qw] = <[f32; 4]>::from(pose.rotation.coords);
    let mut seven = [x, y, z, qx, qy, qz, qw].map(number);
    if origin != [0.0; 3] {
        for (place, (x, offset)) in seven.iter_mut().zip([x, y, z].into_iter().zip(origin)) {
            *place = Some(f64::from(x) + offset);
        }
    }
    seven
}

/// The number of the fewest digits that is this one in single precision: 0.1, not 0.10000000149011612.
fn number(x: f32) -> Option<f64> {
    x.is_finite().then(|| x.to_string().parse().ok()).flatten()
}

/// The name of a value in JSON.
fn name(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) => name,
        _ => String::new(),
    }
}
