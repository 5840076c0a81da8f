//! Clustering by mean shift.

use crate::geometry::{Point, PointTree, Vector};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use bytemuck::{Pod, Zeroable};

/// A mode that mean shift found.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Mode {
    position: [f32; 3],
    /// Number of points within the bandwidth.
    support: u32,
}

/// Distance between starting points, in bandwidths: with a smaller one, hardly more modes are found.
const SEED_DISTANCE: f32 = 0.5;
/// Step below which a mode has converged, as a fraction of the bandwidth.
const CONVERGED: f32 = 1e-3;
/// Steps after which a mode that has not converged is used as it is.
const MAX_STEPS: usize = 300;

/// Bytes of working memory for [`cluster`] over `points`.
pub(crate) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<Mode>(points)
}

/// Mean shift with a flat kernel of radius `bandwidth` (Comaniciu and Meer 2002): writes the cluster of each point
/// of `tree` into `labels` and returns how many clusters there are.
///
/// The search starts from points that lie apart, taken in the order in which `seeds` names them, so that the
/// clusters do not depend on the frame. Modes closer than the bandwidth are one: the one with
/// more support, then the earlier. A point belongs to the nearest mode. Some clusters may be empty.
pub(crate) fn cluster(
    tree: &PointTree,
    seeds: &[u32],
    bandwidth: f32,
    labels: &mut [u32],
    mut scratch: Arena,
    meter: &Meter,
) -> Result<usize, Unfinished> {
    let modes = scratch.slice::<Mode>(tree.points().len())?;
    let apart = |a: &Point, b: &Point, distance: f32| (a - b).norm_squared() >= distance * distance;
    // Starting points stand in `modes` until they are shifted.
    let mut count = 0;
    for (step, &seed) in seeds.iter().enumerate() {
        meter.check_at(step)?;
        let seed = tree.points()[seed as usize];
        if modes[..count].iter().all(|mode| apart(&mode.position.into(), &seed, SEED_DISTANCE * bandwidth)) {
            modes[count] = Mode { position: seed.into(), support: 0 };
            count += 1;
        }
    }
    for mode in &mut modes[..count] {
        *mode = shift(tree, mode.position.into(), bandwidth, meter)?;
    }
    // Stable, so that equals stay in the order of the seeds: an insertion sort, as there are few.
    for i in 1..count {
        let place = modes[..i].partition_point(|mode| mode.support >= modes[i].support);
        modes[place..=i].rotate_right(1);
    }
    let mut kept = 0;
    for i in 0..count {
        meter.check_at(i)?;
        let position = modes[i].position.into();
        if modes[..kept].iter().all(|mode| apart(&mode.position.into(), &position, bandwidth)) {
            modes[kept] = modes[i];
            kept += 1;
        }
    }
    for (step, (label, point)) in labels.iter_mut().zip(tree.points()).enumerate() {
        meter.check_at(step)?;
        let distance = |mode: &Mode| (Point::from(mode.position) - point).norm_squared();
        *label = nearest_of(modes[..kept].iter().map(distance));
    }
    Ok(kept)
}

/// Moves a mode uphill until it converges.
fn shift(tree: &PointTree, mut position: Point, bandwidth: f32, meter: &Meter) -> Result<Mode, Stop> {
    let mut support = 0;
    for _ in 0..MAX_STEPS {
        meter.check_cancelled()?;
        let mut offset = Vector::zeros();
        support = 0;
        tree.for_each_within(&position, bandwidth, |neighbour| {
            offset += tree.points()[neighbour.index as usize] - position;
            support += 1;
        });
        // The mean of points within the bandwidth has one of them within the bandwidth, so only rounding can
        // leave it alone.
        let step = offset / (support.max(1)) as f32;
        position += step;
        if step.norm() < CONVERGED * bandwidth {
            break;
        }
    }
    Ok(Mode { position: position.into(), support })
}

/// The position of the least distance, the first of equal ones.
fn nearest_of(distances: impl Iterator<Item = f32>) -> u32 {
    distances.zip(0..).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, index)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;

    fn gaussian_blobs(centres: &[Point], each: usize, spread: f32, seed: u64) -> Vec<Point> {
        let mut random = Random::new(seed);
        let mut about_zero = || (0..12).map(|_| random.next_f32() - 0.5).sum::<f32>() * spread;
        centres
            .iter()
            .flat_map(|c| vec![*c; each])
            .map(|c| c + Vector::new(about_zero(), about_zero(), about_zero()))
            .collect()
    }

    /// The labels in the order of `points`.
    fn clusters_of(points: &[Point], bandwidth: f32) -> (usize, Vec<u32>) {
        let n = points.len();
        let needed = model_bytes(PointTree::bytes(n) + scratch_bytes(n));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let tree = PointTree::build(points, &mut arena, &Meter::unwatched()).unwrap();
        let mut labels = vec![0; n];
        let mut place = vec![0; n];
        for (i, &item) in tree.order().iter().enumerate() {
            place[item as usize] = i as u32;
        }
        let count =
            cluster(&tree, &place, bandwidth, &mut labels, arena.scratch(), &Meter::unwatched()).unwrap();
        (count, place.iter().map(|&i| labels[i as usize]).collect())
    }

    #[test]
    fn mean_shift_finds_the_blobs_in_any_frame() {
        let centres = [Point::new(0.0, 0.0, 0.0), Point::new(1.0, 0.2, 0.0), Point::new(0.3, 0.9, 0.5)];
        let points = gaussian_blobs(&centres, 150, 0.08, 3);
        let (count, labels) = clusters_of(&points, 0.35);
        assert_eq!(count, 3);
        for blob in labels.chunks(150) {
            assert!(blob.iter().all(|&label| label == blob[0]));
        }
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -2.0);
        let turned: Vec<Point> = points.iter().map(|p| turn * p + Vector::new(3.0, -2.0, 1.0)).collect();
        assert_eq!(clusters_of(&turned, 0.35), (count, labels));
    }

    #[test]
    fn modes_are_means_of_what_is_around_them() {
        let mut random = Random::new(9);
        let points: Vec<Point> = (0..400).map(|_| Point::from([(); 3].map(|()| random.next_f32()))).collect();
        let needed = model_bytes(PointTree::bytes(400));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let tree = PointTree::build(&points, &mut arena, &Meter::unwatched()).unwrap();
        for start in &points[..40] {
            let mode = shift(&tree, *start, 0.3, &Meter::unwatched()).unwrap();
            let position = Point::from(mode.position);
            let near: Vec<_> = points.iter().filter(|p| (*p - position).norm() <= 0.3).collect();
            let mean = near.iter().fold(Vector::zeros(), |sum, p| sum + p.coords) / near.len() as f32;
            assert!((mean - position.coords).norm() < 2.0 * CONVERGED * 0.3);
            assert!(near.len().abs_diff(mode.support as usize) <= 1);
        }
    }

    #[test]
    fn one_point_is_one_cluster() {
        assert_eq!(clusters_of(&[Point::new(1.0, 2.0, 3.0)], 0.1), (1, vec![0]));
        assert_eq!(clusters_of(&[Point::new(1.0, 2.0, 3.0); 50], 0.1), (1, vec![0; 50]));
    }
}
