//! How the object moves after its release, as the prediction simulated it.

use super::{Scene, ShownPose};
use crate::geometry::Pose;
use crate::hanging::{PredictError, predict_bytes, watch_release};

/// Seconds since the release, and the pose of the object then.
pub(super) type Track = Vec<(f32, Pose)>;

/// Time between two shown poses, seconds: a frame of a common display.
const FRAME: f32 = 1.0 / 60.0;

/// Simulates releases of the object.
pub(super) struct Simulation<'a> {
    scene: &'a Scene<'a>,
    memory: Vec<u8>,
}

impl<'a> Simulation<'a> {
    pub(super) fn new(scene: &'a Scene<'a>) -> Self {
        Self { scene, memory: vec![0; predict_bytes(&scene.supporter.limits())] }
    }

    /// The way from the release pose to the rest pose; empty for a pose that was not simulated.
    pub(super) fn settled(&mut self, pose: &ShownPose) -> Result<Track, PredictError> {
        let Some(rest) = pose.rest() else { return Ok(Track::new()) };
        let mut track = self.track(pose.release())?;
        // The rest pose of a given pose need not be the one that the simulation finds.
        if let Some((_, last)) = track.last_mut() {
            *last = *rest;
        }
        Ok(track)
    }

    /// The poses after a release, [`FRAME`] apart and the last one.
    pub(super) fn track(&mut self, release: &Pose) -> Result<Track, PredictError> {
        let Scene { object, supporter, params, monitor, .. } = *self.scene;
        if object.distance_field().is_none() {
            return Ok(Track::new());
        }
        let (mut track, mut last) = (vec![(0.0, *release)], None);
        let mut watch = |seconds: f32, pose: &Pose| {
            last = Some((seconds, *pose));
            if seconds >= FRAME * track.len() as f32 {
                track.push((seconds, *pose));
            }
        };
        let _ = watch_release((object, supporter), release, params, &mut self.memory, monitor, &mut watch)?;
        if track.last() != last.as_ref() {
            track.extend(last);
        }
        Ok(track)
    }
}
