//! From a mesh and a cloud to ranked hanging poses.
//!
//! An [`Object`] and a [`Supporter`] are analysed once; [`predict`] makes [`HangingPose`]s of them, or a [`Rejection`].
//! A method finds *places* on both, which are hanging and support sites in the published method ([`sites`]) and contact
//! candidates in the contact method ([`contacts`]), and poses that join them. `method.rs` alone chooses the method; the
//! other files of this folder serve any.

pub mod contacts;
mod counts;
mod error;
mod found;
mod let_go;
mod many;
mod method;
mod object;
mod opening;
mod pose;
mod predict;
mod region;
mod rejection;
mod request;
#[cfg(test)]
mod request_tests;
mod samples;
mod scene;
mod settling;
pub mod sites;
mod stage;
mod supporter;
#[cfg(test)]
mod tests;
mod watch;

pub use crate::perception::cleaning::CleaningCounts;
pub use counts::Counts;
pub use error::{AnalysisError, PredictError};
pub use let_go::{LetGo, let_go};
pub use many::{MAX_HUNG, Many, predict_many};
pub use method::{ObjectCounts, SearchCounts, SupporterCounts};
pub use object::Object;
pub use pose::HangingPose;
pub use predict::{Prediction, predict, predict_bytes};
pub use region::{Region, RegionError};
pub use rejection::Rejection;
pub use request::{Approach, Distance, Hung, Request, RequestError};
pub use settling::{Rest, SettlingCounts, Tolerance};
pub use stage::Stage;
pub use supporter::{NormalCounts, Supporter};
pub use watch::{Watch, watch_release};
