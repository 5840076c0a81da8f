//! `make bench`: single queries of this project and of other libraries on the same data, one thread.
//!
//! Answers are compared before anything is measured. Each measurement is of all queries of a kind; `bench/primitives.py`
//! divides by their number and adds Open3D, Embree and MuJoCo. A binary, since a benchmark of cargo would compile all
//! dependencies once more, for its own way to panic.

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main};
use hangpose::Monitor;
use hangpose::geometry::Neighbour;
use hangpose::hanging::predict_bytes;
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::sampling;
use hangpose::perception::volume::{Volume, VolumeLimits, VolumeSettings};
use host_tests::performance::nanoflann;
use host_tests::performance::primitives::{Data, SAMPLES, TOLERANCE, VOXEL, ray, vector};
use host_tests::performance::step::Resting;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use parry3d::query::{PointQuery, RayCast};
use parry3d::shape::TriMeshFlags;
use std::hint::black_box;
use std::num::NonZero;
use std::path::PathBuf;
use std::time::Duration;

/// Blocks of the volume: more than the ball needs at 2 mm.
const BLOCKS: usize = 20_000;

/// Whether the arguments of the program ask for one of these groups: criterion leaves out measurements, but not what prepares
/// them. A filter is `^group/`.
fn is_wanted(groups: &[&str]) -> bool {
    let mut filters = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).peekable();
    filters.peek().is_none() || filters.any(|filter| groups.contains(&filter.trim_matches(['^', '/'])))
}

/// Measures the sum over all queries, so that no answer is left out.
fn measure<Q>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    queries: &[Q],
    mut answer: impl FnMut(&Q) -> f32,
) {
    group.bench_function(name, |bencher| {
        bencher.iter(|| queries.iter().map(|query| answer(black_box(query))).sum::<f32>());
    });
}

fn mesh_queries(criterion: &mut Criterion) {
    if !is_wanted(&["any_hit", "closest_hit", "closest_point", "signed_distance"]) {
        return;
    }
    let data = data();
    let mut memory = Vec::new();
    let object = data.object(&mut memory).expect("a mesh");
    let (surface, field) = (object.surface(), object.distance_field().expect("the profile has one"));
    // What parry needs for signs slows closest points down.
    let parry = data.parry(TriMeshFlags::ORIENTED).expect("a mesh");
    let unsigned = data.parry(TriMeshFlags::empty()).expect("a mesh");
    data.check_parry(surface, &parry).expect("the same answers");

    let mut group = criterion.benchmark_group("any_hit");
    measure(&mut group, "hangpose", &data.rays, |(o, d)| f32::from(u8::from(surface.any_hit(o, d))));
    measure(&mut group, "parry", &data.rays, |(o, d)| {
        f32::from(u8::from(unsigned.intersects_local_ray(&ray(o, d), f32::MAX)))
    });
    group.finish();
    let mut group = criterion.benchmark_group("closest_hit");
    measure(&mut group, "hangpose", &data.rays, |(o, d)| surface.closest_hit(o, d).unwrap_or_default());
    measure(&mut group, "parry", &data.rays, |(o, d)| {
        unsigned.cast_local_ray(&ray(o, d), f32::MAX, false).unwrap_or_default()
    });
    group.finish();
    let mut group = criterion.benchmark_group("closest_point");
    measure(&mut group, "hangpose", &data.points, |point| surface.closest_point(point).x);
    measure(&mut group, "parry", &data.points, |point| {
        unsigned.project_local_point(vector(point), false).point.x
    });
    group.finish();
    let mut group = criterion.benchmark_group("signed_distance");
    measure(&mut group, "hangpose", &data.points, |point| surface.signed_distance(point));
    measure(&mut group, "hangpose field", &data.points, |point| field.distance(point));
    measure(&mut group, "parry", &data.points, |point| parry.distance_to_local_point(vector(point), false));
    group.finish();
}

