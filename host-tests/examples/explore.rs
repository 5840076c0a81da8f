//! Throwaway.
use hangpose::geometry::*;
use hangpose::mechanics::*;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, sample_supporter};
use host_tests::judge::*;
use host_tests::shapes::Random;
use host_tests::tables::case;
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

fn frame(along: Vector, down: Vector) -> Matrix3<f32> {
    let a = (along - down * along.dot(&down)).normalize();
    Matrix3::from_columns(&[a, down, a.cross(&down)])
}

fn main() {
    let pairs: usize = std::env::args().nth(1).map_or(60, |s| s.parse().unwrap());
    let per: usize = std::env::args().nth(2).map_or(4, |s| s.parse().unwrap());
    let env = |k: &str, d: f32| std::env::var(k).map_or(d, |s| s.parse().unwrap());
    for (k, (n, d)) in [("THIN", 0.0025), ("DISC", 0.6), ("ND", 0.9)].into_iter().enumerate() { hangpose::hanging::KNOBS[k].store(env(n, d).to_bits(), Ordering::Relaxed); }
    let (dt, cv, cw, mu) = (env("DT", 0.004), env("CV", 2.0), env("CW", 6.0), env("MU", 0.4));
    let cases: Vec<_> = case::made(pairs, 100);
    let next = AtomicUsize::new(0);
    let out = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let mesh = Mesh::new(&case.object.vertices, &case.object.triangles).unwrap();
                    let params = Params { samples: 2000, ..Params::default() };
                    let cloud = sample_supporter(&Mesh::new(&case.supporter.vertices, &case.supporter.triangles).unwrap(), 10_000, case.seed);
                    let (mut a, mut b) = (Vec::new(), Vec::new());
                    let monitor = Monitor::new();
                    let object = analyze_object(&mesh, &params, &mut a, &monitor).unwrap();
                    let cloud = cloud.cloud().unwrap();
                    let supporter = analyze_supporter(&cloud, &params, &mut b, &monitor).unwrap();
                    let (body, support) = (object.body(), supporter.support());
                    let samples = sample_supporter(&mesh, 2000, 1);
                    let mut random = Random::named(&case.name, 7);
                    let com = object.centre_of_mass();
                    let ps: Vec<(Point, Vector)> = samples.points.iter().zip(samples.normals.as_ref().unwrap()).map(|(p, n)| (Point::from(*p), Vector::from(*n))).filter(|(p, n)| (com - p).dot(n) > 0.3 * (com - p).norm()).collect();
                    let qs: Vec<Point> = support.tree.points().iter().zip(support.normals).filter(|(_, n)| n.z > 0.3).map(|(p, _)| *p).collect();
                    if ps.is_empty() || qs.is_empty() { continue; }
                    let scene = Scene::filled(&case.object, &case.supporter, &case.filling);
                    let mut scene = scene; scene.tilt = false;
                    let mut near = vec![Near::default(); 10_000];
                    let mut got = 0;
                    for _ in 0..5000 {
                        if got == per { break; }
                        let (p, n) = ps[(random.range(0.0, ps.len() as f64) as usize).min(ps.len() - 1)];
                        let _ = n;
                        let q = qs[(random.range(0.0, qs.len() as f64) as usize).min(qs.len() - 1)];
                        let down = (com - p).normalize();
                        let any = if down.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
                        let of = frame(any, down);
                        let yaw = random.range(0.0, 6.283) as f32;
                        let sf = frame(Vector::new(yaw.cos(), yaw.sin(), 0.0), -Vector::z());
                        let rot = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(sf * of.transpose()));
                        let lift = random.range(0.0015, 0.006) as f32;
                        let t = (q + Vector::z() * lift) - rot * p;
                        let pose = Pose::from_parts(Translation3::from(t), rot);
                        if !is_clear(&body, &support, &pose, 0.0005) { continue; }
                        got += 1;
                        let settings = Settings { gravity: Vector::new(0.0, 0.0, -9.81), friction: mu, time_step: dt, steps: (3.0 / dt) as usize, damping: [cv, cw] };
                        let start = Instant::now();
                        let settled = settle(&body, &support, &pose, &settings, &mut near);
                        let micros = start.elapsed().as_secs_f64() * 1e6;
                        let verdict = Bullet::default().judge(&scene, &pose);
                        out.lock().unwrap().push((case.object_kind.clone(), case.supporter_kind.clone(), settled, verdict, micros));
                    }
                }
            });
        }
    });
    let rows = out.into_inner().unwrap();
    let mut by: BTreeMap<String, [usize; 4]> = BTreeMap::new();
    let mut total = [0; 4];
    let mut fates = BTreeMap::new();
    for (o, s, settled, verdict, _) in &rows {
        if verdict.figures.penetration > 0.002 { continue; }
        let ours = settled.fate == Fate::Rests;
        let k = ours as usize * 2 + verdict.holds as usize;
        total[k] += 1;
        by.entry(format!("o {o}")).or_default()[k] += 1;
        by.entry(format!("s {s}")).or_default()[k] += 1;
        *fates.entry((format!("{:?}", settled.fate), verdict.holds)).or_insert(0) += 1;
    }
    for (k, v) in &by { println!("{k:24} fall/fall {:4}  fall/HOLD {:4}  HOLD/fall {:4}  hold/hold {:4}", v[0], v[1], v[2], v[3]); }
    println!("{total:?} agreement {:.1}%", 100.0 * (total[0] + total[3]) as f64 / total.iter().sum::<usize>() as f64);
    println!("{fates:?}");
    println!("steps, awake, touching, near, gathers {:?}", DEBUG.each_ref().map(|d| d.load(Ordering::Relaxed)));
    if std::env::var("V").is_ok() { for (o, s, settled, v, _) in &rows { if (settled.fate == Fate::Rests) != v.holds { println!("{o} {s} {:?} sank {:.1} turned {:.2} contacts {} steps {} | bullet holds {} sank {:.1} turned {:.2} pen {:.2} speed {:.3} touches {} fell {:?}", settled.fate, settled.sank * 1e3, settled.turned, settled.contacts, settled.steps, v.holds, v.figures.sank * 1e3, v.figures.turned, v.figures.penetration * 1e3, v.figures.speed, v.figures.touches, v.figures.fell_after); } } }
    let mut us: Vec<f64> = rows.iter().map(|r| r.4).collect();
    us.sort_by(f64::total_cmp);
    let steps: usize = rows.iter().map(|r| r.2.steps).sum();
    println!("median {:.0} us, mean {:.0} us, per step {:.2} us", us[us.len() / 2], us.iter().sum::<f64>() / us.len() as f64, us.iter().sum::<f64>() / steps as f64);
}
