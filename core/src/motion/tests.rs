//! Insertions with known answers, and what must not change the answer.

use super::*;
use crate::geometry::{Aabb, Cloud, Point, Pose, Vector, fibonacci_direction};
use crate::hanging::{Distance, HangingPose, Hung, Object, Request, Rest, Supporter};
use crate::memory::Limits;
use crate::test_shapes::{Shape, peg, prism, torus};
use crate::{Monitor, Params, Stop};
use core::f32::consts::{FRAC_PI_2, PI};
use nalgebra::{Translation3, UnitQuaternion};

/// An object at a goal among the points of a supporter.
#[derive(Clone)]
struct Scene {
    object: Shape,
    points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    goal: Pose,
}

/// Points of round wires along lines, without those that are inside another part.
fn wires(lines: &[Vec<[f32; 3]>], radius: f32) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let segments: Vec<[Point; 2]> = lines
        .iter()
        .flat_map(|line| line.windows(2).map(|ends| [Point::from(ends[0]), Point::from(ends[1])]))
        .collect();
    let distance = |[from, to]: &[Point; 2], point: &Point| {
        let axis = to - from;
        let share = ((point - from).dot(&axis) / axis.norm_squared()).clamp(0.0, 1.0);
        (point - (from + axis * share)).norm()
    };
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    for (index, &[from, to]) in segments.iter().enumerate() {
        let (own, facing) = peg(from, to, radius, 0.0012);
        for (point, normal) in own.into_iter().zip(facing) {
            let is_inside = |(other, segment): (usize, &[Point; 2])| {
                other != index && distance(segment, &Point::from(point)) < 0.98 * radius
            };
            if !segments.iter().enumerate().any(is_inside) {
                points.push(point);
                normals.push(normal);
            }
        }
    }
    (points, normals)
}

/// Points of an arc in the x-z plane.
fn arc([x, z]: [f32; 2], radius: f32, [from, to]: [f32; 2], steps: u32) -> Vec<[f32; 3]> {
    (0..=steps)
        .map(|i| {
            let (sin, cos) = (from + (to - from) * i as f32 / steps as f32).sin_cos();
            [x + radius * cos, 0.0, z + radius * sin]
        })
        .collect()
}

const WIRE: f32 = 0.004;
/// Inner radius of the ring.
const INNER: f32 = 0.014;

impl Scene {
    /// A ring that hangs on wires along lines, at a place where the wire runs along x.
    fn ring_on(lines: &[Vec<[f32; 3]>], at: [f32; 3]) -> Self {
        let (points, normals) = wires(lines, WIRE);
        // Its axis is along the wire, and the top of its hole a millimetre above it.
        let turn = UnitQuaternion::from_axis_angle(&Vector::y_axis(), FRAC_PI_2);
        let down = WIRE + 0.001 - INNER;
        let goal = Pose::from_parts(Translation3::new(at[0], at[1], at[2] + down), turn);
        Self { object: torus(INNER + 0.003, 0.003, 64, 20), points, normals, goal }
    }

    fn on_peg() -> Self {
        Self::ring_on(&[vec![[0.0, 0.0, 0.0], [0.08, 0.0, 0.0]]], [0.04, 0.0, 0.0])
    }

    fn on_l_hook() -> Self {
        let line = vec![[0.0, 0.0, 0.0], [0.06, 0.0, 0.0], [0.06, 0.0, 0.03]];
        Self::ring_on(&[line], [0.03, 0.0, 0.0])
    }

    fn on_j_hook() -> Self {
        let mut line = vec![[0.0, 0.0, 0.08], [0.0, 0.0, 0.0]];
        line.extend(&arc([0.025, 0.0], 0.025, [PI, 2.0 * PI], 16)[1..]);
        line.push([0.05, 0.0, 0.02]);
        Self::ring_on(&[line], [0.025, 0.0, -0.025])
    }

    fn on_double_hook() -> Self {
        let hook = |side: f32| {
            let mut line = vec![[0.0, 0.0, 0.05], [0.0, side * 0.03, 0.0]];
            line.extend(
                arc([0.02, 0.0], 0.02, [PI, 1.9 * PI], 12)[1..].iter().map(|p| [p[0], side * 0.03, p[2]]),
            );
            line
        };
        Self::ring_on(&[hook(1.0), hook(-1.0)], [0.02, 0.03, -0.02])
    }

