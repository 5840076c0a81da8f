//! Closest points, signs and winding numbers.

use crate::random::Random;
use crate::shapes;
use crate::truth::Truth;
use hangpose_core::geometry::{Point, Surface};
use nalgebra::Point3;

/// Bound on the error of a distance, and on the distance of the closest point from the mesh, in roundings. 1.5 and 0.7
/// were found.
const DISTANCE: f64 = 4.0;
/// Bound on the error of the winding number, a quarter above the bound that [`Surface::winding_number`] documents. 0.19
/// was found, on a bottle with thin walls. Without the approximation of distant parts the error is 2e-5.
const WINDING: f64 = 0.25;
/// Distance from the mesh, in diagonals of its bounding box, below which only the sign is checked. There single
/// triangles decide the winding number, and thin ones are subject to rounding.
const CLOSE: f64 = 1e-4;

/// Largest errors; distances in roundings.
#[derive(Debug, Default)]
pub(crate) struct Worst {
    distance: f64,
    off: f64,
    winding: f64,
}

/// A point around the mesh, in its bounding box, close to the mesh, or on it, with equal probability.
fn query(truth: &Truth, random: &mut Random) -> Point {
    let (middle, extents) = (nalgebra::center(&truth.low, &truth.high), truth.high - truth.low);
    let corners = truth.corners[random.below(truth.corners.len())];
    let on_mesh = random.on_triangle(corners);
    let exact: Point3<f64> = match random.below(4) {
        0 => middle + random.in_cube() * truth.size(),
        1 => middle + random.in_cube().component_mul(&extents) * 0.5,
        2 => on_mesh + random.in_cube() * (0.01 * truth.size()),
        _ => on_mesh,
    };
    exact.cast()
}

/// Checks `count` points.
pub(crate) fn check(
    name: &str,
    surface: &Surface,
    truth: &Truth,
    random: &mut Random,
    count: usize,
) -> Worst {
    let mut worst = Worst::default();
    for _ in 0..count {
        let point = query(truth, random);
        let exact = point.cast::<f64>();
        let (expected, rounding) = (truth.distance(&exact), truth.rounding(&exact));
        let closest = surface.closest_point(&point);
        let signed = f64::from(surface.signed_distance(&point));
        let distance = (signed.abs() - expected).abs() / rounding;
        let off = truth.distance(&closest.cast()) / rounding;
        assert!(distance < DISTANCE && off < DISTANCE, "{name}: {point}: {distance} {off}");
        worst.distance = worst.distance.max(distance);
        worst.off = worst.off.max(off);
        // Queries with a radius, unless rounding can decide them.
        for factor in [0.5, 0.99, 1.01, 2.0] {
            let radius = expected * factor;
            if (radius - expected).abs() > DISTANCE * rounding {
                assert_eq!(
                    surface.is_within(&point, radius as f32),
                    factor > 1.0,
                    "{name}: {point} {factor}"
                );
            }
        }
        if expected > DISTANCE * rounding {
            let winding = truth.winding_number(&exact);
            let error = (f64::from(surface.winding_number(&point)) - winding).abs();
            if expected > CLOSE * truth.size() {
                assert!(error < WINDING, "{name}: {point}: {winding} {error}");
                worst.winding = worst.winding.max(error);
            }
            if (winding - 0.5).abs() > WINDING {
                let inside = winding > 0.5 && truth.is_in_box(&exact);
                assert_eq!(surface.is_inside(&point), inside, "{name}: {point}: {winding}");
            }
            if let Some(inside) = truth.is_inside(&exact) {
                assert_eq!(signed < 0.0, inside, "{name}: {point}: {expected} {winding}");
            }
        }
    }
    worst
}

#[test]
fn distances_signs_and_winding_numbers_are_parrys() {
    let mut random = Random(3);
    for shape in shapes::all_places() {
        let worst = shape
            .with_surface(|surface, shape| check(&shape.name, surface, &Truth::of(shape), &mut random, 200));
        eprintln!("{}: {worst:?}", shape.name);
    }
}
