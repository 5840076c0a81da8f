//! Where a patch of the supporter is nearest to the body.

use super::Body;
use super::patch::Patch;
use crate::geometry::{Point, Vector, unit_or};
use heapless::Vec;
use nalgebra::Rotation3;

/// Where a patch is nearest to, or deepest in, the body; in object coordinates.
pub(super) struct Nearest {
    pub(super) at: Point,
    /// The same, as an offset along and across the patch.
    pub(super) offset: [f32; 2],
    /// Between the surfaces, metres, and its gradient.
    pub(super) gap: f32,
    pub(super) gradient: Vector,
}

/// A patch as the object sees it.
struct View<'a> {
    body: &'a Body<'a>,
    patch: &'a Patch,
    at: Point,
    along: Vector,
    across: Vector,
    normal: Vector,
}

/// Looks for that place from the patch's point `at`, in object coordinates; `rotation` is the object's. If no part of the patch is
/// closer than `margin` metres, as far as the field can tell, says how far the body has to move until that may be, metres.
pub(super) fn nearest_on_patch(
    body: &Body,
    patch: &Patch,
    rotation: &Rotation3<f32>,
    at: &Point,
    margin: f32,
) -> Result<Nearest, f32> {
    let sample = body.field.sample_near(at);
    if let Err(bound) = sample
        && bound > patch.reach() + margin
    {
        return Err(bound - patch.reach() - margin);
    }
    let view = View::new(body, patch, rotation, at);
    let start = match sample {
        Ok((gap, gradient)) if !patch.is_all_around() => Nearest { at: *at, offset: [0.0; 2], gap, gradient },
        // The field is exact close to the body only, and a long patch may pass it far from its point.
        _ => view.nearest_part(margin)?,
    };
    if patch.is_all_around() {
        return Ok(start);
    }
    // The rim of a patch comes closer than its point, by about this.
    let [a, b] = patch.extents;
    let fall = start.gradient.dot(&view.along).abs() * a + start.gradient.dot(&view.across).abs() * b;
    if start.gap - fall > margin {
        // That is an estimate: it is looked at again when half of it is used up.
        return Err((start.gap - patch.reach() - margin).max(0.5 * (start.gap - fall - margin)));
    }
    Ok(view.descend(start))
}

/// The surface itself is asked from so far off it, metres: there it is certain on which side that is, and an edge has a direction.
const OFF: f32 = 0.0002;
/// What is deeper in the body by the field than this, in voxels, which is what it may be off by, is in there for certain: it knows the way
/// out.
const DEEP: f32 = 0.5;
/// Unless the patch and the body face each other, by this cosine, it is asked from where the body faces.
const FACING: f32 = 0.5;
/// What is seen there from farther aside than this cosine is on the other side of the surface.
const ASIDE: f32 = 0.3;
/// The place is corrected so often at most, as long as that leads farther than `CLOSE`, metres.
const CORRECTIONS: usize = 3;
const CLOSE: f32 = 1e-5;
/// Patches that are flatter are taken to be bent like this, 1/m: on a flat one it is endlessly far to where there is no slope.
const FLATTEST: f32 = 50.0;

/// A place that was found with the field, by the body's surface itself: in thin walls and at edges the field may be off by half a voxel,
/// and its gradient by ten degrees, which is the difference between what holds by friction and what slides. `at` is the patch's point, as
/// for [`nearest_on_patch`].
pub(super) fn refine(
    body: &Body,
    patch: &Patch,
    rotation: &Rotation3<f32>,
    at: &Point,
    found: Nearest,
) -> Nearest {
    // A wire is asked for from its axis, where the field errs less.
    if found.gap < -DEEP * body.field.voxel_size() || patch.is_all_around() {
        return found;
    }
    let view = View::new(body, patch, rotation, at);
    let Some(mut nearest) = view.look_closely(&found, found.offset, body.field.voxel_size()) else {
        return found;
    };
    for _ in 0..CORRECTIONS {
        let [x, y] = nearest.offset;
        let (slope, curvatures) = (view.slope(&nearest), patch.curvatures_towards([x, y]));
        let [a, b] = curvatures.map(|curvature| 1.0 / curvature.max(FLATTEST));
        let offset = patch.clamp([x - slope[0] * a, y - slope[1] * b]);
        let way = (offset[0] - x).abs() + (offset[1] - y).abs();
        if way < CLOSE {
            break;
        }
        match view.look_closely(&nearest, offset, way + OFF) {
            Some(next) if next.gap < nearest.gap => nearest = next,
            _ => break,
        }
    }
    nearest
}

/// A part of a patch.
#[derive(Clone, Copy)]
struct Part {
    /// Of its middle, along.
    offset: f32,
    /// Half its length, metres.
    half: f32,
}

/// Parts are not cut further that are shorter than this to either side, metres, or than this part of their width: then it is the width
/// that keeps them from being told to be far off.
const SMALL: f32 = 0.0021;
const WIDE: f32 = 0.5;
/// And no patch is cut into more than so many, however large: in a scene that was meant in millimetres they would be thousands.
const MOST_PARTS: f32 = 64.0;
/// Parts that wait, at most: one more than a patch is cut in two.
const WAITING: usize = 8;

/// The place where a patch touches is looked for in so many steps at most,
const DESCENTS: usize = 4;
/// until it is flat there: a slope below this,
const FLAT: f32 = 0.02;
/// and of strides up to so many times as long as first thought.
const LONGEST_STRIDE: f32 = 4.0;
/// What leads uphill was too far by this.
const SHORTER: f32 = 0.3;

