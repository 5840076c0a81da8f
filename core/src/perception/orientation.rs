//! Which side of a surface is outside: turns the normals of a cloud so that they agree with each other and point out of
//! the solid.

use super::visibility;
use crate::geometry::{Neighbour, Point, PointTree, Vector, Viewpoints};
use crate::heap::Heap;
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::sort::sort;
use bytemuck::{Pod, Zeroable};

// Tolerances, set by hand on the shapes of the tests below; no value was fitted.

/// Share of neighbouring normals that must agree in sign for the normals to count as oriented. Normals of one surface
/// agree everywhere but at noise and sharp edges; without orientation half of them do.
const MIN_AGREEMENT: f32 = 0.8;
/// Share of the opposing points that must lie in front of the normals for these to count as pointing inwards.
const MIN_INWARD: f32 = 0.8;
/// Largest thickness at which the two sides of a bar or plate are told apart, metres: thicker than what things hang on.
const MAX_THICKNESS: f32 = 0.025;
/// Cosine between opposing normals, and between a normal and the way to the opposing point.
const OPPOSING: f32 = 0.7;
/// Points of a piece whose votes must agree, net, for it to be reversed or kept by them: by chance fewer do.
const MIN_VOTES: f32 = 8.0;

/// Cosine of the bend between neighbours up to which they are in one piece: 53 degrees.
const SMOOTH: f32 = 0.6;
/// Share of a piece's voters by which those with an opposite surface on one side must outnumber those with one on the
/// other.
const MIN_SHARE: f32 = 0.25;
/// Mean sine of the bend between neighbours above which a piece is convex, or below its negative concave. Less is what
/// noise bends a plane by.
const MIN_DIVERGENCE: f32 = 0.02;

// Budget.

/// Neighbours to which orientation is propagated from a point.
const NEIGHBOURS: usize = 16;
/// Points that vote on the side of a cloud.
const VOTERS: usize = 512;
/// Nearest points with which a voter's normal is compared, itself included: a ring around it, not only its row in a
/// regular grid.
const COMPARED: usize = 9;

/// Bytes of working memory for [`orient`] on a cloud of `points`.
pub(crate) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<u32>(points).saturating_mul(7).saturating_add(array_bytes::<Votes>(points))
}

/// The state of normals that a caller gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Given {
    /// They agree with each other and do not point into the solid.
    Outwards,
    /// They agree with each other and point into the solid.
    Inwards,
    /// Their signs do not agree with each other.
    Unoriented,
}

/// Judges given normals, all known and in tree order.
pub(crate) fn judge(tree: &PointTree, normals: &[Vector], meter: &Meter) -> Result<Given, Stop> {
    let (mut agree, mut compared) = (0.0, 0.0);
    let (mut pairs, mut inward) = (0.0, 0.0);
    for index in voters(normals.len()) {
        meter.check_cancelled()?;
        let point = &tree.points()[index];
        let mut found = [Neighbour::default(); COMPARED];
        for neighbour in tree.k_nearest(point, &mut found).iter().filter(|n| n.distance_squared > 0.0) {
            let other = neighbour.index as usize;
            let agreement = transported(tree, normals, index, other).dot(&normals[other]);
            compared += agreement.abs();
            agree += agreement.max(0.0);
        }
        if let Some(side) = opposing_side(tree, normals, index, |_| false) {
            pairs += 1.0;
            inward += f32::from(u8::from(side > 0.0));
        }
    }
    Ok(if agree < MIN_AGREEMENT * compared {
        Given::Unoriented
    } else if pairs >= MIN_VOTES && inward >= MIN_INWARD * pairs {
        Given::Inwards
    } else {
        Given::Outwards
    })
}

