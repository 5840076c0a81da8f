//! The field against the surface that it is made from.

use super::*;
use crate::memory::model_bytes;
use crate::monitor::Meter;
use crate::random::Random;
use crate::test_shapes::{Shape, ball, grid, torus};

/// A field of at most `voxels` nodes in memory of exactly the bytes that it says it needs.
fn with_field(shape: &Shape, inside_out: bool, voxels: usize, check: impl FnOnce(&Surface, &DistanceField)) {
    let mesh = shape.mesh();
    let count = mesh.triangles().len();
    let mut memory = vec![0; model_bytes(Surface::bytes(count) + Surface::scratch_bytes(count))];
    let needed = memory.len();
    let mut arena = Arena::new(&mut memory, needed).unwrap();
    let surface = Surface::build(&mesh, inside_out, &mut arena, &Meter::unwatched()).unwrap();
    let needed = model_bytes(DistanceField::bytes(voxels) + DistanceField::scratch_bytes(count, voxels));
    let mut memory = vec![0xAB; needed];
    let mut arena = Arena::new(&mut memory, needed).unwrap();
    check(&surface, &DistanceField::build(&surface, voxels, &mut arena, &mut Meter::unwatched()).unwrap());
}

/// A box of twelve triangles with corners at the origin and at `size`.
fn cuboid(size: [f32; 3]) -> Shape {
    let vertices =
        (0..8).map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { size[axis] } else { 0.0 })).collect();
    let quads = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Shape { vertices, triangles }
}

/// The triangles of one of the repository's samples.
fn sample(name: &str) -> Shape {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples").join(name);
    let mut shape = Shape::default();
    for line in std::fs::read_to_string(path).unwrap().lines() {
        let mut words = line.split_whitespace();
        let kind = words.next();
        let mut three = || [(); 3].map(|()| words.next().unwrap().split('/').next().unwrap());
        match kind {
            Some("v") => shape.vertices.push(three().map(|word| word.parse().unwrap())),
            Some("f") => shape.triangles.push(three().map(|word| word.parse::<u32>().unwrap() - 1)),
            _ => {}
        }
    }
    shape
}

/// Turned, so that nothing is aligned with the axes.
fn askew(shape: &Shape) -> Shape {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.4, 0.5, 0.6);
    shape.map(|p| turn * p)
}

/// The largest errors at random points, in voxels.
#[derive(Debug, Default)]
struct Worst {
    /// Within the band.
    in_band: f32,
    /// The mean there.
    mean: f32,
    /// By how much a distance beyond the band is too far from zero,
    overstated: f32,
    /// and by how much it is too close on average, up to twelve voxels off the mesh.
    understated: f32,
    /// The furthest from the mesh that the sign is wrong.
    wrong_side: f32,
}

fn worst(surface: &Surface, field: &DistanceField, count: usize) -> Worst {
    let mut random = Random::new(1);
    let mut worst = Worst::default();
    let (aabb, voxel) = (surface.aabb(), field.voxel_size());
    let (mut in_band, mut sum) = (0, 0.0);
    let (mut beyond, mut understated) = (0, 0.0);
    for round in 0..count {
        let mut unit = || random.next_f32() - 0.5;
        let cube = Vector::new(unit(), unit(), unit());
        let triangles = surface.triangles();
        let [a, b, c] = triangles[((unit() + 0.5) * triangles.len() as f32) as usize];
        let (s, t) = ((unit() + 0.5).sqrt(), unit() + 0.5);
        let on_mesh = a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t);
        let point = match round % 8 {
            0 => aabb.centre() + aabb.extents().component_mul(&cube) * 1.1,
            1 => aabb.centre() + cube * (aabb.diagonal() * 4.0),
            2 => on_mesh + cube * (10.0 * voxel),
            3 => on_mesh,
            _ => on_mesh + cube * (2.0 * voxel),
        };
        let exact = surface.signed_distance(&point);
        let (found, gradient) = field.sample(&point);
        assert_eq!(found, field.distance(&point), "{point}");
        let length = gradient.norm();
        assert!(length == 0.0 || (length - 1.0).abs() < 1e-5, "{point}: {gradient}");
        let error = (found - exact).abs() / voxel;
        if exact.abs() <= field.band() {
            worst.in_band = worst.in_band.max(error);
            (in_band, sum) = (in_band + 1, sum + error);
        } else {
            worst.overstated = worst.overstated.max((found.abs() - exact.abs()) / voxel);
            if exact.abs() < 12.0 * voxel {
                (beyond, understated) = (beyond + 1, understated + (exact.abs() - found.abs()) / voxel);
            }
        }
        if (found < 0.0) != (exact < 0.0) {
            worst.wrong_side = worst.wrong_side.max(exact.abs() / voxel);
        }
    }
    worst.mean = sum / in_band as f32;
    worst.understated = understated / beyond as f32;
    worst
}

