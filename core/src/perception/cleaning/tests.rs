//! What is kept of made clouds whose strays, duplicates and planes are known.

use super::*;
use crate::memory::model_bytes;
use crate::random::Random;
use std::vec::Vec;

/// Cleans a cloud and returns the indices of the points that are left, those of them on planes, and the counts.
fn cleaned(points: &[Point], normals: &[Vector]) -> (Vec<u32>, Vec<u32>, CleaningCounts) {
    let n = points.len();
    let needed = model_bytes(crate::geometry::PointTree::bytes(n) + bytes(n) + scratch_bytes(n));
    let mut memory = vec![0; needed];
    let mut arena = Arena::new(&mut memory, needed).unwrap();
    let mut slots = PointTreeSlots::new(n, &mut arena).unwrap();
    let mut scratch = arena.scratch();
    let cleaned =
        clean((points, &Pose::identity()), normals, false, &mut slots, &mut scratch, &Meter::unwatched())
            .unwrap();
    let order = slots.tree().order().to_vec();
    let on_planes = order.iter().zip(cleaned.is_excluded.iter()).filter(|(_, flag)| **flag > 0);
    (order.clone(), on_planes.map(|(index, _)| *index).collect(), cleaned.counts)
}

/// `count` points at random on a bar along x, 10 cm long and 8 mm thick, around `centre`.
fn bar(count: usize, centre: Point, random: &mut Random) -> Vec<Point> {
    (0..count)
        .map(|_| {
            let (s, c) = (std::f32::consts::TAU * random.next_f32()).sin_cos();
            centre + Vector::new(0.1 * random.next_f32() - 0.05, 0.004 * s, 0.004 * c)
        })
        .collect()
}

/// `count` points at random on a horizontal square of this edge around `centre`, with noise of this size.
fn square(count: usize, edge: f32, centre: Point, noise: f32, random: &mut Random) -> Vec<Point> {
    (0..count)
        .map(|_| {
            let mut next = |size: f32| size * (random.next_f32() - 0.5);
            centre + Vector::new(next(edge), next(edge), next(2.0 * noise))
        })
        .collect()
}

fn unknown(points: &[Point]) -> Vec<Vector> {
    vec![Vector::zeros(); points.len()]
}

#[test]
fn points_in_the_air_are_dropped_and_no_others() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let mut points = bar(3000, Point::origin(), &mut random);
        let surface = points.len() as u32;
        // At least 2 cm from the axis.
        while points.len() < 3030 {
            let mut next = || 0.3 * (random.next_f32() - 0.5);
            let stray = Point::new(next(), next(), next());
            if stray.y.hypot(stray.z) > 0.02 {
                points.push(stray);
            }
        }
        let (kept, _, counts) = cleaned(&points, &unknown(&points));
        let strays = kept.iter().filter(|index| **index >= surface).count();
        assert!(strays == 0, "{strays} strays are left with seed {seed}");
        assert!(counts.strays <= 32 && counts.on_planes == 0, "{counts:?} with seed {seed}");
    }
}

#[test]
fn specks_are_dropped_and_a_sparse_sheet_is_not() {
    let mut random = Random::new(1);
    let mut points = bar(3000, Point::origin(), &mut random);
    let sheet = points.len() as u32;
    // 12 mm between points beside 1 mm.
    points.extend(square(100, 0.12, Point::new(0.0, 0.0, -0.05), 0.0, &mut random));
    let specks = points.len() as u32;
    for k in 0..10 {
        let centre = Point::new(0.03 * k as f32 - 0.15, 0.1, 0.05);
        points.extend(square(5, 0.001, centre, 0.0005, &mut random));
    }
    let (kept, ..) = cleaned(&points, &unknown(&points));
    assert_eq!(kept.iter().filter(|index| **index >= specks).count(), 0);
    let of_sheet = kept.iter().filter(|index| (sheet..specks).contains(*index)).count();
    assert!(of_sheet >= 95, "{of_sheet} of 100");
}

