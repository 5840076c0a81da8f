//! A piece of the supporter's surface: what is known of it around one of its points.

use crate::geometry::{PointTree, Vector, any_perpendicular, unit_or};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix2, Matrix3, Vector2};

/// A rectangle of the plane square to the normal at a point of the supporter, bent to each side as the surface is, or a cylinder all
/// around a wire; and in which directions the surface goes straight on. In supporter coordinates.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Patch {
    /// Unit, out of the solid.
    normal: Vector,
    /// Unit, square to the normal: the direction in which the normals around change least, as along a bar.
    along: Vector,
    /// Half of the rectangle's extents along and across, metres; zero for a point that another one stands for.
    extents: [f32; 2],
    /// How much the normals turn to each side, 1/m, 0 where the surface is straight: along, back, across, and back.
    curvatures: [f32; 4],
    /// In how many directions the surface is straight: in none, along, or both along and across.
    straight: u32,
    /// A bit for each of its sides where the surface ends; and [`ALL_AROUND`].
    ends: u32,
}

/// Half of a patch's extents at most, over the distance of the points. Smaller ones leave gaps between the points, over which things
/// slide as over a rasp. Larger ones thicken what is round.
const HALF_EXTENT: f32 = 0.8;
/// No patch is without any extent, metres.
const LEAST_EXTENT: f32 = 1e-5;

/// The least cosine between normals of points on one side of what is round; and of those that tell that a bar goes on, and how it is bent.
const SAME_SIDE: f32 = 0.75;
const SAME_BAR: f32 = 0.3;

/// A patch is straight in a direction in which its normals turn by less than this, radians, over half its extent.
const STRAIGHT: f32 = 0.15;
/// How much the bending on both sides together says about that on each: by so much of the square of the distance it was looked at.
const SIDE_WEIGHT: f32 = 0.1;
/// How much the surface of what touches a patch is taken to turn at first, 1/m: a radius of 8 mm.
const BLUNT: f32 = 125.0;
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
/// The bit of a patch that goes all the way around a wire.
const ALL_AROUND: u32 = 1 << 4;

/// A patch whose half is longer than this, metres, where points are far apart, is looked at in more places than one: at these parts of it.
const LONG: f32 = 0.0025;
const STATIONS: [f32; 7] = [-1.0, -0.667, -0.333, 0.0, 0.333, 0.667, 1.0];

/// That the supporter is there is certain up to this part of the extent.
const CERTAIN: f32 = 0.7;
/// What touches farther out than this part of the extent touches the patch's rim.
const RIM: f32 = 0.9;

impl Patch {
    /// The patch around a point, in tree order. Points are `spacing` metres from each other, those that have patches at least `apart`.
    pub(super) fn fit(tree: &PointTree, normals: &[Vector], index: usize, apart: f32, spacing: f32) -> Self {
        let half = HALF_EXTENT * apart;
        if let Some(wire) = Self::on_wire(tree, normals[index], index, half, half + spacing) {
            return wire;
        }
        let (along, curvatures) = bending(tree, normals, index, half + spacing);
        let mut patch = Self { normal: normals[index], along, ..Self::default() };
        let sides = patch.side_curvatures(tree, normals, index, half + spacing, curvatures);
        let is_straight = |k: usize| sides[2 * k..][..2].iter().all(|side| side.abs() * half < STRAIGHT);
        patch.straight = match (is_straight(0), is_straight(1)) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        patch.curvatures = sides;
        patch.curvatures[..2 * patch.straight as usize].fill(0.0);
        let [near, far] = patch.seen_extents(tree, normals, index, [half + spacing, half + FAR * spacing]);
        for k in 0..2 {
            let sharpest = patch.curvatures[2 * k].abs().max(patch.curvatures[2 * k + 1].abs());
            let steepest = STEEPEST / sharpest.max(1.0);
            let extent = near[2 * k].min(near[2 * k + 1]).min(half).min(steepest).max(LEAST_EXTENT);
            patch.extents[k] = extent;
            for side in [2 * k, 2 * k + 1] {
                // What is cut off because it gets steep goes on below.
                let is_end = far[side] < extent + BEYOND * spacing && extent < steepest;
                patch.ends |= u32::from(is_end) << side;
            }
        }
        patch
    }

