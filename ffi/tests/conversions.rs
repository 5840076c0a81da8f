//! Tests the conversions from the core's types to the C structs with a different value in every field.

use hangpose::geometry::{Point, Pose, Vector};
use hangpose::hanging::sites::{self, Cost, SiteMatch};
use hangpose::hanging::{
    Counts, HangingPose, Prediction, Rejection, Request, Rest, SearchCounts, SettlingCounts, Stage,
    Tolerance, contacts,
};
use hangpose::mechanics::{Contact, Kind, Margin, Unseen};
use hangpose::motion::{self, Collision, Mover, Obstacle, Plan, PlanCounts, PlanFailure, Waypoint};
use hangpose::{Monitor, Params, Stop, Work, analyze_object, analyze_supporter, files, predict_poses};
use hangpose_ffi::*;
use std::path::Path;

#[test]
fn every_count_of_a_prediction_reaches_its_field() {
    let poses = [HangingPose::default(); 2];
    let settling = SettlingCounts {
        released: 23,
        rotated_off: 24,
        slid_off: 25,
        moving: 26,
        at_rest: 27,
        wedged: 28,
        unseen: 31,
        probable: 29,
        firm: 30,
        firm_as_preferred: 32,
        in_scene: 33,
        outside: 34,
        other_kind: 35,
        no_approach: 36,
        sparse: 37,
    };
    let candidates = contacts::CandidateCounts { made: 21, clear: 22 };
    let search = SearchCounts::Contacts(contacts::Counts { candidates, ..Default::default() });
    let counts = Counts { search, settling };
    let found = Prediction {
        poses: &poses,
        rejection: Some(Rejection { stage: Stage::SlidesOff, counts }),
        stopped: Some(Stop::WorkLimit),
        counts,
        work: Work { rays: 1 << 40, distance_queries: 1 << 41 },
    };
    let c = hangpose_prediction::from(&found);
    assert_eq!(c.struct_size as usize, size_of::<hangpose_prediction>());
    assert_eq!((c.pose_count, c.stage, c.stopped), (2, HANGPOSE_STAGE_SLIDES_OFF, HANGPOSE_WORK_LIMIT));
    assert_eq!([c.matching_pairs, c.matching_fitting, c.matching_clear], [0; 3]);
    assert_eq!([c.settling_candidates, c.settling_clear, c.settling_released], [21, 22, 23]);
    assert_eq!([c.settling_rotated_off, c.settling_slid_off, c.settling_moving], [24, 25, 26]);
    assert_eq!([c.settling_at_rest, c.settling_wedged, c.settling_unseen], [27, 28, 31]);
    assert_eq!([c.settling_probable, c.settling_firm, c.settling_firm_as_preferred], [29, 30, 32]);
    assert_eq!([c.settling_in_scene, c.settling_outside], [33, 34]);
    assert_eq!([c.settling_other_kind, c.settling_no_approach, c.settling_sparse], [35, 36, 37]);
    assert_eq!([c.rays, c.distance_queries], [1 << 40, 1 << 41]);

    let matching = sites::MatchingCounts { pairs: 11, fitting: 12, clear: 13 };
    let search = SearchCounts::Sites(sites::Counts { matching, ..Default::default() });
    let c = hangpose_prediction::from(&Prediction { counts: Counts { search, settling }, ..found });
    assert_eq!([c.matching_pairs, c.matching_fitting, c.matching_clear], [11, 12, 13]);
    assert_eq!([c.settling_candidates, c.settling_clear, c.settling_released], [0, 0, 23]);

    let hung = hangpose_prediction::from(&Prediction { rejection: None, stopped: None, ..found });
    assert_eq!((hung.stage, hung.stopped), (HANGPOSE_STAGE_NONE, HANGPOSE_OK));
}

