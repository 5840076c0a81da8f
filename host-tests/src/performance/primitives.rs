//! Data of the single queries that are compared with other libraries, and this project's answers.

use super::export::{write_all, write_mesh};
use super::refine::{Triangles, refine, weld};
use crate::shapes::Random;
use anyhow::{Context, Result, ensure};
use hangpose::files::{CloudFile, read_cloud, read_mesh};
use hangpose::geometry::{Mesh, Neighbour, Point, Pose, Surface, Vector};
use hangpose::hanging::{Object, Supporter};
use hangpose::perception::depth::{DepthCamera, DepthImage};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter};
use parry3d::math;
use parry3d::query::{PointQuery, Ray, RayCast};
use parry3d::shape::{TriMesh, TriMeshFlags};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Triangles of the mesh.
const TRIANGLES: usize = 20_000;
/// Queries of each kind.
pub const QUERIES: usize = 10_000;
/// Points that are sampled.
pub const SAMPLES: usize = 10_000;
/// Edge of a voxel of the fused volume, m.
pub const VOXEL: f32 = 0.002;
/// Image of the ball: pixels, focal length in pixels, metres per unit of depth.
const IMAGE: ([u32; 2], f32, f32) = ([640, 480], 525.0, 0.0002);
/// Distance of the ball's centre from the camera and its radius, m. It fills 5 % of the image.
const BALL: [f32; 2] = [0.6, 0.0792];
/// Largest difference between distances in single precision that counts as equal, m.
pub const TOLERANCE: f32 = 2e-6;

/// A mesh, a cloud and queries.
pub struct Data {
    /// The sample mug, refined to 20,000 triangles.
    pub mesh: Triangles,
    /// The sample mug tree.
    pub cloud: CloudFile,
    /// Origins and unit directions of rays: from a box half as large again as that of the mesh, to points in it.
    pub rays: Vec<(Point, Vector)>,
    /// Points in that box.
    pub points: Vec<Point>,
    /// Points within 5 mm of points of the cloud.
    pub near_cloud: Vec<Point>,
    /// Depths of a ball before nothing, in units.
    depths: Vec<u16>,
}

impl Data {
    /// The data, from the folder of the samples.
    pub fn new(samples: &Path) -> Result<Self> {
        let mug = read_mesh(&samples.join("mug.obj"))?;
        let mesh = refine(weld(&mug.vertices, &mug.triangles), TRIANGLES);
        let cloud = read_cloud(&samples.join("mug_tree.ply"))?;
        let mut random = Random::named("queries", 1);
        let aabb = Mesh::new(&mesh.0, &mesh.1)?.aabb();
        let mut inside = |scale: f32| {
            let part = Vector::from_fn(|_, _| random.range(-0.5, 0.5) as f32);
            aabb.centre() + aabb.extents().component_mul(&part) * scale
        };
        let mut rays = Vec::new();
        while rays.len() < QUERIES {
            let (from, to) = (inside(1.5), inside(1.0));
            if let Some(direction) = (to - from).try_normalize(1e-3) {
                rays.push((from, direction));
            }
        }
        let points = (0..QUERIES).map(|_| inside(1.5)).collect();
        let near = |_| {
            let point = Point::from(cloud.points[random.pick(cloud.points.len())]);
            point + Vector::from_fn(|_, _| random.range(-0.005, 0.005) as f32)
        };
        let near_cloud = (0..QUERIES).map(near).collect();
        Self { mesh, cloud, rays, points, near_cloud, depths: ball(&camera()?) }.in_frames()
    }

