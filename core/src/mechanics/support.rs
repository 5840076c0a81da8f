//! The supporter as mechanics sees it: points that stand for patches of its surface.

use super::patch::Patch;
use crate::geometry::{Neighbour, PointTree, Vector};

/// A supporter that stands still, in its own coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Support<'a> {
    pub(crate) tree: &'a PointTree<'a>,
    /// In tree order; empty for points that others stand for.
    pub(crate) patches: &'a [Patch],
    /// How far a patch reaches from its point at most, metres.
    pub(crate) reach: f32,
}

/// Points closer than this to one that looks the same way add nothing to where things rest, metres.
const REPRESENTATIVES_APART: f32 = 0.0025;
/// ... that is, whose normals have this cosine: about 25 degrees.
const SAME_WAY: f32 = 0.9;

/// Chooses points so that every other has one near it that looks the same way, fills in their patches, and returns how far they
/// reach at most, metres. `is_covered` is working memory of the same length.
pub(crate) fn fit_patches(
    tree: &PointTree,
    normals: &[Vector],
    patches: &mut [Patch],
    is_covered: &mut [u8],
) -> f32 {
    let spacing = spacing(tree);
    let apart = spacing.max(REPRESENTATIVES_APART);
    let mut reach = 0.0_f32;
    for index in 0..patches.len() {
        if is_covered[index] > 0 {
            continue;
        }
        tree.for_each_within(&tree.points()[index], REPRESENTATIVES_APART, |neighbour| {
            let other = neighbour.index as usize;
            if normals[other].dot(&normals[index]) > SAME_WAY {
                is_covered[other] = 1;
            }
        });
        patches[index] = Patch::fit(tree, normals, index, apart, spacing);
        reach = reach.max(patches[index].reach());
    }
    reach
}

/// The distance at which points have their fourth neighbour, as the median of some, metres.
fn spacing(tree: &PointTree) -> f32 {
    const PROBES: usize = 64;
    let points = tree.points();
    let mut distances = [0.0; PROBES];
    for (k, distance) in distances.iter_mut().enumerate() {
        let mut found = [Neighbour::default(); 5];
        let found = tree.k_nearest(&points[k * points.len() / PROBES], &mut found);
        *distance = found.last().map_or(0.0, |neighbour| libm::sqrtf(neighbour.distance_squared));
    }
    distances.sort_unstable_by(f32::total_cmp);
    distances[PROBES / 2]
}
