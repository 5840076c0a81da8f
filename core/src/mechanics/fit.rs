//! The fit of a patch to the points around a representative.

use super::constants::{
    BOTH_SIDES_WEIGHT, CURVATURE_REGULARISATION, END_MARGIN, END_SEARCH_RANGE, MAX_FIT_POINTS,
    MAX_PATCH_SINE, MIN_PATCH_EXTENT, MIN_WIRE_POINTS, PATCH_HALF_EXTENT, POWER_ITERATIONS,
    REPRESENTATIVE_SPACING, SAME_BAR_COSINE, SAME_SURFACE_COSINE, STRAIGHT_TURN, WIRE_END_RATIO,
    WIRE_VARIANCE_RATIO,
};
use super::patch::Patch;
use crate::geometry::{Neighbour, PointTree, Vector, any_perpendicular, unit_or};
use heapless::Vec;
use nalgebra::{Matrix2, Matrix3, Vector2};

/// The points around a representative, to which its patch is fitted.
pub(super) struct Surroundings {
    /// Normal of the representative.
    normal: Vector,
    /// Those near enough to determine the curvatures.
    near: Vec<SurroundingPoint, MAX_FIT_POINTS>,
    /// The others.
    far: Vec<SurroundingPoint, MAX_FIT_POINTS>,
    /// Distance between points, metres.
    spacing: f32,
}

/// A point near a representative.
#[derive(Clone, Copy)]
struct SurroundingPoint {
    /// Position relative to the representative, metres.
    offset: Vector,
    normal: Vector,
    /// How many points were found before it.
    place: usize,
}

impl Surroundings {
    /// No points yet.
    pub(super) fn new() -> Self {
        Self { normal: Vector::zeros(), near: Vec::new(), far: Vec::new(), spacing: 0.0 }
    }

    /// Collects the points around the representative with this index in the tree, as far as a fit with this `spacing`, the
    /// distance between points in metres, needs them; of too many, a subset spread over all. Calls `visit` with all of them,
    /// and with others that are within [`REPRESENTATIVE_SPACING`].
    pub(super) fn collect(
        &mut self,
        tree: &PointTree,
        normals: &[Vector],
        index: usize,
        spacing: f32,
        mut visit: impl FnMut(Neighbour),
    ) {
        (self.normal, self.spacing) = (normals[index], spacing);
        let (centre, mut stride) = (tree.points()[index], 1);
        let (radius, reach) = (self.radius(), self.half_extent() + END_SEARCH_RANGE * spacing);
        let Self { near, far, .. } = self;
        near.clear();
        far.clear();
        let mut place = 0_usize;
        tree.for_each_within(&centre, reach.max(REPRESENTATIVE_SPACING), |neighbour| {
            visit(neighbour);
            if neighbour.distance_squared > reach * reach {
                return;
            }
            if near.len() + far.len() == MAX_FIT_POINTS {
                // Halve the density of the subset.
                stride *= 2;
                near.retain(|point| point.place.is_multiple_of(stride));
                far.retain(|point| point.place.is_multiple_of(stride));
            }
            if place.is_multiple_of(stride) {
                let other = neighbour.index as usize;
                let is_near = neighbour.distance_squared <= radius * radius;
                let (offset, normal) = (tree.points()[other] - centre, normals[other]);
                let _ = if is_near { &mut *near } else { &mut *far }.push(SurroundingPoint {
                    offset,
                    normal,
                    place,
                });
            }
            place += 1;
        });
    }

    /// Largest half extent of the patch, metres, by the least distance between representatives.
    fn half_extent(&self) -> f32 {
        PATCH_HALF_EXTENT * self.spacing.max(REPRESENTATIVE_SPACING)
    }

    /// Distance of the points that determine the curvatures, metres.
    fn radius(&self) -> f32 {
        self.half_extent() + self.spacing
    }

    /// Fits the patch.
    pub(super) fn fit_patch(&self) -> Patch {
        let half = self.half_extent();
        self.fit_wire(half).unwrap_or_else(|| self.fit_surface(half))
    }

