//! Rest poses, falls and margins with known answers, which `docs/MECHANICS.md` derives.

use super::body::State;
use super::contact::{Contact, Contacts};
use super::motion::Motion;
use super::neighbourhood::Neighbourhood;
use super::patch::Patch;
use super::*;
use crate::geometry::{DistanceField, MassProperties, Point, PointTree, Pose, Surface, Vector};
use crate::memory::{Arena, model_bytes};
use crate::monitor::{Meter, Monitor};
use crate::params::Params;
use crate::perception::cleaning::spacing;
use crate::random::Random;
use crate::test_shapes::{self, Shape};
use nalgebra::{Translation3, UnitQuaternion};
use std::vec::Vec;

/// Points with normals.
type Cloud = (Vec<[f32; 3]>, Vec<[f32; 3]>);

/// An object and the cloud of a supporter.
struct Scene {
    object: Shape,
    cloud: Cloud,
}

/// A scene with its body and support built.
struct Lab<'a> {
    body: Body<'a>,
    support: Support<'a>,
    sleeps: Vec<Sleep>,
    other_sleeps: Vec<Sleep>,
}

impl Scene {
    fn new(object: Shape, cloud: Cloud) -> Self {
        Self { object, cloud }
    }

    fn try_out<R>(&self, check: impl FnOnce(&mut Lab) -> R) -> R {
        const VOXELS: usize = 200_000;
        let (mesh, (points, normals)) = (self.object.mesh(), &self.cloud);
        let (triangles, count) = (mesh.triangles().len(), points.len());
        let lasting = Surface::bytes(triangles)
            + DistanceField::bytes(VOXELS)
            + PointTree::bytes(count)
            + Room::bytes(count);
        let scratch = [
            MassProperties::scratch_bytes(mesh.vertices().len(), triangles),
            Surface::scratch_bytes(triangles),
            DistanceField::scratch_bytes(triangles, VOXELS),
            Support::scratch_bytes(count),
        ];
        let needed = model_bytes(lasting + scratch.into_iter().max().unwrap());
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let mass = MassProperties::of(&mesh, arena.scratch(), &Meter::unwatched()).unwrap();
        let surface = Surface::build(&mesh, false, &mut arena, &Meter::unwatched()).unwrap();
        let field = DistanceField::build(&surface, VOXELS, &mut arena, &mut Meter::unwatched()).unwrap();
        let points: Vec<Point> = points.iter().map(|p| Point::from(*p)).collect();
        let tree = PointTree::build(&points, &mut arena, &Meter::unwatched()).unwrap();
        let normals: Vec<Vector> = tree.order().iter().map(|&i| Vector::from(normals[i as usize])).collect();
        let room = Room::new(count, &mut arena).unwrap();
        let mut spacings = vec![0.0; count];
        spacing::measure(&tree, &mut spacings, &Meter::unwatched()).unwrap();
        let support = Support::fit(
            tree,
            (&normals, &spacings, &vec![0; count], &vec![0; count]),
            room,
            arena.scratch(),
            &Meter::unwatched(),
        )
        .unwrap();
        let centre = mass.volume_centroid.expect("the test shapes are closed");
        let reach = mesh.vertices().iter().map(|v| (Point::from(*v) - centre).norm()).fold(0.0, f32::max);
        let body = Body {
            centre_error: 0.0,
            field: &field,
            surface: &surface,
            centre,
            inverse_inertia: mass.inertia.try_inverse().unwrap(),
            frame: &Pose::identity(),
            reach,
            extent: surface.aabb().extents().max(),
            views: Views::default(),
        };
        let sleeps = vec![Sleep::default(); Support::sleepers(count)];
        check(&mut Lab { body, support, other_sleeps: sleeps.clone(), sleeps })
    }
}

const DOWN: Vector = Vector::new(0.0, 0.0, -1.0);
const FRICTION: f32 = 0.4;

fn with_friction(friction: f32) -> Params {
    Params { friction, ..Params::default() }
}

/// The downward direction, turned by an angle towards a horizontal direction.
fn tilted(degrees: f32, towards: Vector) -> Vector {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DOWN * cos + towards * sin
}

impl Lab<'_> {
    /// Releases the body at `pose`.
    fn settle(&mut self, pose: &Pose, friction: f32) -> (Fate, Pose) {
        self.settle_with(pose, &DOWN, &with_friction(friction))
    }

    /// Releases the body at `pose` with gravity along `down`.
    fn settle_with(&mut self, pose: &Pose, down: &Vector, params: &Params) -> (Fate, Pose) {
        let (monitor, scene) = (Monitor::new(), (&self.body, &self.support));
        let (settings, mut meter) = (Settings::damped(params), Meter::new(&monitor));
        let settled = settle(scene, pose, down, settings, &mut self.sleeps, &mut meter).unwrap();
        (settled.fate, settled.pose)
    }

    /// Releases the body at `pose` and returns its rest pose.
    #[track_caller]
    fn rest(&mut self, pose: &Pose, friction: f32) -> Pose {
        let (fate, pose) = self.settle(pose, friction);
        assert_eq!(fate, Fate::Rests, "{pose}");
        pose
    }

    /// Simulates the body from rest at `pose` with gravity along `down`, and calls `see` after each step.
    fn watch(
        &mut self,
        (pose, down): (&Pose, &Vector),
        settings: Settings,
        seconds: f32,
        mut see: impl FnMut(&Body, &State),
    ) -> State {
        let (monitor, scene) = (Monitor::new(), (&self.body, &self.support));
        let mut meter = Meter::new(&monitor);
        let mut motion = Motion::new(scene, self.body.at(pose), settings, &mut self.sleeps);
        for _ in 0..settings.steps(seconds) {
            motion.step(&(down * GRAVITY), &mut meter).unwrap();
            see(&self.body, &motion.state);
        }
        motion.state
    }

    /// Displacement of the centre of mass in half a second of gravity along `down`.
    fn drift(&mut self, pose: &Pose, down: &Vector, friction: f32) -> Vector {
        let end = self.watch((pose, down), Settings::damped(&with_friction(friction)), 0.5, |_, _| {});
        end.centre - pose * self.body.centre
    }

    fn contacts(&mut self, rest: &Pose) -> Vec<margin::Contact> {
        let (monitor, scene) = (Monitor::new(), (&self.body, &self.support));
        let (params, mut meter) = (Params::default(), Meter::new(&monitor));
        carrying_contacts(scene, rest, &DOWN, &params, &mut self.sleeps, &mut meter).unwrap().to_vec()
    }

    /// How the body hangs where it comes to rest after a release.
    #[track_caller]
    fn kind(&mut self, release: &Pose) -> Kind {
        let rest = self.rest(release, FRICTION);
        let contacts = self.contacts(&rest);
        let (monitor, scene) = (Monitor::new(), (&self.body, &self.support));
        kind_of(scene, &rest, &contacts, &-DOWN, &mut Meter::new(&monitor)).unwrap()
    }

    fn margin(&mut self, rest: &Pose) -> Margin {
        let contacts = self.contacts(rest);
        let (monitor, scene) = (Monitor::new(), (&self.body, &self.support));
        let (at, params, mut meter) = ((rest, &contacts[..]), Params::default(), Meter::new(&monitor));
        let sleeps = [&mut self.sleeps[..], &mut self.other_sleeps];
        margin(scene, at, &DOWN, &params, 0.0, sleeps, &mut meter).unwrap()
    }

    fn is_clear(&self, pose: &Pose, clearance: f32) -> bool {
        let monitor = Monitor::new();
        let scene = (&self.body, &self.support);
        first_within(scene, pose, clearance, &mut Meter::new(&monitor)).unwrap().is_none()
    }
}

