//! Ray casts.
//!
//! A hit can differ from parry's and be correct, because one rounding decides which side of an edge a ray passes. The
//! tests therefore require that every hit is on the mesh, and that no triangle in front of the hit is missed that the
//! ray meets farther than a few roundings from its border. On an oblique ray a rounding moves the hit by 1 / cos of the
//! angle to the normal. From inside a closed mesh every ray must hit, even at an edge.

use crate::random::Random;
use crate::shapes::{self, Shape};
use crate::truth::Truth;
use hangpose_core::geometry::{Point, Surface, Vector};
use nalgebra::{Point3, Vector3};

/// Bound on the distance of a hit from the mesh, and behind parry's hit along the normal, in roundings. 1.5 and 1.3
/// were found. A dozen operations round, seldom in the same direction.
const BOUND: f64 = 4.0;

/// Largest errors, in roundings, and numbers of rays.
#[derive(Debug, Default)]
pub(crate) struct Worst {
    off: f64,
    behind: f64,
    rays: usize,
    hits: usize,
}

/// Checks of rays on one mesh.
struct Check<'a> {
    name: &'a str,
    surface: &'a Surface<'a>,
    truth: &'a Truth,
    worst: Worst,
}

impl Check<'_> {
    /// Checks the ray from `origin` through `target`.
    fn aim(&mut self, origin: Point3<f64>, target: Point3<f64>) {
        self.cast(origin.cast(), (target - origin).normalize().cast(), 0.0);
    }

    /// Checks a ray and returns whether it hits. It may miss what parry hits closer than `skip`.
    fn cast(&mut self, origin: Point, direction: Vector, skip: f64) -> bool {
        let ours = self.surface.closest_hit(&origin, &direction);
        let any = self.surface.any_hit(&origin, &direction);
        assert_eq!(any, ours.is_some(), "{}: {origin} {direction}", self.name);
        // The reference starts from the same rounded numbers.
        let (start, along) = (origin.cast::<f64>(), direction.cast::<f64>());
        let rounding = self.truth.rounding_of_distances(&start);
        self.worst.rays += 1;
        if let Some(at) = ours {
            let off = self.truth.distance(&(start + along * f64::from(at))) / rounding;
            self.worst.off = self.worst.off.max(off);
            self.worst.hits += 1;
            assert!(off < BOUND, "{}: {origin} {direction} hits nothing: {off}", self.name);
        }
        if let Some(hit) = self.truth.first_hit(&start, &along, skip)
            && hit.from_border > BOUND * rounding
        {
            let behind = (ours.map_or(f64::INFINITY, f64::from) - hit.at) * hit.cosine / rounding;
            self.worst.behind = self.worst.behind.max(behind);
            assert!(
                behind < BOUND,
                "{}: {origin} {direction} missed: {behind} at {} cos {} border {}",
                self.name,
                hit.at,
                hit.cosine,
                hit.from_border
            );
        }
        any
    }

    /// Casts `count` rays of each kind on any mesh.
    fn any_mesh(&mut self, random: &mut Random, count: usize) {
        let (middle, size) = (nalgebra::center(&self.truth.low, &self.truth.high), self.truth.size());
        for _ in 0..count {
            let corners = self.truth.corners[random.below(self.truth.corners.len())];
            let on_mesh = random.on_triangle(corners);
            let around = middle + random.in_cube() * size;
            let close = middle + random.in_cube().component_mul(&(self.truth.high - self.truth.low)) * 0.5;
            // In a random direction, at the mesh, and exactly at a vertex or the middle of an edge.
            self.cast(around.cast(), random.direction().cast(), 0.0);
            for origin in [around, close] {
                self.aim(origin, on_mesh);
                self.aim(origin, corners[0]);
                self.aim(origin, nalgebra::center(&corners[0], &corners[1]));
            }
            // Along an axis through a vertex, which lies in the plane of axis-aligned faces.
            let axis = Vector::ith(random.below(3), if random.unit() < 0.5 { 1.0 } else { -1.0 });
            let distance = random.unit() * size;
            self.cast(corners[0].cast() - axis * distance as f32, axis, 0.0);
            // From the mesh itself, up to rounding.
            let skip = 4.0 * BOUND * self.truth.rounding(&on_mesh);
            self.cast(on_mesh.cast(), random.direction().cast(), skip);
            self.cast(corners[0].cast(), random.direction().cast(), skip);
        }
    }

    /// Casts `count` rays of each kind from the inside of a closed mesh, which must all hit.
    fn closed_mesh(&mut self, random: &mut Random, count: usize) {
        let (middle, extents) =
            (nalgebra::center(&self.truth.low, &self.truth.high), self.truth.high - self.truth.low);
        let mut left = count;
        while left > 0 {
            let origin: Point = (middle + random.in_cube().component_mul(&extents) * 0.5).cast();
            let exact = origin.cast();
            // Farther from the mesh than rounding errors, so that the origin is surely inside.
            if self.truth.is_inside(&exact) != Some(true)
                || self.truth.distance(&exact) < 4.0 * BOUND * self.truth.rounding(&exact)
            {
                continue;
            }
            left -= 1;
            let corners = self.truth.corners[random.below(self.truth.corners.len())];
            let mut rays = vec![
                random.direction(),
                corners[0] - exact,
                nalgebra::center(&corners[0], &corners[1]) - exact,
            ];
            rays.extend((0..3).flat_map(|axis| [Vector3::ith(axis, 1.0), Vector3::ith(axis, -1.0)]));
            for direction in rays {
                let hits = self.cast(origin, direction.normalize().cast(), 0.0);
                assert!(hits, "{}: leaks from {origin} along {direction}", self.name);
            }
        }
    }
}

/// Checks `count` rays of each kind.
pub(crate) fn check(
    shape: &Shape,
    surface: &Surface,
    truth: &Truth,
    random: &mut Random,
    count: usize,
) -> Worst {
    let mut check = Check { name: &shape.name, surface, truth, worst: Worst::default() };
    check.any_mesh(random, count);
    if shape.is_closed {
        check.closed_mesh(random, count);
    }
    check.worst
}

#[test]
fn rays_hit_what_parry_hits() {
    let mut random = Random(2);
    for shape in shapes::all_places() {
        let worst =
            shape.with_surface(|surface, shape| check(shape, surface, &Truth::of(shape), &mut random, 120));
        eprintln!("{}: {worst:?}", shape.name);
    }
}
