//! Clusters and principal directions of points.

mod eigen;
mod linkage;
pub(crate) mod mean_shift;
mod principal;

pub(crate) use eigen::{eigenvectors, least_eigenvector};
pub(crate) use linkage::linked_cluster;
pub(crate) use principal::principal_direction;
