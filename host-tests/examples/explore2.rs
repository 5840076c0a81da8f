//! Throwaway.
use hangpose::geometry::*;
use hangpose::hanging::search::*;
use hangpose::hanging::{ObjectContact, SupportContact};
use hangpose::mechanics::*;
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, sample_supporter};
use host_tests::judge::*;
use host_tests::tables::{case, real};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

fn main() {
    let pairs: usize = std::env::args().nth(1).map_or(60, |s| s.parse().unwrap());
    let env = |k: &str, d: f32| std::env::var(k).map_or(d, |s| s.parse().unwrap());
    for (k, (n, d)) in [("THIN", 0.0025), ("DISC", 0.6), ("ND", 0.9)].into_iter().enumerate() { hangpose::hanging::KNOBS[k].store(env(n, d).to_bits(), Ordering::Relaxed); }
    let (dt, cv, cw, mu) = (env("DT", 0.004), env("CV", 2.0), env("CW", 6.0), env("MU", 0.4));
    let knobs = [env("P", 192.0), env("N", 32.0), env("KC", 1.0), env("KY", 1.0), env("FIRM", 3.0), env("FP", 0.5), env("FQ", 0.3), env("RATE", 1.5), env("LEAST", 0.0)];
    let verbose = std::env::var("V").is_ok();
    let seed = env("SEED", 100.0) as u64;
    let only = std::env::var("ONLY").unwrap_or_default();
    let mut cases: Vec<_> = if let Ok(dir) = std::env::var("REAL") { real::real(dir.as_ref(), pairs).unwrap() } else { case::made(pairs, seed) };
    cases.retain(|c| c.name.contains(&only));
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
                    let samples = sample_supporter(&mesh, 10000, 1);
                    let com = object.centre_of_mass();
                    let start = Instant::now();
                    let mut oc = vec![bytemuck::Zeroable::zeroed(); 192];
                    let mut sc = vec![bytemuck::Zeroable::zeroed(); 128];
                    let oc: &[ObjectContact] = object_contacts(object.surface(), bytemuck::cast_slice(&samples.points), bytemuck::cast_slice(samples.normals.as_ref().unwrap()), com, env("COS", 0.3), &mut oc);
                    let t1 = start.elapsed().as_secs_f64();
                    let sc: &[SupportContact] = support_contacts(&support, 0.3, &mut sc);
                    let t2 = start.elapsed().as_secs_f64();
                    let settings = Settings { gravity: Vector::new(0.0, 0.0, -9.81), friction: mu, time_step: dt, steps: (3.0 / dt) as usize, damping: [cv, cw] };
                    let mut near = vec![Near::default(); 10_000];
                    let mut found = Vec::new();
                    let stats = search(&body, oc, &support, sc, &knobs, &settings, &mut near, &mut |f, _| found.push(*f));
                    let t3 = start.elapsed().as_secs_f64();
                    found.sort_by(|a, b| b.least.total_cmp(&a.least));
                    let best = found.first().map(|f| {
                        let (release, gap) = release_pose(&body, &support, &f.rest, 0.001, &Vector::z(), &mut vec![Near::default(); 10_000]);
                        let scene = Scene::filled(&case.object, &case.supporter, &case.filling);
                        let v = if case.fits { Some(Bullet::default().judge(&scene, &release)) } else { None };
                        (*f, gap, v)
                    });
                    if verbose {
                        println!("{:50} contacts {} {} stats {:?} times {:.1} {:.1} {:.1} ms found {} best {:?}", case.name, oc.len(), sc.len(), stats, t1 * 1e3, (t2 - t1) * 1e3, (t3 - t2) * 1e3, found.len(),
                            best.as_ref().map(|(f, gap, v)| (f.tilts, f.least, f.tries, gap * 1e3, v.as_ref().map(|v| (v.clear, v.holds, v.honest, v.robust, v.figures.penetration * 1e3, v.figures.sank * 1e3, v.figures.turned, v.figures.tilts)))));
                    }
                    out.lock().unwrap().push((case.object_kind.clone(), case.supporter_kind.clone(), case.fits, best, [t1, t2 - t1, t3 - t2]));
                }
            });
        }
    });
    let rows = out.into_inner().unwrap();
    let mut by: BTreeMap<String, [usize; 5]> = BTreeMap::new();
    let mut tilt_rows = Vec::new();
    let (mut rejected, mut unhangable) = ([0; 5], 0);
    for (o, s, fits, best, _) in &rows {
        if !fits { unhangable += 1; let t = best.as_ref().map_or(0, |b| b.0.tilts as usize); if best.is_some() { rejected[t] += 1; } continue; }
        let v = best.as_ref().and_then(|b| b.2.as_ref());
        if let (Some(b), Some(v)) = (best, v) { if v.success() { tilt_rows.push((b.0.least, v.robust)); } }
        for k in [format!("o {o}"), format!("s {s}"), "all".into()] {
            let e = by.entry(k).or_default();
            e[0] += 1;
            e[1] += v.is_some() as usize;
            e[2] += v.is_some_and(|v| v.success()) as usize;
            e[3] += v.is_some_and(|v| v.success() && v.robust) as usize;
            e[4] += (best.as_ref().is_some_and(|b| b.0.tilts == 4)) as usize;
        }
    }
    for (k, v) in &by { println!("{k:24} pairs {:4} found {:3.0} success {:3.0} robust {:3.0}  ours firm {:3.0}", v[0], 100.0 * v[1] as f64 / v[0] as f64, 100.0 * v[2] as f64 / v[0] as f64, 100.0 * v[3] as f64 / v[0] as f64, 100.0 * v[4] as f64 / v[0] as f64); }
    for (lo, hi) in [(0.0, 0.2), (0.2, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 1.0), (1.0, 1.04), (1.04, 9.0)] { let n = tilt_rows.iter().filter(|r| r.0 >= lo && r.0 < hi).count(); let r = tilt_rows.iter().filter(|r| r.0 >= lo && r.0 < hi && r.1).count(); println!("tilt {lo}-{hi}: {n} robust {r}"); }
    println!("unhangable {unhangable}: found with tilts 0..4 {rejected:?}");
    for k in 0..3 {
        let mut t: Vec<f64> = rows.iter().map(|r| r.4[k] * 1e3).collect();
        t.sort_by(f64::total_cmp);
        println!("time {k}: median {:.1} mean {:.1} max {:.1} ms", t[t.len() / 2], t.iter().sum::<f64>() / t.len() as f64, t[t.len() - 1]);
    }
}
