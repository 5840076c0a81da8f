//! Points in the air: single ones, as flying pixels and reflections make them, and specks of a few.

use super::spacing;
use crate::disjoint_sets::DisjointSets;
use crate::geometry::{PointTree, Vector, least_eigenvector};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use nalgebra::Matrix3;

// Tolerances, set by hand on the clouds of the tests below.

/// Factor on the spacing of the points around, and on that of the whole cloud, beyond which a point stands apart. Points
/// sampled at random from a surface reach 3.4.
const APART: f32 = 4.0;
/// Factor on a point's spacing within which others that stand as far apart make a surface with it. A sparse wall behind
/// a dense hook stands apart from the hook, but its points lie in a plane.
const PEER_RADIUS: f32 = 2.5;
/// Least number of points, itself included, that make a surface.
const MIN_PEERS: usize = 6;
/// Largest thickness of such a surface, as a share of its extent.
const MAX_THICKNESS: f32 = 0.15;
/// Largest spacing of the points of a surface, metres: an object passes between points that are farther apart.
const MAX_SPACING: f32 = 0.05;
/// Factor on the smaller of two spacings, or on that of the whole cloud, within which points are in one piece.
const LINK: f32 = 2.0;
/// Largest number of points of a speck.
const MAX_SPECK: u32 = 8;

/// Neighbours by which a point is judged and linked, itself included.
const NEIGHBOURS: usize = 9;
/// Peers that are looked at.
const MAX_PEERS: usize = 24;

/// Bytes of working memory for a cloud of `points`.
pub(super) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<u8>(points)
        .saturating_add(array_bytes::<u32>(points).saturating_mul(2))
        .saturating_add(array_bytes::<[u32; NEIGHBOURS]>(points))
}

/// Flags the strays, in the order of the points that the tree was built from, as `is_on_plane` is: points on large planes are
/// none. Measures the spacings on the way, in tree order. At least one point is not flagged.
pub(super) fn find<'s>(
    tree: &PointTree,
    spacings: &mut [f32],
    is_on_plane: &[u8],
    arena: &mut Arena<'s>,
    meter: &Meter,
) -> Result<&'s [u8], Unfinished> {
    let count = tree.points().len();
    let is_stray = arena.slice::<u8>(count)?;
    let parents = arena.slice::<u32>(count)?;
    let sizes = arena.slice::<u32>(count)?;
    let (nearest, _) = arena.unset::<u32>(count * NEIGHBOURS)?.as_chunks_mut::<NEIGHBOURS>();
    tree.for_each_k_nearest::<NEIGHBOURS>(meter, |index, neighbours| {
        spacings[index] = spacing::of(neighbours);
        for (slot, neighbour) in nearest[index].iter_mut().zip(neighbours) {
            *slot = neighbour.index;
        }
    })?;
    let overall = median(spacings, sizes);
    let mut pieces = DisjointSets::new(parents);
    for (index, neighbours) in nearest.iter().enumerate() {
        meter.check_at(index)?;
        if is_on_plane[tree.order()[index] as usize] > 0 {
            continue;
        }
        let neighbours = &neighbours[..count.min(NEIGHBOURS)];
        let is_apart = is_apart(tree, spacings, index, overall, neighbours);
        is_stray[tree.order()[index] as usize] = u8::from(is_apart);
        for &other in neighbours {
            let reach = LINK * spacings[index].min(spacings[other as usize]).max(overall);
            let way = tree.points()[other as usize] - tree.points()[index];
            if way.norm_squared() <= reach * reach {
                pieces.join(index as u32, other);
            }
        }
    }
    flag_specks(tree, &mut pieces, sizes, is_stray, meter)?;
    is_stray.iter_mut().zip(is_on_plane).for_each(|(flag, on_plane)| *flag &= 1 - on_plane);
    if is_stray.iter().all(|flag| *flag > 0) {
        is_stray.fill(0);
    }
    Ok(is_stray)
}

/// The median of positive values. `bits` is working memory.
fn median(values: &[f32], bits: &mut [u32]) -> f32 {
    // Positive floats are ordered like their bits.
    for (bits, value) in bits.iter_mut().zip(values) {
        *bits = value.to_bits();
    }
    let middle = bits.len() / 2;
    if bits.is_empty() {
        return 0.0;
    }
    f32::from_bits(*bits.select_nth_unstable(middle).1)
}

/// Whether a point stands alone among its `neighbours`.
fn is_apart(tree: &PointTree, spacings: &[f32], index: usize, overall: f32, neighbours: &[u32]) -> bool {
    let spacing = spacings[index];
    if spacing > APART * overall {
        return !has_peers(tree, spacings, index);
    }
    let mut sorted = heapless::Vec::<f32, NEIGHBOURS>::new();
    for &other in neighbours.iter().filter(|&&other| other as usize != index) {
        let _ = sorted.push(spacings[other as usize]);
    }
    sorted.sort_unstable_by(f32::total_cmp);
    let local = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    spacing > APART * local && !has_peers(tree, spacings, index)
}

/// Whether a point is part of a plane of points that stand as far apart as it does.
fn has_peers(tree: &PointTree, spacings: &[f32], index: usize) -> bool {
    let (point, spacing) = (&tree.points()[index], spacings[index]);
    if spacing > MAX_SPACING {
        return false;
    }
    let mut peers = heapless::Vec::<Vector, MAX_PEERS>::new();
    tree.for_each_within(point, PEER_RADIUS * spacing, |neighbour| {
        let other = neighbour.index as usize;
        if spacings[other] > 0.5 * spacing {
            let _ = peers.push((tree.points()[other] - point) / spacing);
        }
    });
    peers.len() >= MIN_PEERS && is_flat(&peers)
}

/// Whether points lie in a plane or on a line.
fn is_flat(offsets: &[Vector]) -> bool {
    let mean = offsets.iter().sum::<Vector>() / offsets.len() as f32;
    let spread: Matrix3<f32> = offsets.iter().map(|o| (o - mean) * (o - mean).transpose()).sum();
    let normal = least_eigenvector(spread);
    let thickness = normal.dot(&(spread * normal)).max(0.0);
    thickness <= MAX_THICKNESS * MAX_THICKNESS * spread.trace()
}

/// Flags the points of pieces of at most [`MAX_SPECK`] points. `sizes` is working memory.
fn flag_specks(
    tree: &PointTree,
    pieces: &mut DisjointSets,
    sizes: &mut [u32],
    is_stray: &mut [u8],
    meter: &Meter,
) -> Result<(), Stop> {
    sizes.fill(0);
    for index in 0..sizes.len() {
        meter.check_at(index)?;
        sizes[pieces.find(index as u32) as usize] += 1;
    }
    let largest = sizes.iter().copied().max().unwrap_or(0);
    for index in 0..sizes.len() {
        meter.check_at(index)?;
        let size = sizes[pieces.find(index as u32) as usize];
        if size <= MAX_SPECK && size < largest {
            is_stray[tree.order()[index] as usize] = 1;
        }
    }
    Ok(())
}
