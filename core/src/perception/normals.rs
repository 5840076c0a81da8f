//! Normals for clouds that have none: the direction in which a neighbourhood is thinnest, and which side of it
//! is outside.

use crate::geometry::{Neighbour, Point, PointTree, Vector, least_eigenvector};
use crate::heap::Heap;
use crate::memory::{Arena, OutOfMemory, array_bytes};
use nalgebra::Matrix3;

/// Points that a normal is fitted to, itself included.
const NEIGHBOURS: usize = 16;

/// Bytes of working memory for a cloud of `points`.
pub(crate) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<u32>(points).saturating_mul(5)
}

/// Fills in the normals, in tree order, that are zero, and returns how many they were.
///
/// Where some normals are known, the others are turned like the known ones around them. Where none is, they face
/// the `viewpoint` if there is one, and else are made consistent from point to point, from the top of each part
/// of the cloud on, where outside is `up` (Hoppe et al. 1992, "Surface Reconstruction from Unorganized Points").
pub(crate) fn complete(
    tree: &PointTree,
    normals: &mut [Vector],
    viewpoint: Option<Point>,
    up: Vector,
    scratch: Arena,
) -> Result<usize, OutOfMemory> {
    let missing = normals.iter().filter(|n| **n == Vector::zeros()).count();
    if missing == normals.len() {
        for (normal, point) in normals.iter_mut().zip(tree.points()) {
            *normal = fit(tree, point);
        }
        match viewpoint {
            Some(viewpoint) => face(tree, normals, viewpoint),
            None => propagate(tree, normals, up, scratch)?,
        }
    } else if missing > 0 {
        follow_neighbours(tree, normals, up, scratch)?;
    }
    Ok(missing)
}

/// The direction, of either sign, in which the neighbourhood of `point` is thinnest.
fn fit(tree: &PointTree, point: &Point) -> Vector {
    let mut found = [Neighbour::default(); NEIGHBOURS];
    let neighbours = tree.k_nearest(point, &mut found);
    let offsets = || neighbours.iter().map(|n| tree.points()[n.index as usize] - point);
    let mean = offsets().sum::<Vector>() / neighbours.len() as f32;
    // Scaled by the reach, so that the squares of millimetres keep their precision.
    let reach = offsets().map(|offset| offset.amax()).fold(f32::MIN_POSITIVE, f32::max);
    let covariance: Matrix3<f32> =
        offsets().map(|offset| (offset - mean) / reach).map(|offset| offset * offset.transpose()).sum();
    least_eigenvector(covariance)
}

fn face(tree: &PointTree, normals: &mut [Vector], viewpoint: Point) {
    for (normal, point) in normals.iter_mut().zip(tree.points()) {
        if normal.dot(&(viewpoint - point)) < 0.0 {
            *normal = -*normal;
        }
    }
}

/// Turns all normals consistently along a tree that crosses the sharpest bends last.
fn propagate(
    tree: &PointTree,
    normals: &mut [Vector],
    up: Vector,
    mut scratch: Arena,
) -> Result<(), OutOfMemory> {
    let points = tree.points();
    let from_top = scratch.slice::<u32>(points.len())?;
    let parents = scratch.slice::<u32>(points.len())?;
    let weights = scratch.slice::<f32>(points.len())?;
    let (order, places) = (scratch.slice::<u32>(points.len())?, scratch.slice::<u32>(points.len())?);
    for (slot, index) in from_top.iter_mut().zip(0..) {
        *slot = index;
    }
    let height = |&index: &u32| points[index as usize].coords.dot(&up);
    from_top.sort_unstable_by(|a, b| height(b).total_cmp(&height(a)).then(a.cmp(b)));
    // A point that is done is its own parent no more.
    const WAITING: u32 = u32::MAX;
    const DONE: u32 = u32::MAX - 1;
    parents.fill(WAITING);
    let mut heap = Heap::empty(weights, order, places);
    for &top in from_top.iter() {
        if parents[top as usize] == DONE {
            continue;
        }
        heap.offer(top as usize, 0.0);
        while let Some(index) = heap.pop() {
            let like = if parents[index] == WAITING { up } else { normals[parents[index] as usize] };
            if normals[index].dot(&like) < 0.0 {
                normals[index] = -normals[index];
            }
            parents[index] = DONE;
            let mut found = [Neighbour::default(); NEIGHBOURS];
            for neighbour in tree.k_nearest(&points[index], &mut found) {
                let other = neighbour.index as usize;
                if parents[other] != DONE && heap.offer(other, normals[index].dot(&normals[other]).abs()) {
                    parents[other] = index as u32;
                }
            }
        }
    }
    Ok(())
}

