//! Real depth frames: fuses them, puts supporters into them, and predicts and judges on what the frames then show.

use anyhow::{Context, Result, ensure};
use clap::Parser;
use hangpose::files::depth::{ScanFrame, ScanSources, read_scan};
use hangpose::files::{CloudFile, ply_bytes};
use hangpose::geometry::{Aabb, Point, Pose, Vector};
use hangpose::hanging::{HangingPose, Request};
use hangpose::perception::depth::DepthImage;
use hangpose::perception::depth_points::{DepthPoints, DepthPointsSettings};
use hangpose::perception::volume::VolumeSettings;
use hangpose::{
    CLOUD_VOXEL, Monitor, Params, analyze_object, analyze_supporter, predict_poses, scan, scan_cloud,
};
use host_tests::judge::{Bullet, Judge, Scene};
use host_tests::scan::Sensor;
use host_tests::shapes::Random;
use host_tests::solid::Solid;
use host_tests::tables::case::{Case, made};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use parry3d::shape::TriMesh;
use std::path::PathBuf;
use std::time::Instant;

/// Distances from the camera at which supporters are put, m: as near as the camera measures, to the end of an arm.
const DISTANCES: [f64; 2] = [0.6, 1.0];
/// Free depth behind the centre of a supporter in the image, m.
const FREE: f32 = 0.3;
/// Half the side of the square of pixels whose deviation from a plane is the noise of its centre.
const HALF_WINDOW: u32 = 3;
/// Distance from the plane up to which a pixel is noise and not another surface, in squares of the depth at a metre, m: three
/// standard deviations of the camera.
const NOISE: f32 = 0.005;
/// What is kept around a supporter, m.
const AROUND: f32 = 0.15;
/// Distance around a supporter in which points may be places to hang on, m.
const REGION: f32 = 0.01;
/// Pixels of a supporter that a frame must show for it to count.
const LEAST_PIXELS: usize = 500;
/// Largest number of places that are tried for a supporter.
const TRIES: usize = 200;

#[derive(Parser)]
#[command(about)]
struct Arguments {
    /// Folder with a folder `kinect` of `*.depth.png`, `*.pose.txt` and `camera-intrinsics.txt`.
    folder: PathBuf,
    /// File for the fused mesh as PLY, for bench/fusion.py.
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Size of a voxel of the fused mesh, m.
    #[arg(long, default_value_t = 0.01)]
    voxel: f32,
    /// Number of pairs of an object and a supporter.
    #[arg(long, default_value_t = 40)]
    pairs: usize,
    /// Seed of the sizes and places.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let folder = arguments.folder.join("kinect");
    let pattern = |name: &str| folder.join(name).display().to_string();
    let sources = ScanSources {
        depth: pattern("*.depth.png"),
        camera: folder.join("camera-intrinsics.txt"),
        poses: Some(pattern("*.pose.txt")),
        masks: None,
        depth_scale: None,
        world_to_camera: false,
    };
    let frames = read_scan(&sources)?.frames;
    fuse(&frames, &arguments)?;
    hang(&frames, &arguments)
}

