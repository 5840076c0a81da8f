//! The same bytes on every machine: hashes of predictions on the samples.
//!
//! A hash that changes says that the method's numbers changed, not that they are wrong. After a change that is meant,
//! take the new hash, and see that a Cortex-M7 gives it too.

use hangpose::hanging::HangingPose;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files, predict_poses};
use std::path::Path;

/// FNV-1a over the bits of the ten best poses of a profile.
fn hash(object: &str, supporter: &str, params: &Params) -> u32 {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mesh = files::read_mesh(&samples.join(object)).unwrap();
    let cloud = files::read_cloud(&samples.join(supporter)).unwrap();
    let (mut memory, mut more_memory, monitor) = (Vec::new(), Vec::new(), Monitor::new());
    let object = analyze_object(&mesh.mesh().unwrap(), params, &mut memory, &monitor).unwrap();
    let supporter = analyze_supporter(&cloud.cloud().unwrap(), params, &mut more_memory, &monitor).unwrap();
    let mut poses = [HangingPose::default(); 10];
    let poses = predict_poses(&object, &supporter, params, &mut poses, &monitor).unwrap().poses;
    assert_eq!(poses.len(), 10);
    let numbers = poses.iter().flat_map(|p| {
        [p.pose.translation.vector.as_slice(), p.pose.rotation.coords.as_slice(), &[p.cost.total]].concat()
    });
    numbers
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[test]
fn the_samples_give_the_same_bytes_everywhere() {
    let hashes = [
        hash("mug.obj", "mug_tree.ply", &Params::paper()),
        hash("scissors.obj", "hook.ply", &Params::paper()),
        hash("mug.obj", "hook.ply", &Params::default()),
    ];
    assert_eq!(hashes.map(|hash| format!("{hash:08x}")), ["ac613634", "e4d4535d", "b7b5c51f"]);
}
