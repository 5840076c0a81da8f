//! Objects whose symmetries are known, and what is left of rotations after them.

use super::*;
use crate::geometry::{MassProperties, Surface};
use crate::memory::{Arena, model_bytes};
use crate::monitor::Meter;
use crate::perception::sampling;
use crate::test_shapes::{Shape, ball, prism, revolved, tube};
use core::f32::consts::FRAC_PI_2;

/// The symmetries of a shape, about the centroid of its volume or about another centre of mass.
fn symmetries(shape: &Shape, centre: Option<Point>) -> Vec<Symmetry> {
    const VOXELS: usize = 200_000;
    let mesh = shape.mesh();
    let (vertices, triangles) = (mesh.vertices().len(), mesh.triangles().len());
    let sizes = [
        Surface::bytes(triangles) + Surface::scratch_bytes(triangles),
        DistanceField::bytes(VOXELS) + DistanceField::scratch_bytes(triangles, VOXELS),
        MassProperties::scratch_bytes(vertices, triangles),
    ];
    let needed = sizes.map(model_bytes);
    let mut memory = needed.map(|size| vec![0; size]);
    let [a, b, c] = &mut memory;
    let mass = MassProperties::of(&mesh, Arena::new(c, needed[2]).unwrap(), &Meter::unwatched()).unwrap();
    let surface = Surface::build(
        &mesh,
        mass.is_inside_out,
        &mut Arena::new(a, needed[0]).unwrap(),
        &Meter::unwatched(),
    )
    .unwrap();
    let field = DistanceField::build(
        &surface,
        VOXELS,
        &mut Arena::new(b, needed[1]).unwrap(),
        &mut Meter::unwatched(),
    )
    .unwrap();
    let (mut points, mut normals) = ([Point::origin(); 10_000], [Vector::zeros(); 10_000]);
    sampling::scatter_into(&mesh, 0, &mut points, &mut normals, &Meter::unwatched()).unwrap();
    let centre = centre.or(mass.volume_centroid).unwrap();
    Symmetries::find(&mass.inertia, &centre, &field, &points, &Meter::unwatched())
        .unwrap()
        .as_slice()
        .to_vec()
}

/// Checks the folds that are found, the axis of the first and the angles between them, however the shape is turned.
#[track_caller]
fn assert_has(shape: &Shape, axis: Vector, folds: &[u32]) {
    for angles in [(0.0, 0.0, 0.0), (0.4, 0.5, 0.6), (-2.0, 0.1, 1.3)] {
        let motion = UnitQuaternion::from_euler_angles(angles.0, angles.1, angles.2);
        let moved = shape.map(|p| motion * p + Vector::new(0.1, -0.2, 0.3));
        let found = symmetries(&moved, None);
        assert_eq!(found.iter().map(|s| s.fold).collect::<Vec<_>>(), folds, "{angles:?}: {found:?}");
        for (index, one) in found.iter().enumerate() {
            assert!((one.axis.norm() - 1.0).abs() < 1e-5);
            assert!(found[..index].iter().all(|other| other.axis.dot(&one.axis).abs() < 1e-4), "{found:?}");
        }
        let cosine = found.first().map_or(1.0, |first| first.axis.dot(&(motion * axis)).abs());
        assert!(cosine > 0.9999, "{angles:?}: {found:?}");
    }
}

/// A cylinder around the z axis whose radius depends on the step around it, of so many.
fn cam(height: f32, steps: u32, radius: impl Fn(u32) -> f32) -> Shape {
    let half = 0.5 * height;
    revolved(&[[0.0, half], [1.0, half], [1.0, -half], [0.0, -half]], steps).map(|p| {
        let turn = libm::atan2f(p.y, p.x) / TAU * steps as f32;
        let radius = radius(libm::roundf(turn).rem_euclid(steps as f32) as u32);
        Point::new(radius * p.x, radius * p.y, p.z)
    })
}

