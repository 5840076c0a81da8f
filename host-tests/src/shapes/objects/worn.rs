//! Clothing accessories, bags and clothes hangers.

use super::super::builder::Builder;
use super::super::sections::{circle, rectangle};
use super::super::vector::{V, X, Y, Z, add, arc, rounded, scale, turn};
use super::{HangObject, OpeningKind, Random};

/// A stiff tote, open above, with a loop on its front and one on its back.
pub(super) fn bag(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (width, height) = (random.range(0.2, 0.38), random.range(0.2, 0.36));
    let (depth, wall) = (random.range(0.07, 0.14), 0.004);
    let (w, d) = (width / 2.0, depth / 2.0);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let pairs = corners.map(|[x, y]| [[x * w, y * d], [x * (w - wall), y * (d - wall)]]);
    builder.strip(&pairs, [0.0, height], true);
    let inset = wall / 2.0;
    builder.cuboid([inset - w, inset - d, 0.0005], [w - inset, d - inset, 0.0045]);
    let radius = random.range(0.003, 0.006);
    let (half, rise) = (random.range(0.04, 0.07), random.range(0.07, 0.2));
    for y in [-d - 0.5 * radius, d + 0.5 * radius] {
        let low = height - 0.03;
        let corners = [[-half, y, low], [-half, y, height + rise], [half, y, height + rise], [half, y, low]];
        builder.tube(&rounded(&corners, 0.7 * half, false), radius);
    }
    let inside = |y: f64| [0.0, y, height + rise - half];
    HangObject::new(&builder).hole(inside(-d - 0.5 * radius), Y).hole(inside(d + 0.5 * radius), Y).also(
        OpeningKind::Rim,
        [0.0, 0.0, 0.5 * height],
        Z,
        d - wall,
    )
}

/// A dome, open below, with a brim.
pub(super) fn cap(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, height) = (random.range(0.085, 0.1), random.range(0.09, 0.13));
    let thick = random.range(0.002, 0.0035);
    let dome = |r: f64, h: f64, degrees: f64| {
        let [cos, sin] = turn(degrees);
        [if degrees == 90.0 { 0.0 } else { r * cos }, h * sin]
    };
    let wall: Vec<_> = (0..=9)
        .map(|i| 90.0 - 10.0 * f64::from(i))
        .map(|a| [dome(radius, height, a), dome(radius - thick, height - thick, a)])
        .collect();
    builder.revolve(&wall);
    if random.chance(0.8) {
        // The button on top.
        builder.ball([0.0, 0.0, height], 0.006);
    }
    let brim = random.range(0.06, 0.08);
    let pairs: Vec<_> = (0..=14)
        .map(|i| -60.0 + 120.0 * f64::from(i) / 14.0)
        .map(|a| {
            let ([cos, sin], reach) = (turn(a), brim * turn(0.75 * a)[0]);
            [radius - 0.6 * thick, radius + reach].map(|r| [r * cos, r * sin])
        })
        .collect();
    builder.strip(&pairs, [0.0005, 0.0035], false);
    let mut cap = HangObject::new(&builder);
    // Half way up the hollow, the radius of the widest bar that reaches its ground.
    let clear = (radius - thick) * 0.5;
    cap.push(OpeningKind::Rim, [0.0, 0.0, 0.5 * height], scale(Z, -1.0), clear);
    cap
}

/// A hook on a triangle of wood or wire.
pub(super) fn clothes_hanger(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let wire = random.range(0.0016, 0.0025);
    let (bend, neck) = (random.range(0.018, 0.028), random.range(0.02, 0.04));
    // From the neck around the right side and over the top to the tip on the left.
    let tip = random.range(185.0, 205.0);
    let mut path = vec![[0.0, 0.0, -0.002], [0.0, 0.0, neck - wire]];
    let middle = [0.0, 0.0, neck + bend];
    path.extend(arc(middle, scale(X, bend), scale(Z, bend), [-75.0, tip], 20));
    builder.tube(&path, wire);
    let (half, drop) = (random.range(0.17, 0.22), random.range(0.1, 0.15));
    let corners = [[0.0, 0.0, 0.0], [half, 0.0, -drop], [-half, 0.0, -drop]];
    let bar = random.range(0.0025, 0.006);
    if random.chance(0.5) {
        builder.tube(&rounded(&corners, 0.03, true), bar);
    } else {
        // Wood: broad shoulders and a thin bar.
        let shoulders = [[-half, 0.0, -drop], [0.0, 0.0, 0.0], [half, 0.0, -drop]];
        builder.sweep(&rounded(&shoulders, 0.06, false), Y, &rectangle(3.0 * bar, 2.2 * bar));
        builder.tube(&[[-0.93 * half, 0.0, -drop], [0.93 * half, 0.0, -drop]], bar);
        builder.tube(&[[0.0, 0.0, 0.0], [0.0, 0.0, -0.03]], bar);
    }
    let mouth = 2.0 * bend * turn((270.0 - tip) / 2.0 - 90.0)[1].abs().min(1.0) - 2.0 * wire;
    let chord = 2.0 * bend * turn((285.0 - tip) / 2.0)[1] - 2.0 * wire;
    let hanger = HangObject::new(&builder).hook(middle, Y, mouth.min(chord));
    hanger.also(OpeningKind::Hole, [0.0, 0.0, -0.7 * drop], Y, 0.3 * drop - 3.0 * bar)
}

/// A headband with two cups.
pub(super) fn headphone(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (half, tall) = (random.range(0.07, 0.085), random.range(0.08, 0.1));
    let (broad, thick) = (random.range(0.015, 0.03), random.range(0.004, 0.009));
    let mut path: Vec<V> = vec![[0.0, half, -0.06]];
    path.extend(arc([0.0; 3], scale(Y, half), scale(Z, tall), [0.0, 180.0], 24));
    path.push([0.0, -half, -0.06]);
    builder.sweep(&path, X, &rectangle(broad, thick));
    let (cup, deep) = (random.range(0.03, 0.045), random.range(0.018, 0.026));
    for side in [-1.0, 1.0] {
        let mut shell = Builder::default();
        shell.lathe(&[
            [0.0, -0.5 * deep],
            [0.8 * cup, -0.5 * deep],
            [cup, -0.2 * deep],
            [cup, 0.2 * deep],
            [0.85 * cup, 0.5 * deep],
            [0.0, 0.5 * deep],
        ]);
        // The pad faces inwards.
        shell.sweep(
            &arc([0.0, 0.0, 0.55 * deep], scale(X, 0.7 * cup), scale(Y, 0.7 * cup), [0.0, 360.0], 24),
            Z,
            &circle(0.2 * cup),
        );
        let axes = [scale(X, side), Z, scale(Y, -side)];
        builder.place(&shell, axes, [0.0, side * (half - 0.2 * deep), -0.06]);
    }
    let gap = 2.0 * (half - 0.2 * deep - 0.55 * deep - 0.2 * cup);
    let middle = add([0.0; 3], [0.0, 0.0, tall - half]);
    HangObject::new(&builder).hook(middle, X, gap)
}
