//! A piece of the supporter's surface: what is known of it around one of its points.

use crate::geometry::{Vector, unit_or};
use bytemuck::{Pod, Zeroable};

/// A piece of the plane square to the normal at a point of the supporter, bent to each side as the surface is, or a cylinder all around
/// a wire; and in which directions the surface goes straight on. In supporter coordinates.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Patch {
    /// Unit, out of the solid.
    pub(super) normal: Vector,
    /// Unit, square to the normal: the direction in which the normals around change least, as along a bar.
    pub(super) along: Vector,
    /// How far it goes along and across to either side, metres; of a wire, across it is the radius.
    pub(super) extents: [f32; 2],
    /// How much the normals turn to each side, 1/m, 0 where the surface is straight: along, back, across, and back.
    pub(super) curvatures: [f32; 4],
    /// In how many directions the surface is straight: in none, along, or both along and across.
    pub(super) straight: u32,
    /// A bit for each of its sides where the surface ends; and [`ALL_AROUND`](Self::ALL_AROUND).
    pub(super) ends: u32,
}

/// How much the surface of what touches a patch is taken to turn at first, 1/m: a radius of 8 mm.
const BLUNT: f32 = 125.0;
/// That the supporter is there is certain up to this part of the extent.
const CERTAIN: f32 = 0.7;
/// What touches farther out than this part of the extent touches the patch's rim.
const RIM: f32 = 0.9;

impl Patch {
    /// No patch is without any extent, metres.
    pub(super) const LEAST_EXTENT: f32 = 1e-5;
    /// The bit of a patch that goes all the way around a wire.
    pub(super) const ALL_AROUND: u32 = 1 << 4;

    /// How much the normals turn where an offset leads along and across, 1/m.
    pub(super) fn curvatures_towards(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [self.curvatures[usize::from(x < 0.0)], self.curvatures[2 + usize::from(y < 0.0)]]
    }

    /// The unit normal of the patch at an offset along and across: its components along, across, and along the normal at the point.
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

    /// The same as a vector.
    pub(super) fn turned_normal(&self, offset: [f32; 2]) -> Vector {
        let [x, y, z] = self.normal_at(offset);
        self.along * x + self.across() * y + self.normal * z
    }

    /// How far along and across it is from an offset to the place without a slope, for each unit of slope, if what touches is flat there or
    /// blunt, metres.
    pub(super) fn strides(&self, offset: [f32; 2]) -> [f32; 2] {
        self.curvatures_towards(offset).map(|curvature| 1.0 / (curvature.max(0.0) + BLUNT))
    }

    /// The next offset that is on the patch.
    pub(super) fn clamp(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [a, b] = self.extents;
        if self.straight == 2 {
            // Its corners would stick out over a rim that is round.
            let (u, v) = (x / a, y / b);
            let scale = 1.0 / libm::sqrtf((u * u + v * v).max(1.0));
            return [x * scale, y * scale];
        }
        [x.clamp(-a, a), y.clamp(-b, b)]
    }

    /// How far the place at an offset is below the plane through the point; of a wire, its axis.
    pub(super) fn depth(&self, offset: [f32; 2]) -> f32 {
        if self.is_all_around() {
            return self.wire_radius();
        }
        let [a, b] = self.curvatures_towards(offset);
        sagitta(offset[0], a) + sagitta(offset[1], b)
    }

    /// Unit vectors along, across and out of the patch.
    pub(super) fn axes(&self) -> [Vector; 3] {
        [self.along, self.across(), self.normal]
    }

    pub(super) fn across(&self) -> Vector {
        self.normal.cross(&self.along)
    }

    /// How far its corners are from its point, metres.
    pub(crate) fn reach(&self) -> f32 {
        let [a, b] = self.extents;
        // The other side of a wire is its diameter away.
        let b = if self.is_all_around() { 2.0 * b } else { b };
        libm::sqrtf(a * a + b * b)
    }

    /// Steps from its point to the ends of a line along a bar, on the axis of a wire; both are none where it is no bar. What that passes
    /// through, the supporter passes through, also where it has no points.
    pub(crate) fn line(&self) -> [Vector; 2] {
        let inwards = self.normal * self.wire_radius();
        let length = if self.straight == 1 { CERTAIN * self.extents[0] } else { 0.0 };
        [length, -length].map(|reach| self.along * reach - inwards)
    }

    /// The radius of the wire, metres; 0 if it is none.
    pub(crate) fn wire_radius(&self) -> f32 {
        if self.is_all_around() { 1.0 / self.curvatures[2] } else { 0.0 }
    }

    /// Whether it is that of a wire, all around it.
    pub(crate) fn is_all_around(&self) -> bool {
        self.ends & Self::ALL_AROUND != 0
    }

    /// The unit vector along which the patch pushes a body that it touches at an offset along and across, and whose surface, seen
    /// alone, would be pushed along `push`.
    ///
    /// Where the patch is straight, and on its rim, it is the patch's own normal: a handle that lies between two points of a bar, and
    /// leans on the next patch of one, slides along that bar as if there were points in between. Where it is curved both normals agree,
    /// but for what is not exact: the patch where it is not as round as it was taken to be, the body where it has an edge. Over the
    /// rim where the surface ends, the body's surface decides.
    pub(crate) fn push(&self, push: Vector, offset: [f32; 2]) -> Vector {
        let across = self.across();
        let own = self.normal_at(offset);
        let is_on_rim = self.is_on_rim(offset);
        let seen = [push.dot(&self.along), push.dot(&across)];
        let [along, sideways] =
            [0, 1].map(|k| self.push_in_direction(k, offset[k], is_on_rim[k], seen[k], own[k]));
        let rest = 1.0 - along * along - sideways * sideways;
        unit_or(self.normal * libm::sqrtf(rest.max(0.0)) + self.along * along + across * sideways, push)
    }

    /// Whether an offset is on the rim, along and across: of a flat patch, which is an ellipse, both or neither.
    fn is_on_rim(&self, offset: [f32; 2]) -> [bool; 2] {
        let [x, y] = [0, 1].map(|k| offset[k] / self.extents[k]);
        if self.straight == 2 {
            return [x * x + y * y > RIM * RIM; 2];
        }
        [x, y].map(|part| part.abs() > RIM)
    }

    /// The component along or across of a push that is `push` by the body's surface and `own` by the patch.
    fn push_in_direction(&self, direction: usize, offset: f32, is_on_rim: bool, push: f32, own: f32) -> f32 {
        let extent = self.extents[direction];
        if extent <= Self::LEAST_EXTENT {
            return push;
        }
        let side = 2 * direction + usize::from(offset < 0.0);
        let is_straight = (direction as u32) < self.straight;
        let is_over_end = self.ends & 1 << side != 0 && is_on_rim && (push - own) * offset > 0.0;
        if is_over_end {
            push
        } else if is_straight || is_on_rim {
            own
        } else {
            0.5 * (own + push)
        }
    }
}

/// How far a circle of this curvature, 1/m, is below its tangent at this distance from where it touches.
fn sagitta(distance: f32, curvature: f32) -> f32 {
    let turn = curvature * distance;
    turn * distance / (1.0 + libm::sqrtf((1.0 - turn * turn).max(0.0)))
}