    /// The patch around a point of a wire that is thinner than the points are apart: there are too few on each side of it to tell by their
    /// normals how it is bent, but all together lie along it. `None` if within `radius` they do not.
    fn on_wire(tree: &PointTree, normal: Vector, index: usize, half: f32, radius: f32) -> Option<Self> {
        let place = tree.points()[index];
        let offsets = |tell: &mut dyn FnMut(Vector)| {
            tree.for_each_within(&place, radius, |other| tell(tree.points()[other.index as usize] - place));
        };
        let (mut count, mut sum, mut squares) = (0.0_f32, Vector::zeros(), Matrix3::zeros());
        offsets(&mut |offset| {
            count += 1.0;
            sum += offset;
            squares += offset * offset.transpose();
        });
        let mean = sum / count;
        let spread = squares / count - mean * mean.transpose();
        // The Frobenius norm bounds the greatest eigenvalue, so that most points are seen at once to lie on no wire. The spare is for
        // rounding.
        if count < LEAST_WIRE || (1.0 + WIRE) * spread.norm() < 0.999 * spread.trace() {
            return None;
        }
        // The direction of greatest spread, by power iteration from the farthest offset's: a wire's is so much the greatest that few do.
        let mut along = Vector::zeros();
        offsets(&mut |offset| {
            along = if offset.norm_squared() > along.norm_squared() { offset } else { along }
        });
        for _ in 0..4 {
            along = unit_or(spread * along, along);
        }
        let length = along.dot(&(spread * along));
        // Points on all sides of a cylinder are at its radius from the axis.
        let thickness = spread.trace() - length;
        if thickness > WIRE * length {
            return None;
        }
        let along = unit_or(along - normal * along.dot(&normal), any_perpendicular(normal));
        let mut seen = [0.0_f32; 2];
        offsets(&mut |offset| {
            let reach = offset.dot(&along);
            seen = [seen[0].max(reach), seen[1].max(-reach)];
        });
        let wire_radius = libm::sqrtf(thickness).max(LEAST_EXTENT);
        let extent = seen[0].min(seen[1]).min(half).max(LEAST_EXTENT);
        let ends = seen.map(|seen| u32::from(seen < 1.5 * extent));
        Some(Self {
            normal,
            along,
            extents: [extent, wire_radius],
            straight: 1,
            curvatures: [0.0, 0.0, 1.0 / wire_radius, 1.0 / wire_radius],
            ends: ends[0] | ends[1] << 1 | ALL_AROUND,
        })
    }

    /// How far the surface is seen to go on to each side, metres, up to about the first and the second of `radii`: a patch that reached
    /// over the rim of a bar's end would hold what slides off there.
    fn seen_extents(
        &self,
        tree: &PointTree,
        normals: &[Vector],
        index: usize,
        radii: [f32; 2],
    ) -> [[f32; 4]; 2] {
        let place = tree.points()[index];
        let across = self.across();
        let [mut near, mut far] = [[0.0_f32; 4]; 2];
        tree.for_each_within(&place, radii[1], |neighbour| {
            let other = neighbour.index as usize;
            let offset = tree.points()[other] - place;
            let (x, y) = (offset.dot(&self.along), offset.dot(&across));
            if normals[other].dot(&self.normal_at(x, y)) < SAME_SIDE {
                return;
            }
            let is_near = neighbour.distance_squared <= radii[0] * radii[0];
            let distance = libm::sqrtf(x * x + y * y);
            let ahead = core::f32::consts::FRAC_1_SQRT_2 * distance;
            for (side, reach) in [x, -x, y, -y].into_iter().enumerate() {
                // All along a bar it is as wide, and all across as long.
                let seen = match self.straight {
                    1 => reach,
                    _ if reach > ahead => distance,
                    _ => continue,
                };
                far[side] = far[side].max(seen);
                if is_near {
                    near[side] = near[side].max(seen);
                }
            }
        });
        [near, far]
    }

