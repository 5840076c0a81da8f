//! The dominant plane of a cloud: the table that objects stand on or the wall behind them.

use crate::geometry::{MAX_COORDINATE, Point, Vector, least_eigenvector};
use crate::random::Random;
use nalgebra::Matrix3;

/// Planes tried. A plane with a fifth of the points is drawn with a probability of 98 %, one with a third fails once in 10^8 runs.
const TRIALS: usize = 512;
/// Points that a trial is judged by, taken evenly from all.
const JUDGES: usize = 2048;
/// Times that the best plane is fitted to the points on it.
const FITS: usize = 3;

/// What counts as a dominant plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneSettings {
    /// Greatest distance of a point from the plane that it is on, metres.
    pub tolerance: f32,
    /// Least part of all points that must be on the plane, 0 to 1.
    pub least_part: f32,
    /// A point that the normal faces, metres, such as the position of the camera; `None` for the side on which more of the
    /// other points are.
    pub viewpoint: Option<Point>,
    /// Seed of the random trials.
    pub seed: u64,
}

impl Default for PlaneSettings {
    /// A tolerance of 8 mm, and a fifth of the points.
    fn default() -> Self {
        Self { tolerance: 0.008, least_part: 0.2, viewpoint: None, seed: 1 }
    }
}

/// A plane: the points `p` with `normal · p = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit normal, see [`PlaneSettings::viewpoint`].
    pub normal: Vector,
    /// Distance from the origin along the normal, metres.
    pub offset: f32,
    /// Number of points on the plane.
    pub points: usize,
}

/// Why the plane of a cloud cannot be sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaneError {
    /// The tolerance is not a positive number.
    Tolerance {
        /// Tolerance given, metres.
        tolerance: f32,
    },
    /// The least part is not between 0 and 1.
    LeastPart {
        /// Part given.
        least_part: f32,
    },
    /// The list of marks is not as long as that of points.
    Marks {
        /// Number of points.
        points: usize,
        /// Length of the list of marks.
        marks: usize,
    },
    /// A coordinate is infinite, not a number, or beyond [`MAX_COORDINATE`].
    Coordinate {
        /// Index of the point.
        point: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
}

impl core::fmt::Display for PlaneError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Tolerance { tolerance } => {
                write!(f, "the tolerance {tolerance} must be a positive number of metres, such as 0.008")
            }
            Self::LeastPart { least_part } => {
                write!(f, "the least part {least_part} of the points must be between 0 and 1")
            }
            Self::Marks { points, marks } => {
                write!(f, "there are {points} points and {marks} marks: give one for each point")
            }
            Self::Coordinate { point, position } => write!(
                f,
                "point {point} is at {position:?}: every coordinate must be a number of metres within ±{MAX_COORDINATE}"
            ),
        }
    }
}

impl core::error::Error for PlaneError {}

/// Finds the plane with the most `points` (metres) and marks the points on it; `None`, and no marks, if no plane has enough
/// of them. The same points and seed give the same plane (random sample consensus: Fischler and Bolles, Communications of
/// the ACM, 1981).
pub fn dominant_plane(
    points: &[[f32; 3]],
    settings: &PlaneSettings,
    is_on_plane: &mut [bool],
) -> Result<Option<Plane>, PlaneError> {
    let PlaneSettings { tolerance, least_part, viewpoint, seed } = *settings;
    if !(tolerance.is_finite() && tolerance > 0.0) {
        return Err(PlaneError::Tolerance { tolerance });
    }
    if !(0.0..=1.0).contains(&least_part) {
        return Err(PlaneError::LeastPart { least_part });
    }
    if points.len() != is_on_plane.len() {
        return Err(PlaneError::Marks { points: points.len(), marks: is_on_plane.len() });
    }
    let is_usable = |p: &[f32; 3]| p.iter().all(|x| x.abs() <= MAX_COORDINATE);
    if let Some(point) = points.iter().position(|p| !is_usable(p)) {
        return Err(PlaneError::Coordinate { point, position: points[point] });
    }
    is_on_plane.fill(false);
    let points: &[Point] = bytemuck::cast_slice(points);
    let Some(mut plane) = best_of_trials(points, tolerance, seed) else { return Ok(None) };
    for _ in 0..FITS {
        plane = fit(points, &plane, tolerance).unwrap_or(plane);
    }
    plane.points = points.iter().filter(|p| plane.distance(p).abs() <= tolerance).count();
    if plane.points == 0 || (plane.points as f32) < least_part * points.len() as f32 {
        return Ok(None);
    }
    for (mark, point) in is_on_plane.iter_mut().zip(points) {
        *mark = plane.distance(point).abs() <= tolerance;
    }
    let is_turned = match viewpoint {
        Some(viewpoint) => plane.distance(&viewpoint) < 0.0,
        None => {
            let before = points.iter().filter(|p| plane.distance(p) > tolerance).count();
            2 * before < points.len() - plane.points
        }
    };
    if is_turned {
        plane = Plane { normal: -plane.normal, offset: -plane.offset, ..plane };
    }
    Ok(Some(plane))
}

impl Plane {
    /// Signed distance of a point, metres, positive on the side of the normal.
    pub fn distance(&self, point: &Point) -> f32 {
        self.normal.dot(&point.coords) - self.offset
    }
}

