//! Kitchen tools.

use super::super::builder::Builder;
use super::super::sections::{ellipse, rectangle};
use super::super::vector::{X, Y, Z, arc, bezier, scale, turn};
use super::{HangObject, OpeningKind, Random};

/// A spatula with a hole in its handle's end, or a ladle whose handle ends in a hook or a hole.
pub(super) fn utensil(random: &mut Random) -> HangObject {
    match random.pick(3) {
        0 => spatula(random),
        1 => ladle(random, true),
        _ => ladle(random, false),
    }
}

/// Adds a flat handle along x with a hole at the origin.
fn handle_with_hole(builder: &mut Builder, random: &mut Random, length: f64) {
    let hole = random.range(0.0035, 0.0075);
    let (rim, thick) = (hole + random.range(0.004, 0.007), random.range(0.004, 0.008));
    let stretch = random.range(1.0, 1.5);
    builder.eye(
        [0.0, 0.0],
        [stretch * hole, hole],
        [stretch * hole + rim - hole, rim],
        [-thick / 2.0, thick / 2.0],
    );
    let near = stretch * hole + 0.4 * (rim - hole);
    let inner = 0.8 * rim;
    let outline = [[near, -inner], [length, -0.6 * rim], [length, 0.6 * rim], [near, inner]];
    builder.prism(&outline, [0.0003 - thick / 2.0, thick / 2.0 - 0.0003]);
}

fn spatula(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let length = random.range(0.2, 0.28);
    handle_with_hole(&mut builder, random, length);
    let (broad, long) = (random.range(0.03, 0.045), random.range(0.08, 0.11));
    let bend = random.range(0.005, 0.025);
    let blade = |x: f64, half: f64, z: f64| {
        vec![[x, -half, z - 0.001], [x, half, z - 0.001], [x, half, z + 0.001], [x, -half, z + 0.001]]
    };
    builder.loft(
        &[
            blade(length - 0.01, 0.006, 0.0),
            blade(length + 0.03, 0.8 * broad, -bend),
            blade(length + long, broad, -bend),
        ],
        false,
    );
    let neck = OpeningKind::Neck { head_radius: broad as f32 };
    HangObject::new(&builder).hole([0.0; 3], Z).also(neck, [length, 0.0, 0.0], X, 0.008)
}

fn ladle(random: &mut Random, has_hook: bool) -> HangObject {
    let mut builder = Builder::default();
    let (length, radius) = (random.range(0.22, 0.3), random.range(0.035, 0.05));
    let wall = 0.002;
    let bowl: Vec<_> = (0..=8)
        .map(|i| turn(90.0 - 11.25 * f64::from(i)))
        .enumerate()
        .map(|(i, [cos, sin])| {
            [radius, radius - wall].map(|r| [if i == 0 { 0.0 } else { r * cos }, -r * sin])
        })
        .collect();
    let mut cup = Builder::default();
    cup.revolve(&bowl);
    // The handle runs along x to the rim of the bowl, which opens along z.
    builder.place(&cup, [X, Y, Z], [length + radius, 0.0, 0.0]);
    let bowl_at = [length + radius, 0.0, -0.5 * radius];
    let neck = OpeningKind::Neck { head_radius: radius as f32 };
    let bowl = |ladle: HangObject| {
        let ladle = ladle.also(OpeningKind::Rim, bowl_at, Z, 0.5 * radius);
        ladle.also(neck, [length, 0.0, 0.0], X, 0.008)
    };
    if !has_hook {
        handle_with_hole(&mut builder, random, length + 0.001);
        return bowl(HangObject::new(&builder).hole([0.0; 3], Z));
    }
    let thick = random.range(0.0025, 0.004);
    let bend = random.range(0.011, 0.018);
    let tip = random.range(150.0, 180.0);
    let mut path = vec![[length, 0.0, 0.0]];
    path.extend(arc([0.0, 0.0, -bend], scale(Z, bend), scale(X, -bend), [0.0, tip], 16));
    builder.sweep(&path, Y, &ellipse(1.6 * thick, thick));
    bowl(HangObject::new(&builder).hook([0.0, 0.0, -bend], Y, 2.0 * (bend - thick)))
}

