//! Shows a prediction: as a page for a browser, and as a picture.
//!
//! The page is one file that needs no network. It holds the shapes, thinned out for display, and the poses; `viewer/` in the
//! repository has its source. The picture shows one pose without a browser.

mod display;
mod document;
mod motion;
mod page;
pub mod picture;
mod snapshot;

pub use document::ShownPose;
pub use page::page;
pub use snapshot::snapshot;

use crate::geometry::{Cloud, Mesh, Pose};
use crate::hanging::{Counts, Object, Rejection, Request, Supporter};
use crate::mechanics::Fate;
use crate::motion::Gripper;
use crate::{Monitor, Params};

/// A prediction and what it was made of. Everything is in the frames of the prediction, metres.
pub struct Scene<'a> {
    /// What the object is called, such as the name of its file.
    pub object_name: &'a str,
    /// The mesh of the object.
    pub mesh: &'a Mesh<'a>,
    /// The object, analysed.
    pub object: &'a Object<'a>,
    /// What the supporter is called.
    pub supporter_name: &'a str,
    /// The points of the supporter as they were seen.
    pub cloud: &'a Cloud<'a>,
    /// The supporter, analysed.
    pub supporter: &'a Supporter<'a>,
    /// What was asked for.
    pub request: &'a Request<'a>,
    /// The constants of the prediction.
    pub params: &'a Params,
    /// The poses, best first.
    pub poses: &'a [ShownPose],
    /// Candidates that were released, from [`Request::watch`]; those that rest are left out of the page.
    pub released: &'a [(Pose, Fate)],
    /// How much was left after each step.
    pub counts: Option<&'a Counts>,
    /// Why there is no pose.
    pub rejection: Option<&'a Rejection>,
    /// The gripper that holds the object on its path.
    pub gripper: Option<Gripper<'a>>,
    /// Stops the simulations that the page shows, if they shall end early.
    pub monitor: &'a Monitor<'a>,
}
