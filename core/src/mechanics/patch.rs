//! A patch: a model of the supporter's surface around one of its points.

use super::constants::{
    FILLED_RATIO, HOLLOW_CURVATURE, INITIAL_CURVATURE, MIN_PATCH_EXTENT, PATCH_HALF_EXTENT,
    REPRESENTATIVE_SPACING, RIM_RATIO,
};
use crate::geometry::{Vector, unit_or};
use bytemuck::{Pod, Zeroable};

/// A patch of the supporter's surface at one of its points, in supporter coordinates. It is a piece of the
/// tangent plane, bent in either principal direction with one curvature per side, or a cylinder around a
/// wire.
///
/// A point of the patch is given by its offset along and across it, metres. Sides are numbered: along
/// forwards, along backwards, across forwards, across backwards.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Patch {
    /// Unit normal, out of the solid.
    pub(crate) normal: Vector,
    /// Unit tangent in the principal direction of least curvature, as along a bar.
    pub(super) along: Vector,
    /// Half extents along and across, metres. Of a wire, the second one is the radius.
    pub(super) extents: [f32; 2],
    /// Curvature towards each side, 1/m; zero where the surface is straight.
    pub(super) curvatures: [f32; 4],
    /// Number of straight directions: 0; 1, along; or 2, along and across.
    pub(super) straight: u32,
    /// Bit per side at which the surface ends, [`WIRE`](Self::WIRE), and [`GUESSED`](Self::GUESSED).
    pub(super) ends: u32,
}

/// Cosine between the normals of a patch and a contact on it.
const FACING_NORMALS: f32 = 0.7;
/// Curvature across a bar beyond that along it, 1/m: that of a bar of 4 cm radius. Flatter surfaces have no direction.
const BAR_CURVATURE: f32 = 25.0;

/// Half extent, metres, of patches that are long: half as much again as in a dense cloud.
const LONG: f32 = 1.5 * PATCH_HALF_EXTENT * REPRESENTATIVE_SPACING;

impl Patch {
    /// Bit of [`ends`](Self::ends) that marks a wire: the patch is the whole cylinder around it.
    pub(super) const WIRE: u32 = 1 << 4;
    /// Bit of [`ends`](Self::ends) that marks a patch of surface that was not seen but guessed.
    pub(super) const GUESSED: u32 = 1 << 5;
    /// Bit of [`ends`](Self::ends) that marks a patch on which nothing shall hang.
    pub(super) const EXCLUDED: u32 = 1 << 6;

    /// Curvatures along and across, on the sides of an offset, 1/m.
    pub(super) fn curvatures_towards(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [self.curvatures[usize::from(x < 0.0)], self.curvatures[2 + usize::from(y < 0.0)]]
    }

    /// Unit normal of the patch at an offset: its components along, across, and along the normal at the
    /// centre.
    pub(super) fn normal_at(&self, offset: [f32; 2]) -> [f32; 3] {
        let [a, b] = self.curvatures_towards(offset);
        let (x, y) = (a * offset[0], b * offset[1]);
        let square = x * x + y * y;
        if square < 1.0 {
            return [x, y, libm::sqrtf(1.0 - square)];
        }
        let scale = 1.0 / libm::sqrtf(square);
        [x * scale, y * scale, 0.0]
    }

    /// Initial steps of the secant method from an offset, along and across, metres per unit of slope: the
    /// patch's curvature and an initial guess for that of the touching surface predict where the slope
    /// vanishes.
    pub(super) fn initial_strides(&self, offset: [f32; 2]) -> [f32; 2] {
        self.curvatures_towards(offset).map(|curvature| 1.0 / (curvature.max(0.0) + INITIAL_CURVATURE))
    }

    /// Estimate of how much closer than the point at an offset any other point of the patch is to a body, metres, if `gradient` is that
    /// of the gap there, supporter coordinates. The patch's own curvature widens the gap towards the rim, less that of the hollows
    /// of the body.
    pub(super) fn fall(&self, gradient: &Vector, offset: [f32; 2]) -> f32 {
        let (axes, curvatures) = ([self.along, self.across()], self.curvatures_towards(offset));
        let fall = |k: usize| {
            let slope = gradient.dot(&axes[k]).abs();
            let (way, curvature) =
                (self.extents[k] + offset[k].abs(), (curvatures[k] - HOLLOW_CURVATURE).max(0.0));
            if curvature * way > slope {
                0.5 * slope * slope / curvature
            } else {
                slope * way - 0.5 * curvature * way * way
            }
        };
        fall(0) + fall(1)
    }