/// A cup of 8 cm with a handle: a ring around the y axis, half of it in the wall.
fn mug(handle: Option<(f32, f32)>) -> Shape {
    let outline = [[0.0, -0.046], [0.037, -0.046], [0.037, 0.05], [0.04, 0.05], [0.04, -0.05], [0.0, -0.05]];
    let mut shape = revolved(&outline, 64);
    if let Some((ring, thickness)) = handle {
        let ring = crate::test_shapes::torus(ring, thickness, 32, 16);
        shape.append(&ring.map(|p| Point::new(p.x, p.z, -p.y)), Vector::new(0.04, 0.0, 0.01));
    }
    shape
}

/// A regular polygon of unit radius.
fn polygon(sides: u32) -> Vec<[f32; 2]> {
    let angle = |i: u32| TAU * i as f32 / sides as f32 + 0.3;
    (0..sides).map(|i| [libm::cosf(angle(i)), libm::sinf(angle(i))]).collect()
}

#[test]
fn solids_of_revolution() {
    let torus = crate::test_shapes::torus(0.03, 0.004, 64, 24);
    assert_has(&torus, Vector::z(), &[0, 2]);
    assert_has(&tube(0.02, 0.03, 0.1), Vector::z(), &[0, 2]);
    let cone = revolved(&[[0.0, 0.08], [0.03, 0.0], [0.0, 0.0]], 64);
    assert_has(&cone, Vector::z(), &[0]);
    assert_has(&mug(None), Vector::z(), &[0]);
    // A wall of 1 mm, thinner than a voxel.
    let outline = [[0.0, -0.049], [0.039, -0.049], [0.039, 0.05], [0.04, 0.05], [0.04, -0.05], [0.0, -0.05]];
    assert_has(&revolved(&outline, 64), Vector::z(), &[0]);
    let egg = ball(0.03, 48, 64).map(|p| Point::new(p.x, p.y, 1.3 * p.z));
    assert_has(&egg, Vector::z(), &[0, 2]);
}

#[test]
fn a_rough_mesh() {
    // Each vertex of a ring of 7 cm is up to 0.3 mm off along each axis, as in a good scan.
    let mut random = crate::random::Random::new(7);
    let mut rough = crate::test_shapes::torus(0.03, 0.005, 64, 24);
    for vertex in &mut rough.vertices {
        *vertex = vertex.map(|x| x + 0.0006 * (random.next_f32() - 0.5));
    }
    let folds: Vec<_> = symmetries(&rough, None).iter().map(|symmetry| symmetry.fold).collect();
    assert_eq!(folds, [0, 2]);
}

#[test]
fn a_ball_has_all_axes() {
    let found = symmetries(&ball(0.03, 48, 64), None);
    assert_eq!(found.iter().map(|s| s.fold).collect::<Vec<_>>(), [0; 3]);
    let rotation = UnitQuaternion::from_euler_angles(1.0, 2.0, 3.0);
    assert_eq!(least_angle(&found, &rotation), 0.0);
}

#[test]
fn prisms_and_gears() {
    for (sides, length) in [(3, 0.02), (4, 0.01), (5, 0.2), (6, 0.01), (8, 0.1), (12, 0.02)] {
        let shape = prism(length, &polygon(sides).iter().map(|c| c.map(|x| 0.03 * x)).collect::<Vec<_>>());
        assert_has(&shape, Vector::x(), &[sides, 2]);
    }
    let round = polygon(32).iter().map(|c| c.map(|x| 0.03 * x)).collect::<Vec<_>>();
    assert_has(&prism(0.02, &round), Vector::x(), &[0, 2]);
    let gear = cam(0.01, 96, |step| if step % 12 < 6 { 0.035 } else { 0.03 });
    assert_has(&gear, Vector::z(), &[8, 2]);
    // Its teeth lean to one side.
    let ratchet = cam(0.01, 96, |step| 0.03 + 0.001 * (step % 12) as f32);
    assert_has(&ratchet, Vector::z(), &[8]);
}

