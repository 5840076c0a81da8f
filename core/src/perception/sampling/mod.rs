//! Poisson-disk samples of a mesh, to an exact count: weighted sample elimination (Yuksel 2015, "Sample
//! Elimination for Generating Poisson Disk Sample Sets"). Names are Yuksel's.

mod cells;
mod elimination;
mod falling;

use crate::geometry::{Mesh, Point, Vector};
use crate::memory::{Arena, OutOfMemory, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Unfinished};
pub use crate::params::MAX_SAMPLES;
use crate::random::Random;
use cells::Cells;
use elimination::eliminate;

/// Candidates drawn for each sample that is kept: `M / N`. Yuksel's 5 spreads the samples to 0.70 of the best
/// possible distance; 3 to 0.66, in 0.4 of the time.
const OVERSAMPLING: usize = 3;
/// Bytes of memory for [`sample`].
pub const fn sample_bytes(count: usize) -> usize {
    model_bytes(scratch_bytes(count))
}

/// Bytes of working memory for drawing `count` samples.
pub(crate) const fn scratch_bytes(count: usize) -> usize {
    let candidates = count.saturating_mul(OVERSAMPLING);
    array_bytes::<Candidate>(candidates)
        .saturating_add(Cells::bytes(candidates))
        .saturating_add(larger(Cells::scratch_bytes(candidates), elimination::scratch_bytes(candidates)))
}

/// Why no samples can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplingError {
    /// More samples than are possible.
    TooMany {
        /// Number requested.
        count: usize,
        /// Largest number allowed.
        limit: usize,
    },
    /// The slices for points and normals differ in length.
    Lengths {
        /// Length of the slice for points.
        points: usize,
        /// Length of the slice for normals.
        normals: usize,
    },
    /// The memory is too small.
    OutOfMemory(OutOfMemory),
}

impl From<OutOfMemory> for SamplingError {
    fn from(error: OutOfMemory) -> Self {
        Self::OutOfMemory(error)
    }
}