fn fuse(frames: &[ScanFrame], arguments: &Arguments) -> Result<()> {
    let start = Instant::now();
    let mesh = scan(frames, &VolumeSettings::new(arguments.voxel), &Monitor::new())?;
    println!(
        "{} frames, voxels of {} m: {} vertices, {:.2} s, {:.0} MiB, {:.0} % of the points of a frame reappear in the next",
        frames.len(),
        arguments.voxel,
        mesh.vertices.len(),
        start.elapsed().as_secs_f64(),
        mesh.volume_bytes as f64 / f64::from(1 << 20),
        100.0 * mesh.agreement.unwrap_or_default(),
    );
    if let Some(path) = &arguments.mesh {
        std::fs::write(path, ply_bytes(&mesh.vertices, &mesh.triangles, &mesh.viewpoints))
            .with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// What becomes of a prediction.
#[derive(Clone, Copy, PartialEq)]
enum Outcome {
    Hangs,
    Collides,
    Falls,
    NotFound,
}

fn hang(frames: &[ScanFrame], arguments: &Arguments) -> Result<()> {
    // The camera was held upright.
    let up = frames.iter().map(|frame| frame.pose * -Vector::y()).sum::<Vector>().normalize();
    let all = [Outcome::Hangs, Outcome::Collides, Outcome::Falls, Outcome::NotFound];
    let mut outcomes = Vec::new();
    for case in made(arguments.pairs, arguments.seed).into_iter().take(arguments.pairs) {
        let mut random = Random::named(&case.name, arguments.seed);
        let Some(put) = (0..TRIES).find_map(|_| put(frames, &case.supporter, &up, &mut random)) else {
            println!("{}: there is no place for the supporter", case.name);
            continue;
        };
        let seen = predict(&case, &put.cloud()?)?;
        let exact = predict(&case, &Seen { cloud: case.supporter_cloud(), region: None })?;
        println!(
            "{}: {} frames, nearest at {:.2} m, {:.0} % of its pixels became points: {}; with the exact cloud: {}",
            case.name,
            put.frames.len(),
            put.distance,
            100.0 * put.kept()?,
            words(seen),
            words(exact)
        );
        outcomes.push([seen, exact]);
    }
    ensure!(!outcomes.is_empty(), "no supporter fits into the frames");
    for (i, what) in ["in the frames", "with the exact cloud"].into_iter().enumerate() {
        let count = |outcome| outcomes.iter().filter(|both| both[i] == outcome).count();
        let counts = all.map(|outcome| format!("{} {}", count(outcome), words(outcome)));
        println!("{what}: of {} best poses, {}", outcomes.len(), counts.join(", "));
    }
    Ok(())
}

fn words(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Hangs => "hang",
        Outcome::Collides => "collide",
        Outcome::Falls => "fall",
        Outcome::NotFound => "were not found",
    }
}

/// What a prediction is given of a supporter, in its coordinates.
struct Seen {
    cloud: CloudFile,
    /// Box of the places to hang on.
    region: Option<Aabb>,
}

/// Predicts, and releases the best pose at the true shape.
fn predict(case: &Case, seen: &Seen) -> Result<Outcome> {
    let (params, monitor) = (Params::default(), Monitor::new());
    let (mut for_object, mut for_supporter) = (Vec::new(), Vec::new());
    let object = analyze_object(&case.object.mesh(), &params, &mut for_object, &monitor)?;
    let cloud = seen.cloud.cloud()?;
    let cloud = match seen.region {
        Some(region) => cloud.hang_within(region.min.into(), region.max.into())?,
        None => cloud,
    };
    let supporter = analyze_supporter(&cloud, &params, &mut for_supporter, &monitor)?;
    let mut poses = [HangingPose::default()];
    let found = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor)?;
    let Some(best) = found.poses.first() else { return Ok(Outcome::NotFound) };
    let verdict = Bullet::default().judge(&Scene::new(&case.object, &case.supporter), &best.pose);
    Ok(match (verdict.clear, verdict.success()) {
        (false, _) => Outcome::Collides,
        (true, true) => Outcome::Hangs,
        (true, false) => Outcome::Falls,
    })
}

/// A supporter in the frames that show it. Their world is the supporter's frame.
struct Put {
    frames: Vec<ScanFrame>,
    /// Box around the supporter.
    shape: Aabb,
    /// Distance from the nearest camera to the middle of the supporter, m.
    distance: f32,
}

impl Put {
    /// The cloud as the command makes it of the frames.
    fn cloud(&self) -> Result<Seen> {
        let crop = Some(grown(&self.shape, AROUND));
        let settings = DepthPointsSettings { crop, ..DepthPointsSettings::default() };
        let cloud = scan_cloud(&self.frames, CLOUD_VOXEL, &settings)?.cloud;
        Ok(Seen { cloud, region: Some(grown(&self.shape, REGION)) })
    }

    /// Part of the pixels in the supporter's box that became points.
    fn kept(&self) -> Result<f32> {
        let crop = Some(grown(&self.shape, REGION));
        let settings = DepthPointsSettings { crop, ..DepthPointsSettings::default() };
        let DepthPoints { points, flying, grazing, .. } =
            scan_cloud(&self.frames, CLOUD_VOXEL, &settings)?.counts;
        Ok(points as f32 / (points + flying + grazing) as f32)
    }
}

fn grown(aabb: &Aabb, margin: f32) -> Aabb {
    let margin = Vector::repeat(margin);
    Aabb { min: aabb.min - margin, max: aabb.max + margin }
}

