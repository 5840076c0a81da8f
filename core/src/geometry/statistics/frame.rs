//! Frames that turn with the points that they belong to, so that nothing that is computed in them depends on the frame in which the
//! points are given.

use super::eigenvectors;
use crate::geometry::{Point, Pose, Vector, any_perpendicular, rotation_by};
use crate::monitor::{Meter, Stop};
use nalgebra::{Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// The motion of weighted points to their principal axes: to their mean as the origin, with x along the direction in which they spread
/// most and z along that in which they spread least. The signs are such that the points reach farther towards +x and +y. Where the points
/// spread equally in several directions, and where they are mirror images of themselves, nothing tells the axes or the signs apart.
pub(crate) fn principal_frame<I: Iterator<Item = (Point, f32)>>(
    points: impl Fn() -> I,
    meter: &Meter,
) -> Result<Pose, Stop> {
    let Moments { mean, spread } = Moments::of(points(), meter)?;
    // What single precision leaves of the products is diagonal in the second step.
    let first = axes_of(&spread);
    let rough = first.map(f64::from);
    let [x, y, _] = columns(&(first * axes_of(&(rough.transpose() * spread * rough))));
    let [x, y] = towards_far_side(points(), &mean, [x, y], meter)?;
    let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes.transpose()));
    Ok(to_origin(rotation, &mean))
}

/// The motion of points to their mean as the origin, turned about the unit vector `up` alone: the direction across `up` in which they
/// spread most becomes the perpendicular of `up` that [`any_perpendicular`] gives, y where `up` is z, with the sign of [`principal_frame`].
pub(crate) fn upright_frame<'p, I: Iterator<Item = &'p Point>>(
    points: impl Fn() -> I,
    up: &Vector,
    meter: &Meter,
) -> Result<Pose, Stop> {
    let weighted = || points().map(|point| (*point, 1.0));
    let Moments { mean, spread } = Moments::of(weighted(), meter)?;
    let x = any_perpendicular(*up);
    let (first, second) = (x.cast::<f64>(), up.cross(&x).cast::<f64>());
    let across = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(&(spread * b));
    let twice = libm::atan2(2.0 * across(&first, &second), across(&first, &first) - across(&second, &second));
    let turn = rotation_by(&(up * (0.5 * twice) as f32));
    let long = turn * x;
    let is_reversed = towards_far_side(weighted(), &mean, [long], meter)? != [long];
    let half_turn = if is_reversed { core::f32::consts::PI } else { 0.0 };
    Ok(to_origin(rotation_by(&(up * half_turn)) * turn.inverse(), &mean))
}

/// Mean of weighted points, and of the squares of their offsets from it. Of the sums of many terms, only the additions need double
/// precision, which takes long where the processor has none.
struct Moments {
    mean: Point3<f64>,
    spread: Matrix3<f64>,
}

impl Moments {
    fn of(points: impl Iterator<Item = (Point, f32)>, meter: &Meter) -> Result<Self, Stop> {
        let (mut start, mut weight) = (None, 0.0);
        let (mut sum, mut squares) = (Vector3::zeros(), Matrix3::zeros());
        for (step, (point, of_point)) in points.enumerate() {
            meter.check_at(step)?;
            // Far from the origin, the squares of coordinates have no digits left for their differences.
            let offset = point - *start.get_or_insert(point);
            let weighted = offset * of_point;
            weight += f64::from(of_point);
            sum += weighted.cast::<f64>();
            squares += (weighted * offset.transpose()).cast::<f64>();
        }
        let mean = sum / weight;
        let spread = squares / weight - mean * mean.transpose();
        Ok(Self { mean: start.unwrap_or(Point::origin()).cast() + mean, spread })
    }
}

/// Eigenvectors of a symmetric matrix as columns, those of the largest eigenvalue first.
fn axes_of(spread: &Matrix3<f64>) -> Matrix3<f32> {
    let (values, [a, b, c]) = eigenvectors(spread.cast::<f32>());
    let (mut a, mut b, mut c) = ((values.x, a), (values.y, b), (values.z, c));
    for _ in 0..2 {
        if b.0 > a.0 {
            (a, b) = (b, a);
        }
        if c.0 > b.0 {
            (b, c) = (c, b);
        }
    }
    Matrix3::from_columns(&[a.1, b.1, c.1])
}

fn columns(matrix: &Matrix3<f32>) -> [Vector; 3] {
    [0, 1, 2].map(|k| matrix.column(k).normalize())
}

