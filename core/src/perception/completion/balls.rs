//! Which balls between what was seen free belong to the object.

use super::grid::{Grid, State};

/// Difference between the distances to the nearest surface and to the nearest free space up to which a ball hangs on the
/// surface, voxels: half the spacing of the centres.
const HANGING: f32 = 0.5;
/// Difference between the distances to two places on surfaces up to which a ball touches both, voxels: the spacing of the
/// centres.
const TOUCHING: f32 = 1.0;
/// Cosine of the angle between two places on surfaces from which on a ball is held between them. Normals of a flat
/// surface spread by less than 60° from noise.
const HELD: f32 = 0.5;

/// Bounds of the balls, voxels.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    /// Greatest radius of a ball that touches a surface on one side only.
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
    if nearest > bounds.radius + TOUCHING {
        return None;
    }
    let mut radius = nearest;
    let mut hangs = false;
    let mut contacts = [[0.0; 3]; 7];
    let mut count = 0;
    for around in grid.neighbours(centre).into_iter().chain([centre]) {
        let site = sites[around] as usize;
        let gap = gaps[site];
        if State::of(states[site]) != State::Outside || gap < 0.0 {
            continue;
        }
        let way = grid.way(centre, site);
        let distance = libm::sqrtf(way.iter().map(|x| x * x).sum());
        if distance <= nearest + TOUCHING {
            hangs |= distance <= nearest + HANGING;
            radius = radius.min(distance - gap);
            contacts[count] = way.map(|x| x / distance);
            count += 1;
        }
    }
    let contacts = &contacts[..count];
    let cosine = |a: &[f32; 3], b: &[f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let is_held = || contacts.iter().any(|a| contacts.iter().any(|b| cosine(a, b) < HELD));
    let is_allowed = radius <= bounds.one_sided || (radius <= bounds.radius && is_held());
    (hangs && radius > 0.0 && is_allowed).then_some(radius)
}