    /// The near points whose normals differ little enough for them to be on the same side of a bar.
    fn on_bar(&self) -> impl Iterator<Item = &SurroundingPoint> {
        self.near.iter().filter(|point| point.normal.dot(&self.normal) > SAME_BAR_COSINE)
    }

    /// Fits a patch of a surface with half extents of at most `half` metres.
    fn fit_surface(&self, half: f32) -> Patch {
        let (along, curvatures) = self.principal_curvatures();
        let mut patch = Patch { normal: self.normal, along, ..Patch::default() };
        let sides = self.side_curvatures(&patch, curvatures);
        let is_straight = |k: usize| sides[2 * k..][..2].iter().all(|side| side.abs() * half < STRAIGHT_TURN);
        patch.straight = match (is_straight(0), is_straight(1)) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        patch.curvatures = sides;
        patch.curvatures[..2 * patch.straight as usize].fill(0.0);
        let [near, far] = self.observed_extents(&patch);
        for k in 0..2 {
            let sharpest = patch.curvatures[2 * k].abs().max(patch.curvatures[2 * k + 1].abs());
            let max_extent = MAX_PATCH_SINE / sharpest.max(1.0);
            let extent = near[2 * k].min(near[2 * k + 1]).min(half).min(max_extent).max(MIN_PATCH_EXTENT);
            patch.extents[k] = extent;
            for side in [2 * k, 2 * k + 1] {
                // A patch that is cut off because it becomes steep does not end: the surface goes on below.
                let is_end = far[side] < extent + END_MARGIN * self.spacing && extent < max_extent;
                patch.ends |= u32::from(is_end) << side;
            }
        }
        patch
    }

    /// Fits the patch of a wire thinner than the spacing of the points. Such a wire has too few points on
    /// each side for a fit of its curvature to the normals, but all points lie along it. Returns `None` if
    /// the near ones do not.
    fn fit_wire(&self, half: f32) -> Option<Patch> {
        let offsets = || self.near.iter().map(|point| point.offset);
        let (mut count, mut sum, mut squares) = (0.0_f32, Vector::zeros(), Matrix3::zeros());
        for offset in offsets() {
            count += 1.0;
            sum += offset;
            squares += offset * offset.transpose();
        }
        let mean = sum / count;
        let spread = squares / count - mean * mean.transpose();
        // The Frobenius norm bounds the greatest eigenvalue: this rejects most points without an iteration.
        // The factor 0.999 allows for rounding.
        if count < MIN_WIRE_POINTS || (1.0 + WIRE_VARIANCE_RATIO) * spread.norm() < 0.999 * spread.trace() {
            return None;
        }
        // Direction of the greatest variance by power iteration, starting at the farthest point. A wire's
        // greatest eigenvalue dominates, so a few iterations suffice.
        let farthest = |a: Vector, b: Vector| if b.norm_squared() > a.norm_squared() { b } else { a };
        let mut along = offsets().fold(Vector::zeros(), farthest);
        for _ in 0..POWER_ITERATIONS {
            along = unit_or(spread * along, along);
        }
        let length = along.dot(&(spread * along));
        // Points on all sides of a cylinder are at its radius from the axis, so their variance across it is
        // the square of the radius.
        let thickness = spread.trace() - length;
        if thickness > WIRE_VARIANCE_RATIO * length {
            return None;
        }
        let along = unit_or(along - self.normal * along.dot(&self.normal), any_perpendicular(self.normal));
        let mut observed = [0.0_f32; 2];
        for offset in offsets() {
            let reach = offset.dot(&along);
            observed = [observed[0].max(reach), observed[1].max(-reach)];
        }
        let wire_radius = libm::sqrtf(thickness).max(MIN_PATCH_EXTENT);
        let extent = observed[0].min(observed[1]).min(half).max(MIN_PATCH_EXTENT);
        let ends = observed.map(|reach| u32::from(reach < WIRE_END_RATIO * extent));
        Some(Patch {
            normal: self.normal,
            along,
            extents: [extent, wire_radius],
            straight: 1,
            curvatures: [0.0, 0.0, 1.0 / wire_radius, 1.0 / wire_radius],
            ends: ends[0] | ends[1] << 1 | Patch::WIRE,
        })
    }