#[test]
fn every_number_of_a_pose_reaches_its_field() {
    let margin = Margin {
        tilts: [0.18, 0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17],
        jolt_time: 0.21,
        tilted_sinking: 0.22,
        escape_rise: 0.23,
        escape_ratio: 0.24,
        knock_speed: 0.25,
        centre_of_mass_radius: 0.26,
    };
    let pose = Pose::new(Vector::new(1.0, 2.0, 3.0), Vector::new(0.1, 0.2, 0.3));
    let rest_pose = Pose::new(Vector::new(4.0, 5.0, 6.0), Vector::new(0.4, 0.5, 0.6));
    // The contacts of a rest are private, so they come from a prediction.
    let mut rest = a_rest();
    (rest.pose, rest.margin) = (rest_pose, margin);
    (rest.sinking, rest.clearance, rest.probability, rest.robustness) = (0.31, 0.32, 0.33, 0.36);
    (rest.kind, rest.tolerance) = (Kind::Capped, Tolerance { position: 0.37, rotation: 0.38 });
    rest.unseen = Unseen {
        object: 0.34,
        shadow: 0.35,
        supporter: 0.36,
        object_view: [0.6, 0.8, 0.0],
        supporter_view: [0.0, 0.6, 0.8],
    };
    let cost = Cost { collision: 41, boundary: 0.42, contact_area: 0.43, total: 0.44 };
    let matched = SiteMatch { cost, object_site: 45, support_site: 46, is_reversed: true };
    let c = hangpose_pose::from(&HangingPose { pose, rest: Some(rest), matched: Some(matched) });

    assert_eq!(c.struct_size as usize, size_of::<hangpose_pose>());
    assert_eq!((c.position, c.quaternion), ([1.0, 2.0, 3.0], xyzw(&pose)));
    assert_eq!((c.rest_position, c.rest_quaternion), ([4.0, 5.0, 6.0], xyzw(&rest_pose)));
    assert_eq!((c.unseen_object, c.unseen_shadow, c.unseen_supporter), (0.34, 0.35, 0.36));
    assert_eq!((c.object_view, c.supporter_view), ([0.6, 0.8, 0.0], [0.0, 0.6, 0.8]));
    assert_eq!((c.has_rest, c.sinking, c.clearance), (1, 0.31, 0.32));
    assert_eq!((c.probability, c.robustness), (0.33, 0.36));
    assert_eq!((c.kind, c.tolerance_position, c.tolerance_rotation), (HANGPOSE_KIND_CAPPED, 0.37, 0.38));
    let m = c.margin;
    assert_eq!((m.tilts, m.least_tilt), (margin.tilts, 0.11));
    assert_eq!([m.jolt_time, m.tilted_sinking], [0.21, 0.22]);
    assert_eq!([m.escape_rise, m.escape_ratio], [0.23, 0.24]);
    assert_eq!([m.knock_speed, m.centre_of_mass_radius], [0.25, 0.26]);
    assert_eq!((c.is_matched, c.object_site, c.support_site, c.is_reversed), (1, 45, 46, 1));
    assert_eq!((c.collision, c.boundary, c.contact_area, c.total), (41, 0.42, 0.43, 0.44));

    let contacts = rest.contacts();
    assert!(!contacts.is_empty());
    assert_eq!(c.contact_count as usize, contacts.len());
    for (index, found) in c.contacts.iter().enumerate() {
        let expected = contacts.get(index).copied().unwrap_or_default();
        assert_eq!(found.position, <[f32; 3]>::from(expected.position));
        assert_eq!(found.normal, <[f32; 3]>::from(expected.normal));
        assert_eq!(found.force, expected.force);
    }
}

#[test]
fn every_number_of_a_contact_reaches_its_field() {
    let (position, normal) = (Point::new(1.0, 2.0, 3.0), Vector::new(4.0, 5.0, 6.0));
    let c = hangpose_contact::from(&Contact { position, normal, force: 7.0 });
    assert_eq!((c.position, c.normal, c.force), ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], 7.0));
}