    /// On the lower part of a round wire of 6 cm that lacks a gate of this angle.
    fn on_carabiner(gate: f32) -> Self {
        let line = arc([0.0, 0.0], 0.03, [-FRAC_PI_2, 1.5 * PI - gate], 48);
        let mut closed = line.clone();
        if gate == 0.0 {
            closed.push(line[0]);
        }
        Self::ring_on(&[closed], [0.0, 0.0, -0.03])
    }

    /// On a thin rail between two plates of 40 cm, the points of which are thinned to 12.5 mm.
    fn on_rail_between_plates(inner: f32) -> Self {
        let (mut points, mut normals) = wires(&[vec![[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]]], 0.0025);
        for (side, facing) in [(-0.1, 1.0), (-0.105, -1.0), (0.1, -1.0), (0.105, 1.0)] {
            for (j, k) in (-66..=66).flat_map(|j| (-66..=66).map(move |k| (j, k))) {
                let (y, z) = (0.003 * j as f32, 0.003 * k as f32);
                if y.hypot(z) > 0.0025 {
                    points.push([side, y, z]);
                    normals.push([facing, 0.0, 0.0]);
                }
            }
        }
        let turn = UnitQuaternion::from_axis_angle(&Vector::y_axis(), FRAC_PI_2);
        let goal = Pose::from_parts(Translation3::identity(), turn);
        Self { object: torus(inner + 0.0015, 0.0015, 64, 20), points, normals, goal }
    }

    /// A flat bar in a closed box that has one slot.
    fn in_box_with_slot(slot: [f32; 2]) -> Self {
        let (half, spacing) = (0.04, 0.002);
        let steps = (2.0 * half / spacing) as i32;
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
            for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
                let (a, b) = (i as f32 * spacing - half, j as f32 * spacing - half);
                let is_open = axis == 0 && side > 0.0 && a.abs() < 0.5 * slot[0] && b.abs() < 0.5 * slot[1];
                if !is_open {
                    let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
                    (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (side * half, a, b);
                    normal[axis] = side;
                    points.push(point);
                    normals.push(normal);
                }
            }
        }
        let section = [[-0.01, -0.002], [0.01, -0.002], [0.01, 0.002], [-0.01, 0.002]];
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.5, 0.3);
        let goal = Pose::from_parts(Translation3::new(-0.01, 0.0, 0.0), turn);
        Self { object: prism(0.05, &section), points, normals, goal }
    }

    fn turned(&self, by: &Pose) -> Self {
        let points = self.points.iter().map(|p| (by * Point::from(*p)).into()).collect();
        let normals = self.normals.iter().map(|n| (by.rotation * Vector::from(*n)).into()).collect();
        Self { object: self.object.clone(), points, normals, goal: by * self.goal }
    }

    fn analyse<T>(&self, check: impl FnOnce(&Object, &Supporter, &Params) -> T) -> T {
        let (params, monitor) = (Params::default(), Monitor::new());
        let limits = Limits { points: self.points.len(), ..Object::limits(&self.object.mesh(), &params) };
        let (mut object, mut supporter) =
            (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
        let object = Object::analyze(&self.object.mesh(), &params, &mut object, &monitor).unwrap();
        let cloud = Cloud::new(&self.points, Some(&self.normals)).unwrap();
        let supporter = Supporter::analyze(&cloud, &params, &mut supporter, &monitor).unwrap();
        check(&object, &supporter, &params)
    }

    fn goal(&self) -> HangingPose {
        HangingPose { pose: self.goal, ..HangingPose::default() }
    }

    /// Plans and checks the path.
    fn plan(&self, motion: Motion) -> Result<Found, PlanFailure> {
        self.plan_in(&Request::ANY, motion, &mut |_| true)
    }

    fn plan_in(
        &self,
        request: &Request,
        motion: Motion,
        accepts: &mut dyn FnMut(&Pose) -> bool,
    ) -> Result<Found, PlanFailure> {
        self.analyse(|object, supporter, params| {
            let task = Task { object, supporter, request, params, motion };
            let mut memory = vec![0xAB; plan_bytes(&supporter.limits(), request.scene.len(), motion.nodes)];
            let mut waypoints = vec![Waypoint::default(); 2000];
            let planned =
                plan(&task, &self.goal(), &mut waypoints, accepts, &mut memory, &Monitor::new()).unwrap();
            let path = planned.path?;
            self.check(object, &path, request);
            Ok(Found {
                object: path.object.to_vec(),
                gripper: path.gripper.to_vec(),
                release: path.release,
                counts: planned.counts,
                clearance: path.clearance,
            })
        })
    }

    /// No point of the supporter or the scene is inside the object anywhere on a path, and its times grow.
    fn check(&self, object: &Object, path: &Path, request: &Request) {
        let field = object.distance_field().unwrap();
        for pair in path.object.windows(2) {
            let (from, to) = (pair[0].pose, pair[1].pose);
            assert!(pair[0].seconds < pair[1].seconds, "{} {}", pair[0].seconds, pair[1].seconds);
            let shift = (to.translation.vector - from.translation.vector).norm();
            assert!(shift < 0.012 + 0.1 * 0.1 && from.rotation.angle_to(&to.rotation) < 0.11);
            for step in 0..20 {
                let pose = from.lerp_slerp(&to, step as f32 / 20.0).inverse();
                for point in self.points.iter().chain(request.scene) {
                    let at = object.frame() * (pose * Point::from(*point));
                    let is_clear = field.distance(&at) > 0.001 || !object.surface().is_inside(&at);
                    assert!(is_clear, "{at} is inside at {}", pair[0].seconds);
                }
            }
        }
    }
}

