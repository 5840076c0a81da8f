//! Several objects on one supporter.

use super::{HangingPose, Hung, Object, PredictError, Rejection, Request, Supporter, predict};
use crate::geometry::Pose;
use crate::monitor::{Monitor, Stop, Work};
use crate::params::Params;
use heapless::Vec;

/// Most objects that hang at once, with those that hang already.
pub const MAX_HUNG: usize = 32;

/// Poses that each prediction chooses from.
const CHOICES: usize = 4;
/// Share of the merit of the best pose that another one must have to be chosen because it leaves more room.
const NEARLY_AS_GOOD: f32 = 0.9;
/// Distance from the object, metres, within which a place of the supporter is taken: hardly anything hangs closer to it.
const TAKEN: f32 = 0.015;

/// What [`predict_many`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Many {
    /// Number of objects with a pose.
    pub placed: usize,
    /// Why the first object without a pose has none.
    pub rejection: Option<Rejection>,
    /// Why the search ended early, if it did. The poses are those found until then.
    pub stopped: Option<Stop>,
    /// Rays and distance queries spent.
    pub work: Work,
}

/// Finds poses in which all of `objects` hang at once, and writes the pose of each to `poses`, `None` where there is no room.
///
/// One object after the other takes the best pose that is left, or one nearly as good that leaves more room. Where an object has
/// none, each of the others in turn gives up its pose to it, if there is another one for that. `request` holds for every object;
/// at most [`MAX_HUNG`] hang in the end, with those of [`Request::hung`], and the objects beyond have no pose. Of an object that
/// is given several times, as many copies hang as come before the first without a pose.
///
/// `poses` has one element for each object. `memory` is working memory, [`predict_bytes`](super::predict_bytes) of it. A work
/// limit of `monitor` holds for each of the predictions, of which there are at most one for each object and two for each pair.
pub fn predict_many<'o>(
    objects: &[&'o Object<'o>],
    supporter: &Supporter,
    request: &Request<'o>,
    params: &Params,
    poses: &mut [Option<HangingPose>],
    memory: &mut [u8],
    monitor: &Monitor,
) -> Result<Many, PredictError> {
    params.validate()?;
    request.validate()?;
    let mut search =
        Search { supporter, request, params, memory, monitor, rejection: None, found: Many::NONE };
    poses.fill(None);
    for index in 0..objects.len().min(poses.len()).min(MAX_HUNG.saturating_sub(request.hung.len())) {
        // The search for another copy would go the same way.
        let is_same = |(object, pose): (&&Object, &Option<HangingPose>)| {
            pose.is_none() && core::ptr::eq(*object, objects[index])
        };
        if objects[..index].iter().zip(&*poses).any(is_same) {
            continue;
        }
        poses[index] = search.pose_of(index, objects, poses)?;
        let reason = search.rejection;
        if poses[index].is_none() {
            search.look_back(index, objects, poses)?;
        }
        if poses[index].is_none() {
            search.found.rejection = search.found.rejection.or(reason);
        }
        if search.found.stopped.is_some() {
            break;
        }
    }
    Ok(Many { placed: poses.iter().flatten().count(), ..search.found })
}

struct Search<'a, 'o> {
    supporter: &'a Supporter<'a>,
    request: &'a Request<'o>,
    params: &'a Params,
    memory: &'a mut [u8],
    monitor: &'a Monitor<'a>,
    /// Of the last prediction.
    rejection: Option<Rejection>,
    found: Many,
}

impl Many {
    const NONE: Self =
        Self { placed: 0, rejection: None, stopped: None, work: Work { rays: 0, distance_queries: 0 } };
}

impl<'o> Search<'_, 'o> {
    /// The pose of one object beside all others that have one.
    fn pose_of(
        &mut self,
        index: usize,
        objects: &[&'o Object<'o>],
        poses: &[Option<HangingPose>],
    ) -> Result<Option<HangingPose>, PredictError> {
        let mut hung = Vec::<Hung, MAX_HUNG>::new();
        let others = objects.iter().zip(poses).enumerate().filter(|(other, _)| *other != index);
        let placed = others.filter_map(|(_, (object, pose))| Some((object, rest_of((*pose)?))));
        for one in self.request.hung.iter().copied().chain(placed.map(|(object, pose)| Hung { object, pose }))
        {
            // Their number is limited to the capacity.
            let _ = hung.push(one);
        }
        let request = Request { hung: &hung, ..*self.request };
        let mut choices = [HangingPose::default(); CHOICES];
        let Self { supporter, params, monitor, .. } = *self;
        let prediction =
            predict(objects[index], supporter, &request, params, &mut choices, self.memory, monitor)?;
        self.found.work.rays += prediction.work.rays;
        self.found.work.distance_queries += prediction.work.distance_queries;
        self.found.stopped = prediction.stopped;
        self.rejection = prediction.rejection;
        Ok(self.roomiest(objects[index], prediction.poses))
    }

    /// The best of some poses, or one nearly as good that takes fewer places of the supporter.
    fn roomiest(&self, object: &Object, poses: &[HangingPose]) -> Option<HangingPose> {
        let best = self.merit(poses.first()?);
        let good = poses.iter().filter(|pose| self.merit(pose) >= NEARLY_AS_GOOD * best);
        good.min_by_key(|pose| self.places_taken(object, &rest_of(**pose))).copied()
    }

    fn merit(&self, pose: &HangingPose) -> f32 {
        pose.rest.map_or(1.0, |rest| rest.probability * self.request.weight(rest.kind))
    }

    fn places_taken(&self, object: &Object, pose: &Pose) -> usize {
        let to_object = object.frames_with(self.supporter).inwards(pose).inverse();
        let places = self.supporter.places().contacts().iter();
        places.filter(|place| object.surface().is_within(&(to_object * place.position), TAKEN)).count()
    }

    /// Gives the place of another object to one that has none, if the other one finds a new one.
    fn look_back(
        &mut self,
        index: usize,
        objects: &[&'o Object<'o>],
        poses: &mut [Option<HangingPose>],
    ) -> Result<(), PredictError> {
        for other in (0..index).rev() {
            let Some(given_up) = poses[other].take() else { continue };
            poses[index] = self.pose_of(index, objects, poses)?;
            if poses[index].is_some() {
                poses[other] = self.pose_of(other, objects, poses)?;
                if poses[other].is_some() {
                    return Ok(());
                }
            }
            (poses[index], poses[other]) = (None, Some(given_up));
            if self.found.stopped.is_some() {
                break;
            }
        }
        Ok(())
    }
}

/// Where an object hangs in the end.
fn rest_of(pose: HangingPose) -> Pose {
    pose.rest.map_or(pose.pose, |rest| rest.pose)
}