fn neighbours(criterion: &mut Criterion) {
    if !is_wanted(&["nearest", "eight_nearest"]) {
        return;
    }
    let data = data();
    let mut memory = Vec::new();
    let supporter = data.supporter(&mut memory).expect("a cloud");
    let tree = supporter.points();
    let points: Vec<[f32; 3]> = tree.points().iter().map(|point| (*point).into()).collect();
    let kiddo = ImmutableKdTree::<f32, 3>::new_from_slice(&points).expect("points");
    let flann = nanoflann::Tree::new(&points);
    for query in &data.near_cloud {
        let mut found = [Neighbour::default(); 8];
        let ours = tree.k_nearest(query, &mut found);
        let at: [f32; 3] = (*query).into();
        let eight =
            kiddo.query(&at).nearest_n::<SquaredEuclidean<f32>>(const { NonZero::new(8).unwrap() }).execute();
        let (_, squares) = flann.nearest::<8>(&at);
        for ((ours, kiddo), flann) in ours.iter().zip(&eight).zip(squares) {
            for theirs in [kiddo.distance, flann] {
                let apart = (ours.distance_squared.sqrt() - theirs.sqrt()).abs();
                assert!(apart < TOLERANCE, "near {query}: {ours:?}, others {theirs}");
            }
        }
    }

    let mut group = criterion.benchmark_group("nearest");
    measure(&mut group, "hangpose", &data.near_cloud, |query| tree.nearest(query).distance_squared);
    measure(&mut group, "kiddo", &data.near_cloud, |query| {
        kiddo.query(&(*query).into()).nearest_one::<SquaredEuclidean<f32>>().execute().distance
    });
    measure(&mut group, "nanoflann", &data.near_cloud, |query| flann.nearest::<1>(&(*query).into()).1[0]);
    group.finish();
    let mut group = criterion.benchmark_group("eight_nearest");
    measure(&mut group, "hangpose", &data.near_cloud, |query| {
        let mut found = [Neighbour::default(); 8];
        tree.k_nearest(query, &mut found)[7].distance_squared
    });
    measure(&mut group, "kiddo", &data.near_cloud, |query| {
        let eight = const { NonZero::new(8).unwrap() };
        kiddo.query(&(*query).into()).nearest_n::<SquaredEuclidean<f32>>(eight).execute()[7].distance
    });
    measure(&mut group, "nanoflann", &data.near_cloud, |query| flann.nearest::<8>(&(*query).into()).1[7]);
    group.finish();
}

fn perception(criterion: &mut Criterion) {
    if !is_wanted(&["poisson_disk", "fuse", "isosurface"]) {
        return;
    }
    let data = data();
    let mesh = data.mesh().expect("a mesh");
    let (mut points, mut normals) = (vec![[0.0; 3]; SAMPLES], vec![[0.0; 3]; SAMPLES]);
    let mut memory = vec![0; sampling::sample_bytes(SAMPLES)];
    let mut group = criterion.benchmark_group("poisson_disk");
    group.bench_function("hangpose", |bencher| {
        bencher.iter(|| {
            sampling::sample(&mesh, 1, &mut points, &mut normals, &mut memory).expect("enough memory")
        });
    });
    group.finish();

    let (image, monitor) = (data.image().expect("an image"), Monitor::new());
    let (settings, limits) = (VolumeSettings::new(VOXEL), VolumeLimits { blocks: BLOCKS });
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut group = criterion.benchmark_group("fuse");
    group.bench_function("hangpose", |bencher| {
        bencher.iter(|| {
            let mut volume = Volume::new(&settings, &limits, &mut memory).expect("enough memory");
            volume.integrate(&image, None, &monitor).expect("an image").voxels
        });
    });
    group.finish();
    let mut volume = Volume::new(&settings, &limits, &mut memory).expect("enough memory");
    volume.integrate(&image, None, &monitor).expect("an image");
    let mut scratch = vec![0; Isosurface::bytes(volume.blocks())];
    let mut group = criterion.benchmark_group("isosurface");
    group.bench_function("hangpose", |bencher| {
        bencher.iter(|| {
            let found = Isosurface::find(&volume, &mut scratch, &monitor).expect("enough memory");
            let (mut vertices, mut triangles) =
                (vec![[0.0; 3]; found.vertices()], vec![[0; 3]; found.triangles()]);
            found.write(&mut vertices, &mut triangles).expect("enough places");
            vertices.len()
        });
    });
    group.finish();
}

/// The time of a step is that of a release divided by its steps, which `speed primitives` writes.
fn contact_step(criterion: &mut Criterion) {
    if !is_wanted(&["contact_step"]) {
        return;
    }
    let resting = Resting::new().expect("a pair that hangs");
    let mut group = criterion.benchmark_group("contact_step");
    resting
        .with(|object, supporter, _| {
            let mut memory = vec![0; predict_bytes(&supporter.limits())];
            group.bench_function("hangpose", |bencher| {
                bencher.iter(|| resting.release(object, supporter, &mut memory).expect("a release"));
            });
            Ok(())
        })
        .expect("a pair");
    let mut world = resting.bullet();
    // The first contacts are made.
    world.pass(0.1);
    let step = f64::from(resting.params.time_step);
    group.bench_function("bullet", |bencher| bencher.iter(|| world.pass(100.0 * step)));
    group.finish();
}

fn data() -> Data {
    Data::new(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../samples")).expect("samples/ is complete")
}

criterion_group! {
    name = primitives;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(900))
        .without_plots();
    targets = mesh_queries, neighbours, perception, contact_step
}
criterion_main!(primitives);