struct Found {
    object: Vec<Waypoint>,
    gripper: Vec<Waypoint>,
    release: usize,
    counts: PlanCounts,
    clearance: f32,
}

/// The object is off the supporter at the start and at the goal at the end.
fn assert_hangs(scene: &Scene, found: &Found) {
    let supporter = Aabb::of(&scene.points.iter().map(|p| Point::from(*p)).collect::<Vec<_>>());
    let start = found.object[0].pose.translation.vector;
    let nearest = (0..3).map(|k| start[k].clamp(supporter.min[k], supporter.max[k]) - start[k]);
    let distance = nearest.map(|x| x * x).sum::<f32>().sqrt();
    assert!(distance > 0.015, "{start} is not outside");
    let release = found.object[found.release].pose;
    assert!((release.translation.vector - scene.goal.translation.vector).norm() < 1e-5);
}

#[test]
fn insertions_that_are_possible() {
    let scenes = [
        ("peg", Scene::on_peg()),
        ("L hook", Scene::on_l_hook()),
        ("J hook", Scene::on_j_hook()),
        ("double hook", Scene::on_double_hook()),
        ("carabiner with an open gate", Scene::on_carabiner(0.9)),
        ("box with a slot", Scene::in_box_with_slot([0.04, 0.02])),
    ];
    for (name, scene) in scenes {
        match scene.plan(Motion { samples: 5000, nodes: 16_000, ..Motion::DEFAULT }) {
            Ok(found) => {
                println!("{name}: {:?} {}", found.counts, found.clearance);
                assert_hangs(&scene, &found);
            }
            Err(failure) => panic!("{name}: {failure}"),
        }
    }
}

/// Poses are given by the object's centre: what the rest of the object reaches counts as well.
#[test]
fn a_point_of_the_scene_is_seen_as_far_as_the_object_reaches() {
    let scene = Scene::on_peg();
    scene.analyse(|object, supporter, params| {
        let centre = scene.goal * object.centre_of_mass();
        let region = Aabb { min: centre, max: centre };
        // In the middle of the ring's lowest part, 15.5 mm below its centre.
        let points = [[centre.x, centre.y, centre.z - INNER - 0.0015]];
        let request = Request { scene: &points, ..Request::ANY };
        let task = Task { object, supporter, request: &request, params, motion: Motion::DEFAULT };
        let mut memory = vec![0; Clearance::bytes(&supporter.limits(), 1)];
        let mut clearance = Clearance::new(&task, &region, &[], &mut memory, &Monitor::new()).unwrap();
        let distance = clearance.at(&scene.goal);
        assert!(distance < -0.001, "{distance}");
    });
}