fn turned(axis: Vector, degrees: f32) -> UnitQuaternion<f32> {
    UnitQuaternion::new(axis * degrees.to_radians())
}

fn at(x: f32, y: f32, z: f32) -> Pose {
    Pose::translation(x, y, z)
}

/// A rectangle of points around the origin, about 1.2 mm apart: the quasi-random sequence R2 (Roberts 2018).
fn plane(width: f32, depth: f32, place: impl Fn(Point) -> Point) -> Cloud {
    let count = (width * depth / 0.0012_f32.powi(2)) as usize;
    let at = |u: f32, v: f32| place(Point::new(width * (u - 0.5), depth * (v - 0.5), 0.0));
    let normal = (place(Point::new(0.0, 0.0, 1.0)) - place(Point::origin())).normalize();
    let points = (1..=count).map(|i| {
        let i = i as f64;
        at((i * 0.754_877_666).fract() as f32, (i * 0.569_840_291).fract() as f32).into()
    });
    (points.collect(), vec![normal.into(); count])
}

fn together(parts: impl IntoIterator<Item = Cloud>) -> Cloud {
    parts.into_iter().reduce(|(p, n), (q, m)| ([p, q].concat(), [n, m].concat())).unwrap()
}

/// Radii of the ring's centre line and of its wire, metres.
const RING: [f32; 2] = [0.030, 0.004];
/// Depth of the hanging ring's centre below the axis of a rod of this radius, metres.
fn hang(rod: f32) -> f32 {
    RING[0] - RING[1] - rod
}

fn ring() -> Shape {
    test_shapes::torus(RING[0], RING[1], 72, 24)
}

/// A horizontal rod around the origin along a direction.
fn rod(along: Vector, length: f32, radius: f32) -> Cloud {
    let half = along.normalize() * (0.5 * length);
    test_shapes::peg(Point::from(-half), Point::from(half), radius, 0.0012)
}

/// Pose of a ring just above a rod of radius 5 mm along x, with the ring's axis along x.
fn on_rod() -> Pose {
    Pose::from_parts(Translation3::new(0.0, 0.0, -hang(0.005) + 0.001), turned(Vector::y(), 90.0))
}

#[test]
fn a_ring_hangs_straight_below_the_rod() {
    Scene::new(ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        // Released beside the middle of the rod.
        let release = at(0.01, 0.004, 0.0) * on_rod();
        assert!(lab.is_clear(&release, 0.0));
        // With friction it may rest anywhere on the rod's top, with its centre straight below the contacts.
        let rest = lab.rest(&release, FRICTION);
        let centre = rest * Point::origin();
        assert!(centre.x.hypot(centre.y) < 0.02, "{centre}");
        assert!((centre.z + hang(0.005)).abs() < 0.0005, "{centre}");
        let contacts = lab.contacts(&rest);
        let borne: f32 = contacts.iter().map(|contact| contact.force).sum();
        let bears: f32 =
            contacts.iter().map(|contact| contact.force * contact.position.y).sum::<f32>() / borne;
        assert!((centre.y - bears).abs() < 0.0005, "not below its contacts: {centre}, {bears}");
        assert!(bears.abs() < 0.005 * FRICTION.atan().sin(), "steeper than friction holds: {bears}");
        // Without friction, after a long time, its centre is straight below the rod.
        let mut still = release;
        for _ in 0..8 {
            still = lab.rest(&still, 0.0);
        }
        let centre = still * Point::origin();
        assert!(centre.y.abs() < 0.0005, "not below the rod: {centre}");
    });
}

/// The point of a patch nearest to a step from its centre: its offset along and across, and the step to it.
fn next_to(patch: &Patch, step: Vector) -> ([f32; 2], Vector) {
    let [along, across, normal] = patch.axes();
    let offset = patch.clamp([step.dot(&along), step.dot(&across)]);
    (offset, along * offset[0] + across * offset[1] - normal * patch.depth(offset))
}

#[test]
fn patches_follow_a_bar_and_end_with_it() {
    // A rod of radius 5 mm along x.
    Scene::new(ring(), rod(Vector::x(), 0.06, 0.005)).try_out(|lab| {
        let support = &lab.support;
        let of_bar = |x: [f32; 2]| {
            let between =
                move |point: &Point| (x[0]..x[1]).contains(&point.x) && point.y.hypot(point.z) > 0.0045;
            support.positions().zip(support.patches).filter(move |(point, _)| between(point))
        };
        assert!(of_bar([-0.02, 0.02]).count() > 50);
        for (point, patch) in of_bar([-0.02, 0.02]) {
            let outward = Vector::new(0.0, point.y, point.z).normalize();
            // A body that leans along the bar is pushed perpendicularly to it.
            let lean = (outward + Vector::x() * 0.8).normalize();
            let pushed = patch.contact_normal(lean, next_to(patch, Vector::x() * 0.002).0);
            assert!((pushed - outward).norm() < 0.1, "{pushed} at {point}");
            // The rim of the patch lies on the rod, not on the tangent plane, which is 0.4 mm higher at 2 mm.
            let (offset, step) = next_to(patch, outward.cross(&Vector::x()) * 0.002);
            let aside = (point + step).coords.yz();
            assert!((aside.norm() - 0.005).abs() < 0.00015, "{aside} at {point}");
            // There it pushes away from the rod's axis.
            let away = Vector::new(0.0, aside.x, aside.y).normalize();
            let pushed = patch.contact_normal(away, offset);
            assert!((pushed - away).norm() < 0.05, "{pushed} instead of {away} at {point}");
        }
        // The patches of the flat ends do not stick out over their rims by a millimetre, as the corners of
        // rectangles would.
        let ends =
            support.positions().zip(support.patches).filter(|(_, patch)| patch.axes()[2].x.abs() > 0.9);
        for (point, patch) in ends {
            for k in 0..16 {
                let (sin, cos) = (core::f32::consts::TAU * k as f32 / 16.0).sin_cos();
                let place = point + next_to(patch, Vector::new(0.0, cos, sin) * 0.01).1;
                assert!(place.y.hypot(place.z) < 0.0058, "{place} of the patch at {point}");
            }
        }
        // At the very end a body that leans outwards is pushed outwards.
        let lean = |point: &Point| (Vector::new(0.0, point.y, point.z).normalize() + Vector::x()).normalize();
        let pushed_off = of_bar([0.0285, 0.0301]).filter(|(point, patch)| {
            let (offset, _) = next_to(patch, Vector::x() * 0.002);
            (patch.contact_normal(lean(point), offset) - lean(point)).norm() < 0.1
        });
        let all = of_bar([0.0285, 0.0301]).count();
        assert!(all > 5 && pushed_off.count() > 3 * all / 4, "{all}");
    });
}

