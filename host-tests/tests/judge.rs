//! Tests of the judges: clear cases of hanging and falling have the same verdicts in both engines, and both obey
//! mechanics.

mod common;

use common::*;
use host_tests::judge::{Bullet, GRAVITY, Judge, Ode, Scene, Verdict};
use host_tests::shapes::Random;
use host_tests::solid::Solid;
use nalgebra::{Isometry3, Vector3};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

const JUDGES: [&dyn Judge; 2] = [&Bullet { time_step: 1.0 / 1920.0 }, &Ode { time_step: 1.0 / 960.0 }];

fn verdicts(object: &Solid, supporter: &Solid, release: &Isometry3<f32>) -> [Verdict; 2] {
    let scene = Scene::new(object, supporter);
    JUDGES.map(|judge| judge.judge(&scene, release))
}

fn hanging_mug() -> Isometry3<f32> {
    pose([0.045, 0.07, -0.0545], Vector3::y(), -90.0)
}

#[test]
fn the_defaults_are_what_is_tested() {
    assert_eq!(Bullet::default().time_step, 1.0 / 1920.0);
    assert_eq!(Ode::default().time_step, 1.0 / 960.0);
}

#[test]
fn what_hangs_holds() {
    let cases = [
        ("ring on peg", ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.0145), true),
        ("ring on hook", ring(0.03, 0.003), hook(), at(0.0, 0.07, -0.0225), true),
        ("mug on hook", mug(), hook(), hanging_mug(), true),
        ("ring on hulls", ring(0.03, 0.003), hulls(), at(0.0, 0.07, -0.0215), true),
        ("mug on hulls", mug(), hulls(), hanging_mug(), true),
        ("hanger on hook", hanger(), hook(), at(0.0, 0.07, -0.0125), true),
    ];
    for (name, object, supporter, release, robust) in &cases {
        for (judge, verdict) in JUDGES.iter().zip(verdicts(object, supporter, release)) {
            assert!(verdict.success(), "{name}, {}: {verdict:?}", judge.name());
            assert_eq!(verdict.robust, *robust, "{name}, {}: {verdict:?}", judge.name());
            assert!(verdict.figures.sank.abs() < 0.01 && verdict.figures.fell_after.is_none(), "{verdict:?}");
        }
    }
}

#[test]
fn what_does_not_hang_falls() {
    let cases = [
        ("ball on peg", ball(0.03), peg(), at(0.002, 0.05, 0.0425)),
        ("box on peg", cuboid([0.03, 0.03, 0.03]), peg(), pose([0.02, 0.05, 0.05], Vector3::y(), 20.0)),
        ("mug beside hook", mug(), hook(), at(0.1, 0.0, 0.0) * hanging_mug()),
        ("ring below peg", ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.05)),
    ];
    for (name, object, supporter, release) in &cases {
        for (judge, verdict) in JUDGES.iter().zip(verdicts(object, supporter, release)) {
            assert!(verdict.clear, "{name}, {}: {verdict:?}", judge.name());
            assert!(!verdict.holds && !verdict.success(), "{name}, {}: {verdict:?}", judge.name());
            assert!(
                verdict.figures.fell_after.is_some_and(|t| t < 2.0),
                "{name}, {}: {verdict:?}",
                judge.name()
            );
        }
    }
}

