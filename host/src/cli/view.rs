//! `hangpose view`.

use super::shown::{Background, Outcome};
use super::source::Source;
use super::{ViewArguments, input, json, pose_file};
use anyhow::{Context, Result};
use hangpose::hanging::Request;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter};
use serde_json::Value;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &ViewArguments) -> Result<ExitCode> {
    let ViewArguments { files, prediction: path, shown, cloud, scene, recording } = arguments;
    let at = || path.display().to_string();
    let mut document = pose_file::read(path)?;
    let params = document.get("params").cloned().context("it has no params; give a file of predict --json");
    let params: Params = serde_json::from_value(params.with_context(at)?)
        .with_context(|| format!("{}: its params are not those of this version; predict again", at()))?;
    params.validate().with_context(at)?;
    let (object_source, supporter_source) =
        (Source::of_object(files, recording)?, Source::of_supporter(files, recording)?);
    let inputs: Vec<&Path> = object_source
        .files()
        .into_iter()
        .chain(supporter_source.files())
        .chain(scene.file())
        .chain([path.as_path()])
        .collect();
    let shown = shown.prepare(&inputs)?;

    let mesh = object_source.object(files)?;
    let points = supporter_source.supporter(files, cloud, params.seed)?;
    let obstacles = scene.read(files, &points)?;
    json::shift(&mut document, points.origin.map(|x| -x));
    let details = match document.get_mut("poses").map(Value::take) {
        Some(Value::Array(poses)) => poses,
        _ => return Err(anyhow::anyhow!("{}: it has no poses; give a file of predict --json", at())),
    };
    let poses = details.iter().map(|pose| pose_file::hanging_pose_of(path, pose.clone(), [0.0; 3]));
    let poses: Vec<_> = poses.collect::<Result<_>>()?;

    let (mesh, cloud) = (mesh.mesh()?, input::seen(&points, cloud)?);
    let (mut for_object, mut for_supporter) = (Vec::new(), Vec::new());
    let monitor = Monitor::new();
    let object = analyze_object(&mesh, &params, &mut for_object, &monitor)?;
    let supporter = analyze_supporter(&cloud, &params, &mut for_supporter, &monitor)?;
    let request = Request { scene: &obstacles, ..Request::ANY };
    request.validate()?;
    let background = Background {
        names: [object_source.name(), supporter_source.name()],
        shapes: (&mesh, &cloud),
        models: (&object, &supporter),
        request: &request,
        params: &params,
        gripper: None,
    };
    shown.write(&background, &poses, details, &Outcome::default())?;
    Ok(ExitCode::SUCCESS)
}