/// A blade and a handle with a hole or a ring at its end, or a cleaver with a hole in the blade.
pub(super) fn knife(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let handle = random.range(0.1, 0.13);
    let back = random.range(0.002, 0.0035);
    if random.chance(0.25) {
        return cleaver(random, handle, back);
    }
    let (blade, deep) = (random.range(0.09, 0.22), random.range(0.02, 0.045));
    // A wedge-shaped section with its back at +y and its edge at -y.
    let wedge = |x: f64, edge: f64, top: f64| {
        vec![[x, edge, -0.0004], [x, edge, 0.0004], [x, top, back / 2.0], [x, top, -back / 2.0]]
    };
    let heel = handle - 0.01;
    builder.loft(
        &[
            wedge(heel, 0.012 - deep, 0.012),
            wedge(heel + 0.7 * blade, 0.012 - 0.8 * deep, 0.011),
            wedge(heel + blade, 0.004, 0.008),
        ],
        false,
    );
    let path = bezier([[0.012, 0.0, 0.0], [0.04, 0.004, 0.0], [0.07, -0.004, 0.0], [handle, 0.0, 0.0]], 8);
    builder.tapered(&path, Y, &ellipse(0.013, 0.0085), |t| 1.0 - 0.25 * t * (1.0 - t));
    if random.chance(0.5) {
        let hole = random.range(0.0035, 0.0065);
        let rim = hole + random.range(0.004, 0.006);
        builder.eye([0.012 - rim + 0.002, 0.0], [hole, hole], [rim, rim], [-0.005, 0.005]);
        return HangObject::new(&builder).hole([0.014 - rim, 0.0, 0.0], Z);
    }
    let (wire, bend) = (random.range(0.0012, 0.002), random.range(0.008, 0.013));
    let middle = [0.0125 - bend, 0.0, 0.0];
    builder.tube(&arc(middle, scale(X, bend), scale(Y, bend), [0.0, 360.0], 24), wire);
    HangObject::new(&builder).hole(middle, Z)
}

fn cleaver(random: &mut Random, handle: f64, back: f64) -> HangObject {
    let mut builder = Builder::default();
    let (blade, deep) = (random.range(0.15, 0.19), random.range(0.07, 0.09));
    let hole = random.range(0.005, 0.009);
    // A rectangle with a hole near its far corner at the back: a strip around the hole, and the rest.
    let corner = handle - 0.012 + blade;
    let middle = [corner - 0.02, 0.0];
    let square: Vec<_> = (0..24)
        .map(|i| turn(15.0 * f64::from(i)))
        .map(|[cos, sin]| {
            let out = 0.018 / cos.abs().max(sin.abs());
            [hole, out].map(|r| [middle[0] + r * cos, r * sin])
        })
        .collect();
    let z = [-back / 2.0, back / 2.0];
    builder.strip(&square, z, true);
    let thinner = [0.0001 - back / 2.0, back / 2.0 - 0.0001];
    let left = middle[0] - 0.0175;
    builder.prism(
        &[[handle - 0.012, 0.0178], [handle - 0.012, 0.018 - deep], [left, 0.018 - deep], [left, 0.0178]],
        thinner,
    );
    builder.prism(
        &[
            [left - 0.001, -0.0175],
            [left - 0.001, 0.018 - deep],
            [corner - 0.002, 0.018 - deep],
            [corner - 0.002, -0.0175],
        ],
        z,
    );
    builder.sweep(&[[0.0, 0.0, 0.0], [handle, 0.0, 0.0]], Y, &ellipse(0.014, 0.01));
    HangObject::new(&builder).hole([middle[0], 0.0, 0.0], Z)
}

/// A frying pan or a pot, its handle with a hole.
pub(super) fn pan(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, wall) = (random.range(0.08, 0.14), 0.003);
    let deep = random.range(0.035, 0.09);
    let foot = radius - random.range(0.005, 0.02);
    builder.revolve(&[
        [[0.0, 0.0], [0.0, wall]],
        [[foot, 0.0], [foot - wall, wall]],
        [[radius, deep], [radius - wall, deep]],
    ]);
    let (length, rise) = (random.range(0.14, 0.22), random.range(0.0, 0.04));
    let start = radius - 0.002;
    let z = deep - 0.012;
    let (broad, thick) = (random.range(0.018, 0.026), random.range(0.008, 0.012));
    let path = bezier(
        [
            [start, 0.0, z],
            [start + 0.05, 0.0, z],
            [start + 0.1, 0.0, z + rise],
            [start + length, 0.0, z + rise],
        ],
        10,
    );
    builder.sweep(&path, Y, &rectangle(broad, thick));
    let hole = random.range(0.0045, 0.01);
    let rim = (hole + 0.004).max(0.55 * broad);
    let middle = [start + length + hole, 0.0, z + rise];
    let stretch = random.range(1.0, 1.6);
    let shift = (stretch - 1.0) * hole;
    let half = 0.45 * thick;
    let centre = [middle[0] + shift + 0.002, 0.0];
    builder.eye(
        centre,
        [stretch * hole, hole],
        [stretch * hole + rim - hole, rim],
        [middle[2] - half, middle[2] + half],
    );
    let pan = HangObject::new(&builder).hole([centre[0], 0.0, middle[2]], Z);
    pan.also(OpeningKind::Rim, [0.0, 0.0, 0.5 * deep], Z, foot - wall)
}
