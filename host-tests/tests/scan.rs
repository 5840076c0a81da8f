//! The simulated depth camera against formulas.

use hangpose::geometry::{Point, Pose, Vector};
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::depth::DepthImage;
use host_tests::scan::{Sensor, Shot, Surface, Target, cloud, front, fuse, looking, off_front, sphere};
use host_tests::shapes::Random;
use host_tests::solid::Solid;
use parry3d::math;
use parry3d::shape::{Ball, TriMesh};

/// A square of 2 m in front of a camera at the origin, turned by `angle` degrees about the camera's y axis, at 0.5 m.
fn wall(angle: f32) -> TriMesh {
    let (sin, cos) = angle.to_radians().sin_cos();
    let corner = |x: f32, y: f32| math::Vector::new(x * cos, y, 0.5 + x * sin);
    let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    TriMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

fn pixels<'a>(image: &'a DepthImage) -> impl Iterator<Item = (u32, u32, f32)> + 'a {
    let [width, height] = image.camera().size();
    (0..height).flat_map(move |v| (0..width).filter_map(move |u| Some((u, v, image.depth(u, v)?))))
}

#[test]
fn a_sphere_has_its_depth() {
    let (centre, radius) = (Point::new(0.01, -0.02, 0.03), 0.06);
    let (vertices, triangles) = Ball::new(radius).to_trimesh(256, 256);
    let offset = math::Vector::from_array(centre.into());
    let ball = TriMesh::new(vertices.into_iter().map(|v| v + offset).collect(), triangles).unwrap();
    let target = Target { centre: Point::origin(), radius };
    let pose = looking(&target, &Vector::new(0.3, 1.0, -0.5));
    let shot = Sensor::perfect().take(&ball, &pose, &mut Random::new(1));
    let image = shot.image().unwrap();
    let seen = pose.inverse_transform_point(&centre);
    let mut count = 0;
    for (u, v, depth) in pixels(&image) {
        let [x, y] = image.camera().direction([u as f32, v as f32]);
        // The nearer root of |d (x, y, 1) - seen| = radius.
        let ray = Vector::new(x, y, 1.0);
        let (a, b, c) =
            (ray.norm_squared(), ray.dot(&seen.coords), seen.coords.norm_squared() - radius * radius);
        let under = b * b - a * c;
        // Where the ray is nearly tangent, the facets of the mesh are far from the sphere along it.
        if under > 0.2 * a * radius * radius {
            let expected = (b - under.sqrt()) / a;
            assert!((depth - expected).abs() < 0.0002, "{u} {v}: {depth} {expected}");
            count += 1;
        }
    }
    // Four fifths of a disc with a radius of 600 pixels · 0.06 m / 0.5 m.
    assert!((10_000..16_000).contains(&count), "{count}");
}

#[test]
fn noise_has_its_standard_deviation() {
    let noisy = Sensor { sigma: 0.002, ..Sensor::perfect() };
    for depth in [0.5, 1.0] {
        let away = Pose::translation(0.0, 0.0, 0.5 - depth);
        let shot = noisy.take(&wall(0.0), &away, &mut Random::new(2));
        let image = shot.image().unwrap();
        let errors: Vec<f32> = pixels(&image).map(|(.., measured)| measured - depth).collect();
        let mean = errors.iter().sum::<f32>() / errors.len() as f32;
        let sigma = (errors.iter().map(|e| e * e).sum::<f32>() / errors.len() as f32).sqrt();
        // The noise grows with the square of the depth.
        let expected = 0.002 * (depth / 0.5).powi(2);
        assert!(mean.abs() < 0.05 * expected && (sigma / expected - 1.0).abs() < 0.1, "{mean} {sigma}");
    }
}

#[test]
fn grazing_surfaces_return_nothing() {
    let share = |angle| {
        let sensor = Sensor { edge_loss: 0.0, ..Sensor::default() };
        let shot = sensor.take(&wall(angle), &Pose::identity(), &mut Random::new(3));
        // The middle column, where the angle of incidence is that of the wall up to the image's height.
        let returns = |v: u32| shot.image().is_some_and(|image| image.depth(320, v).is_some());
        (200..280).filter(|&v| returns(v)).count() as f32 / 80.0
    };
    assert_eq!((share(0.0), share(60.0), share(84.0)), (1.0, 1.0, 0.0));
    assert!((share(77.0) - 0.5).abs() < 0.2, "{}", share(77.0));
}

