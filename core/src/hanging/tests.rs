//! The whole method on shapes with known answers, and what must not change the answer.

use super::sites::Cost;
use super::*;
use crate::geometry::{Cloud, Point, Pose, Symmetry, Vector};
use crate::mechanics::{Fate, Kind};
use crate::memory::{Limits, OutOfMemory};
use crate::monitor::tests::ScopedThreads;
use crate::test_shapes::{self, Shape};
use crate::{Candidates, CentreOfMass, Monitor, Params, Stop};
use nalgebra::{Translation3, UnitQuaternion};

/// The published method about the true centre of mass, with few samples: what tests sites and their matching.
fn fast() -> Params {
    Params { samples: 3000, centre_of_mass: CentreOfMass::Volume, max_collision: 0.01, ..Params::paper() }
}

pub(super) struct Scene {
    object: Shape,
    points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

impl Scene {
    /// A ring of 30 mm on a horizontal peg of 5 mm, turned by `yaw`.
    pub(super) fn ring_on_peg(yaw: f32) -> Self {
        let object = test_shapes::torus(0.030, 0.004, 72, 24);
        let along = Vector::new(yaw.cos(), yaw.sin(), 0.0) * 0.05;
        let middle = Point::new(0.3, -0.2, 0.5);
        let (points, normals) = test_shapes::peg(middle - along, middle + along, 0.005, 0.001);
        Self { object, points, normals }
    }

    /// A handle with a bar: nothing about it is symmetric.
    pub(super) fn key_on_peg() -> Self {
        let mut scene = Self::ring_on_peg(0.0);
        let bar = test_shapes::ball(1.0, 24, 24)
            .map(|p| Point::new(0.005 * p.x, 0.04 * p.y, 0.003 * p.z) + Vector::new(0.004, 0.07, 0.001));
        scene.object.append(&bar, Vector::zeros());
        scene
    }

    /// Dust around the peg that no pose can avoid, too thin to be part of a slice, and facing sideways.
    fn dusty_key_on_peg() -> Self {
        let mut scene = Self::key_on_peg();
        for i in 0..30 * 30 * 30 {
            let offset = [i % 30, i / 30 % 30, i / 900].map(|k| k as f32 * 0.007 - 0.1);
            if offset[1].hypot(offset[2]) > 0.012 {
                scene.points.push([0.3 + offset[0], -0.2 + offset[1], 0.5 + offset[2]]);
                scene.normals.push([1.0, 0.0, 0.0]);
            }
        }
        scene
    }

    pub(super) fn limits(&self, params: &Params) -> Limits {
        Limits { points: self.points.len(), ..Object::limits(&self.object.mesh(), params) }
    }

    fn cloud(&self) -> Cloud<'_> {
        Cloud::new(&self.points, Some(&self.normals)).unwrap()
    }

    pub(super) fn analyse(
        &self,
        params: &Params,
        monitor: &Monitor,
        check: impl FnOnce(&Object, &Supporter),
    ) {
        let limits = self.limits(params);
        let (mut object, mut supporter) =
            (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
        let object = Object::analyze(&self.object.mesh(), params, &mut object, monitor).unwrap();
        let supporter = Supporter::analyze(&self.cloud(), params, &mut supporter, monitor).unwrap();
        check(&object, &supporter);
    }

    fn predict(&self, params: &Params) -> (Vec<HangingPose>, Option<Stage>) {
        let mut poses = [HangingPose::default(); 1000];
        let mut result = None;
        self.analyse(params, &Monitor::new(), |object, supporter| {
            let prediction = predict(object, supporter, params, &mut poses, &Monitor::new()).unwrap();
            assert_eq!(prediction.stopped, None);
            let stage = prediction.rejection.map(|rejection| rejection.stage);
            result = Some((prediction.poses.to_vec(), stage));
        });
        result.unwrap()
    }
}

/// [`predict`] in memory of its own.
fn predict<'p>(
    object: &Object,
    supporter: &Supporter,
    params: &Params,
    poses: &'p mut [HangingPose],
    monitor: &Monitor,
) -> Result<Prediction<'p>, PredictError> {
    let memory = &mut vec![0; predict_bytes(&supporter.limits())];
    super::predict(object, supporter, &Request::ANY, params, poses, memory, monitor)
}

/// What a pose of the paper's matching costs.
fn cost(pose: &HangingPose) -> Cost {
    pose.matched.unwrap().cost
}

fn degrees_between_lines(a: &Vector, b: &Vector) -> f32 {
    a.cross(b).norm().atan2(a.dot(b).abs()).to_degrees()
}

/// Distances of the points of the supporter from the object at a pose, metres, negative inside.
fn distances(object: &Object, supporter: &Supporter, pose: &Pose) -> impl Iterator<Item = f32> {
    let to_object = object.frame() * pose.inverse() * supporter.frame().inverse();
    supporter
        .points()
        .points()
        .iter()
        .map(move |point| object.surface().signed_distance(&(to_object * point)))
}

/// How far apart two poses put an object, by the farther of two of its points, metres.
fn gap(a: &Pose, b: &Pose, probes: [Point; 2]) -> f32 {
    probes.iter().map(|p| (a * p - b * p).norm()).fold(0.0, f32::max)
}

