//! The nearest point of a patch to the body.

use super::Body;
use super::constants::{
    CERTAIN_DEPTH, FACING_COSINE, FLAT_SLOPE, MAX_PARTS, MAX_STRIDE_GROWTH, MIN_PART_ASPECT, MIN_PART_LENGTH,
    MIN_REFINEMENT_CURVATURE, PART_STACK, REFINEMENT_STEPS, REFINEMENT_TOLERANCE, REVISIT_RATIO,
    SAME_SIDE_COSINE, SECANT_STEPS, STRIDE_REDUCTION, SURFACE_QUERY_OFFSET,
};
use super::patch::Patch;
use crate::geometry::{Point, Vector, unit_or};
use heapless::Vec;
use nalgebra::Rotation3;

/// The point of a patch that is nearest to the body, or deepest inside it, in object coordinates.
pub(super) struct Nearest {
    /// Position, metres.
    pub(super) at: Point,
    /// Offset of the point along and across the patch, metres.
    pub(super) offset: [f32; 2],
    /// Signed distance from the body's surface, metres, negative inside.
    pub(super) gap: f32,
    /// Gradient of the signed distance: of unit length, or zero where it is undefined.
    pub(super) gradient: Vector,
}

/// A patch in object coordinates.
struct View<'a> {
    body: &'a Body<'a>,
    patch: &'a Patch,
    /// Centre of the patch, metres.
    at: Point,
    along: Vector,
    across: Vector,
    normal: Vector,
}

/// Finds the nearest point of a patch with the distance field. `at` is the centre of the patch in object
/// coordinates; `rotation` rotates object to supporter coordinates. `margin` gives the gap, metres, up to which a point counts, for
/// the gradient of the gap in supporter coordinates, or zero where it is not known.
///
/// # Errors
///
/// If no part of the patch is closer than the margin by the field: the distance that the body must
/// travel before one may be, metres.
pub(super) fn nearest_on_patch(
    body: &Body,
    patch: &Patch,
    rotation: &Rotation3<f32>,
    at: &Point,
    margin: impl Fn(&Vector) -> f32,
) -> Result<Nearest, f32> {
    nearest_from_sample(body.field.sample_near(at), (body, patch), rotation, at, margin)
}

/// The same with the `sample` of the body's field at the centre of the patch.
pub(super) fn nearest_from_sample(
    sample: Result<(f32, Vector), f32>,
    (body, patch): (&Body, &Patch),
    rotation: &Rotation3<f32>,
    at: &Point,
    margin: impl Fn(&Vector) -> f32,
) -> Result<Nearest, f32> {
    let reach = patch.reach();
    if let Err(bound) = sample {
        let margin = margin(&Vector::zeros());
        if bound > reach + margin {
            return Err(bound - reach - margin);
        }
        if !patch.is_wire() && patch.extents[0] <= min_part(patch) {
            return Err(body.field.way_to_bricks(at));
        }
    }
    if patch.is_wire() {
        return View::new(body, patch, rotation, at).nearest_part(margin(&Vector::zeros()));
    }
    let start = match sample {
        Ok((gap, gradient)) => Nearest { at: *at, offset: [0.0; 2], gap, gradient },
        // The field is exact only close to the body, and a long patch may be close to the body far from its
        // centre.
        Err(_) => View::new(body, patch, rotation, at).nearest_part(margin(&Vector::zeros()))?,
    };
    let outwards = rotation * start.gradient;
    let (margin, least) = (margin(&outwards), start.gap - patch.fall(&outwards, start.offset));
    if least > margin {
        // The excess over the margin is an estimate, so the patch is visited again when most of it is used up.
        return Err((start.gap - reach - margin).max(REVISIT_RATIO * (least - margin)));
    }
    Ok(View::new(body, patch, rotation, at).minimise_gap(start))
}