#[test]
fn contacts_of_sleeping_patches_are_not_missed() {
    // A ring on a rod, displaced and rotated at random around its rest pose.
    Scene::new(ring(), rod(Vector::x(), 0.06, 0.004)).try_out(|lab| {
        let scene = (&lab.body, &lab.support);
        let (monitor, mut random) = (Monitor::new(), Random::new(8));
        let mut meter = Meter::new(&monitor);
        let mut state = lab.body.at(&on_rod());
        let mut awake = vec![Sleep::default(); lab.sleeps.len()];
        let mut neighbourhood = Neighbourhood::new(&mut lab.sleeps);
        let mut contacts = Contacts::new();
        let mut found = 0;
        for step in 0..4000 {
            neighbourhood.force_search();
            neighbourhood.update(&mut contacts, scene, &state, (0.001, 0.0), &mut meter).unwrap();
            let (mut all, mut anew) = (Contacts::new(), Neighbourhood::new(&mut awake));
            anew.update(&mut all, scene, &state, (0.001, 0.0), &mut meter).unwrap();
            found += all.len();
            for contact in &all {
                let is_same = |other: &Contact| other.index == contact.index && other.gap == contact.gap;
                assert!(contacts.iter().any(is_same), "{step}: {contact:?} is not among {contacts:?}");
            }
            let mut vector = |size: f32| Vector::from([(); 3].map(|()| (random.next_f32() - 0.5) * size));
            let back = (on_rod() * lab.body.centre - state.centre) * 0.02;
            let (shift, turn) = (vector(0.0008) + back, vector(0.02));
            neighbourhood.record_motion(&state, &shift, &turn);
            state.advance(&shift, &turn);
        }
        assert!(found > 4000, "{found}");
    });
}

#[test]
fn contacts_are_on_the_surface_where_the_field_is_not() {
    // A ball inside a pipe with a wall of 3 mm. The voxels are not much finer, so the field is inexact inside
    // the wall.
    let (inner, outer, radius) = (0.09, 0.093, 0.006);
    let points = (0..400).map(|i| {
        let (z, around) = (1.0 - (i as f32 + 0.5) / 200.0, i as f32 * 2.399_963);
        let (sin, cos) = around.sin_cos();
        Vector::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
    });
    let cloud = points.map(|p| (<[f32; 3]>::from(p * radius), <[f32; 3]>::from(p))).unzip();
    Scene::new(test_shapes::tube(inner, outer, 0.1), cloud).try_out(|lab| {
        assert!(lab.body.field.voxel_size() > 0.0015);
        let scene = (&lab.body, &lab.support);
        let (monitor, mut random) = (Monitor::new(), Random::new(5));
        let mut meter = Meter::new(&monitor);
        let (mut count, mut worst_of_field) = (0, 0.0_f32);
        for _ in 0..200 {
            let mut draw = |low: f32, high: f32| low + (high - low) * random.next_f32();
            let (sin, cos) = draw(0.0, core::f32::consts::TAU).sin_cos();
            let off_axis = inner - radius - draw(0.0, 0.0003);
            let shift = Vector::new(cos * off_axis, sin * off_axis, draw(-0.04, 0.04));
            let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), draw(0.0, 6.0));
            let state = lab.body.at(&Pose::from_parts(Translation3::from(shift), turn));
            let mut contacts = Contacts::new();
            let mut neighbourhood = Neighbourhood::new(&mut lab.sleeps);
            neighbourhood.update(&mut contacts, scene, &state, (0.0005, 0.0), &mut meter).unwrap();
            for contact in &contacts {
                let at = lab.body.centre + contact.anchor;
                let exact = lab.body.surface.signed_distance(&at);
                assert!((contact.gap.abs() - exact.abs()).abs() < 5e-5, "{} {exact}", contact.gap);
                count += 1;
                worst_of_field = worst_of_field.max((lab.body.field.distance(&at) - exact).abs());
            }
        }
        assert!(count > 100 && worst_of_field > 2e-4, "{count} {worst_of_field}");
    });
}

#[test]
fn the_corner_of_a_plate_pushes_along_the_normal_of_the_body() {
    // A body that leans over the corner of a flat patch, which ends along and across, is pushed along its own
    // normal.
    let patch = Patch {
        normal: Vector::z(),
        along: Vector::x(),
        extents: [0.002, 0.002],
        curvatures: [0.0; 4],
        straight: 2,
        ends: 1 | 1 << 2,
    };
    let lean = Vector::new(0.3, 0.3, 0.9).normalize();
    assert!((patch.contact_normal(lean, [0.0014, 0.0014]) - lean).norm() < 1e-3);
    // In the middle of the patch, and where the surface goes on, it is pushed along the patch's.
    assert!((patch.contact_normal(lean, [0.0, 0.0]) - Vector::z()).norm() < 1e-6);
    assert!((patch.contact_normal(lean, [-0.0014, -0.0014]) - Vector::z()).norm() < 1e-6);
}

#[test]
fn a_bar_with_a_round_end_is_fitted_to_few_points() {
    // A bar of radius 4 mm along x from -60 mm to 0, where it ends in half a ball, with points 3 mm apart. A
    // ball has as much surface per millimetre of height as the cylinder around it (Archimedes), and the
    // golden angle spreads the points around the axis.
    const RADIUS: f32 = 0.004;
    const COUNT: i32 = 180;
    let normal_at = |i: i32| {
        let (sin, cos) = (2.399_963_2 * i as f32).sin_cos();
        let beyond = ((0.064 * (i as f32 + 0.5) / COUNT as f32 - 0.06) / RADIUS).max(0.0);
        let around = (1.0 - beyond * beyond).sqrt();
        Vector::new(beyond, around * sin, around * cos)
    };
    let points = (0..COUNT).map(|i| {
        let along = (0.064 * (i as f32 + 0.5) / COUNT as f32 - 0.06).min(0.0);
        (Vector::x() * along + normal_at(i) * RADIUS).into()
    });
    let cloud = (points.collect(), (0..COUNT).map(|i| normal_at(i).into()).collect());
    Scene::new(ring(), cloud).try_out(|lab| {
        let patches = lab.support.positions().zip(lab.support.patches);
        for (point, patch) in patches.filter(|(point, _)| point.x > -0.05) {
            for side in [Vector::x(), -Vector::x(), Vector::y(), -Vector::y(), Vector::z(), -Vector::z()] {
                let (offset, step) = next_to(patch, side * 0.01);
                let place = point + step;
                let off = place - Point::new(place.x.min(0.0), 0.0, 0.0);
                assert!(
                    (off.norm() - RADIUS).abs() < 0.0006,
                    "{place} is on the rim of the patch at {point}"
                );
                // The bar goes on beyond the patch, so the patch does not push along it.
                if point.x < -0.008 {
                    let lean = (off.normalize() + side.x * Vector::x()).normalize();
                    assert!(patch.contact_normal(lean, offset).x.abs() < 0.1, "along the bar at {place}");
                }
            }
        }
    });
}