#[test]
fn duplicates_are_merged_and_two_sides_are_not() {
    let mut random = Random::new(2);
    let once = bar(500, Point::origin(), &mut random);
    let points: Vec<Point> = (0..4).flat_map(|_| once.iter().copied()).collect();
    let (kept, _, counts) = cleaned(&points, &unknown(&points));
    assert_eq!(kept.len() + counts.merged + counts.strays, 2000);
    assert!((450..=500).contains(&kept.len()) && kept.iter().all(|index| *index < 500), "{counts:?}");

    // Two sides of a foil at the same places.
    let foil = square(500, 0.1, Point::origin(), 0.0, &mut random);
    let both: Vec<Point> = foil.iter().chain(&foil).copied().collect();
    let normals: Vec<Vector> = (0..1000).map(|i| if i < 500 { Vector::z() } else { -Vector::z() }).collect();
    assert_eq!(cleaned(&both, &normals).2.merged, 0);
}

#[test]
fn density_does_not_decide_how_many_are_left() {
    let mut random = Random::new(3);
    let [few, many] = [20_000, 80_000].map(|count| {
        let points = bar(count, Point::origin(), &mut random);
        cleaned(&points, &unknown(&points)).0.len() as f32
    });
    assert!((many / few - 1.0).abs() < 0.15 && few < 6000.0, "{few} and {many}");
}

#[test]
fn large_planes_are_found_to_their_rims_and_small_ones_are_not() {
    for (seed, edge, noise) in [(4, 1.0, 0.0), (5, 0.6, 0.002), (6, 0.3, 0.001)] {
        let mut random = Random::new(seed);
        let mut points = bar(3000, Point::new(0.0, 0.0, 0.1), &mut random);
        let table = points.len() as u32;
        let count = (edge * edge * 12_000.0) as usize;
        points.extend(square(count, edge, Point::origin(), noise, &mut random));
        let (kept, on_planes, counts) = cleaned(&points, &unknown(&points));
        let of_table = kept.iter().filter(|index| **index >= table).count();
        assert!(on_planes.iter().all(|index| *index >= table), "a part of the bar with seed {seed}");
        assert!(counts.on_planes * 100 >= of_table * 98, "{counts:?} of {of_table} with seed {seed}");
    }
    // A board of 12 cm is one that hooks are mounted on.
    let mut random = Random::new(7);
    let board = square(4000, 0.12, Point::origin(), 0.0, &mut random);
    assert_eq!(cleaned(&board, &unknown(&board)).2.on_planes, 0);
}

#[test]
fn a_sparse_wall_is_a_plane_and_a_rack_of_bars_is_not() {
    let mut random = Random::new(8);
    let mut points = bar(3000, Point::new(0.0, 0.0, 0.1), &mut random);
    // 32 mm between points.
    points.extend(square(4000, 2.0, Point::origin(), 0.001, &mut random));
    let counts = cleaned(&points, &unknown(&points)).2;
    assert!(counts.on_planes + counts.merged > 3800, "{counts:?}");
    // Bars 4 cm apart.
    let bars = |k: usize| {
        let along = |_| {
            let mut next = |size: f32| size * (random.next_f32() - 0.5);
            Point::new(next(1.0), 0.04 * k as f32 + next(0.003), next(0.003))
        };
        (0..1000).map(along).collect::<Vec<_>>()
    };
    let rack: Vec<Point> = (0..25).flat_map(bars).collect();
    assert_eq!(cleaned(&rack, &unknown(&rack)).2.on_planes, 0);
}

#[test]
fn something_is_left_of_any_cloud() {
    for points in
        [vec![Point::origin()], vec![Point::origin(); 7], vec![Point::origin(), Point::new(1.0, 0.0, 0.0)]]
    {
        assert!(!cleaned(&points, &unknown(&points)).0.is_empty());
    }
}

