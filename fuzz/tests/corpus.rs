//! Runs every target over its seeds, its corpus, what was found before, and seeded mutations of these.

use fuzz::mutate::{Random, mutated};
use fuzz::{TARGETS, seeds};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs an input. It is kept in a file meanwhile, so that it is known whatever becomes of the process.
fn run(name: &str, target: fn(&[u8]), input: &[u8]) {
    let file = std::env::temp_dir().join(format!("fuzz-{name}-{}", std::process::id()));
    std::fs::write(&file, input).expect("a folder for temporary files");
    if let Err(panic) = catch_unwind(AssertUnwindSafe(|| target(input))) {
        eprintln!("target {name}: the input is in {}", file.display());
        std::panic::resume_unwind(panic);
    }
    std::fs::remove_file(&file).expect("it was written above");
}

fn check(name: &str, mutations: usize) {
    let target = TARGETS.iter().find(|(known, _)| *known == name).expect("a target").1;
    let inputs = [seeds::of(name), seeds::stored("corpus", name), seeds::stored("found", name)].concat();
    inputs.iter().for_each(|input| run(name, target, input));
    let mut random = Random(1);
    for _ in 0..mutations {
        let [one, other] = [0; 2].map(|_| random.below(inputs.len()));
        run(name, target, &mutated(&inputs[one], &inputs[other], &mut random));
    }
}

#[test]
fn files() {
    check("files", 60_000);
}

#[test]
fn models() {
    check("models", 250);
}

#[test]
fn images() {
    check("images", 2_500);
}

#[test]
fn calls() {
    check("calls", 3_000);
}

#[test]
fn every_function_of_the_header_is_called() {
    let header = include_str!("../../include/hangpose.h");
    let calls = [
        include_str!("../src/calls/mod.rs"),
        include_str!("../src/calls/hang.rs"),
        include_str!("../src/calls/depth.rs"),
    ]
    .concat();
    let declared = header.lines().filter(|line| !line.starts_with("//") && !line.starts_with(' '));
    let functions: Vec<_> = declared
        .filter_map(|line| line.split_once('(')?.0.split([' ', '*']).next_back())
        .filter(|name| name.starts_with("hangpose_"))
        .collect();
    assert!(functions.len() > 40, "{functions:?}");
    for function in functions {
        assert!(calls.contains(function), "{function} is never called");
    }
}