/// A rest pose in contact, and one that is 2 mm inside the supporter, as it may be where walls are thinner than the distance field
/// resolves.
#[test]
fn a_path_ends_before_the_object_presses() {
    let scene = Scene::on_peg();
    scene.analyse(|object, supporter, params| {
        let plan_to = |sunk: f32| {
            let pose = Translation3::new(0.0, 0.0, -sunk) * scene.goal;
            let goal = HangingPose { rest: Some(Rest::at(pose)), ..scene.goal() };
            let task = Task { object, supporter, request: &Request::ANY, params, motion: Motion::DEFAULT };
            let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, Motion::DEFAULT.nodes)];
            let mut waypoints = vec![Waypoint::default(); 2000];
            let monitor = Monitor::new();
            let planned = plan(&task, &goal, &mut waypoints, &mut |_| true, &mut memory, &monitor).unwrap();
            let last = planned.path.unwrap().object.last().unwrap().pose;
            scene.goal.translation.z - last.translation.z
        };
        // The top of its hole is a millimetre above the wire, and 0.3 mm are left.
        for rest in [0.001, 0.003] {
            let sunk = plan_to(rest);
            assert!((sunk - 0.0007).abs() < 0.0001, "{sunk}");
        }
        // Farther away it ends at the rest pose.
        assert!((plan_to(0.0005) - 0.0005).abs() < 1e-6);
    });
}

/// On the round end of a peg no bar is near, but the peg is.
#[test]
fn a_ring_on_the_round_end_of_a_peg_comes_off_at_once() {
    const BALL: f32 = 0.0122;
    let end = Point::new(0.08, 0.0, 0.03);
    let mut scene = Scene::ring_on(&[vec![[0.0, 0.0, 0.0], end.into()]], end.into());
    let is_off = |point: &[f32; 3]| (Point::from(*point) - end).norm() > BALL;
    let (points, normals): (Vec<_>, Vec<_>) = scene
        .points
        .iter()
        .zip(&scene.normals)
        .filter(|(point, _)| is_off(point))
        .map(|(p, n)| (*p, *n))
        .unzip();
    (scene.points, scene.normals) = (points, normals);
    for index in 0..1500 {
        let normal = fibonacci_direction(index, 1500);
        scene.points.push((end + normal * BALL).into());
        scene.normals.push(normal.into());
    }
    // Too askew for the straight ways out.
    let turn = UnitQuaternion::from_axis_angle(&Vector::y_axis(), FRAC_PI_2 - 0.5);
    scene.goal = Pose::from_parts(Translation3::new(end.x, end.y, end.z + BALL + 0.001 - INNER), turn);
    let found = scene.plan(Motion::DEFAULT).unwrap();
    assert_hangs(&scene, &found);
    assert_eq!(found.counts.samples, 0);
}

#[test]
fn insertions_that_are_not() {
    let failure = Scene::on_carabiner(0.0).plan(Motion::DEFAULT).err();
    assert!(
        matches!(failure, Some(PlanFailure::Enclosed { resolution }) if resolution < 0.01),
        "{failure:?}"
    );
    // Too narrow for its thickness.
    let motion = Motion { samples: 300, ..Motion::DEFAULT };
    let failure = Scene::in_box_with_slot([0.018, 0.018]).plan(motion).err();
    assert_eq!(failure, Some(PlanFailure::BudgetUsedUp { samples: 300 }));
}

/// The plates stop a ring of any size, whichever few of their points are kept: those of a grid that does not move with the scene.
#[test]
fn a_ring_does_not_pass_between_the_points_of_a_plate() {
    for [y, z] in [[0.0, 0.0], [0.005, 0.005], [0.0075, 0.005], [0.0075, 0.0075]] {
        for inner in [0.006, 0.01, 0.013] {
            let scene = Scene::on_rail_between_plates(inner).turned(&Translation3::new(0.0, y, z).into());
            let start = Some(Translation3::new(0.3, 0.0, 0.0) * scene.goal);
            let failure = scene.plan(Motion { start, samples: 20, ..Motion::DEFAULT }).err();
            assert_eq!(failure, Some(PlanFailure::BudgetUsedUp { samples: 20 }), "{inner} {y} {z}");
        }
    }
}

/// No pose with a way out is taken for enclosed.
#[test]
fn what_is_open_is_not_enclosed() {
    for scene in [Scene::on_peg(), Scene::on_j_hook(), Scene::on_carabiner(0.9), Scene::on_carabiner(0.19)] {
        // Never further than to the proof.
        let motion = Motion { workspace: None, samples: 1, ..Motion::DEFAULT };
        let failure = scene.plan(motion).err();
        assert!(!matches!(failure, Some(PlanFailure::Enclosed { .. })), "{failure:?}");
    }
}

