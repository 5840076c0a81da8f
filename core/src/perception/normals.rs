//! Normals for clouds that have none: the direction in which a neighbourhood is thinnest, and which side of it
//! is outside.

use super::orientation::{self, Given};
use super::visibility;
use crate::geometry::{Neighbour, Point, PointTree, Vector, Viewpoints, eigenvectors};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use nalgebra::Matrix3;

/// One in so many of the points that vote on the side of a cloud also tells whether its normals are those of the surface.
const TESTED: usize = 4;
/// Points that a normal is fitted to, itself included.
const NEIGHBOURS: usize = 16;
/// Variance of a neighbourhood along its normal, as a share of the lesser one along its surface, up to which it is flat: 0.09 with noise of
/// a third of the spacing, 0.3 and more in a blob without a surface or along a wire. Set by hand.
const FLAT: f32 = 0.1;
/// Mean cosine between given normals and those of flat neighbourhoods below which the given ones are no normals of the surface: 0.5 if
/// they are random or all the same, and above 0.9 for those of a surface with noise. Set by hand.
const MIN_COSINE: f32 = 0.75;

/// Bytes of working memory for a cloud of `points`.
pub(crate) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<u32>(points).saturating_add(orientation::scratch_bytes(points))
}

/// What was done to normals that were given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Changed {
    /// Some or all were reversed: how many.
    Reversed(usize),
    /// All were estimated anew.
    Replaced,
}

/// Fills in the normals, in tree order, that are zero, reverses given ones that point into the solid or to either side, and
/// replaces all if the given ones do not stand on the surface.
///
/// Where some normals are known, the others take the side of the known ones around them. Where none is, or the known
/// ones have no consistent side, they face the viewpoint if there is one that can have seen them all, and otherwise the
/// outside that [`orientation::orient`] finds. `spacings`, the distances between points around each, are in metres.
pub(crate) fn complete(
    tree: &PointTree,
    normals: &mut [Vector],
    spacings: &[f32],
    viewpoints: Viewpoints,
    up: Vector,
    mut scratch: Arena,
    meter: &Meter,
) -> Result<Changed, Unfinished> {
    let missing = normals.iter().filter(|n| **n == Vector::zeros()).count();
    let orient = |normals: &mut [Vector], scratch| match viewpoints.single() {
        Some(viewpoint) if visibility::explain(tree, normals, spacings, viewpoints, meter)? => {
            face(tree, normals, &viewpoint);
            Ok(())
        }
        _ => orientation::orient(tree, normals, spacings, (viewpoints, up), scratch, meter),
    };
    let are_missing = missing == normals.len();
    if are_missing || !stand_on_surface(tree, normals, meter)? {
        tree.for_each_k_nearest::<NEIGHBOURS>(meter, |index, neighbours| {
            normals[index] = fit(tree, &tree.points()[index], neighbours).0;
        })?;
        orient(normals, scratch)?;
        return Ok(if are_missing { Changed::Reversed(0) } else { Changed::Replaced });
    }
    if missing > 0 {
        follow_neighbours(tree, normals, up, scratch.scratch(), meter)?;
    }
    match orientation::judge(tree, normals, meter)? {
        Given::Outwards => Ok(Changed::Reversed(0)),
        Given::Inwards => {
            normals.iter_mut().for_each(|normal| *normal = -*normal);
            Ok(Changed::Reversed(normals.len()))
        }
        Given::Unoriented => {
            let first = |normal: &Vector| u32::from(leading_sign(normal));
            let before = scratch.slice::<u32>(normals.len())?;
            before.iter_mut().zip(normals.iter()).for_each(|(before, normal)| *before = first(normal));
            orient(normals, scratch)?;
            let is_reversed = |(before, normal): &(&u32, &Vector)| **before != first(normal);
            Ok(Changed::Reversed(before.iter().zip(normals.iter()).filter(is_reversed).count()))
        }
    }
}