#[test]
fn a_bar_through_a_sheet_is_detected_between_its_points() {
    // A bar of radius 3 mm along x with points in rings 4 mm apart, and a sheet of 0.2 mm perpendicular to
    // it, halfway between two rings.
    let normal_at = |k: usize| {
        let (sin, cos) = (core::f32::consts::TAU * (k % 8) as f32 / 8.0 + 0.4 * (k / 8 % 2) as f32).sin_cos();
        Vector::new(0.0, sin, cos)
    };
    let points =
        (0..80).map(|k| (Vector::x() * (0.004 * (k / 8) as f32 - 0.02) + normal_at(k) * 0.003).into());
    let cloud = (points.collect(), (0..80).map(|k| normal_at(k).into()).collect());
    let square = [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]];
    Scene::new(test_shapes::prism(0.0002, &square), cloud).try_out(|lab| {
        let monitor = Monitor::new();
        let is_off = |y: f32| {
            let (pose, scene) = (at(-0.002, y, 0.0), (&lab.body, &lab.support));
            is_off_surface(scene, &pose, 0.0005, &mut Meter::new(&monitor)).unwrap()
        };
        assert!(!is_off(0.0), "the bar runs through the middle of the sheet");
        assert!(is_off(0.024), "the sheet is beside the bar");
    });
}

/// The last points of the bar are 4 mm before the plate, if there is one. A sheet of 0.2 mm fits between.
#[test]
fn a_sheet_does_not_slip_through_between_a_bar_and_its_plate() {
    let normal_at = |k: usize| {
        let (sin, cos) = (core::f32::consts::TAU * (k % 8) as f32 / 8.0).sin_cos();
        Vector::new(0.0, sin, cos)
    };
    let bar = (0..160).map(|k| {
        let at: [f32; 3] = (Vector::x() * (0.002 * (k / 8) as f32 - 0.042) + normal_at(k) * 0.003).into();
        (at, normal_at(k).into())
    });
    let plate = (0..441)
        .map(|k| ([0.0, 0.002 * (k % 21) as f32 - 0.02, 0.002 * (k / 21) as f32 - 0.02], [-1.0, 0.0, 0.0]));
    let square = [[-0.01, -0.01], [0.01, -0.01], [0.01, 0.01], [-0.01, 0.01]];
    // The face of the bar's end, where the bar does not reach the plate.
    let face = (0..25).map(|k| {
        ([-0.0035, 0.001 * (k % 5) as f32 - 0.002, 0.001 * (k / 5) as f32 - 0.002], [1.0, 0.0, 0.0])
    });
    for (has_plate, has_face) in [(true, false), (true, true), (false, true), (false, false)] {
        let rest = plate.clone().filter(|_| has_plate).chain(face.clone().filter(|_| has_face));
        Scene::new(test_shapes::prism(0.0002, &square), bar.clone().chain(rest).unzip()).try_out(|lab| {
            let (pose, scene) = (at(-0.0017, 0.0, 0.0), (&lab.body, &lab.support));
            let is_off = is_off_surface(scene, &pose, 0.0005, &mut Meter::unwatched()).unwrap();
            assert_eq!(is_off, !has_plate || has_face, "plate {has_plate}, face {has_face}");
        });
    }
}

#[test]
fn a_wire_is_fitted_to_the_line_of_its_points() {
    // A wire of radius 1 mm along x with a point every 6 mm, each on another side; the wire of the ring has a
    // radius of 2 mm.
    let around = |k: i32| (2.4 * k as f32).sin_cos();
    let points = (-24..=24).map(|k| [0.006 * k as f32, 0.001 * around(k).0, 0.001 * around(k).1]);
    let normals = (-24..=24).map(|k| [0.0, around(k).0, around(k).1]);
    let thin_ring = test_shapes::torus(0.030, 0.002, 72, 24);
    Scene::new(thin_ring, (points.collect(), normals.collect())).try_out(|lab| {
        let middle = lab.support.positions().zip(lab.support.patches).filter(|(p, _)| p.x.abs() < 0.1);
        for (point, patch) in middle {
            assert!(patch.extents[0] > 0.003, "as far as to the next points");
            for part in [-1.0, 0.0, 1.0] {
                let [along, _, normal] = patch.axes();
                let place = point + along * (part * patch.extents[0]) - normal * patch.depth([0.0; 2]);
                assert!(place.coords.yz().norm() < 0.0002, "on the axis: {place}");
            }
            assert!((patch.wire_radius() - 0.001).abs() < 0.0002, "{}", patch.wire_radius());
        }
        // The ring's axis is along x, between two points of the wire: it hangs there, and the wire does not
        // pass through it.
        let upright = |z: f32| Pose::from_parts(Translation3::new(0.003, 0.0, z), turned(Vector::y(), 90.0));
        let top = 0.030 - 0.002 - 0.001;
        let height = lab.rest(&upright(-top + 0.001), FRICTION) * lab.body.centre;
        assert!((height.z + top).abs() < 0.0005, "{height}");
        let (monitor, scene) = (Monitor::new(), (&lab.body, &lab.support));
        let is_off = |z: f32| is_off_surface(scene, &upright(z), 0.0005, &mut Meter::new(&monitor)).unwrap();
        assert!(is_off(-top + 0.001) && !is_off(-0.030) && is_off(-0.030 - 0.0045));
    });
}

#[test]
fn a_pose_that_nearly_touches_is_pushed_off() {
    let (monitor, radius) = (Monitor::new(), 0.005);
    Scene::new(ring(), rod(Vector::x(), 0.3, radius)).try_out(|lab| {
        let scene = (&lab.body, &lab.support);
        for gap in [-0.0005, 0.0, 0.0004, 0.0006] {
            // Turned about the rod, so that the way out is none of the axes.
            let turn = turned(Vector::x(), 20.0);
            let height = Vector::z() * (gap - hang(radius));
            let pose = Pose::from_parts((turn * height).into(), turn * turned(Vector::y(), 90.0));
            let pushed = push_off_surface(scene, &pose, 0.0005, &mut Meter::new(&monitor)).unwrap().unwrap();
            let way = pushed.translation.vector - pose.translation.vector;
            let missing = (0.0005 - gap).max(0.0);
            // The nearest point of the rod is up to 0.6 mm beside the tube's middle, so that pushes lead along the rod as well.
            assert!((way - turn * Vector::z() * missing).norm() < 0.0004, "{gap}: {way:?}");
            assert!(is_off_surface(scene, &pushed, 0.0005, &mut Meter::new(&monitor)).unwrap());
            assert!(missing > 0.0 || pushed == pose);
        }
    });
    // The rod does not fit into the hole.
    let narrow = test_shapes::torus(0.006, 0.002, 72, 24);
    Scene::new(narrow, rod(Vector::x(), 0.3, radius)).try_out(|lab| {
        let pose = Pose::from_parts(Translation3::identity(), turned(Vector::y(), 90.0));
        let scene = (&lab.body, &lab.support);
        assert_eq!(push_off_surface(scene, &pose, 0.0005, &mut Meter::new(&monitor)), Ok(None));
    });
}