#[test]
fn the_same_seed_gives_the_same_path() {
    // Only what is sampled depends on the seed.
    let scene = Scene::in_box_with_slot([0.04, 0.03]);
    let [one, same, other] = [1, 1, 3].map(|seed| {
        scene.plan(Motion { seed, samples: 5000, nodes: 16_000, ..Motion::DEFAULT }).unwrap().object
    });
    assert!(one == same && one != other);
}

/// Where a straight way leads to the goal, the way of the turned scene is that way, turned.
#[test]
fn the_path_of_the_turned_scene_is_the_turned_path() {
    let scene = Scene::on_peg();
    let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), 2.0);
    let by = Pose::from_parts(Translation3::new(0.5, -1.0, 0.3), turn);
    let start = Translation3::new(0.15, 0.0, 0.0) * scene.goal;
    let path =
        |scene: &Scene, start| scene.plan(Motion { start: Some(start), ..Motion::DEFAULT }).unwrap().object;
    let (path, turned) = (path(&scene, start), path(&scene.turned(&by), by * start));
    assert_eq!(path.len(), turned.len());
    for (a, b) in path.iter().zip(&turned) {
        let a = by * a.pose;
        assert!((a.translation.vector - b.pose.translation.vector).norm() < 1e-4);
        assert!(a.rotation.angle_to(&b.pose.rotation) < 2e-3);
    }
}

#[test]
fn every_capacity_is_exhausted() {
    let scene = Scene::on_carabiner(0.19);
    // Its gate is narrower than the ring is thick, and a tree of 64 nodes is full before the samples are used up.
    let failure = scene.plan(Motion { nodes: 64, ..Motion::DEFAULT }).err();
    assert_eq!(failure, Some(PlanFailure::TreesFull { nodes: 64 }));
    let failure = scene.plan(Motion { samples: 150, ..Motion::DEFAULT }).err();
    assert_eq!(failure, Some(PlanFailure::BudgetUsedUp { samples: 150 }));

    let scene = Scene::on_peg();
    scene.analyse(|object, supporter, params| {
        let motion = Motion::DEFAULT;
        let task = Task { object, supporter, request: &Request::ANY, params, motion };
        let needed = plan_bytes(&supporter.limits(), 0, motion.nodes);
        let mut waypoints = [Waypoint::default(); 100];
        let mut plan_with = |bytes: usize, room: usize, monitor: &Monitor| {
            let memory = &mut vec![0; bytes];
            let planned = plan(&task, &scene.goal(), &mut waypoints[..room], &mut |_| true, memory, monitor);
            planned.map(|planned| planned.path.map(|path| path.object.len()))
        };
        let length = plan_with(needed, 100, &Monitor::new()).unwrap().unwrap();
        assert_eq!(
            plan_with(needed, length - 1, &Monitor::new()),
            Err(PlanError::TooManyWaypoints { needed: length, given: length - 1 })
        );
        assert_eq!(plan_with(needed, length, &Monitor::new()), Ok(Ok(length)));
        assert!(matches!(plan_with(needed - 1, 100, &Monitor::new()), Err(PlanError::OutOfMemory(_))));
        let stopped = Ok(Err(PlanFailure::Stopped(Stop::WorkLimit)));
        assert_eq!(plan_with(needed, 100, &Monitor::with_work_limit(1000)), stopped);
    });
}

#[test]
fn the_callback_decides() {
    let scene = Scene::on_l_hook();
    let nothing = scene.plan_in(&Request::ANY, Motion::DEFAULT, &mut |_| false);
    assert_eq!(nothing.err(), Some(PlanFailure::GoalOutsideWorkspace));

    // Only from the right side, seen along the peg.
    let is_right = |pose: &Pose| pose.translation.y > -0.002;
    let mut asked = Vec::new();
    let found = scene.plan_in(&Request::ANY, Motion::DEFAULT, &mut |pose| {
        asked.push(*pose);
        is_right(pose)
    });
    let found = found.unwrap();
    assert!(found.object.iter().all(|waypoint| is_right(&waypoint.pose)));
    assert_eq!(found.counts.asked, asked.len());

    // Nothing but the neighbourhood of the goal: the budget ends.
    let motion = Motion { samples: 200, ..Motion::DEFAULT };
    let is_near = |pose: &Pose| (pose.translation.vector - scene.goal.translation.vector).norm() < 0.02;
    let failure = scene.plan_in(&Request::ANY, motion, &mut |pose| is_near(pose)).err();
    assert_eq!(failure, Some(PlanFailure::BudgetUsedUp { samples: 200 }));

    // One that cancels.
    scene.analyse(|object, supporter, params| {
        let task = Task { object, supporter, request: &Request::ANY, params, motion };
        let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, motion.nodes)];
        let (monitor, mut waypoints) = (Monitor::new(), [Waypoint::default(); 100]);
        let accepts = &mut |_: &Pose| {
            monitor.cancel();
            true
        };
        let planned = plan(&task, &scene.goal(), &mut waypoints, accepts, &mut memory, &monitor).unwrap();
        assert_eq!(planned.stopped(), Some(Stop::Cancelled));
    });
}

