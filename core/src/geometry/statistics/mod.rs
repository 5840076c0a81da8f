//! Clusters, principal directions and frames of points.

mod eigen;
mod frame;
mod linkage;
pub(crate) mod mean_shift;
mod principal;

pub(crate) use eigen::{eigenvectors, least_eigenvector};
pub(crate) use frame::{principal_frame, upright_frame};
pub(crate) use linkage::linked_cluster;
pub(crate) use principal::principal_direction;