#[test]
fn a_ring_slides_along_the_rod_beyond_the_friction_angle() {
    Scene::new(ring(), rod(Vector::x(), 0.3, 0.005)).try_out(|lab| {
        let rest = lab.rest(&on_rod(), FRICTION);
        // The friction angle is 21.8 degrees. The ring swings about its contact to hang along gravity; any
        // further displacement is a slide.
        for (degrees, slides) in [(10.0_f32, false), (17.0, false), (28.0, true), (35.0, true)] {
            for side in [Vector::x(), -Vector::x()] {
                let drift = lab.drift(&rest, &tilted(degrees, side), FRICTION).dot(&side);
                let swing = hang(0.0) * degrees.to_radians().sin();
                assert_eq!(drift - swing > 0.01, slides, "{degrees}: {drift} {swing}");
                assert!(slides || (drift - swing).abs() < 0.004, "{degrees}: {drift} {swing}");
            }
        }
    });
}

/// The pull is 10 degrees off the rod, which leads the ring.
#[test]
fn a_ring_is_pulled_along_the_rod_and_keeps_its_distance() {
    Scene::new(ring(), rod(Vector::x(), 0.3, 0.005)).try_out(|lab| {
        let direction = -tilted(80.0, -Vector::x());
        let pull = Pull { direction, at: None, travel: 0.02, gap: 0.0005 };
        let (monitor, scene) = (Monitor::new(), (&lab.body, &lab.support));
        let mut meter = Meter::new(&monitor);
        // Pulled up, it comes against the rod from below.
        let low = at(0.0, 0.0, -0.02) * on_rod();
        let lifted = Pull { direction: -DOWN, travel: 0.025, ..pull };
        let start =
            pulled(scene, &low, &lifted, &with_friction(FRICTION), &mut lab.sleeps, &mut meter).unwrap();
        let end =
            pulled(scene, &start, &pull, &with_friction(FRICTION), &mut lab.sleeps, &mut meter).unwrap();
        let moved = end * lab.body.centre - start * lab.body.centre;
        assert!(moved.x > 0.012 && moved.y.abs() < 0.001, "{moved}");
        for pose in [start, end] {
            let mut gaps =
                lab.support.positions().map(|point| lab.body.field.distance(&(pose.inverse() * point)));
            let least = gaps.next().map(|first| gaps.fold(first, f32::min)).unwrap();
            assert!(least > 0.0002, "{least}");
        }
    });
}

#[test]
fn a_rod_lies_at_the_bottom_of_a_v() {
    let wall = |degrees: f32| {
        let turn = turned(Vector::x(), degrees);
        plane(0.1, 0.04, move |p| turn * (p + Vector::new(0.0, 0.02 * degrees.signum(), 0.0)))
    };
    Scene::new(test_shapes::rod(0.06, 0.005), together([wall(45.0), wall(-45.0)])).try_out(|lab| {
        for (y, z) in [(0.0, 0.010), (0.01, 0.022), (-0.015, 0.025)] {
            let rest = lab.rest(&at(0.0, y, z), FRICTION);
            let centre = rest * Point::origin();
            // The corner of two walls at a right angle is sqrt(2) radii below the centre of a circle that
            // touches both.
            assert!(centre.y.abs() < 0.0005, "{centre}");
            assert!((centre.z - 0.005 * 2_f32.sqrt()).abs() < 0.0005, "{centre}");
            let axis = rest * Vector::x();
            assert!(axis.z.abs() < 0.02, "{axis}");
        }
    });
}

/// A plate with bevelled lower edges in front and behind, along x, so that they do not catch.
fn sled() -> Shape {
    let outline =
        [[-0.015, -0.005], [0.015, -0.005], [0.02, 0.0], [0.02, 0.005], [-0.02, 0.005], [-0.02, 0.0]];
    test_shapes::prism(0.04, &outline).map(|p| Point::new(-p.y, p.x, p.z))
}

#[test]
fn a_plate_on_a_slope_slides_beyond_the_friction_angle() {
    let plate = sled();
    for (friction, angles) in [(0.4_f32, [20.0_f32, 24.0]), (0.7, [33.0, 37.0])] {
        let limit = friction.atan().to_degrees();
        assert!(angles[0] < limit && angles[1] > limit);
        for degrees in angles {
            let turn = turned(Vector::y(), degrees);
            let slope = plane(0.3, 0.1, |p| turn * p);
            Scene::new(plate.clone(), slope).try_out(|lab| {
                let start = Pose::from_parts(Translation3::identity(), turn) * at(0.0, 0.0, 0.0052);
                let gone = lab.drift(&start, &DOWN, friction).dot(&(turn * Vector::x()));
                // With a damping rate of 2/s: v' = g (sin - mu cos) - 2 v, for half a second.
                let (sin, cos) = degrees.to_radians().sin_cos();
                let pull = GRAVITY * (sin - friction * cos).max(0.0);
                let expected = pull / 2.0 * (0.5 - (1.0 - (-1.0_f32).exp()) / 2.0);
                // Patches just ahead of the plate slow it a little.
                let least = 0.5 * expected - 0.0005;
                assert!(
                    (least..expected + 0.0005).contains(&gone),
                    "{friction} {degrees}: {gone} {expected}"
                );
            });
        }
    }
}

/// A ball that is closed exactly: its poles are not rounded.
fn ball(radius: f32) -> Shape {
    let profile: Vec<[f32; 2]> = (0..=24)
        .map(|i| {
            let (sin, cos) = (core::f32::consts::PI * i as f32 / 24.0).sin_cos();
            [if i % 24 == 0 { 0.0 } else { radius * sin }, radius * cos]
        })
        .collect();
    test_shapes::revolved(&profile, 48)
}

/// A ring with a ball in its plane that shifts the centre of mass towards the ring's -x.
fn weighted_ring() -> Shape {
    let mut shape = ring();
    shape.append(&ball(0.008), Vector::new(-0.045, 0.0, 0.0));
    shape
}

