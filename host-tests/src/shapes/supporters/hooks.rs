//! Hooks of bent wire.

use super::super::builder::Builder;
use super::super::vector::{V, X, Y, Z, add, arc, bezier, rounded, scale, turn};
use super::super::{Bar, Random, Support};
use super::{bar, plate};

/// Adds a J in front of a wall: from `top` down by `drop`, round a half circle of radius `bend`, and up to `rise` above
/// its centre.
fn j(builder: &mut Builder, top: V, [drop, bend, rise]: [f64; 3], radius: f64) -> Bar {
    let centre = add(top, [bend, 0.0, -drop]);
    let mut path = vec![[-0.001, top[1], top[2]], top];
    path.extend(arc(centre, scale(X, bend), scale(Z, bend), [180.0, 360.0], 14));
    path.push(add(centre, [bend, 0.0, rise]));
    if top[0] <= 0.0 {
        path.remove(0);
    }
    let path = if top[0] > 0.0 {
        let mut bent = rounded(&path[..3], (0.8 * top[0]).min(0.4 * drop), false);
        bent.extend_from_slice(&path[3..]);
        bent
    } else {
        path
    };
    builder.tube(&path, radius);
    let lowest = add(centre, [0.0, 0.0, -bend]);
    bar(add(lowest, [-0.3 * bend, 0.0, 0.0]), add(lowest, [0.3 * bend, 0.0, 0.0]), radius)
}

pub(super) fn j_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.0025, 0.007);
    let bend = random.range(0.015, 0.035) + radius;
    let shape = [random.range(0.03, 0.08), bend, random.range(0.01, 0.04)];
    let off = random.range(0.02, 0.03);
    let bars = vec![j(&mut builder, [off, 0.0, 0.0], shape, radius)];
    let width = random.range(0.03, 0.08);
    plate(&mut builder, [0.0, 0.0], [width, random.range(0.03, 0.1)], 0.012);
    Support { solid: builder.finish(), bars }
}

pub(super) fn l_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.0025, 0.007);
    let (reach, rise) = (random.range(0.04, 0.1), random.range(0.015, 0.05));
    let round = (0.4 * rise).max(2.0 * radius).min(0.8 * rise);
    let path = rounded(&[[-0.001, 0.0, 0.0], [reach, 0.0, 0.0], [reach, 0.0, rise]], round, false);
    builder.tube(&path, radius);
    let width = random.range(0.03, 0.08);
    plate(&mut builder, [0.0, 0.0], [width, random.range(0.03, 0.1)], 0.012);
    // The level part, and the end that points up, for hollows.
    let ground = bar([0.0; 3], [reach - round, 0.0, 0.0], radius);
    let bars = vec![ground, bar([reach, 0.0, round], [reach, 0.0, rise], radius)];
    Support { solid: builder.finish(), bars }
}

pub(super) fn s_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.002, 0.004);
    let [upper, lower] = [random.range(0.014, 0.022), random.range(0.016, 0.032)].map(|bend| bend + radius);
    // A short rail from the wall carries the upper bend.
    let rail = upper - radius;
    let off = random.range(0.06, 0.22);
    builder.tube(&[[-0.001, 0.0, 0.0], [off + 0.06, 0.0, 0.0]], rail.min(0.012));
    let sag = upper - radius - rail.min(0.012);
    plate(&mut builder, [0.0, 0.0], [0.06, 0.08], 0.012);
    let neck = random.range(0.03, 0.07);
    let mut path: Vec<V> = arc([off, 0.0, -sag], scale(Y, upper), scale(Z, upper), [200.0, 0.0], 16);
    let centre = [off, upper + lower, -sag - neck];
    path.extend(arc(centre, scale(Y, lower), scale(Z, lower), [180.0, 380.0], 16));
    builder.tube(&path, radius);
    let lowest = add(centre, [0.0, 0.0, -lower]);
    // The mouth of the lower bend opens to +y, that of the upper bend to -y.
    let mut ground = bar(add(lowest, [0.0, -0.3 * lower, 0.0]), add(lowest, [0.0, 0.3 * lower, 0.0]), radius);
    ground.wall = Some((super::super::vector::single(X), off as f32));
    Support { solid: builder.finish(), bars: vec![ground] }
}

