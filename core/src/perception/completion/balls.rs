//! Which balls between what was seen free belong to the object.

use super::grid::{Grid, State};

/// Difference between the distances to the nearest surface and to the nearest free space up to which a ball hangs on the
/// surface, voxels: less than half the spacing of the centres, since a shadow widens behind what throws it.
const HANGING: f32 = 0.25;
/// Difference between the distances to two places on surfaces up to which a ball touches both, voxels: half the spacing of
/// the centres.
const TOUCHING: f32 = 0.5;
/// Cosine of the angle between two places on surfaces from which on a ball is held between them: 75°. A ball of three
/// voxels behind a flat surface with noise touches it in places up to 62° apart, larger ones in nearer places, and a ball in
/// an edge of a box in two 90° apart.
const HELD: f32 = 0.26;

/// Bounds of the balls, voxels.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    /// Greatest radius of a ball that surfaces do not hold from two sides.
    pub(super) one_sided: f32,
    /// Greatest radius.
    pub(super) radius: f32,
}

/// Radius, voxels, of the ball around a voxel that is not outside; `None` if it does not hang on a surface that was seen.
/// `sites` has the nearest outside voxel of each voxel, and `gaps` for the outside voxels next to a surface the distance to
/// it, negative for others.
pub(super) fn radius(
    grid: &Grid,
    centre: usize,
    states: &[u8],
    sites: &[u32],
    gaps: &[f32],
    bounds: &Bounds,
) -> Option<f32> {
    let nearest = grid.distance(centre, sites[centre] as usize);
    if nearest > bounds.radius + 1.0 {
        return None;
    }
    // Places on surfaces: the direction to each, and how far it is.
    let mut contacts = [([0.0; 3], 0.0); 7];
    let mut count = 0;
    let (mut radius, mut hangs) = (nearest, false);
    for around in grid.neighbours(centre).into_iter().chain([centre]) {
        let site = sites[around] as usize;
        let gap = gaps[site];
        if State::of(states[site]) == State::Outside && gap >= 0.0 {
            let way = grid.way(centre, site);
            let distance = libm::sqrtf(way.iter().map(|x| x * x).sum());
            contacts[count] = (way.map(|x| x / distance), distance - gap);
            count += 1;
            hangs |= distance <= nearest + HANGING;
            radius = radius.min(distance - gap);
        }
    }
    if !hangs || radius <= 0.0 || radius > bounds.radius {
        return None;
    }
    let touching = |(way, distance): &([f32; 3], f32)| (*distance <= radius + TOUCHING).then_some(*way);
    let cosine = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let contacts = || contacts[..count].iter().filter_map(touching);
    let is_held = || contacts().any(|a| contacts().any(|b| cosine(a, b) < HELD));
    (radius <= bounds.one_sided || is_held()).then_some(radius)
}