#[test]
fn views_look_at_the_target_from_their_side() {
    let target = Target { centre: Point::new(0.3, -0.1, 0.2), radius: 0.25 };
    let mut random = Random::new(4);
    let camera = Sensor::default().camera;
    let around = sphere(24, &mut random);
    let before = [front(3, &mut random), front(1, &mut random), vec![off_front(&mut random)]].concat();
    assert!(before.iter().all(|direction| direction.x > 0.0), "{before:?}");
    for direction in around.iter().chain(&before).chain(&[Vector::z()]) {
        let pose = looking(&target, direction);
        assert!((pose.translation.vector - target.centre.coords).cross(direction).norm() < 1e-5);
        // All of the ball is in the image, its centre in the middle.
        let [u, v] = camera.project(pose.inverse_transform_point(&target.centre).into()).unwrap();
        assert!((u - 319.5).abs() < 0.1 && (v - 239.5).abs() < 0.1, "{u} {v}");
        for side in [Vector::x(), Vector::y(), Vector::z()].iter().flat_map(|side| [*side, -side]) {
            let edge = pose.inverse_transform_point(&(target.centre + side * target.radius));
            let [u, v] = camera.project(edge.into()).unwrap();
            assert!((0.0..640.0).contains(&u) && (0.0..480.0).contains(&v), "{u} {v}");
        }
    }
    // The 24 directions balance each other, and each has its own region of the sphere.
    assert!(around.iter().sum::<Vector>().norm() < 0.5);
    for (k, a) in around.iter().enumerate() {
        assert!(around[..k].iter().all(|b| a.dot(b) < 0.95), "{k}");
    }
}

#[test]
fn a_seed_gives_the_same_images() {
    let shot = |seed| {
        let pose = Pose::identity();
        Sensor::default().take(&wall(30.0), &pose, &mut Random::new(seed))
    };
    assert!(shot(5) == shot(5) && shot(5) != shot(6));
}

/// Radii of a torus about the z axis: of its circle and of its tube, m.
const TORUS: [f32; 2] = [0.04, 0.008];

fn torus() -> TriMesh {
    let [large, small] = TORUS;
    let (rings, sides) = (128, 48);
    let at = |i: u32, j: u32| {
        let [a, b] =
            [i as f32 / rings as f32, j as f32 / sides as f32].map(|turn| turn * std::f32::consts::TAU);
        let out = large + small * b.cos();
        math::Vector::new(out * a.cos(), out * a.sin(), small * b.sin())
    };
    let vertices = (0..rings).flat_map(|i| (0..sides).map(move |j| at(i, j))).collect();
    let index = |i: u32, j: u32| i % rings * sides + j % sides;
    let square = |i, j| {
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..rings).flat_map(|i| (0..sides).flat_map(move |j| square(i, j))).collect();
    TriMesh::new(vertices, triangles).unwrap()
}

/// Signed distance from the torus, m.
fn from_torus(point: &[f32; 3]) -> f32 {
    let [x, y, z] = *point;
    (x.hypot(y) - TORUS[0]).hypot(z) - TORUS[1]
}

fn torus_shots(count: usize, sensor: &Sensor) -> Vec<Shot> {
    let mut random = Random::new(7);
    let target = Target { centre: Point::origin(), radius: 0.05 };
    let directions = sphere(count, &mut random);
    directions.iter().map(|way| sensor.take(&torus(), &looking(&target, way), &mut random)).collect()
}