#[test]
fn a_pose_without_rest_and_match_says_so() {
    let c = hangpose_pose::from(&HangingPose::default());
    assert_eq!((c.position, c.quaternion), ([0.0; 3], [0.0, 0.0, 0.0, 1.0]));
    assert_eq!((c.has_rest, c.kind, c.contact_count, c.is_matched), (0, 0, 0, 0));
    let (p, q, m) = (c.rest_position, c.rest_quaternion, c.margin);
    let rest =
        [c.probability, c.robustness, c.sinking, c.clearance, m.least_tilt, m.jolt_time, m.tilted_sinking]
            .into_iter()
            .chain([m.escape_rise, m.escape_ratio, m.knock_speed, m.centre_of_mass_radius])
            .chain([c.tolerance_position, c.tolerance_rotation])
            .chain(p)
            .chain(q)
            .chain(m.tilts);
    assert!(rest.chain([c.boundary, c.contact_area, c.total]).all(f32::is_nan));
    assert!(c.contacts.iter().all(|x| (x.position, x.normal, x.force) == ([0.0; 3], [0.0; 3], 0.0)));
    assert_eq!((c.object_site, c.support_site), (HANGPOSE_NO_INDEX, HANGPOSE_NO_INDEX));
    assert_eq!((c.is_reversed, c.collision), (0, 0));
}

/// x, y, z, w of the rotation.
#[test]
fn every_number_of_a_plan_reaches_its_field() {
    let waypoint = |seconds| Waypoint { seconds, pose: Pose::identity() };
    let (object, gripper) = ([1.0, 2.0, 3.0].map(waypoint), [4.0, 5.0].map(waypoint));
    let path = motion::Path { object: &object, release: 1, gripper: &gripper, clearance: 0.125 };
    let counts = PlanCounts { samples: 11, nodes: 12, poses: 13, asked: 14 };
    let plan = Plan { path: Ok(path), counts, work: Work { rays: 1 << 40, distance_queries: 1 << 41 } };
    let c = hangpose_plan::from(&plan);
    assert_eq!(c.struct_size as usize, size_of::<hangpose_plan>());
    assert_eq!((c.has_path, c.waypoint_count, c.release, c.gripper_waypoint_count), (1, 3, 1, 2));
    assert_eq!((c.clearance, c.failure.reason, c.failure.stopped), (0.125, HANGPOSE_PLAN_FOUND, HANGPOSE_OK));
    assert_eq!((c.samples, c.nodes, c.tested, c.asked), (11, 12, 13, 14));
    assert_eq!((c.rays, c.distance_queries), (1 << 40, 1 << 41));

    let failed = hangpose_plan::from(&Plan { path: Err(PlanFailure::BudgetUsedUp { samples: 15 }), ..plan });
    assert_eq!((failed.has_path, failed.waypoint_count, failed.gripper_waypoint_count), (0, 0, 0));
    assert!(failed.clearance.is_nan());
    assert_eq!((failed.failure.reason, failed.failure.count), (HANGPOSE_PLAN_BUDGET_USED_UP, 15));
    assert_eq!((failed.samples, failed.distance_queries), (11, 1 << 41));
}

#[test]
fn every_number_of_a_waypoint_reaches_its_field() {
    let pose = Pose::new(Vector::new(1.0, 2.0, 3.0), Vector::new(0.1, 0.2, 0.3));
    let c = hangpose_waypoint::from(&Waypoint { seconds: 4.0, pose });
    assert_eq!(c.struct_size as usize, size_of::<hangpose_waypoint>());
    assert_eq!((c.seconds, c.position, c.quaternion), (4.0, [1.0, 2.0, 3.0], xyzw(&pose)));
}

