//! Fits a patch to the points around one of the supporter's.

use super::patch::Patch;
use crate::geometry::{PointTree, Vector, any_perpendicular, unit_or};
use heapless::Vec;
use nalgebra::{Matrix2, Matrix3, Vector2};

/// How far a patch goes at most to either side, over the distance of the points that have one. Smaller ones leave gaps between the points,
/// over which things slide as over a rasp. Larger ones thicken what is round.
const HALF_EXTENT: f32 = 0.8;

/// The least cosine between normals of points on one side of what is round; and of those that tell that a bar goes on, and how it is bent.
const SAME_SIDE: f32 = 0.75;
const SAME_BAR: f32 = 0.3;

/// A patch is straight in a direction in which its normals turn by less than this, radians, over half its extent.
const STRAIGHT: f32 = 0.15;
/// How much the bending on both sides together says about that on each: by so much of the square of the distance it was looked at.
const SIDE_WEIGHT: f32 = 0.1;
/// A patch ends where the surface has turned by as much as has this sine.
const STEEPEST: f32 = 0.9;
/// Whether the surface goes on beyond a patch is looked for so many times as far as points are apart: closer by, there may be none by chance.
const FAR: f32 = 2.5;
/// The surface ends where it is not seen to go on beyond the patch by this part of the distance of the points.
const BEYOND: f32 = 0.5;

/// Points lie along a wire if the variance of their places across it, in both directions together, is below this share of that along it,
const WIRE: f32 = 0.15;
/// and if they are so many.
const LEAST_WIRE: f32 = 4.0;

/// So many points around are looked at, at most: of more, some that are spread over all.
const MOST: usize = 128;

/// What is seen around a point.
struct Surroundings {
    normal: Vector,
    points: Vec<Seen, MOST>,
}

/// A point, from the one in the middle.
#[derive(Clone, Copy)]
struct Seen {
    offset: Vector,
    normal: Vector,
    distance_squared: f32,
}

/// The patch around a point, in tree order. Points are `spacing` metres from each other, those that have patches at least `apart`.
pub(super) fn fit_patch(
    tree: &PointTree,
    normals: &[Vector],
    index: usize,
    apart: f32,
    spacing: f32,
) -> Patch {
    let half = HALF_EXTENT * apart;
    let (radius, far) = (half + spacing, half + FAR * spacing);
    let around = Surroundings::new(tree, normals, index, far);
    around.wire(half, radius).unwrap_or_else(|| around.patch(half, spacing, radius))
}

impl Surroundings {
    fn new(tree: &PointTree, normals: &[Vector], index: usize, radius: f32) -> Self {
        let (place, mut points, mut stride) = (tree.points()[index], Vec::<Seen, MOST>::new(), 1);
        let mut count = 0_usize;
        tree.for_each_within(&place, radius, |neighbour| {
            let other = neighbour.index as usize;
            if points.is_full() {
                // Every other one makes room.
                let mut kept = 0;
                points.retain(|_| {
                    kept += 1;
                    kept % 2 == 1
                });
                stride *= 2;
            }
            if count.is_multiple_of(stride) {
                let (offset, normal) = (tree.points()[other] - place, normals[other]);
                let _ = points.push(Seen { offset, normal, distance_squared: neighbour.distance_squared });
            }
            count += 1;
        });
        Self { normal: normals[index], points }
    }

    /// Those within `radius`.
    fn within(&self, radius: f32) -> impl Iterator<Item = &Seen> {
        self.points.iter().filter(move |seen| seen.distance_squared <= radius * radius)
    }

    /// Those within `radius` on the same bar.
    fn on_bar(&self, radius: f32) -> impl Iterator<Item = &Seen> {
        self.within(radius).filter(|seen| seen.normal.dot(&self.normal) > SAME_BAR)
    }