/// Draws three points at a time; the plane through them with the most judges on it, the first of equals.
fn best_of_trials(points: &[Point], tolerance: f32, seed: u64) -> Option<Plane> {
    let mut random = Random::new(seed);
    let stride = points.len().div_ceil(JUDGES).max(1);
    let mut best: Option<Plane> = None;
    for _ in 0..TRIALS {
        let mut draw = || points.get((random.next_f32() * points.len() as f32) as usize).copied();
        let (Some(a), Some(b), Some(c)) = (draw(), draw(), draw()) else { continue };
        let normal = (b - a).cross(&(c - a));
        let length = normal.norm();
        // Points in a line or too close for a direction.
        if length <= tolerance * tolerance || !length.is_finite() {
            continue;
        }
        let normal = normal / length;
        let mut plane = Plane { normal, offset: normal.dot(&a.coords), points: 0 };
        let judges = points.iter().step_by(stride);
        plane.points = judges.filter(|p| plane.distance(p).abs() <= tolerance).count();
        if best.is_none_or(|best| plane.points > best.points) {
            best = Some(plane);
        }
    }
    best
}

/// The plane of least squares through the points on a plane.
fn fit(points: &[Point], plane: &Plane, tolerance: f32) -> Option<Plane> {
    let on_plane = || points.iter().filter(|p| plane.distance(p).abs() <= tolerance);
    let reference = *on_plane().next()?;
    let (mut count, mut sum, mut squares) = (0, Vector::zeros(), Matrix3::zeros());
    for p in on_plane() {
        let offset = p - reference;
        count += 1;
        sum += offset;
        squares += offset * offset.transpose();
    }
    let mean = sum / count as f32;
    let normal = least_eigenvector(squares / count as f32 - mean * mean.transpose());
    let normal = if normal.dot(&plane.normal) < 0.0 { -normal } else { normal };
    normal.iter().all(|x| x.is_finite()).then(|| Plane {
        normal,
        offset: normal.dot(&(reference + mean).coords),
        points: count,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table with noise of 2 mm, tilted and moved, and a ball above it; how many points are on the table.
    fn scene(on_table: usize, on_ball: usize) -> (Vec<[f32; 3]>, Plane) {
        let mut random = Random::new(8);
        let turn = nalgebra::Rotation3::from_euler_angles(0.5, -0.3, 0.2);
        let shift = Vector::new(0.3, -0.2, 1.1);
        let mut next = || 2.0 * random.next_f32() - 1.0;
        let mut points: Vec<Vector> =
            (0..on_table).map(|_| Vector::new(0.5 * next(), 0.4 * next(), 0.002 * next())).collect();
        points
            .extend((0..on_ball).map(|_| {
                Vector::new(next(), next(), next()).normalize() * 0.1 + Vector::new(0.0, 0.0, 0.15)
            }));
        let points = points.into_iter().map(|p| (turn * p + shift).into()).collect();
        let normal = turn * Vector::z();
        (points, Plane { normal, offset: normal.dot(&shift), points: on_table })
    }

    #[test]
    fn finds_the_table_below_a_ball() {
        for (on_table, on_ball) in [(9000, 3000), (900, 2000), (3, 0)] {
            let (points, truth) = scene(on_table, on_ball);
            let mut marks = vec![true; points.len()];
            let found = dominant_plane(&points, &PlaneSettings::default(), &mut marks).unwrap().unwrap();
            assert_eq!(found.points, on_table);
            assert!(marks.iter().enumerate().all(|(i, mark)| *mark == (i < on_table)));
            if on_ball > 0 {
                assert!((found.normal - truth.normal).norm() < 1e-3, "{found:?}");
                assert!((found.offset - truth.offset).abs() < 5e-4, "{found:?}");
            }
            let below = Some(Point::from(truth.normal * (truth.offset - 1.0)));
            let settings = PlaneSettings { viewpoint: below, ..PlaneSettings::default() };
            let turned = dominant_plane(&points, &settings, &mut marks).unwrap().unwrap();
            assert!(turned.distance(&Point::from(truth.normal * (truth.offset - 1.0))) > 0.0, "{turned:?}");
            let again = dominant_plane(&points, &PlaneSettings::default(), &mut marks).unwrap().unwrap();
            assert_eq!(found, again);
        }
    }

    #[test]
    fn a_ball_alone_a_line_and_nothing_have_no_plane() {
        let (ball, _) = scene(0, 3000);
        let line: Vec<[f32; 3]> = (0..100).map(|i| [i as f32, 0.0, 0.0]).collect();
        for points in [ball, line, vec![], vec![[1.0; 3]; 50]] {
            let mut marks = vec![true; points.len()];
            let found = dominant_plane(&points, &PlaneSettings::default(), &mut marks).unwrap();
            assert!(found.is_none() && marks.iter().all(|mark| !mark), "{found:?}");
        }
    }

    #[test]
    fn names_what_is_broken() {
        let fine = PlaneSettings::default();
        let error = |settings: PlaneSettings, points: &[[f32; 3]], marks: usize| {
            dominant_plane(points, &settings, &mut vec![false; marks]).unwrap_err()
        };
        assert_eq!(
            error(PlaneSettings { tolerance: 0.0, ..fine }, &[], 0),
            PlaneError::Tolerance { tolerance: 0.0 }
        );
        assert_eq!(
            error(PlaneSettings { least_part: 1.5, ..fine }, &[], 0),
            PlaneError::LeastPart { least_part: 1.5 }
        );
        assert_eq!(error(fine, &[[0.0; 3]], 2), PlaneError::Marks { points: 1, marks: 2 });
        assert!(matches!(error(fine, &[[f32::NAN; 3]], 1), PlaneError::Coordinate { point: 0, .. }));
    }
}