/// Refines a point that was found with the distance field by queries of the mesh. In thin walls and at edges
/// the field may be wrong by half a voxel, and its gradient by ten degrees, which is the difference between
/// sticking and sliding. `at` is the centre of the patch, as for [`nearest_on_patch`].
pub(super) fn refine(
    body: &Body,
    patch: &Patch,
    rotation: &Rotation3<f32>,
    at: &Point,
    found: Nearest,
) -> Nearest {
    // The field is queried on the axis of a wire, where its error is smaller.
    if found.gap < -CERTAIN_DEPTH * body.field.voxel_size() || patch.is_wire() {
        return found;
    }
    let view = View::new(body, patch, rotation, at);
    let Some(mut nearest) = view.sample_mesh(&found, found.offset, body.field.voxel_size()) else {
        return found;
    };
    for _ in 0..REFINEMENT_STEPS {
        let [x, y] = nearest.offset;
        let (slope, curvatures) = (view.slope(&nearest), patch.curvatures_towards([x, y]));
        let [a, b] = curvatures.map(|curvature| 1.0 / curvature.max(MIN_REFINEMENT_CURVATURE));
        let offset = patch.clamp([x - slope[0] * a, y - slope[1] * b]);
        let step = (offset[0] - x).abs() + (offset[1] - y).abs();
        if step < REFINEMENT_TOLERANCE {
            break;
        }
        match view.sample_mesh(&nearest, offset, step + SURFACE_QUERY_OFFSET) {
            Some(next) if next.gap < nearest.gap => nearest = next,
            _ => break,
        }
    }
    nearest
}

/// Half length below which a part of a patch is not cut further, metres.
fn min_part(patch: &Patch) -> f32 {
    let [length, width] = patch.extents;
    MIN_PART_LENGTH.max(MIN_PART_ASPECT * width).max(length / MAX_PARTS)
}

/// A part of a patch, over its whole width.
#[derive(Clone, Copy)]
struct Part {
    /// Offset of its centre along the patch, metres.
    offset: f32,
    /// Half its length, metres.
    half: f32,
}

impl<'a> View<'a> {
    fn new(body: &'a Body<'a>, patch: &'a Patch, rotation: &Rotation3<f32>, at: &Point) -> Self {
        let [along, across, normal] = patch.axes().map(|axis| rotation.inverse_transform_vector(&axis));
        Self { body, patch, at: *at, along, across, normal }
    }

    /// Point of the patch at an offset; of a wire, the point on its axis.
    fn point_at(&self, offset: [f32; 2]) -> Point {
        self.at + self.along * offset[0] + self.across * offset[1] - self.normal * self.patch.depth(offset)
    }

    /// Queries the field at an offset.
    fn sample_field(&self, offset: [f32; 2]) -> Nearest {
        let at = self.point_at(offset);
        let (gap, gradient) = self.body.field.sample(&at);
        Nearest { at, offset, gap, gradient }
    }

    /// Queries the mesh at an offset close to the known point `near`. Returns `None` if the gap exceeds that
    /// of `near` by more than `tolerance` metres, or if the mesh is on another side than expected.
    fn sample_mesh(&self, near: &Nearest, offset: [f32; 2], tolerance: f32) -> Option<Nearest> {
        let at = self.point_at(offset);
        let [x, y, z] = self.patch.normal_at(offset);
        let own = self.along * x + self.across * y + self.normal * z;
        let out = if own.dot(&near.gradient) < -FACING_COSINE { -own } else { near.gradient };
        let from = at + out * SURFACE_QUERY_OFFSET;
        let radius = near.gap.max(0.0) + SURFACE_QUERY_OFFSET + tolerance;
        let closest = self.body.surface.closest_point_within(&from, radius)?;
        let (distance, length) = (from - closest, (from - closest).norm());
        if out.dot(&distance) <= SAME_SIDE_COSINE * length {
            return None;
        }
        let gradient = distance / length;
        Some(Nearest { at, offset, gap: (at - closest).dot(&gradient), gradient })
    }