/// Gives normals of arbitrary sign, in tree order, the side that is outside.
///
/// Signs are propagated from neighbour to neighbour across the least bends first (Hoppe et al. 1992, "Surface
/// Reconstruction from Unorganized Points"), along circular arcs (König and Gumhold 2009, "Consistent Propagation of
/// Normal Orientations in Point Clouds"). Sharp bends cut the cloud into pieces, because the side beyond one, as where
/// a bar meets a plate, is not certain. Each piece then takes the side that the `viewpoints` saw or, if there are none, the
/// one that its opposing points say, or else its curvature, because what things hang on is mostly convex. A piece for which neither decides keeps its side against
/// the piece that it was reached from, and the first of all faces `up` at its top.
pub(crate) fn orient(
    tree: &PointTree,
    normals: &mut [Vector],
    spacings: &[f32],
    (viewpoints, up): (Viewpoints, Vector),
    mut scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    let points = tree.points();
    debug_assert!(normals.len() == points.len() && spacings.len() == points.len());
    let from_top = scratch.slice::<u32>(points.len())?;
    let parents = scratch.slice::<u32>(points.len())?;
    // For each point the piece that it is in, which is a place in the next two.
    let piece_of = scratch.slice::<u32>(points.len())?;
    let reached_from = scratch.slice::<u32>(points.len())?;
    let votes = scratch.slice::<Votes>(points.len())?;
    let mut pieces = 0;
    let weights = scratch.slice::<f32>(points.len())?;
    let (order, places) = (scratch.slice::<u32>(points.len())?, scratch.slice::<u32>(points.len())?);
    for (slot, index) in from_top.iter_mut().zip(0..) {
        *slot = index;
    }
    let height = |&index: &u32| points[index as usize].coords.dot(&up);
    // Equal ones keep their order, so that the first comes first.
    sort(from_top, order, meter, |a, b| height(b).total_cmp(&height(a)).is_lt())?;
    const WAITING: u32 = u32::MAX;
    const DONE: u32 = u32::MAX - 1;
    parents.fill(WAITING);
    let mut heap = Heap::empty(weights, order, places);
    for &top in from_top.iter() {
        if parents[top as usize] == DONE {
            continue;
        }
        heap.offer(top as usize, 0.0);
        while let Some(index) = heap.pop() {
            meter.check_cancelled()?;
            let parent = parents[index];
            let like = match parent {
                WAITING => up,
                parent => transported(tree, normals, parent as usize, index),
            };
            if normals[index].dot(&like) < 0.0 {
                normals[index] = -normals[index];
            }
            parents[index] = DONE;
            let is_smooth = parent != WAITING && normals[index].dot(&normals[parent as usize]) > SMOOTH;
            piece_of[index] = if is_smooth { piece_of[parent as usize] } else { pieces };
            if !is_smooth {
                reached_from[pieces as usize] =
                    if parent == WAITING { NONE } else { piece_of[parent as usize] };
                pieces += 1;
            }
            let mut found = [Neighbour::default(); NEIGHBOURS];
            for neighbour in tree.k_nearest(&points[index], &mut found) {
                let other = neighbour.index as usize;
                let agreement = transported(tree, normals, index, other).dot(&normals[other]).abs();
                if parents[other] != DONE && heap.offer(other, agreement) {
                    parents[other] = index as u32;
                }
            }
        }
    }
    for index in voters(points.len()) {
        meter.check_cancelled()?;
        let votes = &mut votes[piece_of[index] as usize];
        let is_free = |other: usize| piece_of[other] != piece_of[index];
        let at = (&points[index], &normals[index]);
        let view = visibility::best_view(tree, at, spacings[index], viewpoints);
        votes.views += view.map_or(0.0, |(_, cosine)| cosine.signum());
        votes.pairs -= opposing_side(tree, normals, index, is_free).unwrap_or(0.0);
        votes.divergence += divergence(tree, normals, index);
        votes.voters += 1.0;
    }
    // A piece comes after the one that it was reached from.
    for piece in 0..pieces as usize {
        let inherited = match reached_from[piece] {
            NONE => 1.0,
            from => votes[from as usize].sign,
        };
        votes[piece].sign = votes[piece].decide().unwrap_or(inherited);
    }
    for (normal, &piece) in normals.iter_mut().zip(piece_of.iter()) {
        *normal *= votes[piece as usize].sign;
    }
    Ok(())
}