#[test]
fn the_workspace_is_kept() {
    let scene = Scene::on_peg();
    let aabb = Aabb { min: Point::new(-0.1, -0.05, -0.06), max: Point::new(0.2, 0.05, 0.03) };
    let found = scene.plan(Motion { workspace: Some(aabb), ..Motion::DEFAULT }).unwrap();
    for waypoint in &found.object {
        for vertex in &scene.object.vertices {
            let at = waypoint.pose * Point::from(*vertex);
            assert!((0..3).all(|k| at[k] > aabb.min[k] - 1e-3 && at[k] < aabb.max[k] + 1e-3), "{at}");
        }
    }
    let small = Aabb { min: Point::new(0.0, -0.05, -0.06), max: Point::new(0.07, 0.05, 0.03) };
    let failure = scene.plan(Motion { workspace: Some(small), ..Motion::DEFAULT }).err();
    assert_eq!(failure, Some(PlanFailure::StartOutsideWorkspace));
}

#[test]
fn scenes_and_hung_objects_are_in_the_way() {
    let scene = Scene::on_peg();
    // A wall in front of the peg that leaves a way only to the sides.
    let wall: Vec<[f32; 3]> =
        (0..60 * 60).map(|i| [0.1, (i % 60) as f32 * 0.004 - 0.12, (i / 60) as f32 * 0.004 - 0.12]).collect();
    let request = Request { scene: &wall, ..Request::ANY };
    let found = scene.plan_in(&request, Motion::DEFAULT, &mut |_| true).unwrap();
    assert!(found.object.iter().all(|waypoint| waypoint.pose.translation.x < 0.1));

    // Another ring between this one and one end of the peg leaves the other end; one on either side leaves none.
    scene.analyse(|object, supporter, params| {
        let beside = |x: f32| Translation3::new(x, 0.0, 0.0) * scene.goal;
        let plan_with = |hung: &[Hung]| {
            let request = &Request { hung, ..Request::ANY };
            let motion = Motion { samples: 200, ..Motion::DEFAULT };
            let task = Task { object, supporter, request, params, motion };
            let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, motion.nodes)];
            let mut waypoints = [Waypoint::default(); 200];
            let planned =
                plan(&task, &scene.goal(), &mut waypoints, &mut |_| true, &mut memory, &Monitor::new());
            planned.unwrap().path.map(|_| ())
        };
        let [left, right] = [-0.02, 0.02].map(|x| Hung { object, pose: beside(x) });
        assert_eq!([plan_with(&[left]), plan_with(&[right])], [Ok(()); 2]);
        assert_eq!(plan_with(&[left, right]), Err(PlanFailure::BudgetUsedUp { samples: 200 }));
        match plan_with(&[Hung { object, pose: beside(0.003) }]) {
            Err(PlanFailure::GoalInCollision(collision)) => {
                assert_eq!((collision.mover, collision.obstacle), (Mover::Object, Obstacle::Hung(0)));
            }
            other => panic!("{other:?}"),
        }
    });
}

/// A hand from below: a palm and two fingers beside the ring.
fn hand() -> [Capsule; 3] {
    let finger = |side: f32| Capsule {
        from: [0.03, 0.0, side * 0.008],
        to: [0.013, 0.0, side * 0.008],
        radius: 0.004,
        opening: [0.0, 0.0, side * 0.006],
    };
    let palm =
        Capsule { from: [0.035, 0.0, -0.015], to: [0.035, 0.0, 0.015], radius: 0.006, opening: [0.0; 3] };
    [finger(1.0), finger(-1.0), palm]
}

