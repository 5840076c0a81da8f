//! Hashes of predictions on the samples, which are the same on every machine.
//!
//! A changed hash means that the method's numbers changed, not that they are wrong. After an intended change, use the
//! new hash, which the failing test prints, and check that a Cortex-M7 gives it too.

use hangpose::hanging::{HangingPose, Request, Rest};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, files, predict_poses};
use std::path::Path;

/// FNV-1a hash over the bits of the ten best poses of a profile and of their fields.
fn hash(object: &str, supporter: &str, params: &Params) -> String {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mesh = files::read_mesh(&samples.join(object)).unwrap();
    let cloud = files::read_cloud(&samples.join(supporter)).unwrap();
    let (mut memory, mut more_memory, monitor) = (Vec::new(), Vec::new(), Monitor::new());
    let object = analyze_object(&mesh.mesh().unwrap(), params, &mut memory, &monitor).unwrap();
    let supporter = analyze_supporter(&cloud.cloud().unwrap(), params, &mut more_memory, &monitor).unwrap();
    let mut poses = [HangingPose::default(); 10];
    let poses =
        predict_poses(&object, &supporter, &Request::ANY, params, &mut poses, &monitor).unwrap().poses;
    assert!(!poses.is_empty());
    let hash = poses
        .iter()
        .flat_map(numbers)
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    format!("{hash:08x}")
}

/// All numbers of a pose.
fn numbers(pose: &HangingPose) -> Vec<f32> {
    let of_pose = |pose: &hangpose::geometry::Pose| {
        [pose.translation.vector.as_slice(), pose.rotation.coords.as_slice()].concat()
    };
    let mut numbers = of_pose(&pose.pose);
    numbers.extend(pose.matched.map(|matched| matched.cost.total));
    if let Some(rest) = &pose.rest {
        let Rest { kind, sinking, clearance, tolerance, probability, robustness, margin, .. } = rest;
        numbers.extend(of_pose(&rest.pose));
        numbers.extend([*sinking, *clearance, *probability, *robustness, margin.escape_rise]);
        numbers.extend([*kind as u8 as f32, tolerance.position, tolerance.rotation]);
        numbers.extend(margin.tilts);
        numbers
            .extend(rest.contacts().iter().flat_map(|c| [c.position.x, c.position.y, c.position.z, c.force]));
    }
    numbers
}

#[test]
fn the_paper_gives_the_same_bytes_everywhere() {
    let pairs = [("mug.obj", "mug_tree.ply", "57b3ab46"), ("scissors.obj", "hook.ply", "30fe0f3f")];
    for (object, supporter, expected) in pairs {
        assert_eq!(hash(object, supporter, &Params::paper()), expected, "{object} on {supporter}");
    }
}

#[test]
fn the_default_gives_the_same_bytes_everywhere() {
    let pairs = [("mug.obj", "hook.ply", "6ef62492"), ("scissors.obj", "mug_tree.ply", "66e32234")];
    // All hashes are compared at once, so that one run prints all new ones.
    let found =
        pairs.map(|(object, supporter, _)| (object, supporter, hash(object, supporter, &Params::default())));
    assert_eq!(found, pairs.map(|(object, supporter, expected)| (object, supporter, expected.to_string())));
}
