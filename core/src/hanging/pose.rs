//! What a prediction is made of.

use super::settling::Rest;
use super::sites::SiteMatch;
use crate::geometry::Pose;

/// A pose in which the object hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HangingPose {
    /// Where to let the object go: maps object coordinates to supporter coordinates; metres. `T_ij` of section II-D, or as close
    /// to where it comes to rest as the clearance allows.
    pub pose: Pose,
    /// What gravity then makes of it, if gravity was asked ([`Params::settle`](crate::Params::settle)).
    pub rest: Option<Rest>,
    /// The sites that it joins, if it comes from the paper's matching ([`Candidates::Sites`](crate::Candidates::Sites)).
    pub matched: Option<SiteMatch>,
}

impl Default for HangingPose {
    fn default() -> Self {
        Self { pose: Pose::identity(), rest: None, matched: None }
    }
}
