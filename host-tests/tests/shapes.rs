//! Every shape is closed and agrees with its convex parts, and its openings have the stated widths.

mod distances;

use std::collections::HashMap;

use distances::{Hull, distance_to_part, distance_to_triangle, winding_number};
use hangpose::geometry::Mesh;
use host_tests::shapes::{HangObject, OBJECTS, OpeningKind, Random, SUPPORTERS, fits};
use host_tests::solid::{Part, Solid};

const SEEDS: u64 = 10;

fn all_solids(seed: u64) -> Vec<(String, Solid)> {
    let objects = OBJECTS.iter().map(|k| (k.name, k.make(seed).solid));
    let supporters = SUPPORTERS.iter().map(|k| (k.name, k.make(seed).solid));
    objects.chain(supporters).map(|(name, solid)| (format!("{name} {seed}"), solid)).collect()
}

fn double(v: [f32; 3]) -> [f64; 3] {
    v.map(f64::from)
}

fn corners(solid: &Solid) -> Vec<[[f64; 3]; 3]> {
    solid.triangles.iter().map(|t| t.map(|v| double(solid.vertices[v as usize]))).collect()
}

/// Random points on the surface, each in a random triangle.
fn surface_points(solid: &Solid, count: usize) -> Vec<[f64; 3]> {
    let (triangles, mut random) = (corners(solid), Random::new(1));
    (0..count)
        .map(|_| {
            let [a, b, c] = triangles[random.pick(triangles.len())];
            let (s, t) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            [0, 1, 2].map(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]))
        })
        .collect()
}

#[test]
fn meshes_are_closed_and_of_a_size() {
    for seed in 0..SEEDS {
        for (name, solid) in all_solids(seed) {
            let mesh = Mesh::new(&solid.vertices, &solid.triangles).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(mesh.vertices().len(), solid.vertices.len());
            let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
            for t in &solid.triangles {
                for i in 0..3 {
                    *edges.entry((t[i], t[(i + 1) % 3])).or_default() += 1;
                }
            }
            for (&(a, b), &count) in &edges {
                assert!(count == 1 && edges.get(&(b, a)) == Some(&1), "{name}: edge {a}-{b} is not manifold");
            }
            let volume: f64 = (corners(&solid).iter())
                .map(|&[a, b, c]| {
                    a[0] * (b[1] * c[2] - b[2] * c[1])
                        + a[1] * (b[2] * c[0] - b[0] * c[2])
                        + a[2] * (b[0] * c[1] - b[1] * c[0])
                })
                .sum();
            assert!(volume > 6e-9, "{name}: volume {}", volume / 6.0);
            let extent = (0..3)
                .map(|i| {
                    let of = |f: fn(f32, f32) -> f32, from| solid.vertices.iter().map(|v| v[i]).fold(from, f);
                    of(f32::max, f32::MIN) - of(f32::min, f32::MAX)
                })
                .fold(0.0, f32::max);
            assert!((0.02..1.2).contains(&extent), "{name}: {extent} m");
        }
    }
}

#[test]
fn parts_agree_with_the_mesh() {
    for seed in 0..SEEDS {
        for (name, solid) in all_solids(seed) {
            let hulls: Vec<Hull> = solid.parts.iter().map(Hull::of).collect();
            for p in surface_points(&solid, 150) {
                let nearest =
                    hulls.iter().map(|h| distance_to_part(h, p).abs()).fold(f64::INFINITY, f64::min);
                assert!(nearest < 5e-4, "{name}: the surface at {p:?} is {nearest} m from the closest part");
            }
            let (triangles, mut random) = (corners(&solid), Random::new(2));
            for _ in 0..40 {
                let part = &solid.parts[random.pick(solid.parts.len())];
                for p in points_of(part, &mut random) {
                    let is_inside = winding_number(&triangles, p) > 0.5;
                    let distance =
                        || triangles.iter().map(|t| distance_to_triangle(p, t)).fold(f64::INFINITY, f64::min);
                    assert!(
                        is_inside || distance() < 5e-4,
                        "{name}: {p:?} of {part:?} is {} m outside",
                        distance()
                    );
                }
            }
        }
    }
}

/// Points in and on the part.
fn points_of(part: &Part, random: &mut Random) -> Vec<[f64; 3]> {
    match part {
        Part::Hull(points) => {
            let weights: Vec<f64> = points.iter().map(|_| random.range(0.0, 1.0).powi(8)).collect();
            let sum: f64 = weights.iter().sum();
            let within = |i: usize| points.iter().zip(&weights).map(|(p, w)| f64::from(p[i]) * w / sum).sum();
            vec![[0, 1, 2].map(within), double(points[random.pick(points.len())])]
        }
        &Part::Capsule { from, to, radius } => {
            let (t, out) = (random.range(0.0, 1.0), [0; 3].map(|_| random.range(-1.0, 1.0)));
            let length = out.iter().map(|x| x * x).sum::<f64>().sqrt();
            let (from, to) = (double(from), double(to));
            let at = |t: f64| {
                [0, 1, 2].map(|i| from[i] + t * (to[i] - from[i]) + f64::from(radius) * out[i] / length)
            };
            vec![at(t), at(0.0)]
        }
        Part::Cuboid { centre, axes, half_extents } => {
            let s = [0; 3].map(|_| random.range(-1.0, 1.0));
            let offset =
                |i: usize| (0..3).map(|k| s[k] * f64::from(half_extents[k] * axes[k][i])).sum::<f64>();
            vec![[0, 1, 2].map(|i| f64::from(centre[i]) + offset(i))]
        }
    }
}

