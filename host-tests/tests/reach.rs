//! The replay on paths whose collisions are known, and the problems of motion on what their construction promises.

use hangpose::geometry::Pose;
use hangpose::motion::{Capsule, Gripper, Motion, Path, Waypoint};
use hangpose::parry::pose_to_parry;
use host_tests::judge::Scene;
use host_tests::judge::replay::{DEEPEST, Replayed, between, replay};
use host_tests::reach::enclosed::{Enclosed, Enclosure, enclosed};
use host_tests::reach::run::{Options, pair, tree};
use host_tests::reach::surroundings::Around;
use host_tests::shapes::vector::{V, X, Y, arc, cross, dot, double, length, scale, sub};
use host_tests::shapes::{Builder, Insertion};
use host_tests::solid::Solid;
use host_tests::tables::case::{Fit, made};
use nalgebra::{Isometry3, Point3, Vector3};
use parry3d::query::PointQuery;
use parry3d::shape::TriMesh;
use std::f64::consts::PI;

/// A peg of 12 mm along x, 10 cm long, that starts at a wall.
fn peg() -> Solid {
    let mut builder = Builder::default();
    builder.cuboid([-0.015, -0.05, -0.05], [0.0, 0.05, 0.05]);
    builder.tube(&[[-0.001, 0.0, 0.0], [0.1, 0.0, 0.02]], 0.006);
    builder.finish()
}

/// A ring of 3 cm in the plane across x.
fn ring() -> Solid {
    let mut builder = Builder::default();
    builder.tube(&arc([0.0; 3], scale(Y, 0.03), [0.0, 0.0, 0.03], [0.0, 360.0], 32), 0.004);
    builder.finish()
}

/// Replays the ring on straight ways between these positions; the release pose is the last but one.
fn replayed(positions: &[[f32; 3]], gripper: Option<&Gripper>, leaving: &[[f32; 3]]) -> Replayed {
    let (ring, peg) = (ring(), peg());
    let waypoints = |positions: &[[f32; 3]]| -> Vec<Waypoint> {
        let at = |&[x, y, z]: &[f32; 3]| Waypoint { seconds: 0.0, pose: Pose::translation(x, y, z) };
        positions.iter().map(at).collect()
    };
    let (object, gripper_path) = (waypoints(positions), waypoints(leaving));
    let path = Path { object: &object, release: object.len() - 2, gripper: &gripper_path, clearance: 0.0 };
    replay(&Scene { tilt: false, ..Scene::new(&ring, &peg) }, &path, gripper, [0.0; 3])
}

/// In front of the peg, from where a straight way leads over its end.
const FRONT: [f32; 3] = [0.12, 0.0, 0.006];
/// Where the ring hangs with a gap of 1 mm, and with hardly one.
const HUNG: [[f32; 3]; 2] = [[0.05, 0.0, -0.0088], [0.05, 0.0, -0.0097]];

#[test]
fn a_ring_over_the_end_of_a_peg_passes() {
    let over = replayed(&[[0.2, 0.1, 0.0], FRONT, HUNG[0], HUNG[1]], None, &[]);
    assert!(over.passes(), "{over:?}");
    assert!(over.tested > 0);
}

#[test]
fn a_ring_through_a_peg_is_found_where_it_passes() {
    // The rim at y = -3 cm meets the peg, 10 mm thick together, half way from y = 6 cm to 0.
    let through = replayed(&[[0.05, 0.3, 0.0], [0.05, 0.06, 0.0], HUNG[0], HUNG[1]], None, &[]);
    assert!(through.way.depth > 0.006, "{through:?}");
    assert!((through.way.at - 1.5).abs() < 0.2, "{through:?}");
    assert!(through.lowering.depth < DEEPEST && through.verdict.success(), "{through:?}");
    assert!(!through.passes());
}

#[test]
fn a_ring_lowered_into_a_peg_is_found() {
    let deep = [HUNG[0][0], 0.0, HUNG[1][2] - 0.003];
    let lowered = replayed(&[FRONT, HUNG[0], deep], None, &[]);
    assert!(lowered.way.depth < DEEPEST, "{lowered:?}");
    assert!((lowered.lowering.depth - 0.003).abs() < 0.0005, "{lowered:?}");
}

