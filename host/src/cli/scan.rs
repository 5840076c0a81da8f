//! `hangpose scan`.

use super::output::Output;
use super::recording::Recording;
use super::terminal;
use super::{ScanArguments, json, progress};
use anyhow::{Context, Result, bail};
use hangpose::files::depth::{ScanFrame, ScanSources};
use hangpose::files::{cloud_ply_bytes, ply_bytes};
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::depth_points::DepthPoints;
use hangpose::{Monitor, complete_scan, scan_cloud};
use std::process::ExitCode;
use std::time::Instant;

/// Voxel size with which the crop box is checked before the images are read and suggest one, metres.
const CHECKED_VOXEL: f32 = 0.002;

/// What the images give.
struct Scanned {
    ply: Vec<u8>,
    /// Positions of the cameras in world coordinates, metres.
    viewpoints: Vec<[f32; 3]>,
    /// Sizes, in words.
    summary: String,
}

pub(crate) fn run(arguments: &ScanArguments) -> Result<ExitCode> {
    let start = Instant::now();
    let recording = arguments.recording();
    recording.volume(arguments.all.voxel.unwrap_or(CHECKED_VOXEL)).validate()?;
    let inputs = recording.files();
    let output = Output::prepare(&arguments.output, &inputs)?;
    let viewpoints =
        arguments.viewpoints.as_deref().map(|path| Output::prepare(path, &inputs)).transpose()?;
    let is_summary_shown = !matches!(output, Output::Standard);
    let frames = recording.read()?.frames;
    let read = start.elapsed().as_secs_f64();
    let (scanned, voxel) = if arguments.cloud {
        let voxel = recording.voxel_of_cloud();
        (cloud(&recording, &frames, voxel)?, voxel)
    } else {
        let voxel = recording.voxel_of_mesh(&frames);
        (mesh(&recording, &frames, voxel, arguments.complete)?, voxel)
    };
    let seconds = start.elapsed().as_secs_f64();
    output.write(scanned.ply)?;
    if let Some(viewpoints) = viewpoints {
        viewpoints.write(json::text(&scanned.viewpoints)).context("--viewpoints")?;
    }
    if is_summary_shown {
        terminal::print(format!(
            "{} images, {} with voxels of {:.2} mm; {seconds:.2} s, of which {read:.2} s for reading\n",
            frames.len(),
            scanned.summary,
            1000.0 * voxel,
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

impl ScanArguments {
    fn recording(&self) -> Recording<'_> {
        let sources = ScanSources {
            depth: self.depth.clone(),
            camera: self.camera.clone(),
            poses: self.poses.clone(),
            masks: self.mask.clone().zip(self.label),
            depth_scale: self.all.depth_scale,
            world_to_camera: self.all.world_to_camera,
        };
        Recording { sources, crop: self.crop, all: &self.all, name: "--depth", prefix: "" }
    }
}

fn mesh(recording: &Recording, frames: &[ScanFrame], voxel: f32, is_completed: bool) -> Result<Scanned> {
    let (settings, monitor) = (recording.volume(voxel), Monitor::new());
    let mesh = progress::show_while(&[&monitor], || match is_completed {
        true => complete_scan(frames, &settings, &CompletionSettings::default(), &monitor),
        false => hangpose::scan(frames, &settings, &monitor),
    });
    let mesh = mesh.map_err(|error| recording.explain(error))?;
    if mesh.triangles.is_empty() {
        bail!("the images show no surface in voxels of {voxel} m: pass a smaller --voxel");
    }
    recording.warn_of(mesh.agreement);
    let summary = format!(
        "{} pixels fused; mesh of {} vertices and {} triangles, {:.1} MiB for the volume",
        mesh.pixels,
        mesh.vertices.len(),
        mesh.triangles.len(),
        mesh.volume_bytes as f64 / f64::from(1 << 20),
    );
    let ply = ply_bytes(&mesh.vertices, &mesh.triangles, &mesh.viewpoints);
    Ok(Scanned { ply, viewpoints: mesh.viewpoints, summary })
}

fn cloud(recording: &Recording, frames: &[ScanFrame], voxel: f32) -> Result<Scanned> {
    let found = scan_cloud(frames, voxel, &recording.points()).map_err(|error| recording.explain(error))?;
    recording.warn_of(found.agreement);
    let cloud = found.cloud;
    let DepthPoints { points, flying, grazing, .. } = found.counts;
    let summary = format!(
        "{points} pixels merged, {flying} between surfaces and {grazing} at grazing angles left out; cloud of {} points",
        cloud.points.len()
    );
    let ply = cloud_ply_bytes(&cloud.points, cloud.normals.as_deref().unwrap_or_default(), &cloud.viewpoints);
    Ok(Scanned { ply, viewpoints: cloud.viewpoints, summary })
}