#[test]
fn the_gripper_leaves() {
    let scene = Scene::on_peg();
    let parts = hand();
    let gripper = Gripper { parts: &parts, retreat: [0.05, 0.0, 0.0] };
    let motion = Motion { gripper: Some(gripper), ..Motion::DEFAULT };
    let found = scene.plan(motion).unwrap();
    let (first, last) = (found.gripper[0], found.gripper[found.gripper.len() - 1]);
    assert!((first.pose.translation.vector - scene.goal.translation.vector).norm() < 1e-5);
    let retreat = first.pose.inverse() * last.pose;
    assert!((retreat.translation.vector - Vector::new(0.05, 0.0, 0.0)).norm() < 1e-4, "{retreat}");
    assert_eq!(found.object.last().unwrap().seconds, first.seconds);

    // To take it off, the same the other way round.
    let off = scene.plan(Motion { take_off: true, ..motion }).unwrap();
    let reversed: Vec<Pose> = off.object.iter().rev().map(|waypoint| waypoint.pose).collect();
    assert_eq!(reversed, found.object.iter().map(|waypoint| waypoint.pose).collect::<Vec<_>>());
    assert_eq!(off.gripper[off.gripper.len() - 1].pose, first.pose);
    assert_eq!(off.gripper.last().unwrap().seconds, off.object[0].seconds);

    // A floor right below leaves no room for the straight retreat, but for another way.
    let floor: Vec<[f32; 3]> = (0..60 * 60)
        .map(|i| [(i % 60) as f32 * 0.003 - 0.05, (i / 60) as f32 * 0.003 - 0.09, -0.065])
        .collect();
    let request = Request { scene: &floor, ..Request::ANY };
    let found = scene.plan_in(&request, motion, &mut |_| true).unwrap();
    let last = found.gripper[found.gripper.len() - 1].pose;
    assert!((last.translation.vector - scene.goal.translation.vector).norm() > 0.03);

    // A finger that opens into the peg cannot.
    let mut parts = hand();
    parts[0].opening = [-0.035, 0.0, -0.006];
    let motion = Motion { gripper: Some(Gripper { parts: &parts, ..gripper }), ..motion };
    assert!(matches!(scene.plan(motion).err(), Some(PlanFailure::GripperCannotOpen(_))));
}

#[test]
fn wrong_motions_are_named() {
    let parts = [Capsule { radius: f32::NAN, ..Capsule::default() }];
    let gripper = Gripper { parts: &parts, retreat: [0.0; 3] };
    let point = Point::origin();
    let motions = [
        Motion { clearance: 0.0, ..Motion::DEFAULT },
        Motion { nodes: 1, ..Motion::DEFAULT },
        Motion { gripper: Some(gripper), ..Motion::DEFAULT },
        Motion { gripper: Some(Gripper { parts: &[], ..gripper }), ..Motion::DEFAULT },
        Motion { workspace: Some(Aabb { min: point, max: point }), ..Motion::DEFAULT },
        Motion { start: Some(Translation3::new(f32::NAN, 0.0, 0.0).into()), ..Motion::DEFAULT },
    ];
    let errors = motions.map(|motion| motion.validate().unwrap_err().to_string());
    for (error, part) in errors.iter().zip(["clearance", "nodes", "part 0", "no parts", "workspace", "start"])
    {
        assert!(error.contains(part), "{error}");
    }
    assert_eq!(Motion::DEFAULT.validate(), Ok(()));
}

/// Each of the poses is planned for until one has a path.
#[test]
fn the_first_pose_that_can_be_reached() {
    let scene = Scene::on_peg();
    scene.analyse(|object, supporter, params| {
        let request = &Request::ANY;
        let task = Task { object, supporter, request, params, motion: Motion::DEFAULT };
        let limits = supporter.limits();
        let mut memory = vec![0; reachable_bytes(&limits, 0, Motion::DEFAULT.nodes)];
        let (mut poses, mut failures) = ([HangingPose::default(); 3], [None; 3]);
        let mut waypoints = [Waypoint::default(); 300];
        let mut refused = None;
        let accepts = &mut |pose: &Pose| *pose != *refused.get_or_insert(*pose);
        let reachable = predict_reachable(
            &task,
            &mut poses,
            &mut failures,
            &mut waypoints,
            accepts,
            &mut memory,
            &Monitor::new(),
        )
        .unwrap();
        assert!(reachable.prediction.poses.len() > 1);
        assert_eq!(reachable.planned, 2);
        assert_eq!(failures, [Some(PlanFailure::GoalOutsideWorkspace), None, None]);
        let path = reachable.plan.unwrap().path.unwrap();
        let rest = reachable.prediction.poses[1].rest.unwrap().pose;
        let left = path.object.last().unwrap().pose.translation.vector - rest.translation.vector;
        assert!((0.0001..0.0006).contains(&left.norm()), "{left}");
    });
}