#[test]
fn what_is_pushed_through_is_not_clear() {
    // The rising end of the hook runs through the wall of the mug, and the peg through a solid box.
    let cases = [
        ("mug through hook", mug(), hook(), pose([0.02, 0.1, -0.01], Vector3::y(), -90.0)),
        ("box through peg", cuboid([0.02, 0.02, 0.02]), peg(), at(0.0, 0.05, 0.0075)),
        // The whole bar is in the box, and no surfaces intersect.
        (
            "box around bar",
            cuboid([0.05, 0.05, 0.05]),
            capsule([0.0; 3], [0.02, 0.0, 0.0], 0.004),
            at(0.0, 0.0, 0.0),
        ),
        ("ball in a box", ball(0.004), cuboid([0.05, 0.05, 0.05]), at(0.0, 0.0, 0.0)),
    ];
    for (name, object, supporter, release) in &cases {
        for (judge, verdict) in JUDGES.iter().zip(verdicts(object, supporter, release)) {
            assert!(!verdict.clear && !verdict.success(), "{name}, {}: {verdict:?}", judge.name());
            // A mug that the hook runs through stays under gravity in any direction.
            let stuck = verdict.holds && !verdict.honest;
            assert!(stuck || *name != "mug through hook", "{}: {verdict:?}", judge.name());
        }
    }
}

#[test]
fn what_is_wedged_is_not_honest() {
    // The hole of the ring is 0.5 mm smaller in radius than the peg. The pose is clear and holds, also under reversed
    // gravity.
    let tight = ring(PEG + 0.003 - 0.0005, 0.003);
    let level = capsule([0.0; 3], [0.0, 0.1, 0.0], PEG);
    for (judge, verdict) in JUDGES.iter().zip(verdicts(&tight, &level, &at(0.0, 0.05, 0.0))) {
        assert!(verdict.clear && verdict.holds, "{}: {verdict:?}", judge.name());
        assert!(!verdict.honest && !verdict.success(), "{}: {verdict:?}", judge.name());
    }
}

#[test]
fn a_little_play_is_enough_to_come_free() {
    // The ring is free while it moves by 2.5 mm. Only in the last two milliseconds has it moved by more than the
    // required 2 mm.
    let loose = ring(PEG + 0.003 + 0.00125, 0.003);
    let level = capsule([0.0; 3], [0.0, 0.1, 0.0], PEG);
    for (judge, verdict) in JUDGES.iter().zip(verdicts(&loose, &level, &at(0.0, 0.05, 0.0))) {
        assert!(verdict.success(), "{}: {verdict:?}", judge.name());
    }
}

#[test]
fn clear_ends_at_two_millimetres() {
    for (depth, clear) in [(0.001, true), (0.003, false)] {
        let cases = [
            (mug(), hook(), at(0.0, 0.0, -depth) * hanging_mug()),
            (ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.0155 - depth)),
            (ball(0.02), peg(), at(0.0, 0.05, 0.0075 + 0.024 * 1.011_f32 - depth)),
            (cuboid([0.02; 3]), capsule([0.0; 3], [0.0, 0.1, 0.0], PEG), at(0.0, 0.05, 0.024 - depth)),
        ];
        for (number, (object, supporter, release)) in cases.iter().enumerate() {
            for (judge, verdict) in JUDGES.iter().zip(verdicts(object, supporter, release)) {
                println!("{number} {depth} {}: {}", judge.name(), verdict.figures.penetration);
                assert_eq!(verdict.clear, clear, "{number}, {}: {verdict:?}", judge.name());
                let off = (verdict.figures.penetration - f64::from(depth)).abs();
                assert!(off < 0.0005, "{number}, {}: {off}", judge.name());
            }
        }
    }
}

#[test]
fn what_is_balanced_is_not_robust() {
    let rod = cuboid([0.1, 0.004, 0.002]);
    let level = capsule([0.0, -0.05, 0.0], [0.0, 0.05, 0.0], 0.008);
    for (judge, verdict) in JUDGES.iter().zip(verdicts(&rod, &level, &at(0.0, 0.0, 0.01))) {
        assert!(verdict.success(), "{}: {verdict:?}", judge.name());
        assert!(!verdict.robust, "{}: {verdict:?}", judge.name());
        assert!(!verdict.figures.tilts[0] && !verdict.figures.tilts[1], "{}: {verdict:?}", judge.name());
    }
}

