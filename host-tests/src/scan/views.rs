//! Where the camera stands: directions from a shape to the camera, and the pose of a camera that looks at the shape.

use crate::shapes::vector::turn;
use crate::shapes::{Opening, OpeningKind, Random};
use hangpose::geometry::{Point, Pose, Vector};
use nalgebra::Isometry3;
use std::f64::consts::PI;

/// Smallest distance of the camera from the centre of what it looks at, m: below it most depth cameras measure badly.
const NEAREST: f32 = 0.5;
/// Distance of the camera in radii of what it looks at, so that all of it fits into 480 rows at 600 pixels of focal
/// length.
const RADII: f32 = 3.0;
/// Azimuth from the front of the outermost of several views of a supporter, degrees.
const ASIDE: f64 = 40.0;
/// Elevations of views of a supporter by somebody who stands in front of it, degrees.
const ABOVE: [f64; 2] = [10.0, 30.0];
/// Azimuths of a single sensible view of a supporter, degrees: not straight along its bars.
const OFF_FRONT: [f64; 2] = [15.0, 40.0];
/// Largest angle between the axis of an opening and a sensible view through it, degrees.
const TILTED: f64 = 20.0;

/// A ball that the camera looks at.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Centre.
    pub centre: Point,
    /// Radius, m.
    pub radius: f32,
}

impl Target {
    /// The ball about the middle of the bounding box of points, `margin` metres larger than the points need.
    pub fn around(points: impl Iterator<Item = Point> + Clone, margin: f32) -> Self {
        let low = points.clone().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = points.clone().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        let centre = nalgebra::center(&low, &high);
        let reach = points.map(|point| (point - centre).norm()).fold(0.0, f32::max);
        Self { centre, radius: reach + margin }
    }
}

/// The pose of a camera that looks at a target from `direction`, upright if possible.
pub fn looking(target: &Target, direction: &Vector) -> Pose {
    let eye = target.centre + direction.normalize() * NEAREST.max(RADII * target.radius);
    let upright = direction.cross(&Vector::z()).norm() > 1e-3 * direction.norm();
    let up = if upright { Vector::z() } else { Vector::x() };
    // Camera coordinates have y down and z forward.
    Isometry3::face_towards(&eye, &target.centre, &-up)
}

/// Directions spread evenly over the sphere on a Fibonacci lattice, turned at random. One direction is uniform.
pub fn sphere(count: usize, random: &mut Random) -> Vec<Vector> {
    let turned = random.rotation();
    let direction = |k: usize| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let angle = PI * (3.0 - 5.0_f64.sqrt()) * k as f64;
        let across = (1.0 - z * z).sqrt();
        let direction = [across * libm::cos(angle), across * libm::sin(angle), z];
        turned * Vector::from(direction.map(|x| x as f32))
    };
    if count == 1 { vec![turned * Vector::z()] } else { (0..count).map(direction).collect() }
}

/// Directions to the front of a supporter, which points towards +x: one is uniform over the hemisphere, several are
/// from slightly above and spread from one side to the other.
pub fn front(count: usize, random: &mut Random) -> Vec<Vector> {
    if count == 1 {
        let direction = sphere(1, random)[0];
        return vec![Vector::new(direction.x.abs(), direction.y, direction.z)];
    }
    let azimuth = |k: usize| ASIDE * (2.0 * k as f64 / (count - 1) as f64 - 1.0);
    (0..count).map(|k| before(azimuth(k), random.range(ABOVE[0], ABOVE[1]))).collect()
}

/// A direction to the front of a supporter, slightly above and off to one side.
pub fn off_front(random: &mut Random) -> Vector {
    let side = if random.chance(0.5) { 1.0 } else { -1.0 };
    before(side * random.range(OFF_FRONT[0], OFF_FRONT[1]), random.range(ABOVE[0], ABOVE[1]))
}

/// A direction from which one of the openings by which people hang the object is seen through, up to a random tilt; any
/// direction without openings.
pub fn through(openings: &[Opening], random: &mut Random) -> Vector {
    let openings: Vec<&Opening> = openings.iter().filter(|opening| opening.is_meant).collect();
    if openings.is_empty() {
        return sphere(1, random)[0];
    }
    let &Opening { kind, axis, .. } = openings[random.pick(openings.len())];
    let axis = Vector::from(axis);
    let along = match kind {
        OpeningKind::Hole | OpeningKind::Hook => axis * if random.chance(0.5) { 1.0 } else { -1.0 },
        // The axis points out of the hollow.
        OpeningKind::Rim => axis,
        // The stem and the head above it appear side by side from any direction across the axis.
        OpeningKind::Neck { .. } => across(&axis, random),
    };
    let [cos, sin] = turn(random.range(0.0, TILTED)).map(|x| x as f32);
    along * cos + across(&along, random) * sin
}

/// The direction of an azimuth and an elevation in degrees, with +x in front.
fn before(azimuth: f64, elevation: f64) -> Vector {
    let ([cos, sin], [level, up]) = (turn(azimuth), turn(elevation));
    Vector::from([level * cos, level * sin, up].map(|x| x as f32))
}

/// A random unit vector perpendicular to a unit vector.
fn across(axis: &Vector, random: &mut Random) -> Vector {
    loop {
        let any = sphere(1, random)[0];
        if let Some(across) = (any - axis * any.dot(axis)).try_normalize(0.1) {
            return across;
        }
    }
}
