//! Predictions from shapes in one call.

use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{HangingPose, Request};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses};

/// The best `count` poses of an object on a supporter, best first.
///
/// # Panics
///
/// If the request or the params are invalid.
pub fn predicted(
    mesh: &Mesh,
    cloud: &Cloud,
    request: &Request,
    params: &Params,
    count: usize,
) -> Vec<HangingPose> {
    let monitor = Monitor::new();
    let (mut memory, mut more_memory) = (Vec::new(), Vec::new());
    let object = analyze_object(mesh, params, &mut memory, &monitor).expect("memory is enough");
    let supporter = analyze_supporter(cloud, params, &mut more_memory, &monitor).expect("memory is enough");
    let mut poses = vec![HangingPose::default(); count];
    let prediction = predict_poses(&object, &supporter, request, params, &mut poses, &monitor);
    prediction.expect("the request and the params are valid").poses.to_vec()
}