#[test]
fn an_arc_on_a_rod_is_stable_with_the_centre_of_mass_below_its_own() {
    Scene::new(weighted_ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        // Without friction, so that neither rolling nor sticking hides an instability.
        let settle = |lab: &mut Lab, degrees: f32| {
            let turn = turned(Vector::x(), degrees) * turned(Vector::y(), -90.0);
            let release = Pose::from_parts(Translation3::new(0.0, 0.0, -hang(0.005) + 0.0005), turn);
            // The weight is on the ring's -x, which is down at zero degrees.
            assert!(((release * Vector::x()).z - degrees.to_radians().cos()).abs() < 1e-4);
            let rest = lab.rest(&release, 0.0);
            let turned = release.rotation.angle_to(&rest.rotation).to_degrees();
            (rest, turned)
        };
        for degrees in [8.0, -8.0, 172.0, -172.0] {
            let (rest, turned) = settle(lab, degrees);
            // With the weight near the bottom it swings back; with the weight near the top it swings down.
            assert!((rest * Vector::x()).z > 0.998, "{degrees}: {rest}");
            assert!((turned - degrees.abs()).abs() < 6.0, "{degrees}: {turned}");
            let centre = rest * Point::origin();
            assert!((centre.z + hang(0.005)).abs() < 0.001 && centre.y.abs() < 0.001, "{degrees}: {centre}");
        }
    });
}

#[test]
fn a_convex_underside_on_a_rod_falls() {
    // The arc's radius is negative: the other side of the condition.
    for object in [test_shapes::rod(0.06, 0.01), ball(0.02)] {
        Scene::new(object, rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
            let release = at(0.0, 0.002, 0.0052 - lab.body.surface.aabb().min.z);
            let (fate, rest) = lab.settle(&release, FRICTION);
            assert_eq!(fate, Fate::RotatesOff, "{rest}");
        });
    }
}

#[test]
fn a_wedge_stays_point_down_and_slips_out_point_up() {
    let rods = together([-0.012, 0.012].map(|y: f32| {
        let end = |x: f32| Point::new(x, y, 0.0);
        test_shapes::peg(end(-0.04), end(0.04), 0.004, 0.0012)
    }));
    let point_down = test_shapes::prism(0.04, &[[0.0, -0.04], [0.015, 0.04], [-0.015, 0.04]]);
    Scene::new(point_down, rods.clone()).try_out(|lab| {
        let release = at(0.0, 0.0, 0.006);
        assert!(lab.is_clear(&release, 0.0));
        let rest = lab.rest(&release, FRICTION);
        // A rod of radius r at a distance m from the middle of the wedge touches a flank at an angle b to the
        // vertical when the wedge's apex is (m cos b - r) / sin b below the rods, here beyond its lower end.
        let lean = 0.015_f32.atan2(0.08);
        let below = (0.012 * lean.cos() - 0.004) / lean.sin();
        let apex = (rest * Point::new(0.0, 0.0, -0.04)).z;
        assert!((apex + below).abs() < 0.003, "{apex} {below}");
    });
    let point_up = test_shapes::prism(0.04, &[[0.0, 0.04], [-0.015, -0.04], [0.015, -0.04]]);
    Scene::new(point_up, rods).try_out(|lab| {
        // Half a millimetre from either rod; both can only push it down.
        let release = Pose::identity();
        assert!(lab.is_clear(&release, 0.0) && !lab.is_clear(&release, 0.001));
        assert_eq!(lab.settle(&release, 1.0).0, Fate::SlidesOff);
    });
}

#[test]
fn energy_never_grows() {
    let no_drag = |friction| Settings::undamped(&with_friction(friction));
    let ring = || Scene::new(ring(), rod(Vector::x(), 0.1, 0.005));
    let plate = test_shapes::prism(0.04, &[[-0.02, -0.005], [0.02, -0.005], [0.02, 0.005], [-0.02, 0.005]]);
    let plate = Scene::new(plate, plane(0.3, 0.1, |p| p));
    for (scene, release, name) in [
        (ring(), at(0.0, 0.01, 0.0) * on_rod(), "a ring released beside the rod"),
        (ring(), at(0.0, 0.0, 0.005) * on_rod(), "a ring dropped on the rod"),
        (
            plate,
            Pose::from_parts(Translation3::new(0.0, 0.0, 0.03), turned(Vector::new(0.6, 0.8, 0.0), 30.0)),
            "a plate dropped on its corner",
        ),
    ] {
        for friction in [0.0, FRICTION] {
            scene.try_out(|lab| {
                let (mut least, mut grown) = (f32::INFINITY, 0.0_f32);
                lab.watch((&release, &DOWN), no_drag(friction), 1.5, |body, state| {
                    let inertia = body.inverse_inertia_in(state).try_inverse().unwrap();
                    let kinetic =
                        0.5 * (state.velocity.norm_squared() + state.spin.dot(&(inertia * state.spin)));
                    // Energy of the unit mass as a height. The patches may differ from the surface by a
                    // millimetre.
                    let energy = kinetic / GRAVITY + state.centre.z;
                    least = least.min(energy);
                    grown = grown.max(energy - least);
                });
                assert!(grown < 0.001, "{name}, friction {friction}: {grown}");
            });
        }
    }
}

#[test]
fn a_body_without_contact_falls() {
    Scene::new(ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        let above = at(0.0, 0.0, -0.045) * on_rod();
        assert!(lab.is_clear(&above, 0.001));
        let (fate, end) = lab.settle(&above, FRICTION);
        assert_eq!(fate, Fate::SlidesOff, "it does not turn");
        let fallen = above.translation.z - end.translation.z;
        assert!(fallen > settle::max_sinking(&lab.body), "{fallen}");
        // A rod inside the ring's wire is not clear, and neither is one closer than the clearance.
        assert!(!lab.is_clear(&(at(0.0, 0.0, -0.004) * on_rod()), 0.0));
        assert!(lab.is_clear(&on_rod(), 0.0) && !lab.is_clear(&(at(0.0, 0.0, -0.0008) * on_rod()), 0.0005));
    });
}

/// Tilts of gravity that the rest pose survives, degrees.
fn tilts(lab: &mut Lab, rest: &Pose) -> [f32; DIRECTIONS] {
    lab.margin(rest).tilts.map(f32::to_degrees)
}

#[test]
fn a_ring_on_a_rod_leaves_over_its_end_and_not_across() {
    Scene::new(ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        // One centimetre from the rod's end in the first direction.
        let rest = lab.rest(&(at(0.04, 0.0, 0.0) * on_rod()), FRICTION);
        let tilts = tilts(lab, &rest);
        // It starts to slide at 21.8 degrees, and gravity tilts further while it slides.
        assert!((21.8..50.0).contains(&tilts[0]), "{tilts:?}");
        let most = Margin::MOST_TILT.to_degrees();
        assert!(tilts[2] == most && tilts[6] == most, "across: {tilts:?}");
        assert!(tilts.iter().all(|tilt| *tilt >= tilts[0]), "{tilts:?}");
    });
}

