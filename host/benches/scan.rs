//! `cargo bench`: time and memory of fusing one depth image of 640 x 480 pixels and of its mesh, on one thread.
//!
//! The image shows a ball that fills 5 % of it, 0.6 m away, before nothing. A last row is the mesh of a dense volume of
//! 128 x 128 x 128 voxels that a sphere passes through.

use hangpose::Monitor;
use hangpose::geometry::{Aabb, Pose, Vector};
use hangpose::perception::depth::{DepthCamera, DepthImage};
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Volume, VolumeLimits, VolumeSettings};
use std::time::Instant;

const RUNS: usize = 15;
const SIZE: [u32; 2] = [640, 480];
const FOCAL: f32 = 525.0;
/// Metres per unit of depth.
const SCALE: f32 = 0.0002;
const DISTANCE: f32 = 0.6;
/// Radius of the ball, metres, that fills 5 % of the image.
const RADIUS: f32 = 0.0792;

/// Depths of a ball on the camera's axis.
fn depths(camera: &DepthCamera) -> Vec<u16> {
    let pixels = (0..SIZE[1]).flat_map(|v| (0..SIZE[0]).map(move |u| [u as f32, v as f32]));
    pixels
        .map(|pixel| {
            let [x, y] = camera.direction(pixel);
            let square = x * x + y * y + 1.0;
            let under_root = DISTANCE * DISTANCE - square * (DISTANCE * DISTANCE - RADIUS * RADIUS);
            if under_root < 0.0 {
                return 0;
            }
            ((DISTANCE - under_root.sqrt()) / square / SCALE).round() as u16
        })
        .collect()
}

/// Median time in milliseconds.
fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2] * 1000.0
}

fn measure(
    name: &str,
    settings: &VolumeSettings,
    image: &DepthImage,
) -> Result<(), Box<dyn std::error::Error>> {
    let monitor = Monitor::new();
    let mut memory = vec![0; Volume::bytes(&VolumeLimits { blocks: 60_000 })];
    let blocks = {
        let limits = VolumeLimits { blocks: 60_000 };
        let mut volume = Volume::new(settings, &limits, &mut memory)?;
        volume.integrate(image, None, &monitor)?;
        volume.blocks()
    };
    let limits = VolumeLimits { blocks };
    let (mut fusing, mut meshing) = (Vec::new(), Vec::new());
    let mut size = [0; 2];
    for _ in 0..RUNS {
        let mut volume = Volume::new(settings, &limits, &mut memory)?;
        let start = Instant::now();
        volume.integrate(image, None, &monitor)?;
        fusing.push(start.elapsed().as_secs_f64());
        let mut scratch = vec![0; Isosurface::bytes(blocks)];
        let found = Isosurface::find(&volume, &mut scratch, &monitor)?;
        size = [found.vertices(), found.triangles()];
        let (mut vertices, mut triangles) = (vec![[0.0; 3]; size[0]], vec![[0; 3]; size[1]]);
        let start = Instant::now();
        let found = Isosurface::find(&volume, &mut scratch, &monitor)?;
        found.write(&mut vertices, &mut triangles)?;
        meshing.push(start.elapsed().as_secs_f64());
    }
    let bytes = Volume::bytes(&limits) + Isosurface::bytes(blocks) + 12 * (size[0] + size[1]);
    println!(
        "{name:14} {:8.2} {:8.2} {blocks:8} {:9} {:10} {:8.2}",
        median(fusing),
        median(meshing),
        size[0],
        size[1],
        bytes as f64 / f64::from(1 << 20)
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let camera = DepthCamera::new(SIZE, [FOCAL; 2], [319.5, 239.5], [0.0; 5])?;
    let depths = depths(&camera);
    let seen = depths.iter().filter(|depth| **depth > 0).count() as f64 / depths.len() as f64;
    let image = DepthImage::new(camera, &depths, SCALE, Pose::identity())?;
    println!(
        "one image with {:.1} % of its pixels on the object: median of {RUNS} runs, milliseconds; memory is volume, scratch and mesh, MiB",
        100.0 * seen
    );
    println!("voxel             fuse     mesh   blocks  vertices  triangles   memory");
    for voxel in [0.001, 0.002, 0.004] {
        measure(&format!("{} mm", voxel * 1000.0), &VolumeSettings::new(voxel), &image)?;
    }
    let voxel = 0.002;
    let corner = Vector::new(0.0, 0.0, 0.512);
    let corner = corner - Vector::new(64.0, 64.0, 32.0) * voxel;
    let crop = Aabb { min: corner.into(), max: (corner + Vector::repeat(127.5 * voxel)).into() };
    let settings = VolumeSettings { crop: Some(crop), dense: true, ..VolumeSettings::new(voxel) };
    measure("128^3 dense", &settings, &image)
}