    /// The same in the frames in which the mesh and the cloud are analysed, where queries are made. The frames of the result are no
    /// motions, but for rounding.
    fn in_frames(mut self) -> Result<Self> {
        let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
        let (of_object, of_supporter) =
            (*self.object(&mut object_memory)?.frame(), *self.supporter(&mut supporter_memory)?.frame());
        for vertex in &mut self.mesh.0 {
            *vertex = (of_object * Point::from(*vertex)).into();
        }
        for (origin, direction) in &mut self.rays {
            (*origin, *direction) = (of_object * *origin, of_object * *direction);
        }
        self.points.iter_mut().for_each(|point| *point = of_object * *point);
        for point in &mut self.cloud.points {
            *point = (of_supporter * Point::from(*point)).into();
        }
        for normal in self.cloud.normals.iter_mut().flatten() {
            *normal = (of_supporter * Vector::from(*normal)).into();
        }
        self.near_cloud.iter_mut().for_each(|point| *point = of_supporter * *point);
        Ok(self)
    }

    /// The mesh as the core takes it.
    pub fn mesh(&self) -> Result<Mesh<'_>> {
        Ok(Mesh::new(&self.mesh.0, &self.mesh.1)?)
    }

    /// The mesh arranged by this project, with its distance field.
    pub fn object<'m>(&self, memory: &'m mut Vec<u8>) -> Result<Object<'m>> {
        Ok(analyze_object(&self.mesh()?, &Params::default(), memory, &Monitor::new())?)
    }

    /// The cloud arranged by this project. Others arrange the points that its tree has.
    pub fn supporter<'m>(&self, memory: &'m mut Vec<u8>) -> Result<Supporter<'m>> {
        Ok(analyze_supporter(&self.cloud.cloud()?, &Params::default(), memory, &Monitor::new())?)
    }

    /// The mesh arranged by parry; signs need [`TriMeshFlags::ORIENTED`].
    pub fn parry(&self, flags: TriMeshFlags) -> Result<TriMesh> {
        let vertices = self.mesh.0.iter().map(|vertex| math::Vector::from_array(*vertex)).collect();
        let mesh = TriMesh::with_flags(vertices, self.mesh.1.clone(), flags);
        mesh.context("parry takes no such mesh")
    }

    /// The image of the ball.
    pub fn image(&self) -> Result<DepthImage<'_>> {
        Ok(DepthImage::new(camera()?, &self.depths, IMAGE.2, Pose::identity())?)
    }

    /// Checks that parry gives the same distances along rays and to closest points. Returns the share of points, in percent,
    /// that both put on the same side.
    pub fn check_parry(&self, surface: &Surface, parry: &TriMesh) -> Result<f64> {
        for (origin, direction) in &self.rays {
            let ours = surface.closest_hit(origin, direction);
            let theirs = parry.cast_local_ray(&ray(origin, direction), f32::MAX, false);
            // A ray along an edge may be a hit for one and none for the other: its neighbours are not.
            let is_same = match (ours, theirs) {
                (Some(a), Some(b)) => (a - b).abs() < 10.0 * TOLERANCE,
                (None, None) => true,
                _ => false,
            };
            ensure!(is_same, "ray from {origin} along {direction}: {ours:?}, parry {theirs:?}");
        }
        let mut same = 0;
        for point in &self.points {
            let ours = surface.signed_distance(point);
            let projection = parry.project_local_point(vector(point), false);
            let theirs = (projection.point - vector(point)).length();
            ensure!((ours.abs() - theirs).abs() < TOLERANCE, "closest to {point}: {ours}, parry {theirs}");
            same += usize::from((ours < 0.0) == projection.is_inside);
        }
        Ok(100.0 * same as f64 / self.points.len() as f64)
    }

    /// Writes the mesh, the queries and this project's answers to files of 32-bit floats, for other programs.
    pub fn export(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder)?;
        write_mesh(&folder.join("mesh.ply"), &self.mesh()?)?;
        let write = |name: &str, numbers: &[f32]| -> Result<()> {
            write_all(&mut BufWriter::new(File::create(folder.join(name))?), numbers)
        };
        let of = |points: &[Point]| points.iter().flat_map(|p| [p.x, p.y, p.z]).collect::<Vec<f32>>();
        let rays: Vec<f32> = self.rays.iter().flat_map(|(o, d)| [o.x, o.y, o.z, d.x, d.y, d.z]).collect();
        write("rays.f32", &rays)?;
        write("points.f32", &of(&self.points))?;
        write("near_cloud.f32", &of(&self.near_cloud))?;
        let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
        let object = self.object(&mut object_memory)?;
        let surface = object.surface();
        let hits = self.rays.iter().map(|(o, d)| surface.closest_hit(o, d).unwrap_or(f32::INFINITY));
        write("hits.f32", &hits.collect::<Vec<f32>>())?;
        let signed = self.points.iter().map(|point| surface.signed_distance(point));
        write("signed.f32", &signed.collect::<Vec<f32>>())?;
        let tree = self.supporter(&mut supporter_memory)?;
        write("cloud.f32", &of(tree.points().points()))?;
        let mut found = [Neighbour::default(); 8];
        let eighth = |point| {
            let found = tree.points().k_nearest(point, &mut found);
            [found[0], found[7]].map(|neighbour| neighbour.distance_squared.sqrt())
        };
        write("neighbours.f32", &self.near_cloud.iter().flat_map(eighth).collect::<Vec<f32>>())?;
        write("samples.f32", hangpose::sample_supporter(&self.mesh()?, SAMPLES, 1).points.as_flattened())?;
        let depths: Vec<u8> = self.depths.iter().flat_map(|depth| depth.to_le_bytes()).collect();
        std::fs::write(folder.join("depths.u16"), depths)?;
        let field = object.distance_field().context("the profile has a distance field")?;
        let off = self.points.iter().map(|point| (field.distance(point), surface.signed_distance(point)));
        let off: Vec<f32> =
            off.filter(|(_, exact)| exact.abs() < field.band()).map(|(a, b)| (a - b).abs()).collect();
        let ([width, height], focal, scale) = IMAGE;
        let about = serde_json::json!({
            "triangles": self.mesh.1.len(), "points": tree.points().points().len(), "queries": QUERIES,
            "samples": SAMPLES, "voxel": VOXEL, "width": width, "height": height, "focal": focal, "scale": scale,
            "centre": BALL[0], "radius": BALL[1], "same_side_parry_percent": self.check_parry(surface, &self.parry(TriMeshFlags::ORIENTED)?)?,
            "field_voxel": field.voxel_size(), "field_error_mean": off.iter().sum::<f32>() / off.len().max(1) as f32,
        });
        Ok(std::fs::write(folder.join("about.json"), serde_json::to_string_pretty(&about)?)?)
    }
}

/// A point for parry.
pub fn vector(point: &Point) -> math::Vector {
    math::Vector::new(point.x, point.y, point.z)
}

/// A ray for parry.
pub fn ray(origin: &Point, direction: &Vector) -> Ray {
    Ray::new(vector(origin), math::Vector::new(direction.x, direction.y, direction.z))
}

fn camera() -> Result<DepthCamera> {
    let ([width, height], focal, _) = IMAGE;
    let centre = [width, height].map(|pixels| 0.5 * (pixels as f32 - 1.0));
    Ok(DepthCamera::new([width, height], [focal; 2], centre, [0.0; 5])?)
}

/// Depths of a ball on the camera's axis.
fn ball(camera: &DepthCamera) -> Vec<u16> {
    let ([width, height], _, scale) = IMAGE;
    let [distance, radius] = BALL;
    let depth = |pixel| {
        let [x, y] = camera.direction(pixel);
        let square = x * x + y * y + 1.0;
        let under_root = distance * distance - square * (distance * distance - radius * radius);
        if under_root < 0.0 {
            return 0;
        }
        ((distance - under_root.sqrt()) / square / scale).round() as u16
    };
    (0..height).flat_map(|v| (0..width).map(move |u| [u as f32, v as f32])).map(depth).collect()
}