#[test]
fn the_tilts_turn_with_the_scene() {
    let tilts = |eighths: usize| {
        let turn = turned(Vector::z(), 45.0 * eighths as f32);
        let mut found = [0.0; DIRECTIONS];
        Scene::new(ring(), rod(turn * Vector::x(), 0.1, 0.005)).try_out(|lab| {
            let rest = lab.rest(&(turn * at(0.04, 0.0, 0.0) * on_rod()), FRICTION);
            found = self::tilts(lab, &rest);
        });
        found
    };
    let straight = tilts(0);
    for eighths in [1, 2, 5] {
        let turned = tilts(eighths);
        // Towards the rod's end and across the rod. Other directions depend on the positions of the points.
        assert!((turned[eighths] - straight[0]).abs() < 6.0, "{eighths}: {straight:?} {turned:?}");
        for k in [2, 6] {
            assert!(turned[(eighths + k) % DIRECTIONS] > 50.0, "{eighths}: {turned:?}");
        }
    }
}

#[test]
fn contacts_bear_the_weight() {
    Scene::new(ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        let rest = lab.rest(&on_rod(), FRICTION);
        let contacts = lab.contacts(&rest);
        let push: Vector = contacts.iter().map(|contact| contact.normal * contact.force).sum();
        assert!((push.z - 1.0).abs() < 0.05, "{contacts:?}");
        for contact in &contacts {
            assert!((contact.position.z - 0.005).abs() < 0.0005, "on top of the rod: {contact:?}");
            assert!(contact.normal.z > 0.9 && contact.position.x.abs() < 0.005, "{contact:?}");
        }
    });
}

#[test]
fn a_deep_hook_is_firmer_than_a_shallow_one() {
    // A bar with a lip of this height over its top at either end.
    let hook = |lip: f32| {
        let end = |x: f32, height: f32| {
            test_shapes::peg(Point::new(x, 0.0, 0.0), Point::new(x, 0.0, 0.004 + height), 0.004, 0.0012)
        };
        let bar = rod(Vector::x(), 0.03, 0.004);
        Scene::new(ring(), together([bar, end(-0.015, lip), end(0.015, lip)]))
    };
    // All from the same rest pose, so that the distances to the ends are equal.
    let mut rest = on_rod();
    hook(0.0).try_out(|lab| rest = lab.rest(&on_rod(), FRICTION));
    let margin = |lip: f32| {
        let mut margin = Margin::default();
        hook(lip).try_out(|lab| margin = lab.margin(&rest));
        margin
    };
    let (none, shallow, low, deep) = (margin(0.0), margin(0.0005), margin(0.0012), margin(0.006));
    let margins = [none, shallow, low, deep];
    for k in [0, 4] {
        assert!(none.tilts[k] < low.tilts[k] && low.tilts[k] < deep.tilts[k], "{margins:?}");
    }
    // A lip of half a millimetre is below the resolution of the points at one end, but not in the sum over
    // both ends.
    let both = |margin: &Margin| margin.tilts[0] + margin.tilts[4];
    assert!(margins.is_sorted_by(|a, b| both(a) < both(b)), "{margins:?}");
    assert!(none.escape_rise < shallow.escape_rise && shallow.escape_rise < deep.escape_rise);
    assert!(none.knock_speed < deep.knock_speed && none.centre_of_mass_radius < deep.centre_of_mass_radius);
}

#[test]
fn a_jolt_shakes_off_what_hangs_close_to_the_end() {
    // Under a slow tilt friction would hold the ring anywhere on the level rod. Under a jolt its swing makes
    // it slip, but no faster than at the end of a swing, v^2 = 2 g l (1 - cos 43.6 degrees) with the centre
    // of mass l = 21 mm below the rod, 0.34 m/s: once it slips, friction equals the pull. So in the middle of
    // a rod of one metre it stays for a second.
    Scene::new(ring(), rod(Vector::x(), 1.0, 0.005)).try_out(|lab| {
        let mut margin_at = |x: f32| {
            let rest = lab.rest(&(Pose::translation(x, 0.0, 0.0) * on_rod()), FRICTION);
            lab.margin(&rest)
        };
        let (middle, close) = (margin_at(0.0), margin_at(0.492));
        assert_eq!(middle.jolt_time, Margin::MOST_JOLT_TIME, "{middle:?}");
        assert!((0.05..0.8).contains(&close.jolt_time), "{close:?}");
    });
}

#[test]
fn a_release_pose_keeps_the_clearance() {
    Scene::new(ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        let rest = lab.rest(&on_rod(), FRICTION);
        let (monitor, clearance) = (Monitor::new(), 0.001);
        let (scene, mut meter) = ((&lab.body, &lab.support), Meter::new(&monitor));
        let (pose, gap) = release_pose(scene, &rest, clearance, &-DOWN, &mut lab.sleeps, &mut meter).unwrap();
        assert_eq!(gap, clearance);
        // The patches around a point may differ a little from it.
        assert!(lab.is_clear(&pose, 0.0008) && !lab.is_clear(&rest, 0.0008));
        let lift = (pose * lab.body.centre - rest * lab.body.centre).dot(&-DOWN);
        assert!((0.0005..0.003).contains(&lift), "{lift}");
    });
}

#[test]
fn the_default_durations_are_these_numbers_of_steps() {
    let settings = Settings::damped(&Params::default());
    let steps = [
        settings.settle_time,
        constants::SWING_TIME,
        constants::REST_WINDOW,
        constants::FREEING_TIME,
        constants::DEPARTURE_TIME,
    ];
    assert_eq!(steps.map(|seconds| settings.steps(seconds)), [750, 1000, 20, 125, 25]);
    assert_eq!(settings.rest_speed * constants::REST_WINDOW, 0.0004);
}

#[test]
fn other_time_steps_give_the_same_rest() {
    Scene::new(ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        let release = at(0.01, 0.004, 0.0) * on_rod();
        let mut rest = |time_step: f32| {
            let params = Params { time_step, ..Params::default() };
            let (fate, pose) = lab.settle_with(&release, &DOWN, &params);
            assert_eq!(fate, Fate::Rests, "{time_step}: {pose}");
            pose
        };
        let usual = rest(0.004);
        for time_step in [0.005, 0.002, 0.0005] {
            let pose = rest(time_step);
            let shift = (usual * Point::origin() - pose * Point::origin()).norm();
            let turn = usual.rotation.angle_to(&pose.rotation).to_degrees();
            assert!(shift < 0.001 && turn < 2.0, "{time_step}: {shift} m, {turn} degrees");
        }
    });
}

#[test]
fn a_body_that_settles_slowly_moves_until_the_settle_time_is_over() {
    Scene::new(weighted_ring(), rod(Vector::x(), 0.1, 0.005)).try_out(|lab| {
        // The weight swings down from 90 degrees.
        let turn = turned(Vector::x(), 90.0) * turned(Vector::y(), -90.0);
        let release = Pose::from_parts(Translation3::new(0.0, 0.0, -hang(0.005) + 0.0005), turn);
        for (settle_time, fate) in [(0.3, Fate::Moves), (3.0, Fate::Rests)] {
            let params = Params { settle_time, ..Params::default() };
            assert_eq!(lab.settle_with(&release, &DOWN, &params).0, fate, "{settle_time}");
        }
    });
}

