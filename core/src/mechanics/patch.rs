//! A piece of the supporter's surface: what is known of it around one of its points.

use crate::geometry::{PointTree, Vector, any_perpendicular, unit_or};
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix2, Matrix3, Vector2};

/// A rectangle of the plane square to the normal at a point of the supporter, or of the cylinder there, or a cylinder all around a wire;
/// and in which directions the surface goes straight on. In supporter coordinates.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Patch {
    /// Unit, out of the solid.
    normal: Vector,
    /// Unit, square to the normal: the direction in which the normals around change least, as along a bar.
    along: Vector,
    /// Half of the rectangle's extents along and across, metres; zero for a point that another one stands for.
    extents: [f32; 2],
    /// In how many directions the surface is straight: in none, along, or both along and across.
    straight: u32,
    /// How much the normals turn across, where it is straight along, 1/m: there it is a piece of a cylinder.
    curvature: f32,
    /// A bit for each of its sides where the surface ends: along, back, across, and back; and [`ALL_AROUND`].
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

/// A patch is straight in a direction in which its normals turn by less than this, radians, over half its extent,
const STRAIGHT: f32 = 0.15;
/// and if the surface goes on for at least this part of that.
const LEAST_STRAIGHT: f32 = 0.2;
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

/// What touches farther out than this part of the extent touches the patch's rim.
const RIM: f32 = 0.9;
/// Less than this of a push across the surface says nothing about where it pushes.
const LEAST_PUSH: f32 = 0.5;

impl Patch {
    /// The patch around a point, in tree order. Points are `spacing` metres from each other, those that have patches at least `apart`.
    pub(super) fn fit(tree: &PointTree, normals: &[Vector], index: usize, apart: f32, spacing: f32) -> Self {
        let half = HALF_EXTENT * apart;
        if let Some(wire) = Self::on_wire(tree, normals[index], index, half, half + spacing) {
            return wire;
        }
        let (along, curvatures) = bending(tree, normals, index, half + spacing);
        let mut patch = Self { normal: normals[index], along, ..Self::default() };
        let seen = patch.seen_extents(tree, normals, index, half + spacing);
        let [length, width] = [seen[0].min(seen[1]), seen[2].min(seen[3])];
        let is_straight =
            |k: usize, seen: f32| curvatures[k].abs() * half < STRAIGHT && seen > LEAST_STRAIGHT * half;
        let extents = [length.min(half), width.min(half)];
        (patch.straight, patch.extents) = if !is_straight(0, length) {
            (0, [length.min(width).min(half); 2])
        } else if !is_straight(1, width) {
            (1, extents)
        } else {
            (2, extents)
        };
        if patch.straight == 1 {
            let sharpest = 1.0 / patch.extents[1].max(LEAST_EXTENT);
            patch.curvature = curvatures[1].clamp(-sharpest, sharpest);
        }
        patch.extents = patch.extents.map(|extent| extent.max(LEAST_EXTENT));
        for (side, seen) in seen.iter().enumerate() {
            let is_end = *seen < patch.extents[side / 2] + BEYOND * spacing;
            patch.ends |= u32::from(is_end) << side;
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
            curvature: 1.0 / wire_radius,
            ends: ends[0] | ends[1] << 1 | ALL_AROUND,
        })
    }

    /// How far the surface is seen to go on to each side, metres, up to about `radius`: a patch that reached over the rim of a bar's end
    /// would hold what slides off there.
    fn seen_extents(&self, tree: &PointTree, normals: &[Vector], index: usize, radius: f32) -> [f32; 4] {
        let place = tree.points()[index];
        let across = self.across();
        let mut seen = [0.0_f32; 4];
        tree.for_each_within(&place, radius, |neighbour| {
            let other = neighbour.index as usize;
            let cosine = normals[other].dot(&self.normal);
            let offset = tree.points()[other] - place;
            let (x, y) = (offset.dot(&self.along), offset.dot(&across));
            let distance = libm::sqrtf(x * x + y * y);
            let ahead = core::f32::consts::FRAC_1_SQRT_2 * distance;
            for (side, (seen, reach)) in seen.iter_mut().zip([x, -x, y, -y]).enumerate() {
                let is_along = side < 2;
                if reach > ahead && cosine > SAME_SIDE {
                    *seen = seen.max(distance);
                } else if reach > ahead && cosine > SAME_BAR && is_along {
                    // On the flank of the bar.
                    *seen = seen.max(reach);
                }
            }
        });
        seen
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

    /// The step from its point to where a wire faces what is the way of `-gradient` from a station; elsewhere the station itself.
    pub(crate) fn facing(&self, station: Vector, gradient: &Vector) -> Vector {
        let across = gradient - self.along * gradient.dot(&self.along);
        station - unit_or(across, -self.normal) * self.wire_radius()
    }

    /// The radius of the wire, metres; 0 if it is none.
    pub(crate) fn wire_radius(&self) -> f32 {
        if self.is_all_around() { 1.0 / self.curvature } else { 0.0 }
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
        // A circle's sagitta.
        let turn = self.curvature * y;
        let below = turn * y / (1.0 + libm::sqrtf((1.0 - turn * turn).max(0.0)));
        self.along * x + across * y - self.normal * below
    }

    /// The unit vector along which the patch pushes a body that it touches at `step` from its point and whose surface, seen alone,
    /// would be pushed along `push`. Where the supporter goes straight on it cannot push along itself: a handle that lies between two
    /// points of a bar, and leans on the next patch of one, slides along that bar as if there were points in between.
    pub(crate) fn push(&self, push: Vector, step: &Vector) -> Vector {
        if self.straight == 0 {
            return push;
        }
        let across = self.across();
        let along = self.along * self.push_over_end(0, step.dot(&self.along), push.dot(&self.along));
        let sideways = push.dot(&across);
        let sideways =
            if self.straight == 1 { sideways } else { self.push_over_end(1, step.dot(&across), sideways) };
        let bare = self.normal * push.dot(&self.normal) + along + across * sideways;
        let length = bare.norm();
        if length > LEAST_PUSH { bare / length } else { push }
    }

    /// What is left of the component of a push in a straight direction, along or across: none, but over the rim where the surface ends.
    fn push_over_end(&self, direction: usize, step: f32, push: f32) -> f32 {
        let side = 2 * direction + usize::from(step < 0.0);
        let is_end = self.ends & 1 << side != 0 && step.abs() > RIM * self.extents[direction];
        if is_end && step * push > 0.0 { push } else { 0.0 }
    }
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