#[test]
fn a_torus_gives_its_hole() {
    let scene = Scene::ring_on_peg(0.0);
    for params in [fast(), Params::paper()] {
        scene.analyse(&params, &Monitor::new(), |object, _| {
            assert!(object.sites().len() > 0);
            for site in object.sites() {
                // The hole's radius is 26 mm. The best of ten steps across it is an eighteenth of its diameter
                // off the centre, which makes its free space that much smaller; samples are 1 mm apart.
                let step = 0.052 / 18.0;
                assert!((site.position.coords.norm() - step).abs() < 1e-3, "{site:?}");
                assert!((site.free_space_radius - (0.026 - step)).abs() < 1e-3, "{site:?}");
                assert!(degrees_between_lines(&site.hanging_direction, &Vector::z()) < 4.0, "{site:?}");
                assert!(site.encircled == 1.0 && site.encircled_above == 1.0);
            }
        });
    }
}

#[test]
fn a_straight_peg_gives_its_axis() {
    for yaw in [0.0_f32, 0.3, 1.0, 2.2] {
        let scene = Scene::ring_on_peg(yaw);
        scene.analyse(&fast(), &Monitor::new(), |_, supporter| {
            assert!(supporter.sites().len() > 3);
            for site in supporter.sites() {
                // Slices are tried every 9 degrees, and next to the right one may look as thin by chance.
                let axis = Vector::new(yaw.cos(), yaw.sin(), 0.0);
                assert!(degrees_between_lines(&site.hanging_direction, &axis) < 9.0, "{yaw}: {site:?}");
                let offset = site.position - Point::new(0.3, -0.2, 0.5);
                assert!(offset.cross(&axis).norm() < 5e-4, "off the axis: {site:?}");
                // The slice is 4 mm thick and, if askew, a little longer.
                let radius = (0.005_f32.powi(2) + 0.003_f32.powi(2)).sqrt();
                assert!(site.support_radius <= radius + 1e-4 && site.support_radius > 0.005, "{site:?}");
                // Askew, the hull would be left through the side.
                if yaw == 0.0 {
                    let along = offset.dot(&site.hanging_direction);
                    let [d1, d2] = site.boundary_distances;
                    assert!((d1 - (0.05 - along)).abs() < 1e-4, "{site:?}");
                    assert!((d2 - (0.05 + along)).abs() < 1e-4, "{site:?}");
                }
            }
        });
    }
}

#[test]
fn a_ring_hangs_on_the_peg_with_its_centre_below() {
    let (poses, stage) = Scene::ring_on_peg(0.4).predict(&fast());
    assert_eq!(stage, None);
    for pose in &poses {
        let axis = pose.pose * Vector::z();
        let peg = Vector::new(0.4_f32.cos(), 0.4_f32.sin(), 0.0);
        assert!(degrees_between_lines(&axis, &peg) < 9.0, "{pose:?}");
        assert!((pose.pose * Point::origin()).z < 0.5, "{pose:?}");
        assert_eq!(cost(pose).collision, 0);
        // Middle of the peg first.
        assert!(cost(pose).boundary >= 0.5 && cost(pose).boundary <= 1.0);
    }
}

#[test]
fn each_stage_rejects_what_it_should() {
    let ring = || Scene::ring_on_peg(0.0);
    let ball = Scene { object: test_shapes::ball(0.04, 32, 64), ..ring() };
    assert_eq!(ball.predict(&fast()), (vec![], Some(Stage::NoContactPoints)));

    // A ball rattling in a shell that leaves it 0.4 mm.
    let mut rattle = test_shapes::ball(0.0102, 32, 64);
    rattle.append(&test_shapes::ball(0.0100, 32, 64).inside_out(), Vector::zeros());
    rattle.append(&test_shapes::ball(0.0096, 32, 64), Vector::zeros());
    let rattle = Scene { object: rattle, ..ring() };
    let dense = Params { samples: 10_000, ..fast() };
    assert_eq!(rattle.predict(&dense), (vec![], Some(Stage::NoFreeSpace)));

    // A gutter's bottom faces its centre of mass, but the other side is open.
    let bend = |p: Point| Point::new(p.x, 0.03 * (30.0 * p.y).sin(), -0.03 * (30.0 * p.y).cos());
    let flat = test_shapes::grid(0.1, 40).map(|p| p - Vector::new(0.05, 0.05, 0.0));
    let gutter = Scene { object: flat.map(bend), ..ring() };
    assert_eq!(gutter.predict(&fast()), (vec![], Some(Stage::NotEncircled)));

    let wall = test_shapes::grid(0.2, 60).map(|p| Point::new(0.0, p.x, p.y));
    let wall = Scene { normals: vec![[1.0, 0.0, 0.0]; wall.vertices.len()], points: wall.vertices, ..ring() };
    assert_eq!(wall.predict(&fast()), (vec![], Some(Stage::NoSupport)));

    let (points, normals) = test_shapes::peg(Point::origin(), Point::new(0.1, 0.0, 0.0), 0.026, 0.001);
    let thick = Scene { points, normals, ..ring() };
    assert_eq!(thick.predict(&fast()), (vec![], Some(Stage::TooThick)));

    let dusty = Scene { object: ring().object, ..Scene::dusty_key_on_peg() };
    let strict = Params { max_collision: 0.0, ..fast() };
    assert_eq!(dusty.predict(&strict), (vec![], Some(Stage::AllCollide)));
    assert!(!dusty.predict(&Params::paper()).0.is_empty(), "the paper keeps poses that collide");
}