#[test]
fn boxes_and_ellipsoids() {
    let cuboid = prism(0.06, &[[-0.02, -0.01], [0.02, -0.01], [0.02, 0.01], [-0.02, 0.01]]);
    let found = symmetries(&cuboid, None);
    assert_eq!(found.iter().map(|s| s.fold).collect::<Vec<_>>(), [2; 3]);
    let ellipsoid = ball(0.03, 32, 48).map(|p| Point::new(p.x, 0.7 * p.y, 0.4 * p.z));
    assert_eq!(symmetries(&ellipsoid, None).len(), 3);
    // A mass within that is off the centre leaves the half turn about the line to it, or none.
    let off = |x: f32, y: f32| symmetries(&cuboid, Some(Point::new(x, y, 0.0)));
    assert_eq!(off(0.01, 0.0).len(), 1);
    assert!(off(0.01, 0.0)[0].axis.x.abs() > 0.9999);
    assert_eq!(off(0.01, 0.005), []);
}

#[test]
fn a_handle_or_a_hole_leaves_nothing() {
    for handle in [(0.02, 0.004), (0.008, 0.002)] {
        assert_has(&mug(Some(handle)), Vector::z(), &[]);
    }
    // A disc of 10 cm with a hole of 9 mm near its rim, which leaves the half turn about the line through both.
    let disc = tube(0.0045, 0.05, 0.004).map(|p| {
        let share = (0.05 - p.coords.xy().norm()) / (0.05 - 0.0045);
        p + Vector::x() * (0.04 * share)
    });
    assert_has(&disc, Vector::x(), &[2]);
}

/// A rotation about an axis.
fn about(axis: Vector, angle: f32) -> UnitQuaternion<f32> {
    turn(&axis.normalize(), angle)
}

#[test]
fn angles_are_reduced_by_turns() {
    let (x, y, z) = (Vector::x(), Vector::y(), Vector::z());
    let tilt = about(x, 0.2);
    let close = |symmetries: &[Symmetry], rotation: UnitQuaternion<f32>, expected: f32| {
        let found = least_angle(symmetries, &rotation);
        assert!((found - expected).abs() < 2e-3, "{found} for {expected}");
    };
    close(&[], about(Vector::new(1.0, 2.0, 3.0), 1.1), 1.1);
    // The length and the sign of the axis do not matter.
    let round = [Symmetry { axis: z * -7.0, fold: 0 }];
    for angle in [0.0, 0.5, 3.0, PI, -2.0, 6.0] {
        close(&round, about(z, angle), 0.0);
        close(&round, about(z, angle) * tilt, 0.2);
        close(&round, tilt * about(z, angle), 0.2);
    }
    let six = [Symmetry { axis: z, fold: 6 }];
    for step in 0..13 {
        let angle = step as f32 * TAU / 6.0;
        close(&six, about(z, angle), 0.0);
        close(&six, about(z, angle + 0.3), 0.3);
        close(&six, about(z, angle - 0.5), 0.5);
    }
    close(&six, about(x, PI), PI);
    // Turned over and turned about its axis, in either order.
    let disc = [round[0], Symmetry { axis: x, fold: 2 }];
    let nut = [six[0], disc[1]];
    for symmetries in [disc, nut, [nut[1], nut[0]]] {
        close(&symmetries, about(x, PI) * about(z, TAU / 3.0), 0.0);
        close(&symmetries, about(z, TAU / 3.0) * about(x, PI), 0.0);
        close(&symmetries, about(y, FRAC_PI_2), FRAC_PI_2);
    }
    let cube = [x, y, z].map(|axis| Symmetry { axis, fold: 4 });
    close(&cube, about(Vector::new(1.0, 1.0, 1.0), TAU / 3.0), 0.0);
    close(&cube, about(Vector::new(0.0, 1.0, -1.0), PI), 0.0);
}

#[test]
fn broken_symmetries_are_known() {
    let with = |axis: Vector, fold| Symmetry { axis, fold }.is_valid();
    assert!(with(Vector::z(), 0) && with(Vector::z() * 9.0, MAX_FOLD));
    assert!(!with(Vector::z(), 1) && !with(Vector::z(), MAX_FOLD + 1));
    assert!(!with(Vector::zeros(), 2) && !with(Vector::repeat(f32::NAN), 2));
}