    /// The patch of a surface, at most `half` to either side; how it is bent is looked at within `radius`.
    fn patch(&self, half: f32, spacing: f32, radius: f32) -> Patch {
        let (along, curvatures) = self.bending(radius);
        let mut patch = Patch { normal: self.normal, along, ..Patch::default() };
        let sides = self.side_curvatures(&patch, radius, curvatures);
        let is_straight = |k: usize| sides[2 * k..][..2].iter().all(|side| side.abs() * half < STRAIGHT);
        patch.straight = match (is_straight(0), is_straight(1)) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        patch.curvatures = sides;
        patch.curvatures[..2 * patch.straight as usize].fill(0.0);
        let [near, far] = self.seen_extents(&patch, radius);
        for k in 0..2 {
            let sharpest = patch.curvatures[2 * k].abs().max(patch.curvatures[2 * k + 1].abs());
            let steepest = STEEPEST / sharpest.max(1.0);
            let extent = near[2 * k].min(near[2 * k + 1]).min(half).min(steepest).max(Patch::LEAST_EXTENT);
            patch.extents[k] = extent;
            for side in [2 * k, 2 * k + 1] {
                // What is cut off because it gets steep goes on below.
                let is_end = far[side] < extent + BEYOND * spacing && extent < steepest;
                patch.ends |= u32::from(is_end) << side;
            }
        }
        patch
    }

    /// The patch of a wire that is thinner than the points are apart: there are too few on each side of it to tell by their normals how it
    /// is bent, but all together lie along it. `None` if within `radius` they do not.
    fn wire(&self, half: f32, radius: f32) -> Option<Patch> {
        let offsets = || self.within(radius).map(|seen| seen.offset);
        let (mut count, mut sum, mut squares) = (0.0_f32, Vector::zeros(), Matrix3::zeros());
        for offset in offsets() {
            count += 1.0;
            sum += offset;
            squares += offset * offset.transpose();
        }
        let mean = sum / count;
        let spread = squares / count - mean * mean.transpose();
        // The Frobenius norm bounds the greatest eigenvalue, so that most points are seen at once to lie on no wire. The spare is for
        // rounding.
        if count < LEAST_WIRE || (1.0 + WIRE) * spread.norm() < 0.999 * spread.trace() {
            return None;
        }
        // The direction of greatest spread, by power iteration from the farthest offset's: a wire's is so much the greatest that few do.
        let farthest = |a: Vector, b: Vector| if b.norm_squared() > a.norm_squared() { b } else { a };
        let mut along = offsets().fold(Vector::zeros(), farthest);
        for _ in 0..4 {
            along = unit_or(spread * along, along);
        }
        let length = along.dot(&(spread * along));
        // Points on all sides of a cylinder are at its radius from the axis.
        let thickness = spread.trace() - length;
        if thickness > WIRE * length {
            return None;
        }
        let along = unit_or(along - self.normal * along.dot(&self.normal), any_perpendicular(self.normal));
        let mut seen = [0.0_f32; 2];
        for offset in offsets() {
            let reach = offset.dot(&along);
            seen = [seen[0].max(reach), seen[1].max(-reach)];
        }
        let wire_radius = libm::sqrtf(thickness).max(Patch::LEAST_EXTENT);
        let extent = seen[0].min(seen[1]).min(half).max(Patch::LEAST_EXTENT);
        let ends = seen.map(|seen| u32::from(seen < 1.5 * extent));
        Some(Patch {
            normal: self.normal,
            along,
            extents: [extent, wire_radius],
            straight: 1,
            curvatures: [0.0, 0.0, 1.0 / wire_radius, 1.0 / wire_radius],
            ends: ends[0] | ends[1] << 1 | Patch::ALL_AROUND,
        })
    }