#[test]
fn the_answer_does_not_depend_on_the_frames_of_object_and_supporter() {
    let mut scene = Scene::key_on_peg();
    // A stem below one end of the peg, so that its ends differ.
    let end = Point::new(0.35, -0.2, 0.5);
    let (points, normals) = test_shapes::peg(end - Vector::z() * 0.04, end, 0.006, 0.001);
    scene.points.extend(points);
    scene.normals.extend(normals);
    let probes = [Point::origin(), Point::new(0.004, 0.11, 0.001)];
    // A ring has many equally good sites, of which merging would keep any one.
    let params = Params { similar_radius: 0.0, ..fast() };
    let (poses, _) = scene.predict(&params);
    for (angles, yaw) in [((0.5, 0.0, 0.0), 0.8), ((1.0, -2.0, 0.3), 3.0), ((-0.4, 0.9, 3.0), -1.1)] {
        let turn = UnitQuaternion::from_euler_angles(angles.0, angles.1, angles.2);
        let motion = Pose::from_parts(Translation3::new(0.2, yaw, -0.1), turn);
        let upright = UnitQuaternion::from_axis_angle(&Vector::z_axis(), yaw);
        let other = Pose::from_parts(Translation3::new(yaw, 0.3, -0.2), upright);
        let moved = Scene {
            object: scene.object.map(|p| motion * p),
            points: scene.points.iter().map(|p| (other * Point::from(*p)).into()).collect(),
            normals: scene.normals.iter().map(|n| (other * Vector::from(*n)).into()).collect(),
        };
        let (moved, _) = moved.predict(&params);
        let back: Vec<Pose> = moved.iter().map(|m| other.inverse() * m.pose * motion).collect();
        let straight: Vec<Pose> = poses.iter().map(|p| p.pose).collect();
        for (some, others) in [(&straight, &back), (&back, &straight)] {
            for pose in &some[..10] {
                let closest =
                    others.iter().map(|other| gap(pose, other, probes)).fold(f32::INFINITY, f32::min);
                assert!(closest < 0.006, "{closest} m apart, turned by {angles:?} and {yaw}");
            }
        }
    }
}

#[test]
fn gravity_may_point_anywhere() {
    let scene = Scene::key_on_peg();
    let (poses, _) = scene.predict(&fast());
    let probes = [Point::origin(), Point::new(0.004, 0.11, 0.001)];
    // The whole world turned about x by a right angle: what was down is now +y.
    let turn = UnitQuaternion::from_axis_angle(&Vector::x_axis(), core::f32::consts::FRAC_PI_2);
    let rotate = |v: &[f32; 3]| -> [f32; 3] { (turn * Vector::from(*v)).into() };
    let turned = Scene {
        points: scene.points.iter().map(rotate).collect(),
        normals: scene.normals.iter().map(rotate).collect(),
        object: scene.object.clone(),
    };
    let (turned, _) = turned.predict(&Params { gravity: [0.0, 9.81, 0.0], ..fast() });
    let closest = turned.iter().map(|t| gap(&(turn * poses[0].pose), &t.pose, probes));
    assert!(closest.fold(f32::INFINITY, f32::min) < 2e-3);
}

#[test]
fn the_same_bytes_twice() {
    let scene = Scene::key_on_peg();
    let bits = |poses: &[HangingPose]| -> Vec<u32> {
        poses
            .iter()
            .flat_map(|p| p.pose.to_homogeneous().iter().chain([&cost(p).total]).copied().collect::<Vec<_>>())
            .map(f32::to_bits)
            .collect()
    };
    let (first, _) = scene.predict(&fast());
    assert!(!first.is_empty());
    assert_eq!(bits(&first), bits(&scene.predict(&fast()).0));
    assert_ne!(bits(&first), bits(&scene.predict(&Params { seed: 1, ..fast() }).0));
}

#[test]
fn memory_of_every_size_gives_the_error_or_the_model() {
    let scene = Scene::ring_on_peg(0.0);
    let params = Params { samples: 1000, min_cluster_points: 5, ..fast() };
    let monitor = Monitor::new();
    let (mesh, cloud, limits) = (scene.object.mesh(), scene.cloud(), scene.limits(&params));
    let needed = [Object::bytes(&limits), Supporter::bytes(&limits)];
    let mut memory = vec![0xFF; needed[0].max(needed[1]) + 64];
    for size in 0..needed[0] {
        let error = Object::analyze(&mesh, &params, &mut memory[..size], &monitor).err();
        assert_eq!(error, Some(AnalysisError::OutOfMemory(OutOfMemory { needed: needed[0], given: size })));
    }
    for size in 0..needed[1] {
        let error = Supporter::analyze(&cloud, &params, &mut memory[..size], &monitor).err();
        assert_eq!(error, Some(AnalysisError::OutOfMemory(OutOfMemory { needed: needed[1], given: size })));
    }
    // Exactly enough is enough wherever it begins, and what was in it does not matter.
    let mut sites = Vec::new();
    for offset in 0..17 {
        memory.fill(offset as u8);
        let object = Object::analyze(&mesh, &params, &mut memory[offset..offset + needed[0]], &monitor);
        sites.push(object.unwrap().sites().collect::<std::vec::Vec<_>>());
        memory.fill(!offset as u8);
        Supporter::analyze(&cloud, &params, &mut memory[offset..offset + needed[1]], &monitor).unwrap();
    }
    assert!(!sites[0].is_empty() && sites.iter().all(|s| *s == sites[0]));
}

