//! A depth camera that measures a mesh by one ray a pixel, with the errors of real cameras.

use crate::shapes::Random;
use hangpose::geometry::Pose;
use hangpose::parry::pose_to_parry;
use hangpose::perception::depth::{DepthCamera, DepthImage};
use parry3d::math;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;

/// Depth up to which the camera measures, m.
const FAR: f32 = 6.0;

/// A depth camera and its errors.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    /// Resolution and focal lengths.
    pub camera: DepthCamera,
    /// Standard deviation of the depth at 0.5 m, m. It grows with the square of the depth, as in all cameras that
    /// triangulate.
    pub sigma: f64,
    /// Unit of the depths, m.
    pub unit: f32,
    /// Angles of incidence, degrees: up to the first every pixel returns, from the second on none, and in between the
    /// chance falls linearly.
    pub grazing: [f64; 2],
    /// Difference in depth between neighbouring pixels that makes both an edge, m. Above the step of a surface at 80°,
    /// which is 5 mm.
    pub edge: f32,
    /// Probability that a pixel at an edge returns nothing.
    pub edge_loss: f64,
    /// Probability that a pixel at an edge is a flying pixel, with a depth between those of both sides.
    pub flying: f64,
    /// Distance behind a silhouette, m, up to which there are flying pixels. Those farther behind are cropped with the
    /// background.
    pub behind: f32,
}

impl Default for Sensor {
    /// The errors of a good stereo or structured-light camera at arm's length: noise of 0.5 mm, units of 0.1 mm, no
    /// return beyond about 77°, and at edges three lost pixels and half a flying pixel in ten.
    fn default() -> Self {
        Self {
            camera: DepthCamera::new([640, 480], [600.0; 2], [319.5, 239.5], [0.0; 5]).expect("valid"),
            sigma: 0.0005,
            unit: 0.0001,
            grazing: [72.0, 82.0],
            edge: 0.01,
            edge_loss: 0.3,
            flying: 0.05,
            behind: 0.03,
        }
    }
}

/// A depth image with its memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    camera: DepthCamera,
    depths: Vec<u16>,
    unit: f32,
    pose: Pose,
}

impl Shot {
    /// The image as the core takes it; `None` if no pixel has a depth.
    pub fn image(&self) -> Option<DepthImage<'_>> {
        DepthImage::new(self.camera, &self.depths, self.unit, self.pose).ok()
    }
}

/// What the ray of a pixel meets.
#[derive(Clone, Copy)]
struct Hit {
    depth: f32,
    /// Cosine of the angle of incidence.
    cosine: f32,
}

impl Sensor {
    /// The same camera without errors but those of the unit.
    pub fn perfect() -> Self {
        Self { sigma: 0.0, grazing: [90.0, 91.0], edge_loss: 0.0, flying: 0.0, ..Self::default() }
    }

    /// Takes a picture of a mesh from `pose`, which maps camera to world coordinates.
    pub fn take(&self, mesh: &TriMesh, pose: &Pose, random: &mut Random) -> Shot {
        let [width, height] = self.camera.size();
        let hits = self.cast(mesh, pose);
        // Neighbours outside the image have wrapped around to large numbers.
        let at = |u: u32, v: u32| {
            if u < width && v < height { hits[(v * width + u) as usize] } else { None }
        };
        let mut depths = vec![0; hits.len()];
        for v in 0..height {
            for u in 0..width {
                let Some(hit) = at(u, v) else { continue };
                let around = [(u.wrapping_sub(1), v), (u + 1, v), (u, v.wrapping_sub(1)), (u, v + 1)];
                let around = around.map(|(u, v)| at(u, v));
                depths[(v * width + u) as usize] = self.measure(hit, around, random);
            }
        }
        Shot { camera: self.camera, depths, unit: self.unit, pose: *pose }
    }

    /// The depth that a pixel reports, in units, given what its neighbours see; 0 for nothing.
    fn measure(&self, hit: Hit, around: [Option<Hit>; 4], random: &mut Random) -> u16 {
        let angle = f64::from(hit.cosine.min(1.0)).acos().to_degrees();
        let [safe, lost] = self.grazing;
        if random.chance((angle - safe) / (lost - safe)) {
            return 0;
        }
        let mut depth = f64::from(hit.depth);
        let others = around.map(|other| other.map_or(hit.depth + self.behind, |other| other.depth));
        if let Some(other) = others.into_iter().find(|other| (other - hit.depth).abs() > self.edge) {
            if random.chance(self.edge_loss) {
                return 0;
            }
            if random.chance(self.flying) {
                depth += random.range(0.0, 1.0) * f64::from(other - hit.depth);
            }
        }
        depth += random.gaussian() * self.sigma * (depth / 0.5).powi(2);
        (depth / f64::from(self.unit)).round().clamp(0.0, f64::from(u16::MAX - 1)) as u16
    }

    /// What the ray of each pixel meets.
    fn cast(&self, mesh: &TriMesh, pose: &Pose) -> Vec<Option<Hit>> {
        let [width, height] = self.camera.size();
        let mut hits = vec![None; self.camera.pixels()];
        let [from, to] = self.window(mesh, pose);
        let to_world = pose_to_parry(pose);
        for v in from[1]..to[1].min(height) {
            for u in from[0]..to[0].min(width) {
                let [x, y] = self.camera.direction([u as f32, v as f32]);
                // The ray's parameter is the depth, since its direction has a z of 1 in camera coordinates.
                let ray =
                    Ray::new(to_world.translation, to_world.transform_vector(math::Vector::new(x, y, 1.0)));
                hits[(v * width + u) as usize] =
                    mesh.cast_local_ray_and_get_normal(&ray, FAR, false).map(|hit| Hit {
                        depth: hit.time_of_impact,
                        cosine: (hit.normal.dot(ray.dir) / ray.dir.length()).abs(),
                    });
            }
        }
        hits
    }

    /// Columns and rows between which the mesh appears, from the corners of its box; all of the image if a corner is
    /// behind the camera.
    fn window(&self, mesh: &TriMesh, pose: &Pose) -> [[u32; 2]; 2] {
        let mut window = [[u32::MAX; 2], [0; 2]];
        for corner in mesh.local_aabb().vertices() {
            let seen = pose.inverse_transform_point(&corner.to_array().into());
            let Some(pixel) = self.camera.project(seen.into()) else {
                return [[0; 2], self.camera.size()];
            };
            for i in 0..2 {
                window[0][i] = window[0][i].min(pixel[i] as u32);
                window[1][i] = window[1][i].max(pixel[i] as u32 + 2);
            }
        }
        window
    }
}