#[test]
fn distances_are_those_of_the_surface() {
    // The errors allowed in the band, at most and on average.
    let shapes: [(&str, Shape, f32, f32); 9] = [
        ("ball", ball(0.05, 40, 60), 0.1, 0.02),
        ("torus", torus(0.05, 0.01, 60, 40), 0.1, 0.03),
        ("box", cuboid([0.1, 0.07, 0.05]), 0.5, 0.02),
        ("box askew", askew(&cuboid([0.1, 0.07, 0.05])), 0.5, 0.02),
        ("plate askew", askew(&cuboid([0.2, 0.15, 0.003])), 0.6, 0.15),
        ("sheet", grid(0.1, 20), 0.6, 0.02),
        ("sheet askew", askew(&grid(0.1, 20)), 0.6, 0.2),
        ("mug", sample("mug.obj"), 0.8, 0.1),
        ("scissors", sample("scissors.obj"), 0.8, 0.1),
    ];
    for (name, shape, most, mean) in shapes {
        for voxels in [40_000, 400_000] {
            with_field(&shape, false, voxels, |surface, field| {
                let worst = worst(surface, field, 8000);
                println!("{name} {voxels} {} mm {worst:?}", field.voxel_size() * 1e3);
                assert!(worst.in_band < most && worst.mean < mean, "{name} {voxels}: {worst:?}");
                assert!(worst.overstated < 1e-3 && worst.wrong_side < 0.8, "{name} {voxels}: {worst:?}");
                // A block's centre is two voxels from what is in it on average; the rest is for what is not exact.
                assert!(worst.understated < 3.0, "{name} {voxels}: {worst:?}");
            });
        }
    }
}

/// Nothing that moves by less than the way to the bricks gets to where the distance is interpolated; and that is not next to nothing.
#[test]
fn the_way_to_the_bricks_is_no_shorter() {
    with_field(&askew(&torus(0.05, 0.01, 60, 40)), false, 100_000, |_, field| {
        let mut random = Random::new(6);
        let (mut count, mut sum) = (0, 0.0);
        for _ in 0..20_000 {
            let mut vector = |size: f32| Vector::from([(); 3].map(|()| (random.next_f32() - 0.5) * size));
            let point = Point::from(vector(0.16));
            if field.sample_near(&point).is_ok() {
                continue;
            }
            let way = field.way_to_bricks(&point);
            (count, sum) = (count + 1, sum + way / field.voxel_size());
            for _ in 0..4 {
                let there = point + unit_or(vector(1.0), Vector::x()) * (0.999 * way);
                assert!(field.sample_near(&there).is_err(), "{way} from {point} is {there}");
            }
        }
        assert!(count > 5000 && sum > 2.0 * count as f32, "{} voxels", sum / count as f32);
    });
}

/// Where the surface is smooth and no other is near, gradients point straight away from the mesh.
#[test]
fn gradients_point_away() {
    let turn = |p: &Point, ring: f32| p.coords - Vector::new(p.x, p.y, 0.0).normalize() * ring;
    for voxels in [60_000, 400_000] {
        with_field(&torus(0.05, 0.015, 120, 60), false, voxels, |_, field| {
            let mut random = Random::new(4);
            for _ in 0..20_000 {
                let p = Point::from([(); 3].map(|()| (random.next_f32() - 0.5) * 0.16));
                let out = turn(&p, 0.05);
                if (out.norm() - 0.015).abs() < field.band() {
                    let (_, gradient) = field.sample(&p);
                    let angle = gradient.dot(&out.normalize()).clamp(-1.0, 1.0).acos().to_degrees();
                    // Its faces are six degrees apart.
                    assert!(angle < 8.0, "{voxels} {p}: {angle}");
                }
            }
        });
    }
}