#[test]
fn a_work_limit_gives_the_best_so_far_and_says_so() {
    let scene = Scene::key_on_peg();
    let unlimited = Monitor::new();
    scene.analyse(&fast(), &unlimited, |object, supporter| {
        let mut all = [HangingPose::default(); 100];
        let full = predict(object, supporter, &fast(), &mut all, &unlimited).unwrap();
        assert_eq!(full.stopped, None);
        let mut some = [HangingPose::default(); 100];
        let limited = Monitor::with_work_limit(full.work.distance_queries / 2);
        let part = predict(object, supporter, &fast(), &mut some, &limited).unwrap();
        assert_eq!((part.stopped, part.rejection), (Some(Stop::WorkLimit), None));
        assert!(!part.poses.is_empty() && part.poses.len() < full.poses.len());
        assert!(part.poses.iter().all(|pose| full.poses.contains(pose)));
        let mut again = [HangingPose::default(); 100];
        assert_eq!(predict(object, supporter, &fast(), &mut again, &limited).unwrap().poses, part.poses);

        unlimited.cancel();
        let cancelled = predict(object, supporter, &fast(), &mut some, &unlimited).unwrap();
        assert_eq!((cancelled.stopped, cancelled.poses.len()), (Some(Stop::Cancelled), 0));
    });
    // A limited analysis says so too, and so does every prediction from it.
    let limited = Monitor::with_work_limit(4000);
    scene.analyse(&fast(), &limited, |object, supporter| {
        assert_eq!(object.stopped(), Some(Stop::WorkLimit));
        let mut poses = [HangingPose::default(); 5];
        let prediction = predict(object, supporter, &fast(), &mut poses, &Monitor::new()).unwrap();
        assert_eq!((prediction.stopped, prediction.rejection), (Some(Stop::WorkLimit), None));
    });
    let limits = scene.limits(&fast());
    let mut memory = vec![0; Object::bytes(&limits)];
    unlimited.cancel();
    let cancelled = Object::analyze(&scene.object.mesh(), &fast(), &mut memory, &unlimited);
    assert_eq!(cancelled.err(), Some(AnalysisError::Cancelled));
}

#[test]
fn fewer_places_for_poses_give_the_first_of_more() {
    let scene = Scene::dusty_key_on_peg();
    let params = Params { max_collision: 1.0, similar_radius: 0.0, radius_ratio: 0.0, ..fast() };
    scene.analyse(&params, &Monitor::new(), |object, supporter| {
        let mut all = [HangingPose::default(); 1000];
        let all = predict(object, supporter, &params, &mut all, &Monitor::new()).unwrap().poses;
        assert!(all.len() > 20 && all.iter().any(|pose| cost(pose).collision > 0));
        for count in [0, 1, 3, 20] {
            let mut some = vec![HangingPose::default(); count];
            let some = predict(object, supporter, &params, &mut some, &Monitor::new()).unwrap();
            assert_eq!(some.poses, &all[..count]);
        }
        // Collisions by brute force.
        for pose in all.iter().step_by(7) {
            let inside = distances(object, supporter, &pose.pose).filter(|distance| *distance < 0.0).count();
            assert_eq!(inside as u32, cost(pose).collision);
        }
    });
}

#[test]
fn broken_normals_are_mended_and_counted() {
    let mut scene = Scene::ring_on_peg(0.0);
    let (expected, _) = scene.predict(&fast());
    for (index, normal) in scene.normals.iter_mut().enumerate() {
        match index % 50 {
            0 => *normal = [0.0; 3],
            1..10 => *normal = normal.map(|x| 3.0 * x),
            _ => {}
        }
    }
    let count = scene.points.len();
    scene.analyse(&fast(), &Monitor::new(), |_, supporter| {
        assert_eq!(supporter.normals().estimated, count.div_ceil(50));
        assert!(supporter.normals().renormalised.abs_diff(count * 9 / 50) < 10);
    });
    let probes = [Point::new(0.03, 0.0, 0.0), Point::new(0.0, 0.03, 0.0)];
    let (mended, _) = scene.predict(&fast());
    assert!(mended.iter().any(|m| gap(&m.pose, &expected[0].pose, probes) < 0.01));
}

/// The product with few samples and a coarse field.
pub(super) fn product() -> Params {
    Params { samples: 2000, voxels: 100_000, ..Params::default() }
}

impl Scene {
    /// The ring on a peg whose end at +x is the higher one.
    fn ring_on_tilted_peg(degrees: f32) -> Self {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let along = Vector::new(cos, 0.0, sin) * 0.05;
        let (points, normals) = test_shapes::peg(Point::from(-along), Point::from(along), 0.005, 0.001);
        Self { points, normals, ..Self::ring_on_peg(0.0) }
    }

    /// All of it turned about the vertical through the origin.
    fn turned(&self, degrees: f32) -> Self {
        let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), degrees.to_radians());
        let rotate = |v: &[f32; 3]| -> [f32; 3] { (turn * Vector::from(*v)).into() };
        Self {
            points: self.points.iter().map(rotate).collect(),
            normals: self.normals.iter().map(rotate).collect(),
            object: self.object.clone(),
        }
    }
}