    /// Nearest offset on the patch. A patch that is straight in both directions is an ellipse, any other a
    /// rectangle.
    pub(super) fn clamp(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [a, b] = self.extents;
        if self.straight == 2 {
            // The corners of a rectangle would stick out over a round rim, as at the end of a bar.
            let (u, v) = (x / a, y / b);
            let scale = 1.0 / libm::sqrtf((u * u + v * v).max(1.0));
            return [x * scale, y * scale];
        }
        // As `clamp`, which panics for a range that is not in order.
        let within = |x: f32, limit: f32| {
            if x < -limit {
                -limit
            } else if x > limit {
                limit
            } else {
                x
            }
        };
        [within(x, a), within(y, b)]
    }

    /// Depth of the surface at an offset below the tangent plane, metres; of a wire, that of its axis.
    pub(super) fn depth(&self, offset: [f32; 2]) -> f32 {
        if self.is_wire() {
            return self.wire_radius();
        }
        let [a, b] = self.curvatures_towards(offset);
        sagitta(offset[0], a) + sagitta(offset[1], b)
    }

    /// Whether the patch faces as a contact with this unit normal does; a wire faces all around.
    pub(super) fn faces(&self, normal: &Vector) -> bool {
        self.is_wire() || self.normal.dot(normal) > FACING_NORMALS
    }

    /// Unit vector along the bar of which the patch is a part; `None` if the surface is hardly more curved across than along.
    pub(super) fn bar_direction(&self) -> Option<Vector> {
        let [forwards, backwards, ..] = self.curvatures;
        let (along, across) = (0.5 * (forwards + backwards), self.curvature_across());
        (self.is_wire() || across > BAR_CURVATURE + along.abs()).then_some(self.along)
    }

    /// Whether it is on a plane that was thinned, but no longer than a patch of a dense cloud to one of its sides.
    pub(super) fn is_cut_off_in_plane(&self) -> bool {
        let [a, b] = self.extents;
        self.ends & Self::EXCLUDED != 0 && a.min(b) < LONG
    }

    /// Mean curvature across, 1/m.
    pub(super) fn curvature_across(&self) -> f32 {
        0.5 * (self.curvatures[2] + self.curvatures[3])
    }

    /// Unit vectors along, across and normal to the patch.
    pub(super) fn axes(&self) -> [Vector; 3] {
        [self.along, self.across(), self.normal]
    }

    /// Unit tangent in the other principal direction.
    pub(super) fn across(&self) -> Vector {
        self.normal.cross(&self.along)
    }

    /// Distance from the centre to the corners, metres.
    pub(crate) fn reach(&self) -> f32 {
        let [a, b] = self.extents;
        // The centre is on the surface of a wire; the other side is one diameter away.
        let b = if self.is_wire() { 2.0 * b } else { b };
        libm::sqrtf(a * a + b * b)
    }

    /// Offsets from the centre to the two ends of segments that the surface is certain to fill, along a bar (of a wire, on
    /// its axis), and along and across a plane, in supporter coordinates, metres. Where one passes through an object, the
    /// supporter does, although no point lies there.
    pub(crate) fn filled_segments(&self) -> impl Iterator<Item = [Vector; 2]> {
        let inwards = self.normal * self.wire_radius();
        let axes = [self.along, self.across()].into_iter().zip(self.extents).take(self.straight as usize);
        axes.map(move |(axis, extent)| {
            let reach = axis * (FILLED_RATIO * extent);
            [reach - inwards, -reach - inwards]
        })
    }

    /// Offsets from the centre of points half way to its four rims, supporter coordinates, metres; of a wire, along it.
    pub(super) fn half_way_out(&self) -> impl Iterator<Item = Vector> {
        let sides = if self.is_wire() { 2 } else { 4 };
        let [along, across, normal] = self.axes();
        [[0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]].into_iter().take(sides).map(
            move |[x, y]: [f32; 2]| {
                let offset = [x * self.extents[0], y * self.extents[1]];
                let depth = if self.is_wire() { 0.0 } else { self.depth(offset) };
                along * offset[0] + across * offset[1] - normal * depth
            },
        )
    }