/// No piece.
const NONE: u32 = u32::MAX;

/// What the points of a piece say about its side.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Votes {
    /// Points seen from in front of the normals, less those seen from behind them.
    views: f32,
    /// Opposing points behind the normals, less those in front of them.
    pairs: f32,
    /// Sum of the divergences of the normals.
    divergence: f32,
    /// Points that voted.
    voters: f32,
    /// -1 if the normals are to be reversed, else 1.
    sign: f32,
}

impl Votes {
    /// The sign, if the votes are clear.
    fn decide(&self) -> Option<f32> {
        if self.views.abs() > MIN_SHARE * self.voters {
            Some(self.views.signum())
        } else if self.pairs.abs() >= MIN_VOTES.max(MIN_SHARE * self.voters) {
            Some(self.pairs.signum())
        } else if self.voters >= MIN_VOTES && self.divergence.abs() > MIN_DIVERGENCE * self.voters {
            Some(self.divergence.signum())
        } else {
            None
        }
    }
}

/// Indices of up to [`VOTERS`] points, spread over the cloud.
pub(super) fn voters(points: usize) -> impl Iterator<Item = usize> {
    let count = points.min(VOTERS);
    (0..count).map(move |voter| voter * points / count)
}

/// The normal of one point carried along a circular arc to another: reflected at the plane half-way between them.
fn transported(tree: &PointTree, normals: &[Vector], from: usize, to: usize) -> Vector {
    let (normal, way) = (normals[from], tree.points()[to] - tree.points()[from]);
    let length_squared = way.norm_squared();
    if length_squared > 0.0 { normal - way * (2.0 * normal.dot(&way) / length_squared) } else { normal }
}

/// On which side of a point's normal the nearest point of an opposite surface lies: -1 behind it, as through a solid, 1
/// in front of it, `None` if there is none. Opposite normals point in opposite directions; where `is_free` says that
/// the sign of the other normal means nothing yet, along one line.
fn opposing_side(
    tree: &PointTree,
    normals: &[Vector],
    index: usize,
    is_free: impl Fn(usize) -> bool,
) -> Option<f32> {
    let (point, normal) = (tree.points()[index], normals[index]);
    let mut side = None;
    tree.bvh().visit_near(&point, MAX_THICKNESS * MAX_THICKNESS, |items, mut limit| {
        for other in items {
            let cosine = normals[other].dot(&normal);
            if !(cosine < -OPPOSING || cosine > OPPOSING && is_free(other)) {
                continue;
            }
            let way = tree.points()[other] - point;
            let (distance_squared, along) = (way.norm_squared(), way.dot(&normal));
            let is_across = along * along > OPPOSING * OPPOSING * distance_squared;
            if is_across && distance_squared < limit {
                (limit, side) = (distance_squared, Some(along.signum()));
            }
        }
        limit
    });
    side
}

/// How much the normals around a point diverge, on average the sine of their bend; positive where the surface is
/// convex.
fn divergence(tree: &PointTree, normals: &[Vector], index: usize) -> f32 {
    let point: Point = tree.points()[index];
    let mut found = [Neighbour::default(); NEIGHBOURS];
    let (mut count, mut sum) = (0.0_f32, 0.0);
    for neighbour in tree.k_nearest(&point, &mut found) {
        let other = neighbour.index as usize;
        if neighbour.distance_squared > 0.0 && normals[other].dot(&normals[index]) > SMOOTH {
            let way = tree.points()[other] - point;
            sum += (normals[other] - normals[index]).dot(&way) / way.norm();
            count += 1.0;
        }
    }
    sum / count.max(1.0)
}