/// Asserts what holds of every pose that was let go: clear where it is released, and at rest below what bears it.
#[track_caller]
fn assert_hangs(poses: &[HangingPose], scene: &Scene, params: &Params) {
    assert!(!poses.is_empty());
    scene.analyse(params, &Monitor::new(), |object, supporter| {
        let mut last = Kind::ALL.map(|kind| (kind, 1.0));
        for pose in poses {
            let rest = pose.rest.unwrap();
            // Within a kind, only a longer lever comes before a higher probability, and it counts for a tenth.
            let (_, last) = last.iter_mut().find(|(kind, _)| *kind == rest.kind).unwrap();
            assert!(
                rest.probability >= params.min_probability && rest.probability <= *last / 0.9,
                "{rest:?}"
            );
            *last = rest.probability;
            let least = distances(object, supporter, &pose.pose).fold(f32::INFINITY, f32::min);
            assert!(least > 0.0 && least < 0.003, "released off the supporter, but not far: {least}");
            assert!(rest.clearance > 0.0 && rest.clearance <= params.clearance);
            let [from, to] = [pose.pose, rest.pose].map(|pose| pose * object.centre_of_mass());
            assert!((from.z - to.z - rest.sinking).abs() < 1e-5, "{rest:?}");
            let contacts = rest.contacts();
            let highest = contacts.iter().map(|c| c.position.z).fold(f32::NEG_INFINITY, f32::max);
            assert!(!contacts.is_empty() && to.z < highest, "{to} {contacts:?}");
        }
    });
}

#[test]
fn what_is_let_go_stays_below_what_bears_it() {
    for degrees in [0.0, 10.0] {
        let scene = Scene::ring_on_tilted_peg(degrees);
        let (poses, stage) = scene.predict(&product());
        assert_eq!(stage, None, "{degrees}");
        assert_hangs(&poses, &scene, &product());
    }
    let scene = Scene::key_on_peg();
    assert_hangs(&scene.predict(&product()).0, &scene, &product());
}

#[test]
fn a_long_hole_goes_over_a_sloping_peg() {
    // Level, a hole of this length needs 8.5 mm of play on a peg that rises by 12 degrees; it has 2.4.
    let object = test_shapes::tube(0.0062, 0.02, 0.04);
    let scene = Scene { object, ..Scene::ring_on_tilted_peg(12.0) };
    let (poses, stage) = scene.predict(&product());
    assert_eq!(stage, None);
    assert_hangs(&poses, &scene, &product());
    let slope = |pose: &HangingPose| (pose.pose * Vector::z()).z.abs().asin().to_degrees();
    assert!(poses.iter().all(|pose| (slope(pose) - 12.0).abs() < 4.0), "{}", slope(&poses[0]));
}

#[test]
fn a_peg_beyond_the_friction_angle_lets_the_ring_slide() {
    let hangs = |degrees: f32, friction: f32| {
        !Scene::ring_on_tilted_peg(degrees).predict(&Params { friction, ..product() }).0.is_empty()
    };
    assert!(hangs(10.0, 0.4) && !hangs(40.0, 0.4));
    // At ten degrees the points of the peg, a millimetre apart, still hold what is slippery.
    assert!(hangs(30.0, 0.9) && !hangs(20.0, 0.02));
}

#[test]
fn the_product_rejects_for_the_right_reason() {
    let ring = || Scene::ring_on_peg(0.0);
    let cube = test_shapes::prism(0.06, &[[-0.03, -0.03], [0.03, -0.03], [0.03, 0.03], [-0.03, 0.03]]);
    for object in [test_shapes::ball(0.04, 32, 64), cube] {
        let convex = Scene { object, ..ring() };
        assert_eq!(convex.predict(&product()), (vec![], Some(Stage::NoContactPoints)));
    }
    let wall = test_shapes::grid(0.2, 60).map(|p| Point::new(0.0, p.x, p.y));
    let wall = Scene { normals: vec![[1.0, 0.0, 0.0]; wall.vertices.len()], points: wall.vertices, ..ring() };
    assert_eq!(wall.predict(&product()), (vec![], Some(Stage::NoSupport)));
    // Everywhere something is in the way.
    let dusty = Scene { object: ring().object, ..Scene::dusty_key_on_peg() };
    assert_eq!(dusty.predict(&product()), (vec![], Some(Stage::AllCollide)));
    let steep = Scene::ring_on_tilted_peg(40.0).predict(&product());
    assert_eq!(steep, (vec![], Some(Stage::SlidesOff)));
}

#[test]
fn a_peg_in_the_shadow_of_the_ring_is_unseen() {
    // The torus has its axis along z. Seen along the axis its hole is free; seen from the side, it is in the shadow.
    let scene = Scene::ring_on_peg(0.4);
    let params = Params { min_probability: 0.5, ..product() };
    let stage = |viewpoint: [f32; 3]| {
        let viewpoints = [viewpoint];
        let mesh = scene.object.mesh().seen_from(&viewpoints).unwrap();
        let limits = scene.limits(&params);
        let (mut object, mut supporter) =
            (vec![0; Object::bytes(&limits)], vec![0; Supporter::bytes(&limits)]);
        let object = Object::analyze(&mesh, &params, &mut object, &Monitor::new()).unwrap();
        let supporter = Supporter::analyze(&scene.cloud(), &params, &mut supporter, &Monitor::new()).unwrap();
        let mut poses = [HangingPose::default(); 5];
        let found = predict(&object, &supporter, &params, &mut poses, &Monitor::new()).unwrap();
        (found.poses.first().and_then(|pose| pose.rest), found.rejection.map(|rejection| rejection.stage))
    };
    let (rest, rejection) = stage([0.0, 0.0, 0.5]);
    assert_eq!(rejection, None);
    let unseen = rest.unwrap().unseen;
    assert!(unseen.shadow < 0.05 && (unseen.object - 0.75).abs() < 0.02, "{unseen:?}");
    assert_eq!(stage([0.5, 0.0, 0.0]), (None, Some(Stage::Unseen)));
}