/// Puts a supporter at a random place in front of a random camera, its front turned towards it up to 40 degrees; `None` if
/// there is something else.
fn put(frames: &[ScanFrame], solid: &Solid, up: &Vector, random: &mut Random) -> Option<Put> {
    let frame = &frames[random.pick(frames.len())];
    let image = frame.image().ok()?;
    let [width, height] = image.camera().size();
    let pixel = [width, height].map(|size| (random.range(0.3, 0.7) * f64::from(size)) as u32);
    let distance = random.range(DISTANCES[0], DISTANCES[1]) as f32;
    if image.depth(pixel[0], pixel[1])? < distance + FREE {
        return None;
    }
    let [x, y] = image.camera().direction(pixel.map(|x| x as f32));
    let place = image.pose() * Point::from(Vector::new(x, y, 1.0) * distance);
    let turn = UnitQuaternion::from_scaled_axis(up * random.range(-0.7, 0.7) as f32);
    let front = turn * (image.viewpoint() - place);
    let front = (front - up * up.dot(&front)).try_normalize(1e-3)?;
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[front, up.cross(&front), *up]));
    let vertices: Vec<Point> = solid.vertices.iter().map(|&vertex| vertex.into()).collect();
    let shape = Aabb::of(&vertices);
    let to_world = Pose::from_parts(place.coords.into(), rotation.into())
        * Pose::translation(-shape.centre().x, -shape.centre().y, -shape.centre().z);

    let mesh =
        TriMesh::new(solid.vertices.iter().map(|&vertex| vertex.into()).collect(), solid.triangles.clone())
            .ok()?;
    let to_supporter = to_world.inverse();
    let mut put = Put { frames: Vec::new(), shape, distance: f32::INFINITY };
    for frame in frames {
        let frame = ScanFrame { pose: to_supporter * frame.pose, ..frame.clone() };
        let image = frame.image().ok()?;
        let camera = Sensor { camera: *image.camera(), sigma: 0.0, unit: image.scale(), ..Sensor::default() };
        let shot = camera.take(&mesh, image.pose(), random);
        let Some(rendered) = shot.image() else { continue };
        let (depths, shown) = composed(&image, &rendered);
        if shown < LEAST_PIXELS {
            continue;
        }
        put.distance = put.distance.min((image.viewpoint() - shape.centre()).norm());
        let mut frame = frame;
        frame.depth.depths = depths;
        put.frames.push(frame);
    }
    (!put.frames.is_empty()).then_some(put)
}

/// The depths of a frame with a supporter in it, and the number of pixels that show it. The nearer surface wins; pixels
/// without a depth keep none; and the supporter has the noise that the frame has at the pixel, which grows with the square of
/// the depth.
fn composed(frame: &DepthImage, rendered: &DepthImage) -> (Vec<u16>, usize) {
    let [width, height] = frame.camera().size();
    let mut depths = frame.depths().to_vec();
    let mut shown = 0;
    for v in 0..height {
        for u in 0..width {
            let (Some(behind), Some(depth)) = (frame.depth(u, v), rendered.depth(u, v)) else { continue };
            if depth < behind {
                let noise = noise(frame, u, v, behind) * (depth / behind).powi(2);
                depths[(v * width + u) as usize] = ((depth + noise) / frame.scale()).round() as u16;
                shown += 1;
            }
        }
    }
    (depths, shown)
}

/// Deviation of a pixel from the plane through the pixels around it, m.
fn noise(image: &DepthImage, u: u32, v: u32, middle: f32) -> f32 {
    let limit = NOISE * middle * middle;
    let (mut products, mut sums, mut count) = (Matrix3::zeros(), Vector::zeros(), 0.0);
    for y in v.saturating_sub(HALF_WINDOW)..=v + HALF_WINDOW {
        for x in u.saturating_sub(HALF_WINDOW)..=u + HALF_WINDOW {
            let Some(depth) = image.depth(x, y).filter(|depth| (depth - middle).abs() < 3.0 * limit) else {
                continue;
            };
            let row = Vector::new(x as f32 - u as f32, y as f32 - v as f32, 1.0);
            products += row * row.transpose();
            sums += row * (depth - middle);
            count += 1.0;
        }
    }
    let plane = products.try_inverse().filter(|_| count > 9.0).map(|inverse| inverse * sums);
    plane.map_or(0.0, |plane| (-plane.z).clamp(-limit, limit))
}