#[test]
fn falling_gains_what_gravity_gives() {
    let (object, supporter) = (mug(), peg());
    let scene = Scene::new(&object, &supporter);
    let Scene { mass, .. } = scene;
    for judge in JUDGES {
        let mut world = judge.world(&scene);
        world.release(&at(1.0, 0.0, 0.0).cast());
        let mut start = world.state();
        start.spin = Vector3::new(5.0, 1.0, -3.0);
        world.place(&start);
        let energy = |spin: Vector3<f64>, rotation: nalgebra::UnitQuaternion<f64>| {
            let spin = (rotation * mass.frame.rotation).inverse() * spin;
            0.5 * spin.component_mul(&spin).dot(&Vector3::from(mass.inertia))
        };
        let turning = energy(start.spin, start.pose.rotation);
        for tenths in 1..=10 {
            world.pass(0.1);
            let (time, state) = (f64::from(tenths) * 0.1, world.state());
            let fallen = start.centre.z - state.centre.z;
            assert!(
                (fallen - GRAVITY * time * time / 2.0).abs() < 0.006 * time,
                "{}: {fallen}",
                judge.name()
            );
            assert!((state.velocity.z + GRAVITY * time).abs() < 0.001 * GRAVITY, "{}", judge.name());
            let now = energy(state.spin, state.pose.rotation);
            let expected = turning * (-2.0 * scene.damping * time).exp();
            assert!((now / expected - 1.0).abs() < 0.03, "{}: {turning} J, then {now} J", judge.name());
        }
    }
}

#[test]
fn a_pendulum_keeps_time() {
    // Two boards that lean against each other hang on a thin bar in the notch between them. Without friction the bar is
    // a hinge.
    const BAR: f32 = 0.002;
    let mut object = Solid::default();
    for side in [-1.0, 1.0] {
        let board = pose([0.0; 3], Vector3::y(), -45.0 * side) * at(side * 0.002, 0.0, -0.05);
        add_box(&mut object, board, [0.002, 0.02, 0.05]);
    }
    let bar = capsule([0.0, -0.1, 0.0], [0.0, 0.1, 0.0], BAR);
    let mut scene = Scene::new(&object, &bar);
    (scene.friction, scene.damping) = (0.0, 0.0);
    let mut worst = 0.0_f64;
    for judge in JUDGES {
        let mut world = judge.world(&scene);
        let release = at(0.0, 0.0, BAR * 2.0_f32.sqrt());
        let tilted = pose([0.0; 3], Vector3::y(), 5.0) * release;
        world.release(&tilted.cast());
        let length = world.state().centre.norm();
        let about = scene.mass.frame.rotation.inverse() * Vector3::y();
        let moment = about.component_mul(&about).dot(&Vector3::from(scene.mass.inertia));
        let mass = scene.mass.mass;
        let period =
            std::f64::consts::TAU * ((moment + mass * length * length) / (mass * GRAVITY * length)).sqrt();
        let mut crossings = Vec::new();
        let mut last = world.state();
        let mut time = 0.0;
        while crossings.len() < 11 && time < 10.0 {
            world.pass(1.0 / 960.0);
            time += 1.0 / 960.0;
            let state = world.state();
            if (state.centre.x > 0.0) != (last.centre.x > 0.0) {
                let part = state.centre.x / (state.centre.x - last.centre.x);
                crossings.push(time - part / 960.0);
            }
            last = state;
        }
        assert_eq!(crossings.len(), 11, "{}: {last:?}", judge.name());
        let measured = (crossings[10] - crossings[0]) / 5.0;
        println!("{}: {measured} s, theory {period} s", judge.name());
        worst = worst.max((measured / period - 1.0).abs());
    }
    assert!(worst < 0.02, "{worst}");
}

/// Verdicts on one random pose in Bullet and in ODE.
struct Trial {
    name: &'static str,
    release: Isometry3<f32>,
    verdicts: [Verdict; 2],
    /// Verdicts with half the time step.
    finer: [Verdict; 2],
    /// Success after displacements by 0.5 mm and 1 degree in two opposite directions.
    nudged: [[bool; 2]; 2],
}

