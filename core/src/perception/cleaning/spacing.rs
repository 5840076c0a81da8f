//! How far apart the points of a cloud are, around each of them.

use crate::geometry::{Neighbour, PointTree};

/// Neighbours that a point's spacing reaches to, itself included: the fourth neighbour of a point in a square grid is the
/// last one that is a step away.
const NEIGHBOURS: usize = 5;

/// Writes the distance from each point to its fourth neighbour, metres; zero for a point that is alone.
pub(crate) fn measure(tree: &PointTree, spacings: &mut [f32]) {
    for (spacing, point) in spacings.iter_mut().zip(tree.points()) {
        let mut found = [Neighbour::default(); NEIGHBOURS];
        let found = tree.k_nearest(point, &mut found);
        *spacing = found.last().map_or(0.0, |neighbour| libm::sqrtf(neighbour.distance_squared));
    }
}
