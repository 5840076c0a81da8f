//! Clusters of contact points, as sections II-B and II-C select them.

use crate::geometry::{Point, PointTree, Vector, mean_shift};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Unfinished};

/// Contact points with the label of their cluster.
pub(super) struct Clusters<'s> {
    points: &'s [Point],
    labels: &'s [u32],
    pub(super) count: usize,
}

impl<'s> Clusters<'s> {
    /// Bytes of working memory for clustering up to `points` contact points.
    pub(super) const fn scratch_bytes(points: usize) -> usize {
        PointTree::bytes(points)
            .saturating_add(mean_shift::scratch_bytes(points))
            .saturating_add(array_bytes::<u32>(points).saturating_mul(2))
    }

    /// Clusters `points`, at least one, by mean shift with a flat kernel of radius `bandwidth`, in metres.
    pub(super) fn find(
        points: &[Point],
        bandwidth: f32,
        mut scratch: Arena<'s>,
        meter: &Meter,
    ) -> Result<Self, Unfinished> {
        let seeds = scratch.slice::<u32>(points.len())?;
        let labels = scratch.slice::<u32>(points.len())?;
        let tree = PointTree::build(points, &mut scratch, meter)?;
        // The seeds are taken in the caller's order: unlike the tree's, it does not change when the frame is rotated.
        for (place, &index) in tree.order().iter().enumerate() {
            seeds[index as usize] = place as u32;
        }
        let count = mean_shift::cluster(&tree, seeds, bandwidth, labels, scratch, meter)?;
        Ok(Self { points: tree.points(), labels, count })
    }

    /// The size of each cluster, and its member that is closest to its centroid.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, Point)> + '_ {
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