#[test]
fn a_body_slower_than_the_rest_speed_rests() {
    // Without friction the ring slides along the rod. With a damping rate of 2/s its final speed is g
    // sin(slope) / 2.
    Scene::new(ring(), rod(Vector::x(), 0.5, 0.005)).try_out(|lab| {
        for (speed, rest_speed, fate) in [
            (0.04, 0.1, Fate::Rests),
            (0.04, 0.005, Fate::Moves),
            (0.003, 0.005, Fate::Rests),
            (0.003, 0.0002, Fate::Moves),
        ] {
            let slope = (2.0 * speed / GRAVITY).asin().to_degrees();
            let params = Params { rest_speed, ..with_friction(0.0) };
            let (found, pose) = lab.settle_with(&on_rod(), &tilted(slope, Vector::x()), &params);
            assert_eq!(found, fate, "{speed} m/s, rest below {rest_speed} m/s: {pose}");
        }
    });
}

#[test]
fn what_is_in_the_shadow_of_all_cameras_is_not_seen() {
    // A tube with its axis along z, 60 mm long, and a peg in its middle that ends with the tube.
    let scene = Scene::new(
        test_shapes::tube(0.03, 0.04, 0.06),
        test_shapes::peg(Point::new(0.0, 0.0, -0.03), Point::new(0.0, 0.0, 0.03), 0.005, 0.002),
    );
    // The tube hides this one from the side, too, but it is behind the tube, where the tube cannot be.
    let behind = Scene::new(
        test_shapes::tube(0.03, 0.04, 0.06),
        test_shapes::peg(Point::new(-0.055, 0.0, -0.02), Point::new(-0.055, 0.0, 0.02), 0.005, 0.002),
    );
    let (beside, above) = (Point::new(0.5, 0.0, 0.0), Point::new(0.0, 0.0, 0.5));
    let shadow = |lab: &Lab, viewpoints: &[Point], unseen: f32| {
        let body = Body { views: Views { viewpoints, unseen, needed: [0.0; 3] }, ..lab.body };
        let monitor = Monitor::new();
        super::unseen((&body, &lab.support), &Pose::identity(), &mut Meter::new(&monitor)).unwrap()
    };
    scene.try_out(|lab| {
        assert_eq!(shadow(lab, &[], 0.0), Unseen::default());
        assert_eq!(shadow(lab, &[beside], 0.75), Unseen { object: 0.75, shadow: 1.0, ..Unseen::default() });
        assert_eq!(shadow(lab, &[beside, above], 0.5).shadow, 0.0);
    });
    behind.try_out(|lab| assert_eq!(shadow(lab, &[beside], 0.75).shadow, 0.0));
}

/// A round wire bent to an open ring of [`RING`] around z, with a gap of this width, metres, around +y.
fn open_ring(gap: f32) -> Shape {
    let [ring, wire] = RING;
    let (length, rows) = (core::f32::consts::TAU * ring - gap, 60);
    let along = |row: u32| length * (rows - row) as f32 / rows as f32;
    let mut profile = std::vec![[0.0, length]];
    profile.extend((0..=rows).map(|row| [wire, along(row)]));
    profile.push([0.0, 0.0]);
    test_shapes::revolved(&profile, 24).map(|p| {
        let (sin, cos) = ((p.z + 0.5 * gap) / ring).sin_cos();
        Point::new((ring + p.x) * sin, (ring + p.x) * cos, p.y)
    })
}

#[test]
fn a_ring_on_a_rod_is_threaded_however_askew_it_hangs() {
    for degrees in [0.0, 12.0, 25.0, 40.0, 55.0] {
        let along = turned(Vector::z(), degrees) * Vector::x();
        Scene::new(ring(), rod(along, 0.2, 0.003)).try_out(|lab| {
            assert_eq!(lab.kind(&(at(0.0, 0.0, 0.002) * on_rod())), Kind::Threaded, "{degrees} degrees");
        });
    }
}

#[test]
fn a_ring_with_a_gap_for_the_rod_is_hooked_and_one_with_a_slit_is_threaded() {
    // The gap is below and aside, where the ring does not slip off.
    let release = at(0.0, 0.0, 0.001) * on_rod() * turned(Vector::z(), 60.0);
    let turns = [(0.014, Kind::Hooked), (0.02, Kind::Hooked), (0.001, Kind::Threaded)];
    for (gap, kind) in turns {
        Scene::new(open_ring(gap), rod(Vector::x(), 0.1, 0.004)).try_out(|lab| {
            assert_eq!(lab.kind(&release), kind, "a gap of {gap} m");
        });
    }
}

#[test]
fn a_cup_upside_down_over_a_tip_is_capped() {
    let upright = test_shapes::peg(Point::new(0.0, 0.0, -0.2), Point::origin(), 0.006, 0.0012);
    for (depth, radius) in [(0.09, 0.04), (0.05, 0.03), (0.03, 0.05)] {
        // Walls of 3 mm, open below.
        let profile = [
            [0.0, 0.003],
            [radius, 0.003],
            [radius, -depth],
            [radius - 0.003, -depth],
            [radius - 0.003, 0.0],
            [0.0, 0.0],
        ];
        let cup = test_shapes::revolved(&profile, 48);
        Scene::new(cup, upright.clone()).try_out(|lab| {
            assert_eq!(lab.kind(&at(0.0, 0.0, 0.001)), Kind::Capped, "{depth} m deep");
        });
    }
}

#[test]
fn a_head_between_two_prongs_is_hooked_and_a_board_on_them_is_balanced() {
    let prong = |y: f32| test_shapes::peg(Point::new(-0.05, y, 0.0), Point::new(0.05, y, 0.0), 0.003, 0.0012);
    let prongs = together([prong(-0.008), prong(0.008)]);
    // A head of 10 mm radius on a stem of 3 mm radius.
    let mut profile: Vec<[f32; 2]> =
        (0..=10).map(|k| (0.16 * k as f32 * 1.65).sin_cos()).map(|(s, c)| [0.01 * s, 0.01 * c]).collect();
    profile.extend([[0.003, -0.0096], [0.003, -0.08], [0.0, -0.08]]);
    Scene::new(test_shapes::revolved(&profile, 32), prongs.clone()).try_out(|lab| {
        assert_eq!(lab.kind(&at(0.0, 0.0, 0.009)), Kind::Hooked);
    });
    let board = test_shapes::prism(0.06, &[[-0.03, 0.0], [0.03, 0.0], [0.03, 0.005], [-0.03, 0.005]]);
    Scene::new(board, prongs).try_out(|lab| {
        assert_eq!(lab.kind(&at(0.0, 0.0, 0.004)), Kind::Balanced);
    });
}
