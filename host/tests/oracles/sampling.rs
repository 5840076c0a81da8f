//! Surface samples lie on the surface, have its normals, and are evenly spread.

use crate::random::Random;
use crate::shapes::{self, Shape};
use crate::truth::Truth;
use hangpose_core::geometry::{Point, Vector};
use hangpose_core::perception::sampling;
use nalgebra::{Point3, Vector3};

fn samples_of(shape: &Shape, count: usize, seed: u64) -> (Vec<Point>, Vec<Vector>) {
    let (mut points, mut normals) = (vec![[f32::NAN; 3]; count], vec![[f32::NAN; 3]; count]);
    let mut memory = vec![0; sampling::sample_bytes(count)];
    sampling::sample(&shape.mesh(), seed, &mut points, &mut normals, &mut memory).unwrap();
    (points.into_iter().map(Into::into).collect(), normals.into_iter().map(Into::into).collect())
}

fn area_normal(&[a, b, c]: &[Point3<f64>; 3]) -> Vector3<f64> {
    (b - a).cross(&(c - a)) / 2.0
}

/// Largest radius of `count` disks on a plane of this area (Yuksel 2015, section 3.1).
fn r_max(area: f64, count: usize) -> f64 {
    (area / (2.0 * 3_f64.sqrt() * count as f64)).sqrt()
}

/// Distance of each point to the closest other point.
fn spacing(points: &[Point]) -> impl Iterator<Item = f64> {
    points.iter().enumerate().map(|(i, p)| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, q)| (p.cast::<f64>() - q.cast()).norm()).fold(f64::INFINITY, f64::min)
    })
}

#[test]
fn samples_are_on_the_mesh_and_have_the_normals_of_its_triangles() {
    /// Bound on the distance from the surface, in roundings: a sum of three products rounds half a dozen times by a
    /// half.
    const OFF: f64 = 4.0;
    /// Bound on the error of a normal times the aspect ratio: a cross product of edges has an error of a few roundings.
    const NORMAL: f64 = 8.0 * f32::EPSILON as f64;
    for shape in shapes::all_places() {
        let truth = Truth::of(&shape);
        let (points, normals) = samples_of(&shape, 200, 7);
        for (point, normal) in points.iter().zip(&normals) {
            let exact = point.cast::<f64>();
            let rounding = truth.rounding(&exact);
            let off = truth.distance(&exact);
            assert!(off < OFF * rounding, "{}: {point} is off by {off}", shape.name);
            // Where triangles meet, the sample may lie on any of several.
            let is_normal_of = |corners: &[Point3<f64>; 3]| {
                let exact_normal = area_normal(corners);
                let longest = (0..3).map(|i| (corners[i] - corners[(i + 1) % 3]).norm()).fold(0.0, f64::max);
                let aspect = 2.0 * exact_normal.norm() / longest.powi(2);
                let unit = exact_normal.normalize();
                (exact - corners[0]).dot(&unit).abs() < OFF * rounding
                    && (normal.cast::<f64>() - unit).norm() < NORMAL / aspect
            };
            assert!(truth.corners.iter().any(is_normal_of), "{}: {point} {normal}", shape.name);
        }
    }
}

#[test]
fn samples_of_a_plane_keep_their_distance_and_leave_no_hole() {
    // One side of the open box: a plane of 1 m².
    let mut shape = shapes::cube(8, true);
    shape.triangles.truncate(2 * 8 * 8);
    for count in [500, 2000] {
        for seed in 0..3 {
            let (points, _) = samples_of(&shape, count, seed);
            let widest = 2.0 * r_max(1.0, count);
            // Yuksel reports 0.6 to 0.75 of the spacing of the best packing.
            let least = spacing(&points).fold(f64::INFINITY, f64::min);
            assert!(least > 0.6 * widest, "{count} {seed}: {}", least / widest);
            // A point farther from all samples than their spacing could hold another sample. The best packing leaves
            // gaps of 0.58 of its spacing. Samples chosen from random candidates inherit the gaps of these: up to 1.03
            // was found.
            let mut random = Random(seed);
            for _ in 0..2000 {
                let place = Point::new(0.5, random.unit() as f32 - 0.5, random.unit() as f32 - 0.5);
                let nearest = points.iter().map(|p| (p - place).norm()).fold(f32::INFINITY, f32::min);
                assert!(f64::from(nearest) < 1.2 * widest, "{count} {seed}: {}", f64::from(nearest) / widest);
            }
        }
    }
}

/// Chi-squared test over cells of equal area, which are divided into different numbers of triangles.
#[test]
fn every_part_of_the_surface_is_as_likely() {
    // A box with five coarse sides and one finely divided side: 2 and 5000 triangles per side.
    let fine = shapes::cube(50, false);
    let mut shape = shapes::cube(1, false);
    let base = shape.vertices.len() as u32;
    shape.vertices.extend(&fine.vertices);
    shape.triangles.splice(..2, fine.triangles[..5000].iter().map(|t| t.map(|v| v + base)));
    shape.bodies = vec![shape.triangles.len()];
    // Each side has 2 by 2 cells.
    let (runs, count) = (40, 600);
    let mut counts = [0_u32; 24];
    for seed in 0..runs {
        let (points, normals) = samples_of(&shape, count, seed);
        for (p, n) in points.iter().zip(&normals) {
            let axis = n.iamax();
            let side = 2 * axis + usize::from(n[axis] < 0.0);
            counts[4 * side
                + 2 * usize::from(p[(axis + 1) % 3] > 0.0)
                + usize::from(p[(axis + 2) % 3] > 0.0)] += 1;
        }
    }
    let expected = runs as f64 * count as f64 / 24.0;
    let chi_squared: f64 = counts.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
    // The 99.9 % quantile for 23 degrees of freedom for independent samples; evenly spread samples vary less. Without a
    // random position for each candidate the fine side had a third fewer samples than the others: 483.
    assert!(chi_squared < 49.7, "{chi_squared}: {counts:?}");
}
