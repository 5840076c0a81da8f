//! Random search for a pose in which an object hangs on a supporter, independent of the predictor.
//!
//! A pair fits if the search finds a pose that hangs. If it finds none, the pair may still fit.

use crate::judge::{Bullet, Judge, Overlap, Scene};
use crate::shapes::Random;
use crate::solid::Solid;
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::{PI, TAU};

/// Largest number of poses that are released.
const DROPS: usize = 60;
/// Largest number of random poses, most of which collide.
const TRIES: usize = 5000;
/// Number of samples of each surface, few of which have a suitable normal.
const SAMPLES: usize = 20_000;
/// Smallest cosine of the angle between a suitable normal and the required direction.
const FACING: f64 = 0.3;
/// Smallest height of the object's point above the supporter's point at release, m.
const LOWEST: f64 = 0.0015;
/// Largest height of the object's point above the supporter's point at release, m.
const HIGHEST: f64 = 0.006;

/// Whether the search finds a pose that hangs. Each random pose places a point of the object whose normal faces the
/// centre of mass straight above that centre, and slightly above a point of the supporter whose normal faces up.
pub fn finds_a_pose(object: &Solid, supporter: &Solid, seed: u64) -> bool {
    let scene = Scene { tilt: false, ..Scene::new(object, supporter) };
    let (mut world, overlap) = (Bullet::default().world(&scene), Overlap::new(&scene));
    let (object, supporter) = (Surface::new(object), Surface::new(supporter));
    let centre = scene.mass.frame.translation.vector;
    let mut random = Random::named("search", seed);
    let samples = |surface: &Surface, random: &mut Random| -> Vec<_> {
        (0..SAMPLES).map(|_| surface.sample(random)).collect()
    };
    let lever = |hold: Vector3<f64>| (centre - hold).try_normalize(1e-6).unwrap_or_default();
    let mut holds = samples(&object, &mut random);
    holds.retain(|(hold, side)| side.dot(&lever(*hold)) > FACING);
    let mut rests = samples(&supporter, &mut random);
    rests.retain(|(_, side)| side.z > FACING);
    if holds.is_empty() || rests.is_empty() {
        return false;
    }
    let poses = (0..TRIES).filter_map(|_| {
        let (hold, _) = holds[random.pick(holds.len())];
        let (rest, _) = rests[random.pick(rests.len())];
        let gap = Vector3::z() * random.range(LOWEST, HIGHEST);
        let yaw = Rotation3::from_axis_angle(&Vector3::z_axis(), random.range(0.0, TAU));
        let upright = Rotation3::rotation_between(&lever(hold), &-Vector3::z())
            .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), PI));
        let turn = UnitQuaternion::from_rotation_matrix(&(yaw * upright));
        let pose = Isometry3::from_parts(Translation3::from(rest + gap - turn * hold), turn);
        overlap.is_free(&pose).then_some(pose)
    });
    poses.take(DROPS).any(|pose| world.judge(&scene, &pose.cast()).success())
}

/// A surface for uniform sampling.
struct Surface {
    triangles: Vec<[Vector3<f64>; 3]>,
    /// Cumulative areas of the triangles.
    areas: Vec<f64>,
    is_closed: bool,
}

impl Surface {
    fn new(solid: &Solid) -> Self {
        let at = |index: u32| Vector3::from(solid.vertices[index as usize]).cast::<f64>();
        let triangles: Vec<_> = solid.triangles.iter().map(|triangle| triangle.map(at)).collect();
        let areas = triangles.iter().scan(0.0, |sum, [a, b, c]| {
            *sum += (b - a).cross(&(c - a)).norm() / 2.0;
            Some(*sum)
        });
        Self { areas: areas.collect(), triangles, is_closed: solid.is_closed() }
    }

    /// A random point and its normal, with a random sign if the surface is not closed.
    fn sample(&self, random: &mut Random) -> (Vector3<f64>, Vector3<f64>) {
        let all = self.areas.last().copied().unwrap_or_default();
        let area = random.range(0.0, all);
        let chosen = self.areas.partition_point(|&sum| sum <= area).min(self.triangles.len() - 1);
        let [a, b, c] = self.triangles[chosen];
        let (u, v) = (random.range(0.0, 1.0).sqrt(), random.range(0.0, 1.0));
        let normal = (b - a).cross(&(c - a)).normalize();
        let is_back = !self.is_closed && random.chance(0.5);
        (a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v), if is_back { -normal } else { normal })
    }
}
