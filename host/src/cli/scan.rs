//! `hangpose scan`.

use super::output::Output;
use super::terminal::{self, say};
use super::{ScanArguments, json, progress};
use anyhow::{Context, Result, anyhow, bail};
use hangpose::files::depth::{ScanError, ScanSources, read_scan};
use hangpose::files::ply_bytes;
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::volume::VolumeSettings;
use hangpose::{FAIR_AGREEMENT, FuseError, Monitor, complete_scan};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

pub(crate) fn run(arguments: &ScanArguments) -> Result<ExitCode> {
    let start = Instant::now();
    let crop = arguments.crop;
    let settings =
        VolumeSettings { crop, max_depth: arguments.max_depth, ..VolumeSettings::new(arguments.voxel) };
    settings.validate()?;
    let inputs = [Path::new(&arguments.depth), &arguments.camera];
    let output = Output::prepare(&arguments.output, &inputs)?;
    let viewpoints =
        arguments.viewpoints.as_deref().map(|path| Output::prepare(path, &inputs)).transpose()?;
    let is_summary_shown = !matches!(output, Output::Standard);
    let sources = ScanSources {
        depth: arguments.depth.clone(),
        camera: arguments.camera.clone(),
        poses: arguments.poses.clone(),
        masks: arguments.mask.clone().zip(arguments.label),
        depth_scale: arguments.depth_scale,
        world_to_camera: arguments.world_to_camera,
    };
    let files = read_scan(&sources).map_err(|error| match error {
        ScanError::DepthScale { suggested, .. } => anyhow!("{error} (--depth-scale {suggested})"),
        error => error.into(),
    })?;
    files.notes.iter().for_each(|note| say("note", note));
    let monitor = Monitor::new();
    let read = start.elapsed().as_secs_f64();
    let mesh = progress::show_while(&[&monitor], || match arguments.complete {
        true => complete_scan(&files.frames, &settings, &CompletionSettings::default(), &monitor),
        false => hangpose::scan(&files.frames, &settings, &monitor),
    });
    let mesh = mesh.map_err(|error| match (&error, arguments.world_to_camera) {
        (FuseError::Convention { .. }, false) => anyhow!("{error}: pass --world-to-camera"),
        (FuseError::Convention { .. }, true) => anyhow!("{error}: leave out --world-to-camera"),
        _ => error.into(),
    })?;
    if mesh.triangles.is_empty() {
        bail!("the images show no surface in voxels of {} m: take smaller voxels", arguments.voxel);
    }
    if let Some(agreement) = mesh.agreement.filter(|agreement| *agreement < FAIR_AGREEMENT) {
        say(
            "warning",
            format_args!(
                "only {:.0} % of the points of an image reappear in the next: check that poses and images are in the same order, or that the images overlap",
                100.0 * agreement
            ),
        );
    }
    let seconds = start.elapsed().as_secs_f64();
    output.write(ply_bytes(&mesh.vertices, &mesh.triangles))?;
    if let Some(viewpoints) = viewpoints {
        viewpoints.write(json::text(&mesh.viewpoints)).context("--viewpoints")?;
    }
    if is_summary_shown {
        terminal::print(format!(
            "{} images, {} pixels fused; mesh of {} vertices and {} triangles; {:.1} MiB for the volume, {seconds:.2} s, of which {read:.2} s for reading\n",
            files.frames.len(),
            mesh.pixels,
            mesh.vertices.len(),
            mesh.triangles.len(),
            mesh.volume_bytes as f64 / f64::from(1 << 20),
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}
