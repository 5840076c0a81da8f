//! The supporter as mechanics sees it: points that stand for discs of its surface.

use crate::geometry::{Neighbour, PointTree, Vector, any_perpendicular};

/// A supporter that stands still, in its own coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Support<'a> {
    pub(crate) tree: &'a PointTree<'a>,
    /// Unit normals in tree order.
    pub(crate) normals: &'a [Vector],
    /// In tree order: how large the disc is that a point stands for, in 255ths of `disc`; zero for points that others stand for.
    pub(crate) disc_shares: &'a [u8],
    /// Radius of the largest disc that such a point stands for, metres.
    pub(crate) disc: f32,
}

impl Support<'_> {
    /// Radius of the disc that a point stands for, metres.
    pub(crate) fn disc_at(&self, index: usize) -> f32 {
        self.disc * f32::from(self.disc_shares[index]) / 255.0
    }
}

/// Points closer than this to one that looks the same way add nothing to where things rest, metres.
const REPRESENTATIVES_APART: f32 = 0.0025;
/// ... that is, whose normals have this cosine: about 25 degrees.
const SAME_WAY: f32 = 0.9;
/// A disc's radius over the distance of the representatives. Smaller ones leave gaps between the points, over which things
/// slide as over a rasp: a ring on a rod then slides at 35 degrees instead of at its friction angle of 22. Larger ones
/// thicken what is round.
const DISC: f32 = 0.8;

/// Chooses points so that every other has one near it that looks the same way, fills in how large their discs are, and returns the
/// radius of the largest. `is_covered` is working memory of the same length.
pub(crate) fn choose_representatives(
    tree: &PointTree,
    normals: &[Vector],
    disc_shares: &mut [u8],
    is_covered: &mut [u8],
) -> f32 {
    for index in 0..disc_shares.len() {
        if is_covered[index] > 0 {
            continue;
        }
        disc_shares[index] = 1;
        tree.for_each_within(&tree.points()[index], REPRESENTATIVES_APART, |neighbour| {
            let other = neighbour.index as usize;
            if normals[other].dot(&normals[index]) > SAME_WAY {
                is_covered[other] = 1;
            }
        });
    }
    let spacing = spacing(tree);
    let disc = DISC * spacing.max(REPRESENTATIVES_APART);
    for (index, representative) in disc_shares.iter_mut().enumerate().filter(|(_, r)| **r > 0) {
        let share = covered(tree, normals, index, disc + spacing) / disc;
        *representative = (share * 255.0).clamp(1.0, 255.0) as u8;
    }
    disc
}

/// Less the same way than for one to stand for the other: a bar is round, and its end is at a right angle.
const SAME_SIDE: f32 = 0.75;

/// How far the surface around a point goes on to every side, metres, up to about `radius`: a disc that reached over the rim of a
/// bar's end would hold what slides off there.
fn covered(tree: &PointTree, normals: &[Vector], index: usize, radius: f32) -> f32 {
    const SIDES: usize = 8;
    let (place, normal) = (tree.points()[index], normals[index]);
    let ahead = any_perpendicular(normal);
    let aside = normal.cross(&ahead);
    let directions: [(f32, f32); SIDES] =
        core::array::from_fn(|k| libm::sincosf(core::f32::consts::TAU * k as f32 / SIDES as f32));
    let mut extents = [0.0_f32; SIDES];
    tree.for_each_within(&place, radius, |neighbour| {
        let other = neighbour.index as usize;
        if normals[other].dot(&normal) < SAME_SIDE {
            return;
        }
        let offset = tree.points()[other] - place;
        let (x, y) = (offset.dot(&ahead), offset.dot(&aside));
        let distance = libm::sqrtf(x * x + y * y);
        for (extent, (sin, cos)) in extents.iter_mut().zip(&directions) {
            if x * cos + y * sin > core::f32::consts::FRAC_1_SQRT_2 * distance {
                *extent = extent.max(distance);
            }
        }
    });
    extents.into_iter().fold(radius, f32::min)
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