impl Trial {
    /// Whether a small displacement changes a verdict.
    fn marginal(&self) -> bool {
        (0..2).any(|i| self.nudged[i].iter().any(|&nudged| nudged != self.verdicts[i].success()))
    }
}

/// Random numbers and poses in single precision.
struct Draw(Random);

impl Draw {
    /// Uniform in [0, 1).
    fn unit(&mut self) -> f32 {
        (self.0.next_u64() >> 40) as f32 / (1 << 24) as f32
    }

    /// Uniform in the cube [-1, 1)³.
    fn vector(&mut self) -> Vector3<f32> {
        Vector3::from_fn(|_, _| 2.0 * self.unit() - 1.0)
    }

    /// A rotation by at most `degrees`.
    fn turn(&mut self, degrees: f32) -> Isometry3<f32> {
        let (axis, share) = (self.vector(), self.unit());
        pose([0.0; 3], axis, degrees * share)
    }
}

const TRIALS: usize = 80;

fn trials() -> &'static [Trial] {
    static TRIALS_ONCE: OnceLock<Vec<Trial>> = OnceLock::new();
    TRIALS_ONCE.get_or_init(|| {
        let scenes = [
            ("ring on peg", ring(0.03, 0.003), peg(), at(0.0, 0.05, -0.0145)),
            ("ring on hulls", ring(0.03, 0.003), hulls(), at(0.0, 0.07, -0.0225)),
            ("mug on hook", mug(), hook(), hanging_mug()),
            ("mug on peg", mug(), peg(), pose([0.045, 0.05, -0.047], Vector3::y(), -90.0)),
            ("hanger on hook", hanger(), hook(), at(0.0, 0.07, -0.0125)),
        ];
        let next = AtomicUsize::new(0);
        let work = || {
            let mut done = Vec::new();
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= TRIALS {
                    return done;
                }
                let (name, object, supporter, hanging) = &scenes[number % scenes.len()];
                done.push((number, trial(number, name, object, supporter, hanging)));
            }
        };
        let mut done = std::thread::scope(|scope| {
            let threads = [scope.spawn(work), scope.spawn(work)];
            threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect::<Vec<_>>()
        });
        done.sort_by_key(|(number, _)| *number);
        done.into_iter().map(|(_, trial)| trial).collect()
    })
}

fn trial(
    number: usize,
    name: &'static str,
    object: &Solid,
    supporter: &Solid,
    hanging: &Isometry3<f32>,
) -> Trial {
    let mut random = Draw(Random::new(number as u64));
    let mut scene = Scene::new(object, supporter);
    scene.tilt = false;
    let centre = Vector3::from(scene.centre_of_mass());
    let about = |shift: Vector3<f32>, turn: Isometry3<f32>, pose: &Isometry3<f32>| {
        let middle = (pose * nalgebra::Point3::from(centre)).coords;
        nalgebra::Translation3::from(middle + shift) * turn * nalgebra::Translation3::from(-middle) * pose
    };
    // Deeply penetrating poses are rejected, since they say nothing about hanging.
    let release = loop {
        let release = about(random.vector() * 0.01, random.turn(40.0), hanging);
        let mut world = JUDGES[0].world(&scene);
        world.release(&release.cast());
        if world.penetration() < 0.003 {
            break release;
        }
    };
    let half: [&dyn Judge; 2] = [&Bullet { time_step: 0.5 / 1920.0 }, &Ode { time_step: 0.5 / 960.0 }];
    let shift = random.vector().normalize() * 0.0005;
    let axis = random.vector();
    let nudges = [1.0, -1.0].map(|sign| about(shift * sign, pose([0.0; 3], axis, sign), &release));
    Trial {
        name,
        release,
        verdicts: JUDGES.map(|judge| judge.judge(&scene, &release)),
        finer: half.map(|judge| judge.judge(&scene, &release)),
        nudged: JUDGES.map(|judge| nudges.map(|nudged| judge.judge(&scene, &nudged).success())),
    }
}