    /// Observed extent of the surface towards each side, metres: by the near points, and by all points. A patch that reached
    /// over the rim of a bar's end would hold a body that slides off there.
    fn observed_extents(&self, patch: &Patch) -> [[f32; 4]; 2] {
        let across = patch.across();
        let [mut near, mut far] = [[0.0_f32; 4]; 2];
        let points = self.near.iter().zip(core::iter::repeat(true));
        for (point, is_near) in points.chain(self.far.iter().zip(core::iter::repeat(false))) {
            let (x, y) = (point.offset.dot(&patch.along), point.offset.dot(&across));
            let [u, v, w] = patch.normal_at([x, y]);
            if point.normal.dot(&(patch.along * u + across * v + patch.normal * w)) < SAME_SURFACE_COSINE {
                continue;
            }
            let distance = libm::sqrtf(x * x + y * y);
            let ahead = core::f32::consts::FRAC_1_SQRT_2 * distance;
            for (side, reach) in [x, -x, y, -y].into_iter().enumerate() {
                // A bar is as wide everywhere along it and as long everywhere across it; other surfaces count
                // within 45 degrees of a side.
                let extent = match patch.straight {
                    1 => reach,
                    _ if reach > ahead => distance,
                    _ => continue,
                };
                far[side] = far[side].max(extent);
                if is_near {
                    near[side] = near[side].max(extent);
                }
            }
        }
        [near, far]
    }

    /// Curvature towards each side, 1/m. At the seam between a bar and its round end the surface is curved on
    /// one side only. `both` are the curvatures of the fit to both sides together.
    fn side_curvatures(&self, patch: &Patch, both: [f32; 2]) -> [f32; 4] {
        let axes = [patch.along, patch.across()];
        let weight = BOTH_SIDES_WEIGHT * self.radius() * self.radius();
        let mut squares = [weight; 4];
        let mut turns = [both[0] * weight, both[0] * weight, both[1] * weight, both[1] * weight];
        for point in self.on_bar() {
            for (k, axis) in axes.iter().enumerate() {
                let reach = point.offset.dot(axis);
                let side = 2 * k + usize::from(reach < 0.0);
                squares[side] += reach * reach;
                turns[side] += reach * point.normal.dot(axis);
            }
        }
        core::array::from_fn(|side| turns[side] / squares[side])
    }

    /// Principal direction of least curvature, and the principal curvatures in and across it, 1/m: from a
    /// least-squares fit of the second fundamental form to the normals of the near points.
    fn principal_curvatures(&self) -> (Vector, [f32; 2]) {
        let ahead = any_perpendicular(self.normal);
        let aside = self.normal.cross(&ahead);
        let flat = |v: &Vector| Vector2::new(v.dot(&ahead), v.dot(&aside));
        let (mut count, mut offset_sum, mut change_sum) = (0.0_f32, Vector2::zeros(), Vector2::zeros());
        let (mut offsets, mut changes) = (Matrix2::zeros(), Matrix2::zeros());
        for point in self.on_bar() {
            let (offset, change) = (flat(&point.offset), flat(&point.normal));
            count += 1.0;
            offset_sum += offset;
            change_sum += change;
            offsets += offset * offset.transpose();
            changes += change * offset.transpose();
        }
        offsets -= offset_sum * offset_sum.transpose() / count;
        changes -= change_sum * offset_sum.transpose() / count;
        let regularisation = CURVATURE_REGULARISATION * offsets.trace();
        let Some(inverse) = (offsets + Matrix2::identity() * regularisation).try_inverse() else {
            return (ahead, [0.0; 2]);
        };
        let form: Matrix2<f32> = changes * inverse;
        // The rotation that diagonalises the symmetric part.
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