#[test]
fn a_gripper_in_the_way_is_found() {
    let ways = [FRONT, HUNG[0], HUNG[1]];
    // A finger beside the lower end of the ring that opens by 1 cm.
    let finger =
        |opening| Capsule { from: [0.0, 0.012, -0.07], to: [0.0, 0.012, -0.04], radius: 0.004, opening };
    let parts = [finger([0.0, 0.01, 0.0])];
    let gripper = Gripper { parts: &parts, retreat: [0.0, 0.0, -0.05] };
    let down = [HUNG[1], [HUNG[1][0], 0.0, -0.08]];
    let leaves = replayed(&ways, Some(&gripper), &down);
    assert_eq!([leaves.held.depth, leaves.leaving.depth], [0.0; 2], "{leaves:?}");
    // Upwards it passes the peg.
    let up = [HUNG[1], [HUNG[1][0], -0.02, -0.08], [HUNG[1][0], -0.02, 0.08]];
    let meets = replayed(&ways, Some(&gripper), &up);
    assert!(meets.leaving.depth > DEEPEST && !meets.passes(), "{meets:?}");
    // A finger in the hole meets the peg while it holds.
    let inside =
        [Capsule { from: [0.0, 0.0, -0.02], to: [0.0, 0.0, 0.02], radius: 0.002, opening: [0.0; 3] }];
    let gripper = Gripper { parts: &inside, retreat: [0.0; 3] };
    let holds = replayed(&ways, Some(&gripper), &[]);
    assert!(holds.held.depth > DEEPEST, "{holds:?}");
}

#[test]
fn the_centre_moves_straight_while_the_body_turns() {
    let centre = Point3::new(0.1, -0.2, 0.3);
    let from = Isometry3::new(Vector3::new(0.3, 0.1, -0.2), Vector3::new(0.2, 0.5, -0.1));
    let to = Isometry3::new(Vector3::new(-0.1, 0.4, 0.2), Vector3::new(-1.2, 0.3, 0.8));
    for k in 0..=8 {
        let t = f64::from(k) / 8.0;
        let at = between(&from, &to, &centre, t);
        let straight = from * centre + (to * centre - from * centre) * t;
        assert!((at * centre - straight).norm() < 1e-12);
        let [all, part] = [&to, &at].map(|pose| from.rotation.angle_to(&pose.rotation));
        assert!((part - all * t).abs() < 1e-7);
    }
}

/// Pairs of each kind of enclosure that are looked at.
const PAIRS: usize = 4;

fn closed(enclosure: Enclosure) -> Vec<Enclosed> {
    let found: Vec<Enclosed> =
        (0..40).filter_map(|seed| enclosed(enclosure, seed, true)).take(PAIRS).collect();
    assert_eq!(found.len(), PAIRS);
    found
}

/// Linking number of two closed lines by Gauss's integral.
fn linking(a: &[V], b: &[V]) -> f64 {
    let mut sum = 0.0;
    for p in a.windows(2) {
        for q in b.windows(2) {
            let middle = |s: &[V]| scale([0, 1, 2].map(|i| s[0][i] + s[1][i]), 0.5);
            let apart = sub(middle(p), middle(q));
            sum += dot(apart, cross(sub(p[1], p[0]), sub(q[1], q[0]))) / length(apart).powi(3);
        }
    }
    sum / (4.0 * PI)
}

