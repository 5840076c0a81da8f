//! Neighbour queries, compared with brute force in double precision.

use crate::random::Random;
use hangpose_core::geometry::{Cloud, Neighbour, Point, PointTree};
use hangpose_core::hanging::Supporter;
use hangpose_core::memory::Limits;
use hangpose_core::{Monitor, Params};
use nalgebra::{Point3, Vector3};

/// Bound on the relative error of a squared distance, in `f32::EPSILON`. Three differences, three products and two sums
/// each round by half of one.
const SQUARE: f64 = 4.0;

/// Point sets that are difficult for trees.
fn clouds(random: &mut Random) -> Vec<(&'static str, Vec<[f32; 3]>)> {
    let mut cloud = |count: usize, point: &mut dyn FnMut(usize, &mut Random) -> Vector3<f64>| {
        (0..count).map(|i| point(i, random).cast::<f32>().into()).collect::<Vec<[f32; 3]>>()
    };
    let clump = |i: usize| 10_f64.powi(-((i % 6) as i32));
    vec![
        ("uniform", cloud(5000, &mut |_, r| r.in_cube())),
        ("clumps within clumps", cloud(5000, &mut |i, r| r.in_cube() * clump(i))),
        ("a sphere", cloud(5000, &mut |_, r| r.direction())),
        ("a grid, many at the same distance", {
            cloud(4096, &mut |i, _| {
                Vector3::new((i % 16) as f64, (i / 16 % 16) as f64, (i / 256) as f64) / 8.0
            })
        }),
        ("a line", cloud(3000, &mut |_, r| Vector3::x() * r.unit())),
        ("each point ten times", cloud(3000, &mut |i, _| Random(1 + i as u64 / 10).in_cube())),
        ("far away", cloud(3000, &mut |_, r| r.in_cube() + Vector3::new(100.0, -70.0, 30.0))),
        ("two points", cloud(2, &mut |_, r| r.in_cube())),
    ]
}

/// Calls `check` with a tree and the points that it was made from, both in the frame of the supporter.
fn with_tree(points: &[[f32; 3]], check: impl FnOnce(&PointTree, &[Point])) {
    // With normals that point down there is nothing to estimate and no support site.
    let normals = vec![[0.0, 0.0, -1.0]; points.len()];
    let limits = Limits::of_points(points.len());
    let mut memory = vec![0; Supporter::bytes(&limits)];
    let cloud = Cloud::new(points, Some(&normals)).unwrap();
    let supporter = Supporter::analyze(&cloud, &Params::paper(), &mut memory, &Monitor::new()).unwrap();
    let points: Vec<Point> = points.iter().map(|point| supporter.frame() * Point::from(*point)).collect();
    check(supporter.points(), &points);
}

/// Squared distances of all points, in the order of the tree.
fn squares(tree: &PointTree, query: &Point) -> Vec<f64> {
    tree.points().iter().map(|p| (p.cast::<f64>() - query.cast()).norm_squared()).collect()
}

fn is_close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= SQUARE * f64::from(f32::EPSILON) * expected
}

fn check(name: &str, tree: &PointTree, query: &Point) {
    let squares = squares(tree, query);
    let mut sorted = squares.clone();
    sorted.sort_by(f64::total_cmp);
    // Each neighbour is at the returned distance, and no closer point is missing.
    let is_right = |n: &Neighbour, expected: f64| {
        let square = f64::from(n.distance_squared);
        is_close(square, squares[n.index as usize]) && is_close(square, expected)
    };
    assert!(is_right(&tree.nearest(query), sorted[0]), "{name}: {query}");
    for count in [1, 8, 100] {
        let mut found = vec![Neighbour::default(); count];
        let found = tree.k_nearest(query, &mut found);
        assert_eq!(found.len(), count.min(squares.len()));
        for (neighbour, &expected) in found.iter().zip(&sorted) {
            assert!(is_right(neighbour, expected), "{name}: {query} {count}: {neighbour:?} {expected}");
        }
        let mut names: Vec<u32> = found.iter().map(|n| n.index).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), found.len(), "{name}: {query}: a point twice");
    }
    for radius in [sorted[0], sorted[sorted.len() / 100], sorted[sorted.len() / 3]].map(f64::sqrt) {
        let radius = radius as f32;
        let mut found = vec![false; squares.len()];
        tree.for_each_within(query, radius, |n| {
            assert!(!std::mem::replace(&mut found[n.index as usize], true), "{name}: {query}: a point twice");
        });
        let limit = f64::from(radius).powi(2);
        for (found, &square) in found.iter().zip(&squares) {
            assert!(
                *found == (square <= limit) || is_close(square, limit),
                "{name}: {query} {radius}: {square}"
            );
        }
    }
}

#[test]
fn neighbours_are_those_of_brute_force() {
    let mut random = Random(5);
    for (name, points) in clouds(&mut random) {
        with_tree(&points, |tree, points| {
            let mut order = tree.order().to_vec();
            order.sort_unstable();
            assert!(order.iter().copied().eq(0..points.len() as u32), "{name}: not a permutation");
            assert!(tree.order().iter().zip(tree.points()).all(|(&i, p)| points[i as usize] == *p));
            for i in 0..150 {
                let at = points[random.below(points.len())].cast::<f64>();
                let query: Point3<f64> = match i % 3 {
                    0 => at,
                    1 => at + random.in_cube() * 0.01,
                    _ => at + random.in_cube() * 3.0,
                };
                check(name, tree, &query.cast());
            }
        });
    }
}