/// Points on a peg of 5 mm radius, ever farther apart.
#[test]
fn the_farther_apart_the_points_the_less_is_certain() {
    let said = |apart: f32, min_probability: f32| {
        let mut scene = Scene::ring_on_peg(0.0);
        let along = Vector::x() * 0.05;
        let middle = Point::new(0.3, -0.2, 0.5);
        (scene.points, scene.normals) = test_shapes::peg(middle - along, middle + along, 0.005, apart);
        let (poses, rejection) = scene.predict(&Params { min_probability, ..product() });
        (poses.first().map_or(0.0, |pose| pose.rest.unwrap().probability), rejection)
    };
    let [(dense, _), (thinned, _), (sparse, _)] = [0.001, 0.004, 0.02].map(|apart| said(apart, 0.0));
    assert!((dense - thinned).abs() < 0.01, "{dense} {thinned}");
    assert!(sparse > 0.0 && sparse < 0.7 * dense, "{sparse} {dense}");
    assert_eq!(said(0.02, 0.9), (0.0, Some(Stage::TooSparse)));
}

#[test]
fn what_the_memory_held_does_not_matter() {
    let scene = Scene::key_on_peg();
    let params = product();
    let poses_in = |held: u8| {
        let limits = scene.limits(&params);
        let (mut object, mut supporter) =
            (vec![held; Object::bytes(&limits)], vec![held; Supporter::bytes(&limits)]);
        let object = Object::analyze(&scene.object.mesh(), &params, &mut object, &Monitor::new()).unwrap();
        let cloud = scene.cloud().seen_from(&[[0.3, -0.9, 0.8]]).unwrap();
        let supporter = Supporter::analyze(&cloud, &params, &mut supporter, &Monitor::new()).unwrap();
        let mut memory = vec![held; predict_bytes(&supporter.limits())];
        let mut poses = [HangingPose::default(); 5];
        let found = super::predict(
            &object,
            &supporter,
            &Request::ANY,
            &params,
            &mut poses,
            &mut memory,
            &Monitor::new(),
        )
        .unwrap();
        (found.counts, found.poses.to_vec())
    };
    let (counts, poses) = poses_in(0);
    assert!(!poses.is_empty());
    assert_eq!((counts, poses), poses_in(0xA5));
}

#[test]
fn the_product_gives_the_same_bytes_twice() {
    let scene = Scene::key_on_peg();
    let bits = |params: &Params| std::format!("{:?}", scene.predict(params).0);
    let first = bits(&product());
    assert_eq!(first, bits(&product()));
    assert_ne!(first, bits(&Params { seed: 1, ..product() }));
}

#[test]
fn exactly_enough_memory_lets_go() {
    let scene = Scene::ring_on_peg(0.0);
    scene.analyse(&product(), &Monitor::new(), |object, supporter| {
        let needed = predict_bytes(&scene.limits(&product()));
        let mut memory = vec![0xFF; needed + 17];
        let mut run = |from: usize, size: usize, fill: u8| {
            memory.fill(fill);
            let mut poses = [HangingPose::default(); 4];
            let memory = &mut memory[from..from + size];
            let found = super::predict(
                object,
                supporter,
                &Request::ANY,
                &product(),
                &mut poses,
                memory,
                &Monitor::new(),
            );
            found.map(|prediction| prediction.poses.to_vec())
        };
        let first = run(0, needed, 0).unwrap();
        assert!(!first.is_empty());
        // Wherever it begins, and what was in it does not matter.
        for from in [1, 7, 16] {
            assert_eq!(run(from, needed, !0), Ok(first.clone()));
        }
        let too_small = OutOfMemory { needed, given: needed - 1 };
        assert_eq!(run(0, needed - 1, 0), Err(PredictError::OutOfMemory(too_small)));
        assert!(run(0, 0, 0).is_err());
    });
}

#[test]
fn a_work_limit_gives_what_has_come_to_rest_so_far() {
    let scene = Scene::key_on_peg();
    let params = Params { firm_enough: 1000, settle_attempts: 12, ..product() };
    // Poses that are alike replace each other, so that a part would not be contained in the whole.
    let request = Request { distinct: Distance { position: 0.0, rotation: 0.0 }, ..Request::ANY };
    scene.analyse(&params, &Monitor::new(), |object, supporter| {
        let mut memory = vec![0; predict_bytes(&scene.limits(&params))];
        let mut slots = [HangingPose::default(); 50];
        let full =
            super::predict(object, supporter, &request, &params, &mut slots, &mut memory, &Monitor::new())
                .unwrap();
        assert_eq!(full.stopped, None);
        assert!(full.poses.len() > 1, "{:?}", full.counts);
        let mut partial = 0;
        for tenths in [1, 5, 8, 9] {
            let monitor = Monitor::with_work_limit(full.work.distance_queries * tenths / 10);
            let mut slots = [HangingPose::default(); 50];
            let part =
                super::predict(object, supporter, &request, &params, &mut slots, &mut memory, &monitor)
                    .unwrap();
            assert_eq!((part.stopped, part.rejection), (Some(Stop::WorkLimit), None));
            assert!(part.poses.iter().all(|pose| full.poses.contains(pose)));
            partial += usize::from(!part.poses.is_empty() && part.poses.len() < full.poses.len());
        }
        assert!(partial > 0, "some limit leaves some of them");
        let monitor = Monitor::new();
        monitor.cancel();
        let cancelled =
            super::predict(object, supporter, &request, &params, &mut slots, &mut memory, &monitor).unwrap();
        assert_eq!((cancelled.stopped, cancelled.poses.len()), (Some(Stop::Cancelled), 0));
    });
}

