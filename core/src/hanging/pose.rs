//! What a prediction is made of.

use super::settling::rest::Rest;
use super::sites::site_match::SiteMatch;
use crate::geometry::Pose;
use crate::mechanics::Frames;

/// A pose in which the object hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HangingPose {
    /// The release pose: maps object coordinates to supporter coordinates; metres. `T_ij` of section II-D, or, with
    /// [`Params::settle`](crate::Params::settle), as close to the rest pose as the clearance allows.
    pub pose: Pose,
    /// The rest pose and its margins; `None` without [`Params::settle`](crate::Params::settle).
    pub rest: Option<Rest>,
    /// The pair of sites that it joins; `None` unless it comes from [`Candidates::Sites`](crate::Candidates::Sites).
    pub matched: Option<SiteMatch>,
}

impl HangingPose {
    /// The same in the caller's coordinates.
    pub(super) fn outwards(&self, frames: &Frames) -> Self {
        let rest = self.rest.map(|rest| rest.outwards(frames));
        Self { pose: frames.outwards(&self.pose), rest, matched: self.matched }
    }
}

impl Default for HangingPose {
    fn default() -> Self {
        Self { pose: Pose::identity(), rest: None, matched: None }
    }
}