    /// How much the normals turn to each side, 1/m: where a bar has a round end they turn on one only.
    fn side_curvatures(
        &self,
        tree: &PointTree,
        normals: &[Vector],
        index: usize,
        radius: f32,
        both: [f32; 2],
    ) -> [f32; 4] {
        let place = tree.points()[index];
        let axes = [self.along, self.across()];
        let weight = SIDE_WEIGHT * radius * radius;
        let mut squares = [weight; 4];
        let mut turns = [both[0] * weight, both[0] * weight, both[1] * weight, both[1] * weight];
        tree.for_each_within(&place, radius, |neighbour| {
            let other = neighbour.index as usize;
            if normals[other].dot(&self.normal) > SAME_BAR {
                let offset = tree.points()[other] - place;
                for (k, axis) in axes.iter().enumerate() {
                    let reach = offset.dot(axis);
                    let side = 2 * k + usize::from(reach < 0.0);
                    squares[side] += reach * reach;
                    turns[side] += reach * normals[other].dot(axis);
                }
            }
        });
        core::array::from_fn(|side| turns[side] / squares[side])
    }

    /// How much the normals turn where a step leads along and across, 1/m.
    fn curvatures_towards(&self, x: f32, y: f32) -> [f32; 2] {
        [self.curvatures[usize::from(x < 0.0)], self.curvatures[2 + usize::from(y < 0.0)]]
    }

    /// The normal of the patch at a step along and across.
    fn normal_at(&self, x: f32, y: f32) -> Vector {
        let [a, b] = self.curvatures_towards(x, y);
        let (x, y) = (a * x, b * y);
        let upwards = libm::sqrtf((1.0 - x * x - y * y).max(0.0));
        unit_or(self.normal * upwards + self.along * x + self.across() * y, self.normal)
    }

    /// The slope along and across the patch, at a step from its point, of what grows as `gradient` says.
    pub(super) fn slope(&self, step: &Vector, gradient: &Vector) -> [f32; 2] {
        let across = self.across();
        let normal = self.normal_at(step.dot(&self.along), step.dot(&across));
        let slope = gradient - normal * gradient.dot(&normal);
        [slope.dot(&self.along), slope.dot(&across)]
    }

    /// How far along and across it is from a step to the place without a slope, for each unit of slope, if what touches is flat there or
    /// blunt, metres.
    pub(super) fn strides(&self, step: &Vector) -> [f32; 2] {
        self.curvatures_towards(step.dot(&self.along), step.dot(&self.across()))
            .map(|curvature| 1.0 / (curvature.max(0.0) + BLUNT))
    }

    /// The step moved on along and across, as far as the patch goes.
    pub(super) fn moved(&self, step: &Vector, [x, y]: [f32; 2]) -> Vector {
        self.step_towards(&(step + self.along * x + self.across() * y))
    }

    fn across(&self) -> Vector {
        self.normal.cross(&self.along)
    }

    /// Whether another point stands for this one.
    pub(crate) fn is_empty(&self) -> bool {
        self.extents[0] == 0.0
    }

    /// How far its corners are from its point, metres.
    pub(crate) fn reach(&self) -> f32 {
        let [a, b] = self.extents;
        // The other side of a wire is its diameter away.
        let b = if self.is_all_around() { 2.0 * b } else { b };
        libm::sqrtf(a * a + b * b)
    }

