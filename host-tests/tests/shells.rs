//! Tests of the shells that represent arbitrary meshes: they preserve the holes of the mesh, and verdicts on shells
//! agree with those on exact parts.

mod common;

use common::*;
use host_tests::judge::{Bullet, Judge, Mass, Scene, Verdict};
use host_tests::solid::{Part, Solid};
use nalgebra::{Isometry3, Vector3};
use parry3d::query::PointQuery;
use parry3d::shape::TriMesh;

/// Largest distance of a shell outside its mesh, m.
const OUTSIDE: f32 = 0.001;

fn shell(solid: &Solid) -> Solid {
    Solid::shell(solid.vertices.clone(), solid.triangles.clone())
}

fn judge(object: &Solid, supporter: &Solid, release: &Isometry3<f32>) -> Verdict {
    let scene = Scene { tilt: false, ..Scene::new(object, supporter) };
    Bullet::default().judge(&scene, release)
}

fn hanging_mug() -> Isometry3<f32> {
    pose([0.045, 0.07, -0.0545], Vector3::y(), -90.0)
}

#[test]
fn verdicts_on_shells_are_those_on_exact_parts() {
    let cases = [
        ("ring on peg", ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.0145), true),
        ("ring on hook", ring(0.03, 0.003), hook(), at(0.0, 0.07, -0.0225), true),
        ("mug on hook", mug(), hook(), hanging_mug(), true),
        ("ring on hulls", ring(0.03, 0.003), hulls(), at(0.0, 0.07, -0.0215), true),
        ("mug beside hook", mug(), hook(), at(0.1, 0.0, 0.0) * hanging_mug(), false),
        ("ring below peg", ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.05), false),
        ("ball on peg", ball(0.03), peg(), at(0.002, 0.05, 0.0425), false),
        ("mug through hook", mug(), hook(), pose([0.02, 0.1, -0.01], Vector3::y(), -90.0), false),
        ("ball in a box", ball(0.004), cuboid([0.05; 3]), at(0.0, 0.0, 0.0), false),
    ];
    let check = |(name, object, supporter, release, hangs): &(&str, Solid, Solid, Isometry3<f32>, bool)| {
        let exact = judge(object, supporter, release);
        assert_eq!(exact.success(), *hangs, "{name}: {exact:?}");
        for (object, supporter) in [(&shell(object), &shell(supporter)), (&shell(object), supporter)] {
            let verdict = judge(object, supporter, release);
            assert_eq!(verdict.clear, exact.clear, "{name}: {verdict:?}");
            assert_eq!(verdict.success(), *hangs, "{name}: {verdict:?}");
        }
    };
    // Two threads, since the other tests of this file are short.
    let (even, odd) = (cases.iter().step_by(2), cases.iter().skip(1).step_by(2));
    std::thread::scope(|scope| {
        scope.spawn(|| even.for_each(check));
        odd.for_each(check);
    });
}

#[test]
fn what_is_pushed_through_is_not_clear() {
    let (ring, peg) = (shell(&ring(0.03, 0.003)), shell(&peg()));
    for (depth, clear) in [(-0.0005, true), (0.001, true), (0.004, false), (0.006, false)] {
        let verdict = judge(&ring, &peg, &at(0.0, 0.05, -0.0155 - depth));
        assert_eq!(verdict.clear, clear, "{depth}: {verdict:?}");
    }
}

#[test]
fn a_tight_hole_stays_open() {
    // Half a millimetre of play all around.
    let object = shell(&ring(PEG + 0.003 + 0.0005, 0.003));
    let level = shell(&capsule([0.0; 3], [0.0, 0.1, 0.0], PEG));
    let verdict = judge(&object, &level, &at(0.0, 0.05, 0.0));
    assert!(verdict.figures.penetration == 0.0 && verdict.holds, "{verdict:?}");
}

#[test]
fn shells_are_where_the_mesh_is() {
    for (name, solid) in
        [("ring", ring(0.03, 0.003)), ("mug", mug()), ("hanger", hanger()), ("box", cuboid([0.02; 3]))]
    {
        let shell = shell(&solid);
        let points = solid.vertices.iter().map(|&vertex| vertex.into()).collect();
        let surface = TriMesh::new(points, solid.triangles.clone()).unwrap();
        for part in &shell.parts {
            let Part::Hull(corners) = part else { panic!("{name}: {part:?} is not a prism") };
            for &corner in corners {
                let off = surface.distance_to_local_point(corner.into(), true);
                // Inside, the distance may be as large as the thickness of the shell.
                assert!(off < 0.002 + OUTSIDE, "{name}: {off} m from the mesh");
            }
            for corner in &corners[..3] {
                let off = surface.distance_to_local_point((*corner).into(), true);
                assert!(off < OUTSIDE, "{name}: the outer side is {off} m from the mesh");
            }
        }
    }
}

#[test]
fn inside_out_is_the_same() {
    let mut turned = ring(0.03, 0.003);
    turned.triangles.iter_mut().for_each(|triangle| triangle.reverse());
    let [usual, mass] = [&ring(0.03, 0.003), &turned].map(|solid| Mass::of(solid, 0.2));
    assert!((Vector3::from(usual.inertia) - Vector3::from(mass.inertia)).norm() < 1e-6 * usual.inertia[2]);
    assert!(judge(&shell(&turned), &shell(&peg()), &at(0.0, 0.05, -0.0145)).success());
}

#[test]
fn an_open_mesh_is_a_sheet() {
    // A box without a lid: its centre of mass is below its centre.
    let mut open = cuboid([0.02; 3]);
    open.triangles.retain(|triangle| triangle.iter().any(|&index| open.vertices[index as usize][2] < 0.0));
    assert!(!open.is_closed() && cuboid([0.02; 3]).is_closed());
    let mass = Mass::of(&open, 0.2);
    assert!((mass.frame.translation.z - -0.004).abs() < 1e-6, "{:?}", mass.frame);
}