/// Wherever a work limit ends the search: what a second thread did in vain leaves no trace.
#[test]
fn a_second_thread_changes_nothing() {
    let params = Params::default();
    let scene = Scene::key_on_peg();
    let run = |limit: u64| {
        let alone = format_run(&scene, &params, &Monitor::with_work_limit(limit));
        let monitor = Monitor::with_work_limit(limit).with_threads(&ScopedThreads);
        assert_eq!(format_run(&scene, &params, &monitor), alone, "limit {limit}");
        alone
    };
    let all = run(u64::MAX);
    let stopped = (1..8).filter(|k| run(50_000 * k) != all).count();
    assert!(stopped > 3, "{stopped}");
}

/// All that a prediction answers, with the work that it did.
fn format_run(scene: &Scene, params: &Params, monitor: &Monitor) -> String {
    let mut poses = [HangingPose::default(); 20];
    let mut answer = String::new();
    scene.analyse(params, monitor, |object, supporter| {
        answer = format!("{:?}", predict(object, supporter, params, &mut poses, monitor).unwrap());
    });
    answer
}

#[test]
fn each_part_can_be_switched_off() {
    let scene = Scene::ring_on_peg(0.0);
    let (poses, stage) = scene.predict(&Params { settle: false, ..product() });
    assert!(stage.is_none() && poses.len() > 10);
    assert!(poses.iter().all(|pose| pose.rest.is_none() && pose.matched.is_none()));

    // The paper's candidates, let go.
    let params = Params { candidates: Candidates::Sites, settle: true, voxels: 100_000, ..fast() };
    let matched = scene.predict(&fast()).0;
    let (poses, stage) = scene.predict(&params);
    assert_eq!(stage, None);
    assert!(poses.len() <= matched.len());
    assert!(poses.iter().all(|pose| matched.iter().any(|m| m.matched == pose.matched)));
    assert_hangs(&poses, &scene, &params);
}

#[test]
fn without_a_field_nothing_can_be_let_go() {
    let scene = Scene::ring_on_peg(0.0);
    for params in [Params { voxels: 0, ..product() }, Params { settle: true, ..fast() }] {
        let error = params.validate().unwrap_err();
        assert!(std::format!("{error}").starts_with("voxels = 0 "), "{error}");
        let mut memory = vec![0; Object::bytes(&scene.limits(&params))];
        let object = Object::analyze(&scene.object.mesh(), &params, &mut memory, &Monitor::new());
        assert_eq!(object.err(), Some(AnalysisError::Params(error)));
    }
    // An object that was analysed for another profile.
    scene.analyse(&fast(), &Monitor::new(), |object, supporter| {
        let mut poses = [HangingPose::default(); 1];
        let prediction = predict(object, supporter, &product(), &mut poses, &Monitor::new());
        assert_eq!(prediction, Err(PredictError::NoDistanceField));
    });
}

#[test]
fn the_product_hangs_in_every_direction() {
    for degrees in [30.0, 90.0, 200.0] {
        let scene = Scene::key_on_peg().turned(degrees);
        assert_hangs(&scene.predict(&product()).0, &scene, &product());
    }
}

#[test]
fn any_pose_can_be_let_go() {
    let (scene, params) = (Scene::key_on_peg(), product());
    scene.analyse(&params, &Monitor::new(), |object, supporter| {
        let mut poses = [HangingPose::default(); 1];
        let found = predict(object, supporter, &params, &mut poses, &Monitor::new()).unwrap();
        let (release, rest) = (found.poses[0].pose, found.poses[0].rest.unwrap().pose);
        let mut memory = vec![0; predict_bytes(&scene.limits(&params))];
        let mut fate = |pose: &Pose| {
            let_go(object, supporter, pose, &params, &mut memory, &Monitor::new()).unwrap().unwrap()
        };
        // What was predicted to rest rests, and there.
        let stays = fate(&release);
        assert_eq!(stays.fate, Fate::Rests);
        assert!(gap(&stays.pose, &rest, [Point::origin(), Point::new(0.0, 0.1, 0.0)]) < 0.005, "{stays:?}");
        // Beside the supporter it falls without turning.
        let aside = Translation3::new(0.0, 0.5, 0.0) * release;
        let falls = fate(&aside);
        assert_eq!(falls.fate, Fate::SlidesOff);
        assert!(falls.pose.translation.z < aside.translation.z - 0.05, "{falls:?}");
    });
}

#[test]
fn poses_that_are_no_rigid_motions_are_refused() {
    let (scene, params) = (Scene::key_on_peg(), product());
    scene.analyse(&params, &Monitor::new(), |object, supporter| {
        let quaternion = |w: f32| UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, 0.0, 0.0, 0.0));
        let mut memory = vec![0; predict_bytes(&scene.limits(&params))];
        for (pose, is_rigid) in [
            (Pose::translation(0.0, 0.5, 1e6), true),
            (Pose::translation(0.0, 0.5, 1.1e6), false),
            (Pose::translation(f32::NAN, 0.5, 0.0), false),
            (Pose::from_parts(Translation3::identity(), quaternion(-1.0)), true),
            (Pose::from_parts(Translation3::identity(), quaternion(1.1)), false),
            (Pose::from_parts(Translation3::identity(), quaternion(f32::NAN)), false),
        ] {
            let gone = let_go(object, supporter, &pose, &params, &mut memory, &Monitor::new());
            assert_eq!(gone.err(), (!is_rigid).then_some(PredictError::Release), "{pose}");
            let hung = [Hung { object, pose: Pose::identity() }, Hung { object, pose }];
            let request = Request { hung: &hung, ..Request::ANY };
            let expected = if is_rigid { Ok(()) } else { Err(RequestError::Hung { index: 1 }) };
            assert_eq!(request.validate(), expected, "{pose}");
        }
    });
}