    /// How far the surface of a patch is seen to go on to each side, metres, within about `radius`, and as far as can be seen: a patch that
    /// reached over the rim of a bar's end would hold what slides off there.
    fn seen_extents(&self, patch: &Patch, radius: f32) -> [[f32; 4]; 2] {
        let across = patch.across();
        let [mut near, mut far] = [[0.0_f32; 4]; 2];
        for seen in &self.points {
            let (x, y) = (seen.offset.dot(&patch.along), seen.offset.dot(&across));
            if seen.normal.dot(&patch.turned_normal([x, y])) < SAME_SIDE {
                continue;
            }
            let is_near = seen.distance_squared <= radius * radius;
            let distance = libm::sqrtf(x * x + y * y);
            let ahead = core::f32::consts::FRAC_1_SQRT_2 * distance;
            for (side, reach) in [x, -x, y, -y].into_iter().enumerate() {
                // All along a bar it is as wide, and all across as long.
                let seen = match patch.straight {
                    1 => reach,
                    _ if reach > ahead => distance,
                    _ => continue,
                };
                far[side] = far[side].max(seen);
                if is_near {
                    near[side] = near[side].max(seen);
                }
            }
        }
        [near, far]
    }

    /// How much the normals turn to each side, 1/m: where a bar has a round end they turn on one only.
    fn side_curvatures(&self, patch: &Patch, radius: f32, both: [f32; 2]) -> [f32; 4] {
        let axes = [patch.along, patch.across()];
        let weight = SIDE_WEIGHT * radius * radius;
        let mut squares = [weight; 4];
        let mut turns = [both[0] * weight, both[0] * weight, both[1] * weight, both[1] * weight];
        for seen in self.on_bar(radius) {
            for (k, axis) in axes.iter().enumerate() {
                let reach = seen.offset.dot(axis);
                let side = 2 * k + usize::from(reach < 0.0);
                squares[side] += reach * reach;
                turns[side] += reach * seen.normal.dot(axis);
            }
        }
        core::array::from_fn(|side| turns[side] / squares[side])
    }

    /// The direction square to the normal in which the normals around change least, and by how much they change there and across, 1/m: a
    /// least-squares fit of the surface's second fundamental form, and its principal directions.
    fn bending(&self, radius: f32) -> (Vector, [f32; 2]) {
        /// For where points lie in a line: across it, nothing is known.
        const STIFFNESS: f32 = 0.01;
        let ahead = any_perpendicular(self.normal);
        let aside = self.normal.cross(&ahead);
        let flat = |v: &Vector| Vector2::new(v.dot(&ahead), v.dot(&aside));
        let (mut count, mut offset_sum, mut change_sum) = (0.0_f32, Vector2::zeros(), Vector2::zeros());
        let (mut offsets, mut changes) = (Matrix2::zeros(), Matrix2::zeros());
        for seen in self.on_bar(radius) {
            let (offset, change) = (flat(&seen.offset), flat(&seen.normal));
            count += 1.0;
            offset_sum += offset;
            change_sum += change;
            offsets += offset * offset.transpose();
            changes += change * offset.transpose();
        }
        offsets -= offset_sum * offset_sum.transpose() / count;
        changes -= change_sum * offset_sum.transpose() / count;
        let stiffness = STIFFNESS * offsets.trace();
        let Some(inverse) = (offsets + Matrix2::identity() * stiffness).try_inverse() else {
            return (ahead, [0.0; 2]);
        };
        let form: Matrix2<f32> = changes * inverse;
        // The rotation that makes its symmetric part diagonal.
        let (mean, half) = (0.5 * form.trace(), 0.5 * (form.m11 - form.m22));
        let off = 0.5 * (form.m12 + form.m21);
        let root = libm::sqrtf(half * half + off * off);
        let (sin, cos) = libm::sincosf(0.5 * libm::atan2f(off, half));
        if (mean + root).abs() < (mean - root).abs() {
            (ahead * cos + aside * sin, [mean + root, mean - root])
        } else {
            (aside * cos - ahead * sin, [mean - root, mean + root])
        }
    }
}
