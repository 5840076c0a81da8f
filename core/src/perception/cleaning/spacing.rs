//! How far apart the points of a cloud are, around each of them.

use crate::geometry::{Neighbour, PointTree};
use crate::monitor::{Meter, Stop};

/// Neighbours that a point's spacing reaches to, itself included: the fourth neighbour of a point in a square grid is the
/// last one that is a step away.
const NEIGHBOURS: usize = 5;

/// The distance from a point to its fourth neighbour, metres; zero for a point that is alone. `nearest` are its neighbours,
/// itself included, nearest first.
pub(super) fn of(nearest: &[Neighbour]) -> f32 {
    let last = nearest[..nearest.len().min(NEIGHBOURS)].last();
    last.map_or(0.0, |neighbour| libm::sqrtf(neighbour.distance_squared))
}

/// Writes the distance from each point to its fourth neighbour, metres; zero for a point that is alone.
pub(crate) fn measure(tree: &PointTree, spacings: &mut [f32], meter: &Meter) -> Result<(), Stop> {
    tree.for_each_k_nearest::<NEIGHBOURS>(meter, |index, nearest| spacings[index] = of(nearest))
}