#[test]
fn whoever_watches_sees_each_release_and_how_it_ended() {
    let (scene, params) = (Scene::key_on_peg(), product());
    scene.analyse(&params, &Monitor::new(), |object, supporter| {
        let seen = std::sync::Mutex::new(std::vec::Vec::new());
        let watch = |pose: &Pose, fate| seen.lock().unwrap().push((*pose, fate));
        let request = Request { watch: Some(Watch(&watch)), ..Request::ANY };
        let (mut poses, mut unwatched) = ([HangingPose::default(); 3], [HangingPose::default(); 3]);
        let mut memory = vec![0; predict_bytes(&scene.limits(&params))];
        let monitor = Monitor::new();
        let found =
            super::predict(object, supporter, &request, &params, &mut poses, &mut memory, &monitor).unwrap();
        let counts = found.counts.settling;
        let best = found.poses[0];
        // It changes nothing.
        assert_eq!(predict(object, supporter, &params, &mut unwatched, &monitor).unwrap().poses[0], best);
        let seen = seen.into_inner().unwrap();
        assert_eq!(seen.len(), counts.released);
        assert_eq!(seen.iter().filter(|(_, fate)| *fate == Fate::Rests).count(), counts.at_rest);
        // Each release ends as it did, and the best one where it was said to, but for the rounding of the poses that are told.
        let mut replay = |pose: &Pose| {
            let mut track = std::vec::Vec::new();
            let mut watch = |seconds: f32, pose: &Pose| track.push((seconds, *pose));
            let release = (object, supporter);
            let end = watch_release(release, pose, &params, &mut memory, &Monitor::new(), &mut watch);
            let end = end.unwrap().unwrap();
            assert_eq!(track.last().unwrap().1, end.pose);
            assert!(track.is_sorted_by(|(earlier, _), (later, _)| earlier < later));
            end
        };
        for (pose, fate) in seen.iter().take(30) {
            assert_eq!(replay(pose).fate, *fate);
        }
        let end = replay(&best.pose);
        assert_eq!(end.fate, Fate::Rests);
        let probes = [Point::origin(), object.centre_of_mass()];
        assert!(gap(&end.pose, &best.rest.unwrap().pose, probes) < 1e-5);
    });
}

#[test]
fn no_room_for_poses_is_no_rejection() {
    let scene = Scene::ring_on_peg(0.0);
    scene.analyse(&product(), &Monitor::new(), |object, supporter| {
        for settle in [true, false] {
            let params = Params { settle, ..product() };
            let found = predict(object, supporter, &params, &mut [], &Monitor::new()).unwrap();
            assert_eq!((found.poses.len(), found.rejection), (0, None));
        }
    });
}

#[test]
fn poses_that_differ_by_a_symmetry_are_one() {
    let scene = Scene::ring_on_peg(0.4);
    let params = Params { firm_enough: 1000, ..product() };
    scene.analyse(&params, &Monitor::new(), |object, supporter| {
        let folds: Vec<u32> = object.symmetries().iter().map(|symmetry| symmetry.fold).collect();
        assert_eq!(folds, [0, 2]);
        // Near enough that the peg has several places.
        let distinct = Distance { position: 0.01, ..Request::ANY.distinct };
        let mut memory = vec![0; predict_bytes(&supporter.limits())];
        let mut hang = |symmetries| {
            let mut poses = [HangingPose::default(); 20];
            let request = Request { symmetries, distinct, ..Request::ANY };
            let monitor = Monitor::new();
            let found =
                super::predict(object, supporter, &request, &params, &mut poses, &mut memory, &monitor);
            found.unwrap().poses.to_vec()
        };
        // Pairs of one kind at one place whose ring has the same axis, which the ring does not tell apart.
        let same = |poses: &[HangingPose]| {
            let rests: Vec<Rest> = poses.iter().map(|pose| pose.rest.unwrap()).collect();
            let Distance { position, rotation } = distinct;
            let is_same = |a: &Rest, b: &Rest| {
                let apart = a.pose * object.centre_of_mass() - b.pose * object.centre_of_mass();
                let angle = degrees_between_lines(&(a.pose * Vector::z()), &(b.pose * Vector::z()));
                // What is just at the limit may be either.
                a.kind == b.kind && apart.norm() < position - 1e-4 && angle < rotation.to_degrees() - 0.5
            };
            let of = |index: usize, rest: &Rest| {
                rests[..index].iter().filter(|other| is_same(other, rest)).count()
            };
            rests.iter().enumerate().map(|(index, rest)| of(index, rest)).sum::<usize>()
        };
        let detected = hang(None);
        assert!(detected.len() > 1 && same(&detected) == 0, "{} of {}", same(&detected), detected.len());
        let none = hang(Some(&[]));
        assert!(same(&none) > 0 && none.len() > detected.len());
        let given = hang(Some(object.symmetries()));
        assert_eq!(given, detected);
        // About an axis that is none of the ring's, what differs by a turn about its own axis stays different.
        assert!(same(&hang(Some(&[Symmetry { axis: Vector::x(), fold: 2 }]))) > 0);
        let broken = Request { symmetries: Some(&[Symmetry { axis: Vector::x(), fold: 1 }]), ..Request::ANY };
        assert_eq!(broken.validate(), Err(RequestError::Symmetry { index: 0 }));
    });
}