pub(super) fn coat_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.004, 0.007);
    let (reach, rise) = (random.range(0.05, 0.09), random.range(0.03, 0.06));
    let top = random.range(0.03, 0.05);
    let upper = bezier(
        [[-0.001, 0.0, top], [0.5 * reach, 0.0, top - 0.015], [reach, 0.0, top], [reach, 0.0, top + rise]],
        16,
    );
    builder.tube(&upper, radius);
    builder.ball(upper[16], 1.3 * radius);
    let bend = random.range(0.014, 0.024);
    let bend_below = [0.015, bend, random.range(0.005, 0.015)];
    let lower = j(&mut builder, [0.0; 3], bend_below, 0.8 * radius);
    let width = random.range(0.025, 0.04);
    plate(&mut builder, [0.0, 0.01], [width, 2.0 * top + 0.04], 0.01);
    let mut ground = bar(upper[5], upper[9], radius);
    ground.pass_radius = (1.3 * radius) as f32;
    let mut tip = bar(upper[12], upper[16], radius);
    tip.pass_radius = ground.pass_radius;
    Support { solid: builder.finish(), bars: vec![lower, ground, tip] }
}

pub(super) fn double_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.003, 0.006);
    let apart = random.range(0.04, 0.1);
    let shape = [random.range(0.02, 0.05), random.range(0.015, 0.03) + radius, random.range(0.01, 0.03)];
    let off = random.range(0.015, 0.025);
    let bars = [-0.5, 0.5].map(|side| {
        let mut bar = j(&mut builder, [off, side * apart, 0.0], shape, radius);
        bar.gap = (apart - 2.0 * radius) as f32;
        bar
    });
    plate(&mut builder, [0.0, 0.0], [apart + 0.04, random.range(0.03, 0.06)], 0.01);
    Support { solid: builder.finish(), bars: bars.to_vec() }
}

/// A carabiner on a wall bracket with its gate pushed open. Objects hang in the lower bend.
pub(super) fn carabiner_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.003, 0.005);
    let bend = random.range(0.012, 0.02) + radius;
    let tall = random.range(0.04, 0.06);
    let off = random.range(0.045, 0.2);
    // It hangs on a bracket through its upper bend.
    builder.tube(&[[-0.001, 0.0, 0.0], [off + 0.02, 0.0, 0.0]], 0.005);
    plate(&mut builder, [0.0, 0.0], [0.04, 0.05], 0.012);
    let above = [off, 0.0, 0.005 + radius - bend];
    let below = add(above, [0.0, 0.0, -tall]);
    let mut path = arc(above, scale(Y, bend), scale(Z, bend), [180.0, 0.0], 12);
    path.extend(arc(below, scale(Y, bend), scale(Z, bend), [0.0, -190.0], 12));
    builder.tube(&path, radius);
    // The gate, held open inwards.
    let hinge = path[0];
    let [cos, sin] = turn(-65.0);
    let gate = 0.75 * tall;
    let (inwards, down) = (0.5 * gate * cos, gate * sin);
    builder.tube(&[hinge, add(hinge, [0.0, inwards, down.max(-0.6 * tall)])], 0.7 * radius);
    let lowest = add(below, [0.0, 0.0, -bend]);
    let mut ground = bar(add(lowest, [0.0, 0.3 * bend, 0.0]), add(lowest, [0.0, -0.3 * bend, 0.0]), radius);
    ground.wall = Some((super::super::vector::single(X), off as f32));
    Support { solid: builder.finish(), bars: vec![ground] }
}
