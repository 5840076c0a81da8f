//! Turns of an object after which it looks as before: found on its surface, and taken out of the difference of two poses.

#[cfg(test)]
mod tests;

use super::{DistanceField, Point, Vector, any_perpendicular, eigenvectors};
use crate::monitor::{Meter, Stop};
use core::f32::consts::{PI, TAU};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion};

/// Turns of an object after which it looks as before, about an axis through its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Symmetry {
    /// The axis, in object coordinates: of unit length and either sign where it was detected, of any length but zero where it is
    /// given.
    pub axis: Vector,
    /// 0 for a solid of revolution, which may turn by any angle; n, from 2 to [`MAX_FOLD`], for turns by multiples of an
    /// n-th of a full turn.
    pub fold: u32,
}

/// Maximum of [`Symmetry::fold`]. Turns by steps finer than a degree are no choice of poses: such an object is one of
/// revolution.
pub const MAX_FOLD: u32 = 360;

/// The symmetries of an object.
#[derive(Clone, Copy, Default)]
pub(crate) struct Symmetries {
    slots: [Symmetry; 3],
    count: usize,
}

/// Largest number of samples that are turned: ten of them are on a part of half a percent of the surface, as the smallest handle
/// and the hole by which a disc hangs.
const TURNED: usize = 2000;
/// One sample in so many may be off the surface after a turn, for flaws of the mesh and of the field at edges: less than half of
/// such a part.
const SAMPLES_A_MISS: usize = 500;
/// Distance from the surface, as a share of the object's width across the axis, up to which a turned sample is on it. A
/// polygon of 16 sides still passes for a circle, one of 12 does not.
const ROUGHNESS: f32 = 0.01;
/// The same in voxels, where that is more: the error of the field at sharp edges.
const FIELD_ERROR: f32 = 0.5;
/// Most turns that are looked for about one axis: of a polygon of more sides, or a gear of more teeth, only those that a
/// divisor of their number allows are found.
const MOST_TURNS: u32 = 12;
/// Parts of a full turn after which a solid of revolution looks as before: multiples of the golden section, which are far from
/// every simple fraction.
const REVOLUTION: [f32; 4] = [0.618, 0.236, 0.854, 0.472];

impl Symmetry {
    pub(crate) fn is_valid(&self) -> bool {
        let squared = self.axis.norm_squared();
        squared.is_finite() && squared > 1e-12 && self.fold != 1 && self.fold <= MAX_FOLD
    }

    /// The angle, radians, that is left of a rotation after the turn about the axis that takes most of it away.
    fn angle_after(&self, rotation: &UnitQuaternion<f32>) -> f32 {
        let (axis, q) = (self.axis.normalize(), rotation.quaternion());
        let (along, scalar) = (q.imag().dot(&axis), q.scalar());
        // The turn is 2 half; adding π to half changes nothing.
        let mut half = libm::atan2f(along, scalar);
        if self.fold > 0 {
            let step = PI / self.fold as f32;
            half = libm::roundf(half / step) * step;
        }
        let (sin, cos) = libm::sincosf(half);
        angle_of(scalar * cos + along * sin)
    }

    /// The rotation by `steps` of its steps.
    fn turn(&self, steps: u32) -> UnitQuaternion<f32> {
        turn(&self.axis.normalize(), TAU * steps as f32 / self.fold as f32)
    }
}

impl Default for Symmetry {
    fn default() -> Self {
        Self { axis: Vector::z(), fold: 0 }
    }
}

/// The angle of a rotation, radians, by the scalar part of its quaternion.
fn angle_of(scalar: f32) -> f32 {
    2.0 * libm::acosf(scalar.abs().min(1.0))
}

/// The rotation by an angle about an axis of unit length.
fn turn(axis: &Vector, angle: f32) -> UnitQuaternion<f32> {
    let (sin, cos) = libm::sincosf(0.5 * angle);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis * sin))
}

/// The least angle, radians, that is left of the rotation from one pose of an object to another, in object coordinates, after
/// turns that its symmetries allow: one turn, or two about different axes, which are all there are for the symmetries that
/// can be found.
pub(crate) fn least_angle(symmetries: &[Symmetry], rotation: &UnitQuaternion<f32>) -> f32 {
    let mut least = angle_of(rotation.scalar());
    for (index, one) in symmetries.iter().enumerate() {
        least = least.min(one.angle_after(rotation));
        let others =
            || symmetries.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, other)| other);
        // What looks the same all around two axes is a ball.
        let is_across = |other: &Symmetry| one.axis.normalize().cross(&other.axis.normalize()).norm() > 0.1;
        if one.fold == 0 && others().any(|other| other.fold == 0 && is_across(other)) {
            return 0.0;
        }
        for steps in 1..one.fold {
            let left = one.turn(steps).inverse() * rotation;
            least = others().map(|other| other.angle_after(&left)).fold(least, f32::min);
        }
    }
    least
}

impl Symmetries {
    pub(crate) fn as_slice(&self) -> &[Symmetry] {
        &self.slots[..self.count]
    }