/// A triangle of 100 m that is everywhere close to the object would be halved 16 million times.
#[test]
fn the_work_limit_ends_the_queries_of_a_large_triangle() {
    let scene = Scene::on_peg();
    let mut wall = scene.object.clone();
    wall.append(
        &Shape {
            vertices: vec![[-100.0, -100.0, 0.0], [100.0, -100.0, 0.0], [0.0, 100.0, 0.0]],
            triangles: vec![[0, 1, 2]],
        },
        Vector::zeros(),
    );
    let scene = Scene { object: wall, ..scene };
    scene.analyse(|object, supporter, params| {
        let hung = [Hung { object, pose: scene.goal }];
        let request = &Request { hung: &hung, ..Request::ANY };
        let task = Task { object, supporter, request, params, motion: Motion::DEFAULT };
        let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, task.motion.nodes)];
        let monitor = Monitor::with_work_limit(10_000);
        let planned = plan(&task, &scene.goal(), &mut [], &mut |_| true, &mut memory, &monitor).unwrap();
        assert_eq!(planned.path, Err(PlanFailure::Stopped(Stop::WorkLimit)));
        assert!(planned.work.distance_queries < 20_000, "{}", planned.work.distance_queries);
    });
}

/// Between two questions about poses of a leg, of which there are many where steps are short.
#[test]
fn a_cancel_ends_the_questions() {
    let scene = Scene::on_peg();
    scene.analyse(|object, supporter, params| {
        let motion = Motion { step: Distance { position: 1e-4, rotation: 1e-3 }, ..Motion::DEFAULT };
        let task = Task { object, supporter, request: &Request::ANY, params, motion };
        let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, motion.nodes)];
        for cancelled_at in [5, 50] {
            let (monitor, mut asked) = (Monitor::new(), 0);
            let mut accepts = |_: &Pose| {
                asked += 1;
                if asked == cancelled_at {
                    monitor.cancel();
                }
                true
            };
            let goal = scene.goal();
            let planned = plan(&task, &goal, &mut [], &mut accepts, &mut memory, &monitor).unwrap();
            assert_eq!(planned.path, Err(PlanFailure::Stopped(Stop::Cancelled)));
            assert_eq!(asked, cancelled_at);
        }
    });
    let step = Distance { position: 1e-12, rotation: 0.1 };
    assert!(matches!(
        Motion { step, ..Motion::DEFAULT }.validate(),
        Err(MotionError::Value { name: "step.position", min: 1e-4, .. })
    ));
}

/// A start so far away that a step is less than the rounding of the way to it: the search ends all the same.
#[test]
fn a_start_out_of_all_reach_has_no_path() {
    let start = Some(Pose::translation(9e5, 0.0, 0.0));
    let motion = Motion { start, samples: 3, ..Motion::DEFAULT };
    let failure = Scene::on_peg().plan(motion).err();
    assert_eq!(failure, Some(PlanFailure::BudgetUsedUp { samples: 3 }));
}

#[test]
fn a_goal_that_is_no_pose_is_named() {
    let scene = Scene::on_peg();
    scene.analyse(|object, supporter, params| {
        let task = Task { object, supporter, request: &Request::ANY, params, motion: Motion::DEFAULT };
        let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, task.motion.nodes)];
        for far in [f32::NAN, f32::INFINITY, 2e6] {
            let pose = Pose::translation(0.0, far, 0.0);
            let goal = HangingPose { pose, ..HangingPose::default() };
            let planned = plan(&task, &goal, &mut [], &mut |_| true, &mut memory, &Monitor::new());
            assert_eq!(planned.err(), Some(PlanError::Goal), "{far}");
        }
    });
}