#[test]
fn seeds_name_shapes() {
    let bytes = |solid: &Solid| {
        format!(
            "{:?}",
            (solid.vertices.iter().map(|v| v.map(f32::to_bits)).collect::<Vec<_>>(), &solid.parts)
        )
    };
    for seed in 0..SEEDS {
        for ((name, a), ((_, again), (_, b))) in
            all_solids(seed).iter().zip(all_solids(seed).iter().zip(&all_solids(seed + 1)))
        {
            assert_eq!(bytes(a), bytes(again), "{name}");
            assert_ne!(bytes(a), bytes(b), "{name}");
        }
    }
}

#[test]
fn openings_are_as_wide_as_they_say() {
    for seed in 0..SEEDS {
        for kind in OBJECTS {
            let HangObject { solid, openings } = kind.make(seed);
            assert_eq!(openings.is_empty(), !kind.is_hangable, "{}", kind.name);
            let triangles = corners(&solid);
            let hulls: Vec<Hull> = solid.parts.iter().map(Hull::of).collect();
            for o in openings {
                if !o.is_meant || matches!(o.kind, OpeningKind::Rim | OpeningKind::Neck { .. }) {
                    continue;
                }
                let (centre, axis) = (double(o.centre), double(o.axis));
                let clearance = (-10..=10)
                    .map(|k| [0, 1, 2].map(|i| centre[i] + axis[i] * 5e-4 * f64::from(k)))
                    .flat_map(|p| triangles.iter().map(move |t| distance_to_triangle(p, t)))
                    .fold(f64::INFINITY, f64::min);
                assert!(hulls.iter().all(|h| distance_to_part(h, centre) > 0.0), "{}: {o:?}", kind.name);
                let clear = f64::from(o.clear_radius);
                let name = format!("{} {seed}: {o:?}, but {clearance}", kind.name);
                assert!(clear > 0.0015 && clearance > clear - 5e-4, "{name}");
                // The clear radius of a hook is limited by its mouth, too.
                assert!(o.kind == OpeningKind::Hook || clearance < clear + 1e-3, "{name}");
            }
        }
    }
}

fn object(name: &str, seed: u64) -> HangObject {
    OBJECTS.iter().find(|k| k.name == name).expect("a kind of this name").make(seed)
}

#[test]
fn fits_is_true_and_false_where_it_is_plain() {
    let supporter = |name: &str, seed| SUPPORTERS.iter().find(|k| k.name == name).unwrap().make(seed);
    for seed in 0..SEEDS {
        assert!(fits(&object("ring", seed), &supporter("nail", seed)), "ring on nail {seed}");
        assert!(fits(&object("headphone", seed), &supporter("peg", seed)), "headphone on peg {seed}");
        for kind in OBJECTS.iter().filter(|k| !k.is_hangable) {
            assert!(SUPPORTERS.iter().all(|s| !fits(&kind.make(seed), &s.make(seed))), "{}", kind.name);
        }
        for name in ["key", "ring", "mug", "knife", "cap"] {
            assert!(!fits(&object(name, seed), &supporter("rail", seed)), "{name} on a rail {seed}");
        }
        assert!(
            !fits(&object("cap", seed), &supporter("nail", seed))
                || supporter("nail", seed).bars[0].tilt > 0.35
        );
    }
}

#[test]
fn every_hangable_kind_fits_somewhere() {
    const SEEDS: u64 = 20;
    let supporters: Vec<Vec<_>> =
        SUPPORTERS.iter().map(|s| (0..SEEDS).map(|i| s.make(i)).collect()).collect();
    let mut table = format!("{:16}", "");
    SUPPORTERS.iter().for_each(|s| table += &format!("{:>6.5}", s.name));
    let mut shares = Vec::new();
    for kind in OBJECTS.iter().filter(|k| k.is_hangable) {
        let objects: Vec<_> = (0..SEEDS).map(|i| kind.make(100 + i)).collect();
        let share = |kind: &Vec<_>| {
            let pairs = objects.iter().flat_map(|o| kind.iter().map(move |s| (o, s)));
            100.0 * pairs.filter(|(o, s)| fits(o, s)).count() as f64 / (SEEDS * SEEDS) as f64
        };
        let row: Vec<f64> = supporters.iter().map(share).collect();
        table += &format!("\n{:16}", kind.name);
        row.iter().for_each(|s| table += &format!("{s:6.0}"));
        assert!(row.iter().any(|&s| s > 5.0), "{} fits nowhere\n{table}", kind.name);
        shares.push(row.iter().sum::<f64>() / row.len() as f64);
    }
    let share = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("percent of pairs that fit\n{table}\nin all {share:.0}");
    assert!((20.0..80.0).contains(&share), "{share} % of all pairs fit");
}