    /// The same about rotated axes.
    pub(crate) fn rotated(self, rotation: &UnitQuaternion<f32>) -> Self {
        let slots = self.slots.map(|Symmetry { axis, fold }| Symmetry { axis: rotation * axis, fold });
        Self { slots, ..self }
    }

    /// Finds symmetries about the principal axes of the object's inertia and, of one that has more than half turns about one
    /// axis alone, half turns across it. A cube has no principal axes of its own; it shows its symmetry only where they happen
    /// to be along its edges. `points` are on the surface and cover it evenly.
    pub(crate) fn find(
        inertia: &Matrix3<f32>,
        centre: &Point,
        field: &DistanceField,
        points: &[Point],
        meter: &Meter,
    ) -> Result<Self, Stop> {
        let trial = Trial { centre, field, points, meter };
        let (_, axes) = eigenvectors(*inertia);
        let mut found = Self::default();
        for axis in axes {
            if let Some(fold) = trial.fold(&axis)? {
                found.push(Symmetry { axis, fold });
            }
        }
        let mut main = found.as_slice().iter().filter(|symmetry| symmetry.fold != 2).copied();
        if let (Some(main), None) = (main.next(), main.next()) {
            // All axes across are principal ones, so that those that were tried mean nothing.
            found.count = 0;
            found.push(main);
            let axis = trial.axis_across(&main);
            if trial.looks_the_same(&axis, PI, trial.tolerance(&axis))? {
                found.push(Symmetry { axis, fold: 2 });
            }
        }
        Ok(found)
    }

    fn push(&mut self, symmetry: Symmetry) {
        self.slots[self.count] = symmetry;
        self.count += 1;
    }
}

/// An object that is turned about its centre of mass.
struct Trial<'a> {
    centre: &'a Point,
    field: &'a DistanceField<'a>,
    points: &'a [Point],
    meter: &'a Meter<'a>,
}

impl Trial<'_> {
    /// The symmetry about an axis with the most turns.
    fn fold(&self, axis: &Vector) -> Result<Option<u32>, Stop> {
        let tolerance = self.tolerance(axis);
        let looks_the_same_after_all = |angles: &mut dyn Iterator<Item = f32>| {
            for angle in angles {
                if !self.looks_the_same(axis, angle, tolerance)? {
                    return Ok(false);
                }
            }
            Ok(true)
        };
        if looks_the_same_after_all(&mut REVOLUTION.iter().map(|part| TAU * part))? {
            return Ok(Some(0));
        }
        for fold in (2..=MOST_TURNS).rev() {
            // A turn may leave so little that all of them together do not.
            let angle = |steps: u32| TAU * steps as f32 / fold as f32;
            if looks_the_same_after_all(&mut (1..=fold / 2).map(angle))? {
                return Ok(Some(fold));
            }
        }
        Ok(None)
    }

    /// Distance from the surface up to which a point is on it after a turn about an axis, metres.
    fn tolerance(&self, axis: &Vector) -> f32 {
        (FIELD_ERROR * self.field.voxel_size()).max(ROUGHNESS * 2.0 * self.radius(axis))
    }

    /// Whether the points are on the surface after a turn, to within a tolerance in metres.
    fn looks_the_same(&self, axis: &Vector, angle: f32, tolerance: f32) -> Result<bool, Stop> {
        self.meter.check_cancelled()?;
        let stride = self.points.len().div_ceil(TURNED).max(1);
        let rotation = turn(axis, angle).to_rotation_matrix();
        let is_off = |point: &&Point| {
            let turned = self.centre + rotation * (*point - self.centre);
            self.field.distance(&turned).abs() > tolerance
        };
        let most = self.points.len() / stride / SAMPLES_A_MISS;
        Ok(self.points.iter().step_by(stride).filter(is_off).nth(most).is_none())
    }

    /// The largest distance of a point from the axis, metres.
    fn radius(&self, axis: &Vector) -> f32 {
        let square = |point: &Point| (point - self.centre).cross(axis).norm_squared();
        libm::sqrtf(self.points.iter().map(square).fold(0.0, f32::max))
    }

    /// Where the axis of a half turn is across an axis, if there is one.
    fn axis_across(&self, main: &Symmetry) -> Vector {
        let x = any_perpendicular(main.axis);
        let y = main.axis.cross(&x);
        let radius = self.radius(&main.axis).max(f32::MIN_POSITIVE);
        // A half turn about the direction φ takes the angle α to 2φ - α. It leaves the sum of the n-th powers of x + iy as it is,
        // so that their angle is n φ, up to half turns. What is far out counts most, because it shows the corners.
        let (mut re, mut im) = (0.0, 0.0);
        for point in self.points {
            let offset = (point - self.centre) / radius;
            let (a, b) = (offset.dot(&x), offset.dot(&y));
            let square = a * a + b * b;
            let (mut power, mut weight) = ((1.0, 0.0), square);
            for _ in 0..3 {
                weight *= weight;
            }
            for _ in 0..main.fold {
                power = (power.0 * a - power.1 * b, power.0 * b + power.1 * a);
            }
            (re, im) = (re + weight * power.0, im + weight * power.1);
        }
        let (sin, cos) = libm::sincosf(libm::atan2f(im, re) / main.fold.max(1) as f32);
        x * cos + y * sin
    }
}