#[test]
fn a_wall_is_thinned_the_more_the_farther_it_is_from_what_hangs() {
    let mut random = Random::new(5);
    let mut points = bar(3000, Point::new(0.0, 0.0, 0.1), &mut random);
    let surface = points.len() as u32;
    points.extend(square(60_000, 2.0, Point::new(0.013, 0.013, 0.013), 0.001, &mut random));
    let (kept, on_planes, counts) = cleaned(&points, &unknown(&points));
    assert!(kept.iter().filter(|index| **index < surface).count() > 2900 && counts.strays == 0);
    // 2 m by 2 m in squares of 5 cm are 1600, and 0.8 square metres near the bar in squares of 12.5 mm are 5100.
    assert!((3000..7500).contains(&on_planes.len()), "{}", on_planes.len());
    // No gap: every square of 10 cm has points, nearer ones more.
    let in_square = |x: f32, y: f32| {
        let is_in = |index: &&u32| {
            let point = points[**index as usize];
            (x..x + 0.1).contains(&point.x) && (y..y + 0.1).contains(&point.y)
        };
        on_planes.iter().filter(is_in).count()
    };
    for k in 0..400 {
        let [x, y] = [k % 20, k / 20].map(|i| i as f32 * 0.1 - 0.987);
        assert!(in_square(x, y) >= 1, "{x} {y}");
    }
    assert!(in_square(-0.05, -0.05) > 3 * in_square(0.8, 0.8));
}

#[test]
fn a_lattice_of_wires_is_no_plane_and_the_rim_of_a_plane_stays_where_it_is() {
    let mut random = Random::new(11);
    // Wires of 6 mm every 2 cm, both ways, 40 cm long.
    let wires = |(k, ahead): (usize, bool)| {
        let at = 0.02 * k as f32;
        let along = |_| {
            let (s, c) = (std::f32::consts::TAU * random.next_f32()).sin_cos();
            let (x, y) = (0.4 * random.next_f32(), at + 0.003 * c);
            if ahead { Point::new(x, y, 0.003 * s) } else { Point::new(y, x, 0.003 * s) }
        };
        (0..1500).map(along).collect::<Vec<_>>()
    };
    let lattice: Vec<Point> = (0..21).flat_map(|k| [(k, false), (k, true)]).flat_map(wires).collect();
    assert_eq!(cleaned(&lattice, &unknown(&lattice)).2.on_planes, 0);

    // A table top of 40 cm with a bar above it.
    let mut points = bar(3000, Point::new(0.0, 0.0, 0.1), &mut random);
    let surface = points.len();
    points.extend(square(40_000, 0.4, Point::origin(), 0.0, &mut random));
    let needed = model_bytes(merge::bytes(points.len()) + merge::scratch_bytes(points.len()));
    let mut memory = vec![0; needed];
    let mut arena = Arena::new(&mut memory, needed).unwrap();
    let kept = merge::merge(&points, &unknown(&points), &mut arena, &Meter::unwatched()).unwrap();
    let on_table = kept.names.iter().zip(&*kept.points).filter(|(name, _)| **name as usize >= surface);
    let top: Vec<Point> = on_table.map(|(_, point)| *point).collect();
    // Each point of the table had one within a few millimetres; now every place of the rim still has.
    for k in 0..80 {
        let along = 0.395 * (k as f32 / 79.0 - 0.5);
        for rim in [Point::new(0.2, along, 0.0), Point::new(along, -0.2, 0.0)] {
            let nearest = top.iter().map(|point| (point - rim).norm()).fold(f32::MAX, f32::min);
            assert!(nearest < 0.005, "{rim}: {nearest}");
        }
    }
    // Inside there are fewer: the square of the inner 30 cm in cubes of 12.5 mm.
    let inside = top.iter().filter(|point| point.x.abs() < 0.15 && point.y.abs() < 0.15).count();
    assert!(inside < 25 * 25 + 50, "{inside}");
}