/// The sign of the first component that is not zero, true if positive.
fn leading_sign(normal: &Vector) -> bool {
    normal.iter().find(|x| **x != 0.0).is_some_and(|x| *x > 0.0)
}

/// Whether the given normals are, but for their signs, those of the surface on which the points are, as far as it is flat enough to
/// tell. Those of a cloud without a surface pass.
fn stand_on_surface(tree: &PointTree, normals: &[Vector], meter: &Meter) -> Result<bool, Stop> {
    let (mut known, mut flat, mut cosines) = (0, 0, 0.0);
    for index in orientation::voters(normals.len()).step_by(TESTED) {
        meter.check_cancelled()?;
        let (Some(point), Some(given)) = (tree.points().get(index), normals.get(index)) else { continue };
        if *given == Vector::zeros() {
            continue;
        }
        let mut found = [Neighbour::default(); NEIGHBOURS];
        let (normal, thinness) = fit(tree, point, tree.k_nearest(point, &mut found));
        known += 1;
        if thinness <= FLAT {
            flat += 1;
            cosines += normal.dot(given).abs();
        }
    }
    Ok(2 * flat < known || cosines >= MIN_COSINE * flat as f32)
}

/// The direction, of either sign, in which the `neighbours` of `point` are thinnest, and their variance along it as a share of that in the
/// next direction; 1 where they are on a line.
fn fit(tree: &PointTree, point: &Point, neighbours: &[Neighbour]) -> (Vector, f32) {
    let offsets = || neighbours.iter().map(|n| tree.points()[n.index as usize] - point);
    let mean = offsets().sum::<Vector>() / neighbours.len() as f32;
    // Scaled by the reach, so that the squares of millimetres keep their precision.
    let reach = offsets().map(|offset| offset.amax()).fold(f32::MIN_POSITIVE, f32::max);
    let covariance: Matrix3<f32> =
        offsets().map(|offset| (offset - mean) / reach).map(|offset| offset * offset.transpose()).sum();
    let (variances, directions) = eigenvectors(covariance);
    let least = variances.imin();
    let next = variances[(least + 1) % 3].min(variances[(least + 2) % 3]);
    let thinness = if next > f32::EPSILON * variances.max() { variances[least] / next } else { 1.0 };
    (directions[least], thinness)
}

fn face(tree: &PointTree, normals: &mut [Vector], viewpoint: &Point) {
    for (normal, point) in normals.iter_mut().zip(tree.points()) {
        if normal.dot(&(viewpoint - point)) < 0.0 {
            *normal = -*normal;
        }
    }
}