/// In the middle of a wall the distance is that of its sides, and on them it is next to nothing.
#[test]
fn thin_walls_stay() {
    for size in [[0.4, 0.2, 0.003], [0.2, 0.1, 0.002], [0.2, 0.1, 0.0015]] {
        for shape in [cuboid(size), askew(&cuboid(size))] {
            with_field(&shape, false, 400_000, |surface, field| {
                let mut random = Random::new(3);
                for &[a, b, c] in surface.triangles() {
                    let inwards = -(b - a).cross(&(c - a)).normalize();
                    for _ in 0..500 {
                        let (s, t) = (random.next_f32().sqrt(), random.next_f32());
                        let side = a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t);
                        let middle = side + inwards * (0.5 * size[2]);
                        let exact = surface.signed_distance(&middle);
                        if (exact + 0.5 * size[2]).abs() < 1e-5 {
                            let (on_side, within) = (field.distance(&side), field.distance(&middle));
                            assert!(on_side.abs() < 0.3e-3, "{size:?}: {on_side}");
                            assert!(within < -0.1 * size[2], "{size:?}: {within}");
                        }
                    }
                }
            });
        }
    }
}

/// What the memory holds at most is enough, and the finest field that fits is not far from it.
#[test]
fn any_mesh_gets_a_field() {
    let mut random = Random::new(2);
    let mut spread = Shape::default();
    for _ in 0..300 {
        let offset = Vector::from([(); 3].map(|()| random.next_f32()));
        spread.append(&cuboid([0.001, 0.002, 0.001]), offset);
    }
    let needle = cuboid([1.0, 1e-4, 1e-4]);
    let shapes = [
        spread.clone(),
        askew(&needle),
        needle,
        ball(1e-3, 8, 12),
        ball(1e6, 8, 12),
        ball(20.0, 30, 40).map(|p| p + Vector::new(9e5, -9e5, 9e5)),
        cuboid([2.0, 1.0, 1.0]).map(|p| Point::from(p.coords * 1e6 - Vector::repeat(1e6))),
        grid(1.0, 1),
        grid(1e-3, 1),
        askew(&grid(0.3, 3)),
    ];
    for (index, shape) in shapes.iter().enumerate() {
        for voxels in [0, 1, 124, 1000, 20_000, 200_000] {
            with_field(shape, index % 2 == 1, voxels, |surface, field| {
                assert!(field.nodes.len() <= voxels.max(125), "{index} {voxels}");
                let worst = worst(surface, field, 400);
                assert!(worst.overstated < 0.01, "{index} {voxels} {}: {worst:?}", field.voxel_size());
            });
        }
    }
}

#[test]
fn the_same_mesh_gives_the_same_bytes() {
    let shape = sample("mug.obj");
    let bytes = || {
        let mut bytes = Vec::<u8>::new();
        with_field(&shape, false, 60_000, |_, field| {
            bytes.extend_from_slice(bytemuck::cast_slice(field.grid));
            bytes.extend_from_slice(bytemuck::cast_slice(field.nodes));
        });
        bytes
    };
    assert!(bytes() == bytes());
}

#[test]
fn a_positive_distance_exceeds_that_from_the_mesh_by_less_than_it_may() {
    let thin = torus(0.05, 0.0003, 200, 8);
    let mut random = Random::new(9);
    let mut largest = 0.0_f32;
    for shape in [cuboid([0.1, 0.08, 0.0004]), askew(&cuboid([0.1, 0.08, 0.0004])), askew(&thin)] {
        with_field(&shape, false, 60_000, |surface, field| {
            let aabb = surface.aabb();
            for _ in 0..20_000 {
                let share = Vector::from([(); 3].map(|()| 1.4 * random.next_f32() - 0.2));
                let point = aabb.min + aabb.extents().component_mul(&share);
                let excess = field.distance(&point) - (surface.closest_point(&point) - point).norm();
                assert!(excess <= field.excess(), "{point}: {excess}, voxel {}", field.voxel_size());
                largest = largest.max(excess / field.voxel_size());
            }
        });
    }
    assert!(largest > 0.4, "the thin parts are thinner than a voxel: {largest}");
}