    /// Finds the part of the patch that is nearest to the body by bisection: a part is cut in two while it
    /// may be closer than `margin` metres and the field is not exact there.
    ///
    /// # Errors
    ///
    /// If no part is closer: the distance that the body must travel before one may be, metres.
    fn nearest_part(&self, margin: f32) -> Result<Nearest, f32> {
        let (field, [length, width]) = (self.body.field, self.patch.extents);
        let min_half = min_part(self.patch);
        let (mut nearest, mut travel) = (None::<Nearest>, f32::INFINITY);
        let mut waiting = Vec::<Part, PART_STACK>::new();
        let _ = waiting.push(Part { offset: 0.0, half: length });
        while let Some(Part { offset, half }) = waiting.pop() {
            let at = self.point_at([offset, 0.0]);
            let sample = field.sample_near(&at);
            let gap =
                sample.map_or_else(|bound| bound, |(gap, _)| gap) - libm::sqrtf(half * half + width * width);
            if gap > margin {
                travel = travel.min(gap - margin);
                continue;
            }
            let is_small = half <= min_half;
            match sample {
                Ok(sample) if !self.patch.is_wire() || is_small => {
                    let found = self.nearest_around(offset, at, sample);
                    if nearest.as_ref().is_none_or(|nearest| found.gap < nearest.gap) {
                        nearest = Some(found);
                    }
                }
                Err(_) if is_small => travel = travel.min(field.way_to_bricks(&at)),
                _ => {
                    let half = 0.5 * half;
                    for side in [half, -half] {
                        let _ = waiting.push(Part { offset: offset + side, half });
                    }
                }
            }
        }
        nearest.ok_or(travel.max(0.0))
    }

    /// Nearest point of the patch at an offset along it, where `at` is the point there; of a wire, the point
    /// around its axis that faces the body.
    fn nearest_around(&self, offset: f32, at: Point, (gap, gradient): (f32, Vector)) -> Nearest {
        let radius = self.patch.wire_radius();
        if radius == 0.0 || gap < 0.0 {
            return Nearest { at, offset: [offset, 0.0], gap: gap - radius, gradient };
        }
        let towards = unit_or(gradient - self.along * gradient.dot(&self.along), -self.normal) * -radius;
        let at = at + towards;
        let (gap, gradient) = self.body.field.sample(&at);
        Nearest { at, offset: [offset, towards.dot(&self.across)], gap, gradient }
    }

    /// Minimises the gap over the patch from a point of it, by the secant method in either direction.
    fn minimise_gap(&self, start: Nearest) -> Nearest {
        let mut nearest = start;
        let first = self.patch.initial_strides(nearest.offset);
        let (mut strides, mut slope) = (first, self.slope(&nearest));
        for _ in 0..SECANT_STEPS {
            let [x, y] = nearest.offset;
            let offset = self.patch.clamp([x - strides[0] * slope[0], y - strides[1] * slope[1]]);
            let step = [offset[0] - x, offset[1] - y];
            // Converged, or the gap decreases only beyond the rim.
            if (0..2).all(|k| step[k].abs() <= FLAT_SLOPE * strides[k]) {
                break;
            }
            let next = self.sample_field(offset);
            if next.gap >= nearest.gap {
                strides = strides.map(|stride| stride * STRIDE_REDUCTION);
                continue;
            }
            let next_slope = self.slope(&next);
            nearest = next;
            for k in 0..2 {
                let change = next_slope[k] - slope[k];
                if change * step[k] > 0.0 {
                    strides[k] = (step[k] / change).min(first[k] * MAX_STRIDE_GROWTH);
                }
            }
            slope = next_slope;
        }
        nearest
    }

    /// Slope of the gap along and across the patch: its change per metre on the surface.
    fn slope(&self, nearest: &Nearest) -> [f32; 2] {
        let normal = self.patch.normal_at(nearest.offset);
        let gradient = [&self.along, &self.across, &self.normal].map(|axis| nearest.gradient.dot(axis));
        let steepness = (0..3).map(|k| gradient[k] * normal[k]).sum::<f32>();
        [0, 1].map(|k| gradient[k] - normal[k] * steepness)
    }
}
