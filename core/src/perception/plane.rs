//! The plane that most points of a cloud are on: random sample consensus (Fischler and Bolles, Communications of the ACM,
//! 1981), then least squares.

use crate::geometry::{Point, Vector, least_eigenvector};
use crate::random::Random;
use nalgebra::Matrix3;

/// Triples of points that are tried. One in 27 lies on a plane that has a third of the points; a plane with a fifth is
/// missed once in five runs, and then tried again when another has been taken out.
const TRIALS: usize = 192;
/// Times that the best plane is fitted to the points on it: the better plane has other points.
const FITS: usize = 2;

/// A plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// A point on it.
    pub(super) origin: Point,
    /// Unit normal, of either sign.
    pub(super) normal: Vector,
}

impl Plane {
    /// The plane with the most points within `tolerance` metres, if they are more than `least`. The same points and state
    /// of the generator give the same plane.
    pub(super) fn search(
        points: &[Point],
        tolerance: f32,
        least: usize,
        random: &mut Random,
    ) -> Option<Self> {
        let (mut best, mut most) = (None, least);
        if points.len() < 3 {
            return None;
        }
        for _ in 0..TRIALS {
            let [a, b, c] = core::array::from_fn(|_| points[random.next_u32() as usize % points.len()]);
            let Some(normal) = (b - a).cross(&(c - a)).try_normalize(tolerance * tolerance) else { continue };
            let plane = Self { origin: a, normal };
            if let Some(count) = plane.count_above(points, tolerance, most) {
                (best, most) = (Some(plane), count);
            }
        }
        (0..FITS).fold(best, |plane, _| plane.map(|plane| plane.fitted(points, tolerance)))
    }

    /// The number of points within `tolerance` metres, if they are more than `most`.
    fn count_above(&self, points: &[Point], tolerance: f32, most: usize) -> Option<usize> {
        let (mut count, mut left) = (0, points.len());
        for part in points.chunks(256) {
            // Without a branch, so that several are counted at once.
            count += part.iter().map(|p| u32::from(self.distance(p) < tolerance)).sum::<u32>() as usize;
            left -= part.len();
            if count + left <= most {
                return None;
            }
        }
        (count > most).then_some(count)
    }

    /// Distance of a point, metres.
    pub(super) fn distance(&self, point: &Point) -> f32 {
        (point - self.origin).dot(&self.normal).abs()
    }

    /// The plane of least squares through the points on this one.
    fn fitted(&self, points: &[Point], tolerance: f32) -> Self {
        let on_plane = || points.iter().filter(|p| self.distance(p) < tolerance).map(|p| p - self.origin);
        let count = on_plane().count().max(1) as f32;
        let mean = on_plane().sum::<Vector>() / count;
        let spread: Matrix3<f32> = on_plane().map(|p| (p - mean) * (p - mean).transpose()).sum();
        Self { origin: self.origin + mean, normal: least_eigenvector(spread) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_noisy_plane_among_clutter() {
        for seed in 0..10 {
            let mut random = Random::new(seed);
            let mut next = |size: f32| size * (random.next_f32() - 0.5);
            let normal = Vector::new(0.3, -0.2, 1.0).normalize();
            let place = |x, y, z| Point::new(x, y, 0.1 + z - (0.3 * x - 0.2 * y));
            let mut points: Vec<Point> = (0..600).map(|_| place(next(0.5), next(0.5), next(0.004))).collect();
            points.extend((0..900).map(|_| Point::new(next(0.5), next(0.5), next(0.5))));
            let plane = Plane::search(&points, 0.004, 100, &mut Random::new(0)).unwrap();
            assert!(plane.normal.dot(&normal).abs() > 0.9999, "{plane:?} with seed {seed}");
            assert!(plane.distance(&Point::new(0.0, 0.0, 0.1)) < 0.001, "{plane:?} with seed {seed}");
        }
    }

    #[test]
    fn a_line_and_too_few_points_have_none() {
        let line: Vec<Point> = (0..50).map(|i| Point::new(0.01 * i as f32, 0.0, 0.0)).collect();
        assert!(Plane::search(&line, 0.004, 2, &mut Random::new(0)).is_none());
        assert!(Plane::search(&line[..2], 0.004, 0, &mut Random::new(0)).is_none());
    }
}