/// Fits the missing normals and turns them like the known ones around them, or up where there are none.
fn follow_neighbours(
    tree: &PointTree,
    normals: &mut [Vector],
    up: Vector,
    mut scratch: Arena,
) -> Result<(), OutOfMemory> {
    let is_missing = scratch.slice::<u32>(normals.len())?;
    for (flag, normal) in is_missing.iter_mut().zip(normals.iter()) {
        *flag = u32::from(*normal == Vector::zeros());
    }
    for index in (0..normals.len()).filter(|&index| is_missing[index] == 1) {
        let point = &tree.points()[index];
        let mut found = [Neighbour::default(); NEIGHBOURS];
        let around: Vector = tree
            .k_nearest(point, &mut found)
            .iter()
            .map(|neighbour| neighbour.index as usize)
            .filter(|&other| is_missing[other] == 0)
            .map(|other| normals[other])
            .sum();
        let normal = fit(tree, point);
        let like = if around == Vector::zeros() { up } else { around };
        normals[index] = if normal.dot(&like) < 0.0 { -normal } else { normal };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::perception::sampling;
    use crate::test_shapes;

    /// Calls `check` with samples of a tilted torus, their true normals, and what `complete` makes of `known`.
    fn with_completed(
        known: impl Fn(usize, Vector) -> Vector,
        viewpoint: Option<Point>,
        check: impl Fn(&[Point], &[Vector], &[Vector], usize),
    ) {
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, 0.2, 0.0);
        let shape = test_shapes::torus(0.04, 0.012, 64, 32).map(|p| turn * p);
        let n = 3000;
        let (mut points, mut truth) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n]);
        let mut memory = vec![0; sampling::sample_bytes(n)];
        sampling::sample(&shape.mesh(), 1, &mut points, &mut truth, &mut memory).unwrap();

        let needed = model_bytes(PointTree::bytes(n) + PointTree::scratch_bytes(n).max(scratch_bytes(n)));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let points: Vec<Point> = points.into_iter().map(Into::into).collect();
        let tree = PointTree::build(&points, &mut arena).unwrap();
        let truth: Vec<Vector> = tree.order().iter().map(|&i| truth[i as usize].into()).collect();
        let mut normals: Vec<Vector> =
            truth.iter().enumerate().map(|(i, &normal)| known(i, normal)).collect();
        let missing = complete(&tree, &mut normals, viewpoint, Vector::z(), arena.scratch()).unwrap();
        check(tree.points(), &truth, &normals, missing);
    }

    #[test]
    fn propagated_over_a_torus_all_face_out() {
        with_completed(
            |_, _| Vector::zeros(),
            None,
            |_, truth, normals, missing| {
                assert_eq!(missing, 3000);
                assert!(truth.iter().zip(normals).all(|(t, n)| t.dot(n) > 0.95));
            },
        );
    }

    #[test]
    fn viewpoint_decides_the_side() {
        let eye = Point::new(0.0, 0.0, 1.0);
        with_completed(
            |_, _| Vector::zeros(),
            Some(eye),
            |points, truth, normals, _| {
                for ((point, t), n) in points.iter().zip(truth).zip(normals) {
                    assert!(n.dot(&(eye - point)) >= 0.0 && t.dot(n).abs() > 0.95);
                }
            },
        );
    }

    #[test]
    fn a_few_missing_ones_follow_their_neighbours() {
        // Known normals point inwards here, to see that they are what is followed.
        let known = |i: usize, normal: Vector| if i.is_multiple_of(7) { Vector::zeros() } else { -normal };
        with_completed(known, None, |_, truth, normals, missing| {
            assert_eq!(missing, 3000_usize.div_ceil(7));
            assert!(truth.iter().zip(normals).all(|(t, n)| t.dot(n) < -0.95));
        });
    }

    #[test]
    fn one_point_gets_a_unit_normal() {
        let needed = model_bytes(PointTree::bytes(1) + scratch_bytes(1));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let tree = PointTree::build(&[Point::origin()], &mut arena).unwrap();
        let mut normals = [Vector::zeros()];
        complete(&tree, &mut normals, None, Vector::z(), arena.scratch()).unwrap();
        assert!((normals[0].norm() - 1.0).abs() < 1e-5);
    }
}