/// Fits the missing normals and turns them like the known ones around them, or up where there are none.
fn follow_neighbours(
    tree: &PointTree,
    normals: &mut [Vector],
    up: Vector,
    mut scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    let is_missing = scratch.slice::<u32>(normals.len())?;
    for (flag, normal) in is_missing.iter_mut().zip(normals.iter()) {
        *flag = u32::from(*normal == Vector::zeros());
    }
    for index in (0..normals.len()).filter(|&index| is_missing[index] == 1) {
        meter.check_cancelled()?;
        let point = &tree.points()[index];
        let mut found = [Neighbour::default(); NEIGHBOURS];
        let neighbours = tree.k_nearest(point, &mut found);
        let around: Vector = neighbours
            .iter()
            .map(|neighbour| neighbour.index as usize)
            .filter(|&other| is_missing[other] == 0)
            .map(|other| normals[other])
            .sum();
        let (normal, _) = fit(tree, point, neighbours);
        let like = if around == Vector::zeros() { up } else { around };
        normals[index] = if normal.dot(&like) < 0.0 { -normal } else { normal };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::memory::model_bytes;
    use crate::perception::cleaning::spacing;
    use crate::perception::sampling;
    use crate::test_shapes;

    fn spacings(tree: &PointTree) -> Vec<f32> {
        let mut spacings = vec![0.0; tree.points().len()];
        spacing::measure(tree, &mut spacings, &Meter::unwatched()).unwrap();
        spacings
    }

    /// Calls `check` with samples of a tilted torus, their true normals, and what `complete` makes of `known`.
    fn with_completed(
        known: impl Fn(usize, Vector) -> Vector,
        viewpoints: &[Point],
        check: impl Fn(&[Point], &[Vector], &[Vector], Changed),
    ) {
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, 0.2, 0.0);
        let shape = test_shapes::torus(0.04, 0.012, 64, 32).map(|p| turn * p);
        let n = 3000;
        let (mut points, mut truth) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n]);
        let mut memory = vec![0; sampling::sample_bytes(n)];
        sampling::sample(&shape.mesh(), 1, &mut points, &mut truth, &mut memory).unwrap();

        let needed = model_bytes(PointTree::bytes(n) + scratch_bytes(n));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let points: Vec<Point> = points.into_iter().map(Into::into).collect();
        let tree = PointTree::build(&points, &mut arena, &Meter::unwatched()).unwrap();
        let truth: Vec<Vector> = tree.order().iter().map(|&i| truth[i as usize].into()).collect();
        let mut normals: Vec<Vector> =
            truth.iter().enumerate().map(|(i, &normal)| known(i, normal)).collect();
        let spacings = spacings(&tree);
        let changed = complete(
            &tree,
            &mut normals,
            &spacings,
            Viewpoints::new(viewpoints, &Pose::identity()),
            Vector::z(),
            arena.scratch(),
            &Meter::unwatched(),
        )
        .unwrap();
        check(tree.points(), &truth, &normals, changed);
    }

    #[test]
    fn propagated_over_a_torus_all_face_out() {
        with_completed(
            |_, _| Vector::zeros(),
            &[],
            |_, truth, normals, changed| {
                assert_eq!(changed, Changed::Reversed(0));
                assert!(truth.iter().zip(normals).all(|(t, n)| t.dot(n) > 0.95));
            },
        );
    }

    #[test]
    fn viewpoint_decides_the_side_of_what_it_can_have_seen() {
        let eye = Point::new(0.0, 0.0, 1.0);
        // One that cannot have seen the far side does not decide on it.
        with_completed(
            |_, _| Vector::zeros(),
            &[eye],
            |points, truth, normals, _| {
                for ((point, t), n) in points.iter().zip(truth).zip(normals) {
                    assert!(t.dot(n) > 0.95, "{point}");
                }
            },
        );
    }

    #[test]
    fn several_viewpoints_decide_the_side_of_a_plate() {
        // Both sides of a plate of 4 mm, one seen from above and one from below.
        let points: Vec<Point> = (0..2 * 900)
            .map(|i| {
                Point::new(0.002 * (i % 30) as f32, 0.002 * (i / 30 % 30) as f32, 0.004 * (i / 900) as f32)
            })
            .collect();
        let n = points.len();
        let needed = model_bytes(PointTree::bytes(n) + scratch_bytes(n));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let tree = PointTree::build(&points, &mut arena, &Meter::unwatched()).unwrap();
        let mut normals = vec![Vector::zeros(); n];
        let eyes = [Point::new(0.03, 0.03, 0.5), Point::new(0.03, 0.03, -0.5)];
        complete(
            &tree,
            &mut normals,
            &spacings(&tree),
            Viewpoints::new(&eyes, &Pose::identity()),
            Vector::z(),
            arena.scratch(),
            &Meter::unwatched(),
        )
        .unwrap();
        // Normals at the rim lean over it.
        let is_inside = |(p, _): &(&Point, &Vector)| [p.x, p.y].iter().all(|x| (0.007..0.051).contains(x));
        for (p, n) in tree.points().iter().zip(&normals).filter(is_inside) {
            assert!(n.z * (p.z - 0.002) > 0.0, "{p} {n}");
        }
    }

    #[test]
    fn a_few_missing_ones_follow_their_neighbours() {
        // Known normals point inwards here, so that the missing ones are seen to follow them; then all are reversed.
        let known = |i: usize, normal: Vector| if i.is_multiple_of(7) { Vector::zeros() } else { -normal };
        with_completed(known, &[], |_, truth, normals, changed| {
            assert_eq!(changed, Changed::Reversed(3000));
            assert!(truth.iter().zip(normals).all(|(t, n)| t.dot(n) > 0.95));
        });
    }

    #[test]
    fn given_normals_that_point_inwards_are_reversed() {
        with_completed(
            |_, normal| -normal,
            &[],
            |_, truth, normals, changed| {
                assert_eq!(changed, Changed::Reversed(3000));
                assert!(truth.iter().zip(normals).all(|(t, n)| t == n));
            },
        );
    }

    #[test]
    fn given_normals_of_random_sign_are_turned_outwards() {
        let sign = |i: usize| if i.wrapping_mul(2_654_435_761) & 64 == 0 { 1.0 } else { -1.0 };
        with_completed(
            |i, normal| normal * sign(i),
            &[],
            |_, truth, normals, changed| {
                let wrong = (0..3000).filter(|&i| sign(i) < 0.0).count();
                assert!(wrong > 1000 && changed == Changed::Reversed(wrong));
                assert!(truth.iter().zip(normals).all(|(t, n)| t == n));
            },
        );
    }

    #[test]
    fn given_normals_that_do_not_stand_on_the_surface_are_estimated_anew() {
        let mut random = crate::random::Random::new(1);
        let directions: Vec<Vector> =
            (0..3000).map(|_| Vector::from_fn(|_, _| random.next_f32() - 0.5).normalize()).collect();
        let at_random = |i: usize, _: Vector| directions[i];
        let all_the_same = |_: usize, _: Vector| Vector::z();
        for given in [&at_random as &dyn Fn(usize, Vector) -> Vector, &all_the_same] {
            with_completed(given, &[], |_, truth, normals, changed| {
                assert_eq!(changed, Changed::Replaced);
                assert!(truth.iter().zip(normals).all(|(t, n)| t.dot(n) > 0.95));
            });
        }
    }

    /// Noise of a camera, which turns normals by up to 40 degrees.
    #[test]
    fn given_normals_with_noise_stay() {
        let mut random = crate::random::Random::new(2);
        let lean: Vec<Vector> = (0..3000).map(|_| Vector::from_fn(|_, _| random.next_f32() - 0.5)).collect();
        with_completed(
            |i, normal| (normal + lean[i]).normalize(),
            &[],
            |_, truth, normals, changed| {
                assert_eq!(changed, Changed::Reversed(0));
                assert!(truth.iter().zip(normals).zip(&lean).all(|((t, n), l)| *n == (t + l).normalize()));
            },
        );
    }

    #[test]
    fn given_normals_that_are_right_stay() {
        with_completed(
            |_, normal| normal,
            &[],
            |_, truth, normals, changed| {
                assert_eq!(changed, Changed::Reversed(0));
                assert!(truth.iter().zip(normals).all(|(t, n)| t == n));
            },
        );
    }

    #[test]
    fn one_point_gets_a_unit_normal() {
        let needed = model_bytes(PointTree::bytes(1) + scratch_bytes(1));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let tree = PointTree::build(&[Point::origin()], &mut arena, &Meter::unwatched()).unwrap();
        let mut normals = [Vector::zeros()];
        complete(
            &tree,
            &mut normals,
            &[0.0],
            Viewpoints::new(&[], &Pose::identity()),
            Vector::z(),
            arena.scratch(),
            &Meter::unwatched(),
        )
        .unwrap();
        assert!((normals[0].norm() - 1.0).abs() < 1e-5);
    }
}
