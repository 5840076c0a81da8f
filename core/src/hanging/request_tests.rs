//! What is asked for is what is given, or the rejection says which wish was the reason.

use super::tests::{Scene, product};
use super::*;
use crate::geometry::{Point, Pose};
use crate::mechanics::{Kind, Kinds};
use crate::{Monitor, Params};
use std::vec::Vec;

/// Middle of the peg of [`Scene::ring_on_peg`], which is along x and 0.1 m long.
const MIDDLE: [f32; 3] = [0.3, -0.2, 0.5];

/// The poses of a ring on a peg, or the stage that left none.
fn predict_as(request: &Request) -> Result<Vec<HangingPose>, Stage> {
    let params = Params { settle_attempts: 24, ..product() };
    let mut found = Ok(Vec::new());
    Scene::ring_on_peg(0.0).analyse(&params, &Monitor::new(), |object, supporter| {
        let mut poses = [HangingPose::default(); 10];
        let memory = &mut vec![0; predict_bytes(&supporter.limits())];
        let prediction =
            predict(object, supporter, request, &params, &mut poses, memory, &Monitor::new()).unwrap();
        found = prediction.rejection.map_or(Ok(prediction.poses.to_vec()), |rejection| Err(rejection.stage));
    });
    found
}

fn rest(pose: &HangingPose) -> Rest {
    pose.rest.unwrap()
}

#[test]
fn a_ring_hangs_where_it_is_asked_for() {
    let here = [[MIDDLE[0] + 0.035, MIDDLE[1], MIDDLE[2]]];
    let near = |points: &'static [[f32; 3]]| Region::Points { points, indices: None, radius: 0.012 };
    for on in [
        Region::Points { points: &here, indices: None, radius: 0.012 },
        Region::Box { low: [0.32, -0.3, 0.4], high: [0.36, -0.1, 0.6] },
    ] {
        let poses = predict_as(&Request { on, ..Request::ANY }).unwrap();
        for contact in poses.iter().flat_map(|pose| rest(pose).contacts().to_vec()) {
            assert!((0.3175..0.3525).contains(&contact.position.x), "{contact:?}");
        }
    }
    let nowhere = Request { on: near(&[[0.0; 3]]), ..Request::ANY };
    assert_eq!(predict_as(&nowhere), Err(Stage::OutsideRegion));
    // All of the ring is farther than this from its centre.
    let by_nothing = Request { by: near(&[[0.0; 3]]), ..Request::ANY };
    assert_eq!(predict_as(&by_nothing), Err(Stage::OutsideRegion));
}

#[test]
fn only_kinds_that_are_allowed_are_given() {
    let poses = predict_as(&Request::ANY).unwrap();
    assert!(poses.iter().all(|pose| rest(pose).kind == Kind::Threaded), "{poses:?}");
    let others = Request { allow: Kinds::of(&[Kind::Hooked, Kind::Capped]), ..Request::ANY };
    assert_eq!(predict_as(&others), Err(Stage::OtherKind));
}

#[test]
fn a_ring_does_not_touch_the_scene() {
    // Points all around the peg, where any ring would be, but for its last three centimetres.
    let around = |limit: f32| -> Vec<[f32; 3]> {
        let offsets = (0..60 * 20 * 20).map(|i| [i / 400, i / 20 % 20, i % 20].map(|k| k as f32));
        let places = offsets.map(|[x, y, z]| [0.23 + 0.002 * x, -0.26 + 0.006 * y, 0.42 + 0.006 * z]);
        places.filter(|p| p[0] < limit && (p[1] + 0.2).hypot(p[2] - 0.5) > 0.02).collect()
    };
    let free_end = around(0.32);
    let poses = predict_as(&Request { scene: &free_end, ..Request::ANY }).unwrap();
    assert!(poses.iter().all(|pose| (rest(pose).pose * Point::origin()).x > 0.32), "{poses:?}");
    assert_eq!(predict_as(&Request { scene: &around(0.4), ..Request::ANY }), Err(Stage::InScene));
}

#[test]
fn a_ring_comes_onto_the_peg_along_it() {
    let from = |direction: [f32; 3]| {
        let approach = Some(Approach { direction, angle: 0.02, length: 0.12 });
        predict_as(&Request { approach, ..Request::ANY })
    };
    assert!(from([1.0, 0.0, 0.0]).is_ok() && from([-2.0, 0.0, 0.0]).is_ok());
    for direction in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]] {
        assert_eq!(from(direction), Err(Stage::NoApproach), "{direction:?}");
    }
}

#[test]
fn poses_are_as_distinct_as_asked() {
    let distinct = Distance { position: 0.04, rotation: 0.0 };
    let request = Request { distinct, ..Request::ANY };
    let params = Params { firm_enough: 1000, ..product() };
    Scene::key_on_peg().analyse(&params, &Monitor::new(), |object, supporter| {
        let mut poses = [HangingPose::default(); 20];
        let memory = &mut vec![0; predict_bytes(&supporter.limits())];
        let found =
            predict(object, supporter, &request, &params, &mut poses, memory, &Monitor::new()).unwrap();
        let alike = |a: &Rest, b: &Rest| {
            let [a_centre, b_centre] = [a, b].map(|rest| rest.pose * object.centre_of_mass());
            a.kind == b.kind
                && (a_centre - b_centre).norm() < distinct.position
                && a.pose.rotation.angle_to(&b.pose.rotation) < distinct.rotation
        };
        for (k, pose) in found.poses.iter().enumerate() {
            assert!(found.poses[..k].iter().all(|other| !alike(&rest(pose), &rest(other))));
        }
    });
}

#[test]
fn several_rings_hang_beside_each_other() {
    Scene::ring_on_peg(0.0).analyse(&product(), &Monitor::new(), |object, supporter| {
        let rings = [object; 4];
        let mut poses = [None; 4];
        let memory = &mut vec![0; predict_bytes(&supporter.limits())];
        let (request, params, monitor) = (Request::ANY, product(), Monitor::new());
        let many = predict_many(&rings, supporter, &request, &params, &mut poses, memory, &monitor).unwrap();
        assert_eq!((many.placed, many.rejection, many.stopped), (4, None, None));
        let rests: Vec<Pose> = poses.iter().flatten().map(|pose| rest(pose).pose).collect();
        for (k, a) in rests.iter().enumerate() {
            for b in &rests[..k] {
                let between = object.frame() * b.inverse() * a * object.frame().inverse();
                let corners = object.surface().triangles().iter().flatten();
                let least = corners.map(|corner| object.surface().signed_distance(&(between * corner)));
                assert!(least.fold(f32::INFINITY, f32::min) > 0.0, "rings {k} and another overlap");
            }
        }
    });
}

#[test]
fn a_broken_request_says_what_is_wrong() {
    let text = |request: Request| request.validate().unwrap_err().to_string();
    assert!(text(Request { allow: Kinds::NONE, ..Request::ANY }).contains("no kind"));
    let upside_down = Region::Box { low: [1.0; 3], high: [0.0; 3] };
    assert!(text(Request { on: upside_down, ..Request::ANY }).contains("region of the supporter is empty"));
    let approach = Some(Approach { direction: [0.0; 3], angle: 0.1, length: 0.1 });
    assert!(text(Request { approach, ..Request::ANY }).contains("approach"));
    let scene = &[[0.0; 3], [0.0, f32::NAN, 0.0]];
    assert!(text(Request { scene, ..Request::ANY }).contains("point 1 of the scene"));
    let distinct = Distance { position: -1.0, rotation: 0.1 };
    assert!(text(Request { distinct, ..Request::ANY }).contains("distance between poses"));
}
