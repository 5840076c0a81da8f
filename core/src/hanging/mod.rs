//! The method, one file a section of the paper.

mod candidates;
mod cost;
mod error;
mod hangability;
mod let_go;
mod matching;
mod object;
mod object_contact;
mod pose;
mod predict;
mod probability;
mod settling;
mod support_contact;
mod supportability;
mod supporter;
#[cfg(test)]
mod tests;

pub use cost::Cost;
pub use error::AnalysisError;
pub use hangability::{HangabilityCounts, HangingSite};
pub use let_go::{LetGo, let_go};
pub use matching::MatchingCounts;
pub use object::Object;
pub use object_contact::ObjectContact;
pub use pose::{HangingPose, Rest, SiteMatch};
pub use predict::{Counts, PredictError, Prediction, Rejection, Stage, predict, predict_bytes};
pub use settling::SettlingCounts;
pub use support_contact::SupportContact;
pub use supportability::{SupportSite, SupportabilityCounts};
pub use supporter::{NormalCounts, Supporter};

use crate::geometry::{Point, PointTree, Vector, mean_shift};
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// The contact points that hang together, as sections II-B and II-C select them.
struct ContactClusters<'s> {
    points: &'s [Point],
    labels: &'s [u32],
    count: usize,
}

/// Bytes of working memory for clustering up to `points` contact points.
const fn contact_cluster_bytes(points: usize) -> usize {
    PointTree::bytes(points)
        .saturating_add(PointTree::scratch_bytes(points))
        .saturating_add(mean_shift::scratch_bytes(points))
        .saturating_add(array_bytes::<u32>(points).saturating_mul(2))
}

impl<'s> ContactClusters<'s> {
    /// Clusters `points`, at least one, by mean shift with this bandwidth, in metres.
    fn find(points: &[Point], bandwidth: f32, mut scratch: Arena<'s>) -> Result<Self, OutOfMemory> {
        let seeds = scratch.slice::<u32>(points.len())?;
        let labels = scratch.slice::<u32>(points.len())?;
        let tree = PointTree::build(points, &mut scratch)?;
        // Started from in the caller's order, which a turn of the frame does not change, unlike the tree's.
        for (place, &index) in tree.order().iter().enumerate() {
            seeds[index as usize] = place as u32;
        }
        let count = mean_shift::cluster(&tree, seeds, bandwidth, labels, scratch)?;
        Ok(Self { points: tree.points(), labels, count })
    }

    /// For each cluster, how many points it has and which of them is closest to their centroid.
    fn iter(&self) -> impl Iterator<Item = (usize, Point)> + '_ {
        (0..self.count as u32).filter_map(|cluster| {
            let members = || self.points.iter().zip(self.labels).filter(|m| *m.1 == cluster).map(|m| m.0);
            let size = members().count();
            let centroid = Point::from(members().map(|p| p.coords).sum::<Vector>() / size as f32);
            let distance = |point: &Point| (point - centroid).norm_squared();
            let centre = members().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            Some((size, *centre))
        })
    }
}
