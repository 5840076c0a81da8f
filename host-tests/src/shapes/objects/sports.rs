//! Racquets.

use super::super::builder::Builder;
use super::super::sections::{circle, ellipse};
use super::super::vector::{X, Y, Z, arc, scale};
use super::{HangObject, OpeningKind, Random};

/// A strung hoop with a handle; a tennis racquet has an open throat.
pub(super) fn racquet(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let is_tennis = random.chance(0.5);
    let (a, b) = if is_tennis {
        (random.range(0.15, 0.17), random.range(0.115, 0.13))
    } else {
        (random.range(0.115, 0.125), random.range(0.09, 0.1))
    };
    let frame = if is_tennis { random.range(0.008, 0.01) } else { random.range(0.004, 0.005) };
    let x = |r: f64| scale([1.0, 0.0, 0.0], r);
    builder.sweep(&arc([0.0; 3], x(a), scale(Y, b), [0.0, 360.0], 36), Z, &ellipse(1.2 * frame, 0.8 * frame));
    // Strings end in the hoop's middle.
    let gut = if is_tennis { 0.0009 } else { 0.0006 };
    let spacing = random.range(0.017, 0.024);
    let chord = |across: f64, whole: f64, other: f64| {
        other * (1.0 - across * across / (whole * whole)).max(0.0).sqrt()
    };
    for (whole, other, lift, is_along) in [(b, a, -0.5 * gut, true), (a, b, 0.5 * gut, false)] {
        let count = (0.93 * whole / spacing) as i32;
        for i in -count..=count {
            let at = (f64::from(i) + 0.5) * spacing;
            let half = chord(at, whole, other);
            if half < 0.2 * other {
                continue;
            }
            let ends = [-half, half].map(|s| if is_along { [s, at, lift] } else { [at, s, lift] });
            builder.sweep(&ends, Z, &circle(gut));
        }
    }
    let grip = random.range(0.013, 0.017);
    let handle = if is_tennis { random.range(0.17, 0.2) } else { random.range(0.15, 0.18) };
    let shaft = if is_tennis { random.range(0.1, 0.13) } else { random.range(0.18, 0.22) };
    let neck = a + shaft;
    builder.sweep(&[[neck, 0.0, 0.0], [neck + handle, 0.0, 0.0]], Y, &ellipse(grip, 0.85 * grip));
    if !is_tennis {
        builder.tube(&[[a, 0.0, 0.0], [neck + 0.02, 0.0, 0.0]], 0.0035);
        let racquet = with_necks(HangObject::new(&builder).hole([0.0; 3], Z), [a, b], neck, grip);
        return between_strings(racquet, [a, b], spacing, gut);
    }
    for side in [-1.0, 1.0] {
        let [cos, sin] = super::super::vector::turn(32.0);
        let start = [a * cos, side * b * sin, 0.0];
        builder.tube(&[start, [neck + 0.01, side * 0.45 * grip, 0.0]], 0.8 * frame);
    }
    let racquet = HangObject::new(&builder).hole([0.0; 3], Z).hole([a + 0.3 * shaft, 0.0, 0.0], Z);
    between_strings(with_necks(racquet, [a, b], neck, grip), [a, b], spacing, gut)
}

/// Adds the ends of the shaft, by which a racquet hangs between two bars: the hoop or the handle is above them.
fn with_necks(racquet: HangObject, [a, b]: [f64; 2], neck: f64, grip: f64) -> HangObject {
    let below = |head: f64| OpeningKind::Neck { head_radius: head as f32 };
    racquet.also(below(b), [1.15 * a, 0.0, 0.0], scale(X, -1.0), 0.0035).also(
        below(grip),
        [neck, 0.0, 0.0],
        X,
        0.0035,
    )
}

/// Adds the openings between the strings of a hoop of half axes `a` and `b`.
fn between_strings(mut racquet: HangObject, [a, b]: [f64; 2], spacing: f64, gut: f64) -> HangObject {
    let count = (a / spacing) as i32;
    for (i, j) in (-count..=count).flat_map(|i| (-count..=count).map(move |j| (i, j))) {
        let [x, y] = [i, j].map(|k| f64::from(k) * spacing);
        if (x / a).powi(2) + (y / b).powi(2) < 0.9 && (i, j) != (0, 0) {
            racquet = racquet.also(OpeningKind::Hole, [x, y, 0.0], Z, spacing / 2.0 - gut);
        }
    }
    racquet
}