#[test]
fn the_engines_agree() {
    let clearly: Vec<_> = trials().iter().filter(|trial| !trial.marginal()).collect();
    let agree = |trial: &&&Trial| trial.verdicts[0].success() == trial.verdicts[1].success();
    let agreeing = clearly.iter().filter(agree).count();
    let hanging = clearly.iter().filter(|trial| trial.verdicts[0].success()).count();
    for trial in clearly.iter().filter(|trial| !agree(trial)) {
        println!("{}, {:?}\n  {:?}\n  {:?}", trial.name, trial.release, trial.verdicts[0], trial.verdicts[1]);
    }
    println!("{TRIALS} poses, {} not marginal, {hanging} of them hang; {agreeing} agree", clearly.len());
    let of_all = trials().iter().filter(|trial| agree(&trial)).count();
    println!("of all {of_all} agree");
    assert!(agreeing as f64 >= 0.95 * clearly.len() as f64);
    assert!(hanging * 5 > clearly.len() && hanging * 5 < clearly.len() * 4);
}

#[test]
fn half_the_time_step_changes_little() {
    for (i, judge) in JUDGES.iter().enumerate() {
        let changed = |trial: &&Trial| trial.verdicts[i].success() != trial.finer[i].success();
        let all = trials().iter().filter(changed).count();
        let clearly = trials().iter().filter(|trial| !trial.marginal()).filter(changed).count();
        for trial in trials().iter().filter(|trial| !trial.marginal()).filter(changed) {
            println!("{} {}\n  {:?}\n  {:?}", judge.name(), trial.name, trial.verdicts[i], trial.finer[i]);
        }
        println!(
            "{}: half the step changes {all} of all {TRIALS}, {clearly} of those that are not marginal",
            judge.name()
        );
        assert!(clearly as f64 <= 0.02 * TRIALS as f64, "{}", judge.name());
    }
}

#[test]
fn the_same_again_is_the_same() {
    let (object, supporter) = (mug(), hook());
    let releases = [hanging_mug(), at(0.005, 0.01, 0.0) * hanging_mug()];
    let judged = || releases.map(|release| verdicts(&object, &supporter, &release));
    let first = judged();
    let others = std::thread::scope(|scope| {
        let threads = [scope.spawn(judged), scope.spawn(judged)];
        threads.map(|thread| thread.join().unwrap())
    });
    // All bits are equal.
    assert_eq!([first, first], others);
}

#[test]
fn the_shapes_are_what_they_seem() {
    let (radius, thickness) = (0.03_f64, 0.003);
    let object = ring(0.03, 0.003);
    let peg = peg();
    let Scene { mass, .. } = Scene::new(&object, &peg);
    // The moments of a torus, up to the error of the polygon.
    let across = mass.mass * (radius * radius + 0.75 * thickness * thickness);
    let along = mass.mass * (0.5 * radius * radius + 0.625 * thickness * thickness);
    assert!(mass.frame.translation.vector.norm() < 1e-6);
    let mut moments = mass.inertia;
    moments.sort_by(f64::total_cmp);
    for (moment, expected) in moments.iter().zip([along, along, across]) {
        assert!((moment / expected - 1.0).abs() < 0.02, "{moments:?}");
    }
    for solid in [object, peg, hook(), hulls(), mug(), hanger(), ball(0.02), cuboid([0.01; 3])] {
        // Closed: triangles use every edge once in each direction.
        let edges = solid.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let mut edges: Vec<_> = edges.collect();
        let mut back: Vec<_> = edges.iter().map(|&(a, b)| (b, a)).collect();
        edges.sort_unstable();
        back.sort_unstable();
        assert_eq!(edges, back);
    }
}
