//! Throwaway.
use hangpose::geometry::*;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, sample_supporter};
use host_tests::tables::case;
use std::time::Instant;
fn main() { for (k, d) in [0.002_f32, 0.35, 0.9].into_iter().enumerate() { hangpose::hanging::KNOBS[k].store(d.to_bits(), std::sync::atomic::Ordering::Relaxed); }
    for case in case::made(22, 100) {
        let mesh = Mesh::new(&case.object.vertices, &case.object.triangles).unwrap();
        let params = Params::default();
        let (mut a, mut b) = (Vec::new(), Vec::new());
        let monitor = Monitor::new();
        let _ = analyze_object(&mesh, &params, &mut a, &monitor).unwrap();
        let start = Instant::now();
        let object = analyze_object(&mesh, &params, &mut a, &monitor).unwrap();
        let t = start.elapsed().as_secs_f64() * 1e3;
        let cloud = sample_supporter(&Mesh::new(&case.supporter.vertices, &case.supporter.triangles).unwrap(), 10_000, case.seed);
        let cloud = cloud.cloud().unwrap();
        let start = Instant::now();
        let supporter = analyze_supporter(&cloud, &params, &mut b, &monitor).unwrap();
        let ts = start.elapsed().as_secs_f64() * 1e3;
        let f = object.body().field;
        let start = Instant::now();
        let mut sum = 0.0;
        let bb = object.surface().aabb();
        for i in 0..100000 { let x = (i % 97) as f32 / 97.0; let y = (i % 89) as f32 / 89.0; let z = (i % 83) as f32 / 83.0; let e = bb.extents(); let p = bb.min + Vector::new(x * e.x, y * e.y, z * e.z); sum += f.sample(&p).0; }
        let q = start.elapsed().as_secs_f64() * 1e9 / 1e5;
        println!("{:16} tri {:6} extent {:.3} voxel {:.2} mm object {t:.1} ms ({:.2} MB) query {q:.0} ns | {:14} {ts:.1} ms disc {:.2} mm chosen {} ({sum:.1})", case.object_kind, mesh.triangles().len(), bb.extents().max(), f.voxel_size() * 1e3, a.len() as f64 / 1e6, case.supporter_kind, supporter.support().disc * 1e3, supporter.support().is_chosen.iter().filter(|c| **c > 0).count());
    }
}