    /// Steps from its point to places along a patch that is long, on the axis of a wire; none if it is short.
    pub(crate) fn stations(&self) -> impl Iterator<Item = Vector> + '_ {
        let is_long = self.extents[0] > LONG;
        let inwards = self.normal * self.wire_radius();
        let places = STATIONS.into_iter().filter(move |_| is_long || self.is_all_around());
        places.map(move |part| self.along * (part * self.extents[0]) - inwards)
    }

    /// Steps from its point to the ends of a line along a bar, on the axis of a wire; both are none where it is no bar. What that passes
    /// through, the supporter passes through, also where it has no points.
    pub(crate) fn line(&self) -> [Vector; 2] {
        let inwards = self.normal * self.wire_radius();
        let length = if self.straight == 1 { CERTAIN * self.extents[0] } else { 0.0 };
        [length, -length].map(|reach| self.along * reach - inwards)
    }

    /// The step from its point to where a wire faces what is the way of `-gradient` from a station; elsewhere the station itself.
    pub(crate) fn facing(&self, station: Vector, gradient: &Vector) -> Vector {
        let across = gradient - self.along * gradient.dot(&self.along);
        station - unit_or(across, -self.normal) * self.wire_radius()
    }

    /// The radius of the wire, metres; 0 if it is none.
    pub(crate) fn wire_radius(&self) -> f32 {
        if self.is_all_around() { 1.0 / self.curvatures[2] } else { 0.0 }
    }

    /// Whether it is that of a wire, all around it.
    pub(crate) fn is_all_around(&self) -> bool {
        self.ends & ALL_AROUND != 0
    }

    /// By how much what grows as `gradient` says is less at the rim than at the point, at most.
    pub(crate) fn fall(&self, gradient: &Vector) -> f32 {
        let [a, b] = self.extents;
        gradient.dot(&self.along).abs() * a + gradient.dot(&self.across()).abs() * b
    }

    /// The step from the point that is next to `step` and stays on the patch.
    pub(crate) fn step_towards(&self, step: &Vector) -> Vector {
        let (across, [a, b]) = (self.across(), self.extents);
        let (x, y) = (step.dot(&self.along).clamp(-a, a), step.dot(&across).clamp(-b, b));
        let [turn_along, turn_across] = self.curvatures_towards(x, y);
        let below = sagitta(x, turn_along) + sagitta(y, turn_across);
        self.along * x + across * y - self.normal * below
    }

    /// The unit vector along which the patch pushes a body that it touches at `step` from its point and whose surface, seen alone,
    /// would be pushed along `push`.
    ///
    /// Where the patch is straight, and on its rim, it is the patch's own normal: a handle that lies between two points of a bar, and
    /// leans on the next patch of one, slides along that bar as if there were points in between. Where it is curved both normals agree,
    /// but for what is not exact: the patch where it is not as round as it was taken to be, the body where it has an edge. Over the
    /// rim where the surface ends, the body's surface decides.
    pub(crate) fn push(&self, push: Vector, step: &Vector) -> Vector {
        let across = self.across();
        let [x, y] = [step.dot(&self.along), step.dot(&across)];
        let own = self.normal_at(x, y);
        let along = self.push_in_direction(0, x, push.dot(&self.along), own.dot(&self.along));
        let sideways = self.push_in_direction(1, y, push.dot(&across), own.dot(&across));
        let rest = 1.0 - along * along - sideways * sideways;
        unit_or(self.normal * libm::sqrtf(rest.max(0.0)) + self.along * along + across * sideways, push)
    }

    /// The component along or across of a push that is `push` by the body's surface and `own` by the patch.
    fn push_in_direction(&self, direction: usize, step: f32, push: f32, own: f32) -> f32 {
        let extent = self.extents[direction];
        if extent <= LEAST_EXTENT {
            return push;
        }
        let side = 2 * direction + usize::from(step < 0.0);
        let is_on_rim = step.abs() > RIM * extent;
        let is_straight = (direction as u32) < self.straight;
        let is_over_end = self.ends & 1 << side != 0 && is_on_rim && (push - own) * step > 0.0;
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

/// The direction square to the normal of a point in which the normals around it change least, and by how much they change there and
/// across, 1/m: a least-squares fit of the surface's second fundamental form, and its principal directions.
fn bending(tree: &PointTree, normals: &[Vector], index: usize, radius: f32) -> (Vector, [f32; 2]) {
    /// For where points lie in a line: across it, nothing is known.
    const STIFFNESS: f32 = 0.01;
    let (place, normal) = (tree.points()[index], normals[index]);
    let ahead = any_perpendicular(normal);
    let aside = normal.cross(&ahead);
    let flat = |v: Vector| Vector2::new(v.dot(&ahead), v.dot(&aside));
    let (mut count, mut offset_sum, mut change_sum) = (0.0_f32, Vector2::zeros(), Vector2::zeros());
    let (mut offsets, mut changes) = (Matrix2::zeros(), Matrix2::zeros());
    tree.for_each_within(&place, radius, |neighbour| {
        let other = neighbour.index as usize;
        if normals[other].dot(&normal) > SAME_BAR {
            let (offset, change) = (flat(tree.points()[other] - place), flat(normals[other]));
            count += 1.0;
            offset_sum += offset;
            change_sum += change;
            offsets += offset * offset.transpose();
            changes += change * offset.transpose();
        }
    });
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