/// Each of some axes or its reverse: towards the side on which weighted points reach farther from their mean, by the third moment.
fn towards_far_side<const N: usize>(
    points: impl Iterator<Item = (Point, f32)>,
    mean: &Point3<f64>,
    axes: [Vector; N],
    meter: &Meter,
) -> Result<[Vector; N], Stop> {
    let (mean, mut moments) = (mean.cast::<f32>(), axes.map(|axis| (axis, 0.0)));
    for (step, (point, weight)) in points.enumerate() {
        meter.check_at(step)?;
        let offset = point - mean;
        for (axis, moment) in &mut moments {
            let reach = offset.dot(axis);
            *moment += f64::from(weight * reach * reach * reach);
        }
    }
    Ok(moments.map(|(axis, moment)| if moment < 0.0 { -axis } else { axis }))
}

/// The rotation about a point that becomes the origin.
fn to_origin(rotation: UnitQuaternion<f32>, mean: &Point3<f64>) -> Pose {
    let shift = -(rotation * mean.cast::<f32>().coords);
    Pose::from_parts(Translation3::from(shift), rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use std::vec::Vec;

    /// Points without any symmetry, of so many metres.
    fn some(random: &mut Random, size: f32) -> Vec<Point> {
        let mut next = |scale: f32| size * scale * random.next_f32() * random.next_f32();
        (0..200).map(|_| Point::new(next(1.0), next(0.6), next(0.3))).collect()
    }

    fn any_turn(random: &mut Random) -> UnitQuaternion<f32> {
        let mut angle = || 6.0 * random.next_f32();
        UnitQuaternion::from_euler_angles(angle(), angle(), angle())
    }

    fn assert_same(frame: &Pose, points: &[Point], other: &Pose, moved: &[Point], size: f32) {
        for (point, moved) in points.iter().zip(moved) {
            let apart = (frame * point - other * moved).norm();
            assert!(apart < 3e-6 * size, "{apart}");
        }
    }

    #[test]
    fn moved_points_are_at_the_same_place_in_their_frame() {
        let (mut random, meter) = (Random::new(5), Meter::unwatched());
        for size in [1e-3, 0.1, 10.0] {
            for _ in 0..50 {
                let points = some(&mut random, size);
                let motion = Pose::from_parts(Translation3::new(size, -size, size), any_turn(&mut random));
                let moved: Vec<Point> = points.iter().map(|point| motion * point).collect();
                let of = |points: &[Point]| {
                    principal_frame(|| points.iter().map(|point| (*point, 2.0)), &meter).unwrap()
                };
                assert_same(&of(&points), &points, &of(&moved), &moved, size);

                let up = motion.rotation * Vector::z();
                let yaw = UnitQuaternion::from_axis_angle(&nalgebra::Unit::new_unchecked(up), 4.0);
                let yawed: Vec<Point> = moved.iter().map(|point| yaw * point).collect();
                let of = |points: &[Point]| upright_frame(|| points.iter(), &up, &meter).unwrap();
                assert_same(&of(&moved), &moved, &of(&yawed), &yawed, size);
                assert!((of(&moved).rotation * up - up).norm() < 1e-5);
            }
        }
    }

    #[test]
    fn points_on_axes_are_put_there() {
        let (up, meter) = (Vector::z(), Meter::unwatched());
        // Along y most, then along z; farther on the negative sides.
        let points = [
            Point::new(1.0, -3.0, 0.0),
            Point::new(1.0, 0.5, -1.0),
            Point::new(1.0, 0.5, 0.2),
            Point::new(1.0, 1.0, 0.3),
            Point::new(1.0, 1.0, 0.5),
        ];
        let of_all = principal_frame(|| points.iter().map(|point| (*point, 1.0)), &meter).unwrap();
        let upright = upright_frame(|| points.iter(), &up, &meter).unwrap();
        // Of the two axes across up, the long one becomes the one that `any_perpendicular` gives, and up stays.
        let long = any_perpendicular(up);
        for point in &points {
            let (at, reach) = (upright * point, -point.y);
            assert!((of_all * point).z.abs() < 1e-6);
            assert!((at.coords - (long * reach + up * point.z)).norm() < 1e-6, "{at}");
        }
        assert!((of_all * points[0]).x > 2.9);
    }

    #[test]
    fn points_at_one_place_have_a_frame() {
        let meter = Meter::unwatched();
        let points = [Point::new(1.0, 2.0, 3.0); 4];
        let of_all = principal_frame(|| points.iter().map(|point| (*point, 1.0)), &meter).unwrap();
        let upright = upright_frame(|| points.iter(), &Vector::x(), &meter).unwrap();
        for frame in [of_all, upright] {
            assert!((frame * points[0]).coords.norm() < 1e-5 && frame.rotation.norm() > 0.999);
        }
    }
}