#[test]
fn a_fused_torus_is_within_a_voxel_and_closed() {
    let shots = torus_shots(24, &Sensor::default());
    let images: Vec<_> = shots.iter().filter_map(Shot::image).collect();
    let guess = CompletionSettings::default();
    let surface = fuse(&images, Some(&guess));
    assert!(surface == fuse(&images, Some(&guess)));
    let open = fuse(&images, None);
    assert!(
        open.triangles.len() * 100 > 97 * surface.triangles.len()
            && surface.seen.len() == surface.vertices.len()
    );
    let off = surface.vertices.iter().filter(|v| from_torus(v).abs() > 0.0015).count();
    assert!(off * 100 < 2 * surface.vertices.len(), "{off} of {}", surface.vertices.len());
    // Every edge of a closed surface is used in both directions.
    let Surface { vertices, triangles, .. } = surface;
    let solid = Solid { vertices, triangles, ..Solid::default() };
    assert!(solid.is_closed());
    // Outside is outside: the volume is that of the torus.
    let volume: f32 = solid
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| Vector::from(solid.vertices[v as usize]));
            a.dot(&b.cross(&c)) / 6.0
        })
        .sum();
    let expected = 2.0 * std::f32::consts::PI.powi(2) * TORUS[0] * TORUS[1] * TORUS[1];
    assert!((volume / expected - 1.0).abs() < 0.15, "{volume} {expected}");
}

#[test]
fn one_image_of_a_torus_is_half_of_it_facing_the_camera() {
    let shots = torus_shots(1, &Sensor { flying: 0.0, ..Sensor::default() });
    let image = shots[0].image().unwrap();
    let Surface { vertices, triangles, seen, .. } = fuse(&[image], None);
    assert!(seen.iter().all(|seen| *seen == 1));
    assert!(vertices.iter().all(|v| from_torus(v).abs() < 0.003));
    let (mut area, mut facing) = (0.0, 0.0);
    for [a, b, c] in triangles.iter().map(|t| t.map(|v| Vector::from(vertices[v as usize]))) {
        let normal = (b - a).cross(&(c - a));
        facing += normal.norm() * f32::from(normal.dot(&(image.viewpoint().coords - a)) > 0.0) / 2.0;
        area += normal.norm() / 2.0;
    }
    assert!(facing > 0.95 * area, "{facing} of {area}");
    // Half of the torus at most, less its grazing parts and a strip along its outline.
    let half = 2.0 * std::f32::consts::PI.powi(2) * TORUS[0] * TORUS[1];
    assert!((0.35 * half..1.1 * half).contains(&area), "{area} {half}");
}

#[test]
fn one_image_of_a_torus_through_its_hole_is_completed_to_all_of_it() {
    let target = Target { centre: Point::origin(), radius: 0.05 };
    let from = looking(&target, &Vector::new(0.1, 0.2, 1.0));
    let shot = Sensor::default().take(&torus(), &from, &mut Random::new(3));
    let surface = fuse(&[shot.image().unwrap()], Some(&CompletionSettings::default()));
    let off = surface.vertices.iter().filter(|v| from_torus(v).abs() > 0.004).count();
    assert!(off * 100 < 10 * surface.vertices.len(), "{off} of {}", surface.vertices.len());
    let guessed = surface.seen.iter().filter(|seen| **seen == 0).count();
    assert!((0.3..0.7).contains(&(guessed as f32 / surface.seen.len() as f32)));
    assert!(surface.shown().len() < surface.triangles.len());
    let Surface { vertices, triangles, .. } = surface;
    assert!(Solid { vertices, triangles, ..Solid::default() }.is_closed());
}

#[test]
fn clouds_lie_on_the_torus_with_normals_that_face_out() {
    let shots = torus_shots(3, &Sensor::default());
    let images: Vec<_> = shots.iter().filter_map(Shot::image).collect();
    let seen = cloud(&images);
    let near = seen.points.iter().filter(|p| from_torus(p).abs() < 0.0015).count();
    assert!(near * 100 > 97 * seen.points.len(), "{near} of {}", seen.points.len());
    let normals = seen.normals.unwrap();
    let outwards = seen.points.iter().zip(&normals).filter(|(point, normal)| {
        let [x, y, z] = **point;
        let inner = Vector::new(x, y, 0.0).normalize() * TORUS[0];
        (Vector::new(x, y, z) - inner).normalize().dot(&Vector::from(**normal).normalize()) > 0.8
    });
    let share = outwards.count() as f32 / normals.len() as f32;
    assert!(share > 0.9, "{share}");
    let one = cloud(&images[..1]);
    assert_eq!(one.normals.map(|normals| normals.len()), Some(one.points.len()));
    assert_eq!(one.viewpoints, [<[f32; 3]>::from(images[0].viewpoint())]);
}
