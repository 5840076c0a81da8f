//! Depth images of shapes with known distances, for tests.

use crate::geometry::{Point, Pose, Vector};
use crate::perception::depth::{DepthCamera, DepthImage};

/// A shape by its signed distance, metres.
pub(crate) type Distance = fn(Point) -> f32;

pub(crate) const BALL_RADIUS: f32 = 0.05;
/// Radii of the ring and of the tube.
pub(crate) const TORUS: [f32; 2] = [0.045, 0.015];
/// Half the edges.
pub(crate) const BOX: [f32; 3] = [0.04, 0.03, 0.05];
/// Metres per unit of depth: fine, so that tests measure the fusion and not the camera.
pub(crate) const SCALE: f32 = 1e-4;
/// Distance from the cameras to the origin, metres.
pub(crate) const AWAY: f32 = 0.4;

pub(crate) fn ball(p: Point) -> f32 {
    p.coords.norm() - BALL_RADIUS
}

pub(crate) fn torus(p: Point) -> f32 {
    (p.x.hypot(p.y) - TORUS[0]).hypot(p.z) - TORUS[1]
}

pub(crate) fn cuboid(p: Point) -> f32 {
    let outside = [0, 1, 2].map(|i| p[i].abs() - BOX[i]);
    let most = outside[0].max(outside[1]).max(outside[2]);
    Vector::from(outside.map(|x| x.max(0.0))).norm() + most.min(0.0)
}

/// Depths of one image and from where it was taken.
pub(crate) struct View {
    pub(crate) camera: DepthCamera,
    pub(crate) depths: Vec<u16>,
    pub(crate) pose: Pose,
}

impl View {
    /// What a camera at `pose` sees of a shape, in front of a wall at the depth `wall`, metres, or of nothing if that is
    /// zero.
    pub(crate) fn new(camera: DepthCamera, pose: Pose, shape: impl Fn(Point) -> f32, wall: f32) -> Self {
        let [width, height] = camera.size();
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| [u as f32, v as f32]));
        let depth = |pixel| {
            let [x, y] = camera.direction(pixel);
            let direction = Vector::new(x, y, 1.0);
            let mut depth = 0.0;
            // Sphere tracing: a step as long as the distance never passes the surface.
            for _ in 0..500 {
                let distance = shape(pose * Point::from(direction * depth));
                depth += distance / direction.norm();
                if distance < 1e-6 {
                    return depth;
                }
                if depth > 2.0 * AWAY {
                    break;
                }
            }
            wall
        };
        let depths = pixels.map(|pixel| (depth(pixel) / SCALE).round() as u16).collect();
        Self { camera, depths, pose }
    }

    pub(crate) fn image(&self) -> DepthImage<'_> {
        DepthImage::new(self.camera, &self.depths, SCALE, self.pose).unwrap()
    }
}

/// A camera of 320 x 240 pixels.
pub(crate) fn camera() -> DepthCamera {
    DepthCamera::new([320, 240], [400.0, 398.0], [160.3, 119.2], [0.0; 5]).unwrap()
}

/// The pose of a camera at `eye` that looks at the origin.
pub(crate) fn look_from(eye: Point) -> Pose {
    let up = if eye.x.hypot(eye.y) < 1e-3 { Vector::y() } else { Vector::z() };
    Pose::face_towards(&eye, &Point::origin(), &-up)
}

/// Poses spread evenly over a sphere around the origin, along a spiral.
pub(crate) fn poses(count: usize) -> impl Iterator<Item = Pose> {
    (0..count).map(move |i| {
        let z = 1.0 - (2 * i + 1) as f32 / count as f32;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        look_from(Point::new(radius * cos * AWAY, radius * sin * AWAY, z * AWAY))
    })
}

/// Views of a shape from all around, without a wall behind it.
pub(crate) fn around(shape: Distance, count: usize) -> Vec<View> {
    poses(count).map(|pose| View::new(camera(), pose, shape, 0.0)).collect()
}