#[test]
fn rings_on_loops_and_rails_are_linked() {
    for enclosure in [Enclosure::Loop, Enclosure::Rail] {
        let rings = (0..400).filter_map(|seed| enclosed(enclosure, seed, true));
        let mut rings = rings.filter(|made| made.object_kind == "ring");
        let made = rings.next().expect("a ring");
        let extent = double(made.object.mesh().aabb().extents().into());
        let bend = 0.5 * extent[0].max(extent[1]) - 0.5 * extent[2];
        let to_supporter = |v: V| double((made.pose * Point3::from(v.map(|x| x as f32))).into());
        let circle = arc([0.0; 3], scale(X, bend), scale(Y, bend), [0.0, 360.0], 200);
        let circle: Vec<V> = circle.into_iter().map(to_supporter).collect();
        let mut line = made.line.clone();
        if enclosure == Enclosure::Rail {
            // The plates at the ends are larger than the ring: it cannot pass to the other side of a line around them.
            for side in [0, 1] {
                let end = made.line[side][1];
                let plate = made.supporter.vertices.iter().filter(|v| (f64::from(v[1]) - end).abs() < 0.011);
                let wide = plate.fold(0.0_f32, |wide, v| wide.max(v[0].abs()));
                assert!(2.0 * f64::from(wide) > extent[0].max(extent[1]));
            }
            let ends = [line[0], line[1]];
            let far = |v: V| [v[0] + 3.0, v[1], v[2]];
            line = [ends[0], ends[1], far(ends[1]), far(ends[0]), ends[0]].to_vec();
        }
        let fine: Vec<V> = (line.windows(2))
            .flat_map(|p| {
                (0..400).map(|k| [0, 1, 2].map(|i| p[0][i] + (p[1][i] - p[0][i]) * f64::from(k) / 400.0))
            })
            .chain(line.last().copied())
            .collect();
        let number = linking(&circle, &fine);
        assert!((number.abs() - 1.0).abs() < 0.05, "{}: {number}", enclosure.name());
    }
}

/// Points of the faces of a cube of this half edge length about the origin.
fn faces(half: f64, steps: u32) -> Vec<V> {
    let at = |k: u32| half * (2.0 * f64::from(k) / f64::from(steps) - 1.0);
    let grid = (0..=steps).flat_map(|i| (0..=steps).map(move |j| [i, j]));
    grid.flat_map(|[i, j]| {
        let (u, v) = (at(i), at(j));
        [-half, half].into_iter().flat_map(move |s| [[s, u, v], [u, s, v], [u, v, s]])
    })
    .collect()
}

#[test]
fn no_ball_inside_the_object_leaves_a_cage_or_box() {
    let surface = |solid: &Solid| {
        let vertices = solid.vertices.iter().map(|&vertex| vertex.map(|x| 1000.0 * x).into()).collect();
        TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles")
    };
    for enclosure in [Enclosure::Cage, Enclosure::Slot] {
        for Enclosed { object, supporter, pose, .. } in closed(enclosure) {
            // The ball is about the origin of the supporter, in millimetres.
            let origin = pose_to_parry(&pose.inverse()).translation * 1000.0;
            let ball = surface(&object).distance_to_local_point(origin, false);
            let supporter_surface = surface(&supporter);
            let half = supporter.vertices.iter().fold(0.0_f32, |most, v| most.max(v[0].abs()));
            // The middle of the wires or walls.
            let thick = if enclosure == Enclosure::Cage { 0.003 } else { 0.005 };
            for point in faces(f64::from(half) - thick, 60) {
                let point = point.map(|x| 1000.0 * x as f32).into();
                let free = supporter_surface.distance_to_local_point(point, false);
                assert!(free < ball, "{}: a gap of {free} mm and a ball of {ball} mm", enclosure.name());
            }
        }
    }
}

#[test]
fn starts_and_goals_are_free() {
    // The answers do not matter here.
    let motion = Motion { samples: 1, nodes: 64, ..Motion::DEFAULT };
    let options = Options { motion, gripper: false, peer: false };
    let arounds = [Around::Nothing, Around::Wall, Around::Shelf, Around::Neighbours];
    let cases = made(30, 3);
    let fitting = cases.iter().filter(|case| case.fit == Fit::Yes).step_by(10);
    let mut rows: Vec<_> = fitting.flat_map(|case| pair(case, &arounds, &options).expect("a plan")).collect();
    rows.extend(tree(3, &options).expect("a plan"));
    let planned = rows.iter().filter_map(|row| Some((row, row.plan.as_ref()?)));
    let mut count = 0;
    for (row, plan) in planned {
        assert_ne!(row.insertion, Some(Insertion::Impossible), "{}", row.pair);
        for depth in plan.ends.into_iter().flatten() {
            assert!(depth < DEEPEST, "{}, {}: {depth} m deep", row.pair, row.scene);
        }
        count += 1;
    }
    assert!(count >= 10, "{count} problems");
}
