//! From two models to ranked poses, or the reason why there are none.

use super::counts::Counts;
use super::found::Found;
use super::method;
use super::scene::Scene;
use super::settling::Settling;
use super::{HangingPose, Object, PredictError, Rejection, Request, Supporter};
use crate::memory::{Arena, Limits, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::Params;

/// What [`predict`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction<'p> {
    /// The poses, best first.
    pub poses: &'p [HangingPose],
    /// Why there are none, if there are none and the search was not stopped.
    pub rejection: Option<Rejection>,
    /// Why the search ended early, here or in the analysis of the object or the supporter; `None` if it did not. The
    /// poses are the best found until then.
    pub stopped: Option<Stop>,
    /// How much was left after each step.
    pub counts: Counts,
    /// Rays and distance queries spent on the prediction, without the analyses.
    pub work: Work,
}

/// Bytes of working memory for [`predict`], for a supporter within `limits`.
pub const fn predict_bytes(limits: &Limits) -> usize {
    model_bytes(method::search_bytes().saturating_add(Settling::bytes(limits.points)))
}

/// Finds poses in which the object hangs and writes the best to `poses`, best first, as many as it holds.
///
/// With [`Candidates::Sites`](crate::Candidates::Sites) every hanging site is matched with every support site; a pose
/// that cannot get into `poses` any more is not evaluated to the end, so that more room costs more time. With
/// [`Params::settle`] poses are released under gravity, and only those that stay are given. `memory` is working memory,
/// [`predict_bytes`] of it; its contents do not matter.
///
/// `request` says how and where the object shall hang and what it must not touch; with [`Request::ANY`] it may hang anywhere.
/// Without [`Params::settle`] only its regions count, and these only with
/// [`Candidates::Contacts`](crate::Candidates::Contacts).
///
/// The object and the supporter must have been analysed with the same `params`.
pub fn predict<'p>(
    object: &Object,
    supporter: &Supporter,
    request: &Request,
    params: &Params,
    poses: &'p mut [HangingPose],
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Prediction<'p>, PredictError> {
    params.validate()?;
    request.validate()?;
    let arena = Arena::new(memory, predict_bytes(&supporter.limits()))?;
    let mut meter = Meter::new(monitor);
    let body = object.body();
    let scene = Scene {
        surface: object.surface(),
        centre_of_mass: object.centre(),
        body: body.as_ref(),
        support: supporter.support(),
        symmetries: request.symmetries_of(object),
        request,
        params,
    };
    let found = method::search(&scene, (object.places(), supporter.places()), poses, arena, &mut meter)?;
    meter.progress(1.0);
    let Found { poses: count, counts: search, settling, stop } = found;
    let (poses, frames) = (&mut poses[..count], object.frames_with(supporter));
    for pose in &mut *poses {
        *pose = pose.outwards(&frames);
    }
    let counts = Counts { search, settling };
    let stopped = object.stopped().or(supporter.stopped()).or(stop);
    let stage = if stopped.is_some() { None } else { counts.empty_stage(params.settle) };
    Ok(Prediction {
        poses,
        rejection: stage.map(|stage| Rejection { stage, counts }),
        stopped,
        counts,
        work: meter.work,
    })
}
