//! `hangpose predict`.

use super::json::{self, PerPart, Pose, Prediction, Reason, Seconds, Stats};
use super::output::Output;
use super::{PredictArguments, input, progress};
use anyhow::{Result, ensure};
use hangpose::geometry::{Cloud, Mesh};
use hangpose::hanging::{self, AnalysisError, HangingPose, Object, Supporter, predict};
use hangpose::{CentreOfMass, Monitor, Params, analyze_object, analyze_supporter};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Nothing hangs.
const REJECTED: u8 = 3;

pub(crate) fn run(arguments: &PredictArguments) -> Result<ExitCode> {
    let start = Instant::now();
    let mut params = arguments.method.params()?;
    if let Some(com) = arguments.com {
        params.centre_of_mass = CentreOfMass::Given(com);
    }
    params.validate()?;
    let output = arguments.json.as_deref().map(Output::prepare).transpose()?;
    let is_table_shown = !matches!(output, Some(Output::Standard));

    let mesh = input::read_object(&arguments.object, arguments.object_scale, arguments.object_up)?;
    let points = input::read_supporter(
        &arguments.supporter,
        arguments.supporter_scale,
        arguments.supporter_up,
        &arguments.cloud,
    )?;
    let mut cloud = points.cloud()?;
    if let Some(viewpoint) = arguments.cloud.viewpoint {
        cloud = cloud.seen_from(viewpoint)?;
    }
    let mut seconds = Seconds { read: start.elapsed().as_secs_f64(), ..Seconds::default() };

    let (mut object_memory, mut supporter_memory) = (Vec::new(), Vec::new());
    let mut poses = vec![HangingPose::default(); arguments.top as usize];
    let monitors = [Monitor::new(), Monitor::new(), Monitor::new()];
    let (object, supporter, prediction) = progress::show_while(&monitors.each_ref(), || -> Result<_> {
        let (object, supporter) = analyse(
            (&mesh.mesh()?, &mut object_memory, &monitors[0]),
            (&cloud, &mut supporter_memory, &monitors[1]),
            &params,
            arguments.threads > 1,
            &mut seconds,
        )?;
        let start = Instant::now();
        let prediction = predict(&object, &supporter, &params, &mut poses, &monitors[2])?;
        seconds.matching = start.elapsed().as_secs_f64();
        Ok((object, supporter, prediction))
    })?;
    seconds.total = start.elapsed().as_secs_f64();

    if supporter.normals().estimated > 0 {
        eprintln!(
            "note: {}: {} of {} normals were estimated from the neighbouring points",
            arguments.supporter.display(),
            supporter.normals().estimated,
            points.points.len(),
        );
    }
    if is_table_shown {
        print_table(&prediction, &object, &supporter);
    }
    if let Some(output) = output {
        let document = Prediction {
            schema: json::SCHEMA,
            poses: (1..)
                .zip(prediction.poses)
                .map(|(rank, pose)| Pose::new(rank, pose, object.sites(), supporter.sites()))
                .collect(),
            rejection: prediction.rejection.as_ref().map(Reason::from),
            stats: Stats {
                seconds,
                memory_bytes: PerPart { object: object_memory_len, supporter: supporter_memory_len },
                sites: PerPart { object: object.sites().len(), supporter: supporter.sites().len() },
                counts: prediction.counts,
            },
            params: &params,
        };
        output.write(&json::text(&document))?;
    }
    Ok(if prediction.rejection.is_some() { ExitCode::from(REJECTED) } else { ExitCode::SUCCESS })
}