impl core::fmt::Display for SamplingError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooMany { count, limit } => {
                write!(f, "{count} samples were asked for, at most {limit} are possible")
            }
            Self::Lengths { points, normals } => {
                write!(
                    f,
                    "there are places for {points} points and for {normals} normals, but both come in pairs"
                )
            }
            Self::OutOfMemory(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SamplingError {}

/// Draws `points.len()` points from the surface of `mesh`, evenly spread, with the normals of their triangles.
///
/// Positions in metres; `normals` is as long as `points`. The same seed gives the same points, and a rigid motion
/// of the mesh moves them along (up to rounding). `memory` holds [`sample_bytes`].
pub fn sample(
    mesh: &Mesh,
    seed: u64,
    points: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
    memory: &mut [u8],
) -> Result<(), SamplingError> {
    if points.len() > MAX_SAMPLES {
        return Err(SamplingError::TooMany { count: points.len(), limit: MAX_SAMPLES });
    }
    if points.len() != normals.len() {
        return Err(SamplingError::Lengths { points: points.len(), normals: normals.len() });
    }
    let scratch = Arena::new(memory, sample_bytes(points.len()))?;
    let (points, normals) = (bytemuck::cast_slice_mut(points), bytemuck::cast_slice_mut(normals));
    match sample_into(mesh, seed, points, normals, scratch, &Meter::new(&Monitor::new())) {
        Err(Unfinished::OutOfMemory(error)) => Err(error.into()),
        // Nobody stops this one.
        Ok(()) | Err(Unfinished::Stopped(_)) => Ok(()),
    }
}

/// [`sample`], for callers that have an arena.
pub(crate) fn sample_into(
    mesh: &Mesh,
    seed: u64,
    points: &mut [Point],
    normals: &mut [Vector],
    mut scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    let count = points.len();
    meter.check_cancelled()?;
    let drawn = scratch.unset::<Candidate>(count * OVERSAMPLING)?;
    let area = draw(mesh, seed, drawn.len(), meter, |place, candidate| drawn[place] = candidate)?;
    // The largest radius that `count` disks on a plane of this area can have (section 3.1).
    let r_max = libm::sqrtf(area / (2.0 * libm::sqrtf(3.0) * count.max(1) as f32));
    let cells = Cells::sort(drawn, 2.0 * r_max, &mut scratch, meter)?;
    let kept = eliminate(&cells, count, r_max, scratch, meter)?;
    for ((point, normal), &index) in points.iter_mut().zip(normals).zip(kept) {
        (*point, *normal) = drawn[index as usize].on(mesh);
    }
    Ok(())
}

/// Draws points with the normals of their triangles uniformly by area, without a least distance, and in random order, so that
/// any part of them covers the whole surface.
pub(crate) fn scatter_into(
    mesh: &Mesh,
    seed: u64,
    points: &mut [Point],
    normals: &mut [Vector],
    meter: &Meter,
) -> Result<(), Stop> {
    let count = points.len();
    // Steps by about the golden section go through all places, and far from each other, if they have no divisor in common.
    let is_coprime = |&stride: &usize| {
        let (mut a, mut b) = (count, stride);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    let stride = (1..=(0.618 * count as f64) as usize).rev().find(is_coprime).unwrap_or(1);
    let mut place = 0;
    draw(mesh, seed, count, meter, |_, candidate| {
        (points[place], normals[place]) = candidate.on(mesh);
        // Not a product, which 32 bits cannot hold.
        place += stride;
        place -= if place < count { 0 } else { count };
    })?;
    Ok(())
}

#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Candidate {
    position: [f32; 3],
    triangle: u32,
}

impl Candidate {
    /// The point and the normal.
    fn on(&self, mesh: &Mesh) -> (Point, Vector) {
        let normal = crate::geometry::scaled_normal(&mesh.corners(self.triangle as usize)).normalize();
        (self.position.into(), normal)
    }
}

/// Draws `count` candidates uniformly by area, tells them in the order of the triangles, and returns the area in m².
fn draw(
    mesh: &Mesh,
    seed: u64,
    count: usize,
    meter: &Meter,
    mut tell: impl FnMut(usize, Candidate),
) -> Result<f32, Stop> {
    let normal_of = |t: u32| crate::geometry::scaled_normal(&mesh.corners(t as usize));
    let mut total = 0.0_f64;
    for (step, triangle) in mesh.solid_triangles().enumerate() {
        meter.check_at(step)?;
        total += f64::from(normal_of(triangle).norm()) / 2.0;
    }
    let mut random = Random::new(seed);
    // One candidate in each of as many equal shares of the area, so that no part is left out by chance, at a random
    // place of the share, so that it makes no pattern with the order of the triangles.
    let share = total / count as f64;
    let place = |drawn: usize, random: &mut Random| (drawn as f64 + f64::from(random.next_f32())) * share;
    let mut next = place(0, &mut random);
    let (mut covered, mut drawn) = (0.0, 0);
    let mut triangles = mesh.solid_triangles().peekable();
    let mut step = 0;
    while let Some(triangle) = triangles.next() {
        meter.check_at(step)?;
        step += 1;
        let normal = normal_of(triangle);
        covered += f64::from(normal.norm()) / 2.0;
        let [a, b, c] = mesh.corners(triangle as usize);
        let is_last = triangles.peek().is_none();
        while drawn < count && (is_last || next < covered) {
            let (s, t) = (libm::sqrtf(random.next_f32()), random.next_f32());
            let position = a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t);
            tell(drawn, Candidate { position: position.into(), triangle });
            drawn += 1;
            next = place(drawn, &mut random);
        }
    }
    Ok(total as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes;

    fn samples_of(mesh: &Mesh, count: usize, seed: u64) -> (Vec<Point>, Vec<Vector>) {
        let (mut points, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        sample(mesh, seed, &mut points, &mut normals, &mut vec![0; sample_bytes(count)]).unwrap();
        (points.into_iter().map(Into::into).collect(), normals.into_iter().map(Into::into).collect())
    }

    #[test]
    fn exact_count_on_the_surface_spread_out_with_normals() {
        let torus = test_shapes::torus(0.04, 0.01, 96, 32);
        let mesh = torus.mesh();
        for count in [1, 2, 10, 500, 2000] {
            let (points, normals) = samples_of(&mesh, count, 1);
            for (point, normal) in points.iter().zip(&normals) {
                let ring = Vector::new(point.x, point.y, 0.0).normalize() * 0.04;
                let outward = point.coords - ring;
                assert!((outward.norm() - 0.01).abs() < 1e-4, "off the surface");
                assert!((normal.norm() - 1.0).abs() < 1e-5 && normal.dot(&outward.normalize()) > 0.98);
            }
            // Disks packed as densely as can be are 2 r_max apart; Yuksel reports 0.6 to 0.75 of that. With few
            // samples the disks are wider than the tube, which is then no plane.
            let area = 4.0 * core::f32::consts::PI.powi(2) * 0.04 * 0.01;
            let r_max = (area / (2.0 * 3_f32.sqrt() * count as f32)).sqrt();
            let closest = (0..points.len())
                .flat_map(|i| (0..i).map(move |j| (i, j)))
                .map(|(i, j)| (points[i] - points[j]).norm())
                .fold(f32::INFINITY, f32::min);
            assert!(count < 500 || closest > 0.6 * 2.0 * r_max, "{count}: {closest} of {}", 2.0 * r_max);
        }
    }

    #[test]
    fn scattered_ones_are_of_the_whole_surface_from_the_start() {
        let torus = test_shapes::torus(0.04, 0.01, 96, 32);
        for count in [1, 2, 100, 1000] {
            let (mut points, mut normals) = (vec![Point::origin(); count], vec![Vector::zeros(); count]);
            scatter_into(&torus.mesh(), 1, &mut points, &mut normals, &Meter::unwatched()).unwrap();
            for (point, normal) in points.iter().zip(&normals) {
                let outward = point.coords - Vector::new(point.x, point.y, 0.0).normalize() * 0.04;
                assert!((outward.norm() - 0.01).abs() < 1e-4, "off the surface");
                assert!((normal.norm() - 1.0).abs() < 1e-5 && normal.dot(&outward.normalize()) > 0.98);
            }
            // Of each tenth of them about half are on either side.
            for part in points.chunks(100) {
                let aside = part.iter().filter(|point| point.x > 0.0).count();
                assert!(part.len() < 100 || (40..=60).contains(&aside), "{aside} of {}", part.len());
            }
        }
    }

    #[test]
    fn scattered_ones_fill_every_place() {
        let torus = test_shapes::torus(0.04, 0.012, 48, 24);
        for count in [1, 2, 3, 10, 997, 100_000] {
            let (mut points, mut normals) =
                (vec![Point::from([f32::NAN; 3]); count], vec![Vector::zeros(); count]);
            scatter_into(&torus.mesh(), 1, &mut points, &mut normals, &Meter::unwatched()).unwrap();
            let is_filled = |(point, normal): (&Point, &Vector)| point.x.is_finite() && normal.norm() > 0.9;
            assert!(points.iter().zip(&normals).all(is_filled), "{count}");
        }
    }

    #[test]
    fn names_what_is_wrong() {
        let torus = test_shapes::torus(0.04, 0.01, 48, 16);
        let mut four = ([[0.0; 3]; 4], [[0.0; 3]; 4]);
        let error = sample(&torus.mesh(), 0, &mut four.0, &mut four.1[..3], &mut []);
        assert_eq!(error, Err(SamplingError::Lengths { points: 4, normals: 3 }));
        let error = sample(&torus.mesh(), 0, &mut four.0, &mut four.1, &mut []);
        let needed = sample_bytes(4);
        assert_eq!(error, Err(SamplingError::OutOfMemory(OutOfMemory { needed, given: 0 })));
        let mut many = vec![[0.0; 3]; MAX_SAMPLES + 1];
        let error = sample(&torus.mesh(), 0, &mut many.clone(), &mut many, &mut []);
        assert_eq!(error, Err(SamplingError::TooMany { count: MAX_SAMPLES + 1, limit: MAX_SAMPLES }));
        assert_eq!(sample(&torus.mesh(), 0, &mut [], &mut [], &mut vec![0; sample_bytes(0)]), Ok(()));
    }

    #[test]
    fn the_same_seed_gives_the_same_bytes() {
        let torus = test_shapes::torus(0.04, 0.01, 48, 16);
        assert_eq!(samples_of(&torus.mesh(), 300, 5), samples_of(&torus.mesh(), 300, 5));
        assert_ne!(samples_of(&torus.mesh(), 300, 5), samples_of(&torus.mesh(), 300, 6));
    }

    #[test]
    fn every_part_gets_its_share_of_the_samples() {
        // Two squares, one of four times the area, far apart and finely divided.
        let mut shape = test_shapes::grid(1.0, 40);
        shape.append(&test_shapes::grid(0.5, 3), Vector::new(100.0, 0.0, 0.0));
        let (points, _) = samples_of(&shape.mesh(), 1000, 2);
        let small = points.iter().filter(|p| p.x > 50.0).count();
        assert!((180..=220).contains(&small), "{small}");
    }

    #[test]
    fn rows_of_small_triangles_get_their_share() {
        // Two squares of the same area. One has 17 triangles for each candidate in rows of 100, so that every 17th
        // triangle would be below the one of the row before.
        let mut shape = test_shapes::grid(1.0, 50);
        shape.append(&test_shapes::grid(1.0, 1), Vector::new(100.0, 0.0, 0.0));
        let (points, _) = samples_of(&shape.mesh(), 200, 2);
        let fine = points.iter().filter(|p| p.x < 50.0).count();
        assert!((90..=110).contains(&fine), "{fine}");
    }
}
