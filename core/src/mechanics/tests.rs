//! Rests with known answers.

use super::*;
use crate::geometry::{DistanceField, MassProperties, Point, PointTree, Pose, Surface, Vector};
use crate::memory::{Arena, model_bytes};
use crate::test_shapes::{self, Shape};
use std::vec::Vec;

fn with_scene(
    object: &Shape,
    points: &[[f32; 3]],
    normals: &[[f32; 3]],
    disc: f32,
    check: impl FnOnce(&Body, &Support),
) {
    let mesh = object.mesh();
    let mut memory = vec![0; 200_000_000];
    let mut arena = Arena::new(&mut memory, model_bytes(1000)).unwrap();
    let mass = MassProperties::of(&mesh, arena.scratch()).unwrap();
    let surface = Surface::build(&mesh, false, &mut arena).unwrap();
    let field = DistanceField::build(&surface, 400_000, &mut arena).unwrap();
    let points: Vec<Point> = points.iter().map(|p| Point::from(*p)).collect();
    let tree = PointTree::build(&points, &mut arena).unwrap();
    let normals: Vec<Vector> = tree.order().iter().map(|&i| Vector::from(normals[i as usize])).collect();
    let centre = mass.volume_centroid.unwrap();
    let reach = mesh.vertices().iter().map(|v| (v - centre).norm()).fold(0.0, f32::max);
    let body = Body {
        field: &field,
        centre,
        inverse_inertia: mass.inertia.try_inverse().unwrap(),
        reach,
        extent: surface.aabb().extents().max(),
    };
    let chosen = vec![1; points.len()];
    check(&body, &Support { tree: &tree, normals: &normals, disc, is_chosen: &chosen });
}

fn settings() -> Settings {
    Settings {
        gravity: Vector::new(0.0, 0.0, -9.81),
        friction: 0.4,
        time_step: 0.004,
        steps: 1000,
        damping: [2.0, 15.0],
    }
}

#[test]
fn a_ring_on_a_rod_slides_at_the_friction_angle() {
    let object = test_shapes::torus(0.030, 0.004, 72, 24);
    let mut random = crate::random::Random::new(3);
    let (points, normals): (Vec<[f32; 3]>, Vec<[f32; 3]>) = (0..4000)
        .map(|_| {
            let (s, c) = (random.next_f32() * 6.2832).sin_cos();
            ([random.next_f32() * 0.3 - 0.15, 0.005 * s, 0.005 * c], [0.0, s, c])
        })
        .unzip();
    for disc in [0.0, 0.0007, 0.001, 0.0015] {
        with_scene(&object, &points, &normals, disc, |body, support| {
            let turn = nalgebra::UnitQuaternion::from_axis_angle(&Vector::y_axis(), 1.5708);
            let release = Pose::from_parts(nalgebra::Translation3::new(0.0, 0.0, -0.022), turn);
            let mut near = vec![Near::default(); points.len()];
            let settled = settle(body, support, &release, &settings(), &mut near);
            std::println!("disc {disc} {settled:?}");
            for degrees in [15.0_f32, 18.0, 20.0, 22.0, 24.0, 27.0, 30.0, 35.0, 40.0] {
                let (s, c) = degrees.to_radians().sin_cos();
                let gravity = Vector::new(s, 0.0, -c) * 9.81;
                let tilted = settle(
                    body,
                    support,
                    &settled.pose,
                    &Settings { gravity, steps: 250, damping: [0.0, 3.0], ..settings() },
                    &mut near,
                );
                let moved = (tilted.pose * body.centre - settled.pose * body.centre).x;
                let swing = s * 0.021;
                std::println!(
                    "  {degrees}: {:?} {:.1} mm along, {:.1} swing, steps {} contacts {}",
                    tilted.fate,
                    moved * 1000.0,
                    swing * 1000.0,
                    tilted.steps,
                    tilted.contacts
                );
            }
        });
    }
}