    /// Share of a segment at which it passes through the patch, or as near to it as others would be that face alike, as if it were flat; if
    /// it does, by the offsets of its ends, metres.
    pub(super) fn is_passed_at(&self, from: &Vector, to: &Vector) -> Option<f32> {
        let [along, across, normal] = self.axes();
        let [before, after] = [from, to].map(|end| end.dot(&normal));
        if self.is_wire() || before * after > 0.0 || before == after {
            return None;
        }
        let share = before / (before - after);
        let at = from + (to - from) * share;
        // The patch of a face that is smaller than the distance between patches has no extent.
        let [length, width] =
            self.extents.map(|extent| extent.max(PATCH_HALF_EXTENT * REPRESENTATIVE_SPACING));
        (at.dot(&along).abs() <= length && at.dot(&across).abs() <= width).then_some(share)
    }

    /// Whether the patch is longer than those of a dense cloud, so that its middle tells little of its ends.
    pub(super) fn is_long(&self) -> bool {
        self.extents[0].max(self.extents[1]) > LONG
    }

    /// Radius of the wire, metres; 0 if the patch is not that of a wire.
    pub(crate) fn wire_radius(&self) -> f32 {
        if self.is_wire() { 1.0 / self.curvatures[2] } else { 0.0 }
    }

    /// Whether the surface was not seen but guessed.
    pub(super) fn is_guessed(&self) -> bool {
        self.ends & Self::GUESSED != 0
    }

    /// Whether the patch is that of a wire.
    pub(crate) fn is_wire(&self) -> bool {
        self.ends & Self::WIRE != 0
    }

    /// Contact normal: the unit vector along which the patch pushes a body that touches it at an offset.
    /// `body_normal` is the unit vector along which the body's surface alone would be pushed.
    ///
    /// Along and across are treated separately. Where the patch is straight, and on its rim, the patch's own
    /// normal counts: a handle that lies between two points of a bar and touches the rims of both patches
    /// slides along the bar as if there were points in between. Where the patch is curved, both normals agree
    /// except for errors, of the patch where its curvature varies and of the body at its edges, and their
    /// mean counts. Over a rim where the surface ends, the body's normal counts.
    pub(crate) fn contact_normal(&self, body_normal: Vector, offset: [f32; 2]) -> Vector {
        let across = self.across();
        let own = self.normal_at(offset);
        let is_on_rim = self.is_on_rim(offset);
        let of_body = [body_normal.dot(&self.along), body_normal.dot(&across)];
        let [along, sideways] =
            [0, 1].map(|k| self.normal_component(k, offset[k], is_on_rim[k], of_body[k], own[k]));
        let rest = 1.0 - along * along - sideways * sideways;
        unit_or(
            self.normal * libm::sqrtf(rest.max(0.0)) + self.along * along + across * sideways,
            body_normal,
        )
    }

    /// Whether an offset is on the rim, along and across. Of an elliptic patch it is both or neither.
    fn is_on_rim(&self, offset: [f32; 2]) -> [bool; 2] {
        let [x, y] = [0, 1].map(|k| offset[k] / self.extents[k]);
        if self.straight == 2 {
            return [x * x + y * y > RIM_RATIO * RIM_RATIO; 2];
        }
        [x, y].map(|part| part.abs() > RIM_RATIO)
    }

    /// Component of the contact normal along (direction 0) or across (1), where `of_body` is that of the
    /// body's normal and `own` that of the patch's.
    fn normal_component(
        &self,
        direction: usize,
        offset: f32,
        is_on_rim: bool,
        of_body: f32,
        own: f32,
    ) -> f32 {
        let extent = self.extents[direction];
        if extent <= MIN_PATCH_EXTENT {
            return of_body;
        }
        let side = 2 * direction + usize::from(offset < 0.0);
        let is_straight = (direction as u32) < self.straight;
        let is_over_end = self.ends & 1 << side != 0 && is_on_rim && (of_body - own) * offset > 0.0;
        if is_over_end {
            of_body
        } else if is_straight || is_on_rim {
            own
        } else {
            0.5 * (own + of_body)
        }
    }
}

/// Sagitta: depth of a circle below its tangent at a distance from the tangent point, metres; the curvature
/// is in 1/m.
fn sagitta(distance: f32, curvature: f32) -> f32 {
    let turn = curvature * distance;
    turn * distance / (1.0 + libm::sqrtf((1.0 - turn * turn).max(0.0)))
}