#[test]
fn every_failure_of_a_plan_has_its_numbers() {
    let collision = |mover, obstacle| Collision { mover, obstacle, at: [1.0, 2.0, 3.0], distance: -0.25 };
    for (mover, obstacle, expected) in [
        (Mover::Object, Obstacle::Supporter, [1, HANGPOSE_NO_INDEX, 1, HANGPOSE_NO_INDEX]),
        (Mover::Gripper(7), Obstacle::Scene(8), [2, 7, 2, 8]),
        (Mover::Object, Obstacle::Hung(9), [1, HANGPOSE_NO_INDEX, 3, 9]),
        (Mover::Gripper(0), Obstacle::Object, [2, 0, 4, HANGPOSE_NO_INDEX]),
    ] {
        let both = collision(mover, obstacle);
        for (failure, reason) in [
            (PlanFailure::GoalInCollision(both), HANGPOSE_PLAN_GOAL_IN_COLLISION),
            (PlanFailure::StartInCollision(both), HANGPOSE_PLAN_START_IN_COLLISION),
            (PlanFailure::GripperCannotOpen(both), HANGPOSE_PLAN_GRIPPER_CANNOT_OPEN),
        ] {
            let c = hangpose_plan_failure::from(&failure);
            assert_eq!((c.reason, [c.mover, c.part, c.obstacle, c.obstacle_index]), (reason, expected));
            assert_eq!((c.position, c.distance, c.count), ([1.0, 2.0, 3.0], -0.25, 0));
            assert!(c.resolution.is_nan());
        }
    }
    let c = hangpose_plan_failure::from(&PlanFailure::Enclosed { resolution: 0.5 });
    assert_eq!((c.reason, c.resolution), (HANGPOSE_PLAN_ENCLOSED, 0.5));
    assert_eq!((c.mover, c.obstacle, c.part), (0, 0, HANGPOSE_NO_INDEX));
    assert!(c.distance.is_nan() && c.position.iter().all(|x| x.is_nan()));
    let c = hangpose_plan_failure::from(&PlanFailure::TreesFull { nodes: 16 });
    assert_eq!((c.reason, c.count), (HANGPOSE_PLAN_TREES_FULL, 16));
    for (stop, status) in [(Stop::Cancelled, HANGPOSE_CANCELLED), (Stop::WorkLimit, HANGPOSE_WORK_LIMIT)] {
        let c = hangpose_plan_failure::from(&PlanFailure::Stopped(stop));
        assert_eq!((c.reason, c.stopped), (HANGPOSE_PLAN_STOPPED, status));
    }
    for (failure, reason) in [
        (PlanFailure::GoalOutsideWorkspace, HANGPOSE_PLAN_GOAL_OUTSIDE_WORKSPACE),
        (PlanFailure::StartOutsideWorkspace, HANGPOSE_PLAN_START_OUTSIDE_WORKSPACE),
        (PlanFailure::GripperCannotLeave, HANGPOSE_PLAN_GRIPPER_CANNOT_LEAVE),
    ] {
        assert_eq!(hangpose_plan_failure::from(&failure).reason, reason);
    }
}

fn xyzw(pose: &Pose) -> [f32; 4] {
    let q = pose.rotation.quaternion();
    [q.i, q.j, q.k, q.w]
}

/// The rest of the sample mug on the sample hook.
fn a_rest() -> Rest {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mesh = files::read_mesh(&samples.join("mug.obj")).unwrap();
    let cloud = files::read_cloud(&samples.join("hook.ply")).unwrap();
    let params = Params { samples: 4000, voxels: 100_000, ..Params::default() };
    let (mut memory, mut more_memory, monitor) = (Vec::new(), Vec::new(), Monitor::new());
    let object = analyze_object(&mesh.mesh().unwrap(), &params, &mut memory, &monitor).unwrap();
    let supporter = analyze_supporter(&cloud.cloud().unwrap(), &params, &mut more_memory, &monitor).unwrap();
    let mut poses = [HangingPose::default()];
    let found = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor).unwrap();
    found.poses.first().and_then(|pose| pose.rest).expect("the mug hangs on the hook")
}