impl<'a> View<'a> {
    fn new(body: &'a Body<'a>, patch: &'a Patch, rotation: &Rotation3<f32>, at: &Point) -> Self {
        let [along, across, normal] = patch.axes().map(|axis| rotation.inverse_transform_vector(&axis));
        Self { body, patch, at: *at, along, across, normal }
    }

    /// The place at an offset along and across; on the axis of a wire.
    fn place(&self, offset: [f32; 2]) -> Point {
        self.at + self.along * offset[0] + self.across * offset[1] - self.normal * self.patch.depth(offset)
    }

    /// What is there.
    fn look(&self, offset: [f32; 2]) -> Nearest {
        let at = self.place(offset);
        let (gap, gradient) = self.body.field.sample(&at);
        Nearest { at, offset, gap, gradient }
    }

    /// What is there by the body's surface, if its gap is not greater by more than `more` metres than at `near`, a place close by.
    fn look_closely(&self, near: &Nearest, offset: [f32; 2], more: f32) -> Option<Nearest> {
        let at = self.place(offset);
        let [x, y, z] = self.patch.normal_at(offset);
        let own = self.along * x + self.across * y + self.normal * z;
        let out = if own.dot(&near.gradient) < -FACING { -own } else { near.gradient };
        let from = at + out * OFF;
        let closest = self.body.surface.closest_point_within(&from, near.gap.max(0.0) + OFF + more)?;
        let (way, length) = (from - closest, (from - closest).norm());
        if out.dot(&way) <= ASIDE * length {
            return None;
        }
        let gradient = way / length;
        Some(Nearest { at, offset, gap: (at - closest).dot(&gradient), gradient })
    }

    /// Looks for the part of the patch that is nearest to the body by cutting the patch in two as long as a part may be closer than
    /// `margin` and the field is not exact there. If none is, says how far the body has to move until that may be.
    fn nearest_part(&self, margin: f32) -> Result<Nearest, f32> {
        let (field, [length, width]) = (self.body.field, self.patch.extents);
        let small = SMALL.max(WIDE * width).max(length / MOST_PARTS);
        let (mut nearest, mut way) = (None::<Nearest>, f32::INFINITY);
        let mut waiting = Vec::<Part, WAITING>::new();
        let _ = waiting.push(Part { offset: 0.0, half: length });
        while let Some(Part { offset, half }) = waiting.pop() {
            let at = self.place([offset, 0.0]);
            let sample = field.sample_near(&at);
            let gap =
                sample.map_or_else(|bound| bound, |(gap, _)| gap) - libm::sqrtf(half * half + width * width);
            if gap > margin {
                way = way.min(gap - margin);
                continue;
            }
            let is_small = half <= small;
            match sample {
                Ok(sample) if !self.patch.is_all_around() || is_small => {
                    let found = self.facing(offset, at, sample);
                    if nearest.as_ref().is_none_or(|nearest| found.gap < nearest.gap) {
                        nearest = Some(found);
                    }
                }
                Err(_) if is_small => way = way.min(field.way_to_bricks(&at)),
                _ => {
                    let half = 0.5 * half;
                    for side in [half, -half] {
                        let _ = waiting.push(Part { offset: offset + side, half });
                    }
                }
            }
        }
        nearest.ok_or(way.max(0.0))
    }

    /// The place of a patch there; of a wire, around its axis, the one that faces the body.
    fn facing(&self, offset: f32, at: Point, (gap, gradient): (f32, Vector)) -> Nearest {
        let radius = self.patch.wire_radius();
        if radius == 0.0 || gap < 0.0 {
            return Nearest { at, offset: [offset, 0.0], gap: gap - radius, gradient };
        }
        let towards = unit_or(gradient - self.along * gradient.dot(&self.along), -self.normal) * -radius;
        let at = at + towards;
        let (gap, gradient) = self.body.field.sample(&at);
        Nearest { at, offset: [offset, towards.dot(&self.across)], gap, gradient }
    }

    /// Goes on from a place of the patch to the nearest one, by the secant method in either direction.
    fn descend(&self, start: Nearest) -> Nearest {
        let mut nearest = start;
        let first = self.patch.strides(nearest.offset);
        let (mut strides, mut slope) = (first, self.slope(&nearest));
        for _ in 0..DESCENTS {
            let [x, y] = nearest.offset;
            let offset = self.patch.clamp([x - strides[0] * slope[0], y - strides[1] * slope[1]]);
            let way = [offset[0] - x, offset[1] - y];
            // It is flat, or downhill is over the rim.
            if (0..2).all(|k| way[k].abs() <= FLAT * strides[k]) {
                break;
            }
            let next = self.look(offset);
            if next.gap >= nearest.gap {
                strides = strides.map(|stride| stride * SHORTER);
                continue;
            }
            let next_slope = self.slope(&next);
            nearest = next;
            for k in 0..2 {
                let change = next_slope[k] - slope[k];
                if change * way[k] > 0.0 {
                    strides[k] = (way[k] / change).min(first[k] * LONGEST_STRIDE);
                }
            }
            slope = next_slope;
        }
        nearest
    }

    /// How much the gap grows along and across the patch.
    fn slope(&self, nearest: &Nearest) -> [f32; 2] {
        let normal = self.patch.normal_at(nearest.offset);
        let gradient = [&self.along, &self.across, &self.normal].map(|axis| nearest.gradient.dot(axis));
        let steepness = (0..3).map(|k| gradient[k] * normal[k]).sum::<f32>();
        [0, 1].map(|k| gradient[k] - normal[k] * steepness)
    }
}
