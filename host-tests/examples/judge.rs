//! Prints the verdicts of both judges on hand-made scenes and their median time per judgement in milliseconds.

#[allow(dead_code)]
#[path = "../tests/common/mod.rs"]
mod common;

use common::{at, hanger, hook, mug, peg, pose, ring};
use host_tests::judge::{Bullet, Judge, Ode, Scene};
use nalgebra::Vector3;
use std::time::Instant;

const RUNS: usize = 7;

fn main() {
    let scenes = [
        ("mug on hook", mug(), hook(), pose([0.045, 0.07, -0.054], Vector3::y(), -90.0)),
        (
            "mug on hook, swinging",
            mug(),
            hook(),
            pose([0.0, 0.07, 0.004], Vector3::y(), 20.0) * pose([0.045, 0.0, -0.058], Vector3::y(), -90.0),
        ),
        ("mug beside hook", mug(), hook(), pose([0.145, 0.07, -0.054], Vector3::y(), -90.0)),
        ("ring on peg", ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.014)),
        ("hanger on peg", hanger(), peg(), at(0.0, 0.05, -0.004)),
    ];
    let judges: [&dyn Judge; 2] = [&Bullet::default(), &Ode::default()];
    for (name, object, supporter, release) in &scenes {
        let scene = Scene::new(object, supporter);
        for judge in judges {
            let mut times: Vec<_> = (0..RUNS)
                .map(|_| {
                    let start = Instant::now();
                    std::hint::black_box(judge.judge(&scene, release));
                    start.elapsed().as_secs_f64() * 1e3
                })
                .collect();
            times.sort_by(f64::total_cmp);
            let verdict = judge.judge(&scene, release);
            println!("{name}, {}: {:.0} ms", judge.name(), times[RUNS / 2]);
            println!("  {verdict:.4?}");
        }
    }
}
