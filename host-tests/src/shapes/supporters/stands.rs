//! Rails, rods, racks and stands.

use super::super::builder::Builder;
use super::super::vector::{V, X, Z, add, bezier, scale, single, turn};
use super::super::{Random, Support};
use super::{bar, plate};

pub(super) fn mug_tree(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let (post, base) = (random.range(0.009, 0.014), random.range(0.07, 0.1));
    let (height, thick) = (random.range(0.3, 0.42), random.range(0.012, 0.02));
    builder.lathe(&[[0.0, 0.0], [base, 0.0], [base, 0.7 * thick], [0.9 * base, thick], [0.0, thick]]);
    builder.lathe(&[
        [0.0, thick - 0.002],
        [post, thick - 0.002],
        [post, height],
        [0.5 * post, height + 0.01],
        [0.0, height + 0.012],
    ]);
    let radius = random.range(0.003, 0.0055);
    let (length, tilt) = (random.range(0.055, 0.085), random.range(25.0, 50.0));
    let tiers = 2 + random.pick(2);
    let mut bars = Vec::new();
    for tier in 0..tiers {
        for side in 0..2 {
            let [cos, sin] = turn(180.0 * f64::from(side) + 180.0 * tier as f64 / tiers as f64);
            let [out, up] = turn(tilt);
            let away = [cos, sin, 0.0];
            let z = height - 0.04 - 0.06 * tier as f64;
            let at = |s: f64| add(scale(away, s * out), [0.0, 0.0, z + s * up]);
            builder.tube(&[at(0.3 * post), at(post + length)], radius);
            let mut bar = bar(at(post / out + radius), at(post + length), radius);
            bar.wall = Some((single(away), (out * radius) as f32));
            bar.drop = bar.position[2] - thick as f32;
            bars.push(bar);
        }
    }
    Support { solid: builder.finish(), bars }
}

/// A straight rail along the wall, held off it by a bracket at each end.
pub(super) fn rail(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.005, 0.0125);
    let half = random.range(0.15, 0.35);
    // For towels, or for clothes.
    let off = if random.chance(0.5) { random.range(0.05, 0.09) } else { random.range(0.22, 0.3) };
    builder.tube(&[[off, -half, 0.0], [off, half, 0.0]], radius);
    for side in [-1.0, 1.0] {
        let y = side * (half - 0.015);
        builder.tube(&[[-0.001, y, 0.0], [off, y, 0.0]], 0.8 * radius);
        plate(&mut builder, [y, 0.0], [0.05, 0.05], random.range(0.008, 0.014));
    }
    let reach = half - 0.03;
    let mut bar = bar([off, -reach, 0.0], [off, reach, 0.0], radius);
    bar.has_free_end = false;
    // An object can hang anywhere on the rail; the centre represents all positions.
    (bar.position, bar.length) = ([off as f32, 0.0, 0.0], 0.0);
    Support { solid: builder.finish(), bars: vec![bar] }
}

/// A rod on a stand, free at one end.
pub(super) fn rod(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let (height, reach) = (random.range(0.5, 0.9), random.range(0.2, 0.4));
    let (post, radius) = (random.range(0.01, 0.016), random.range(0.004, 0.0125));
    let foot = random.range(0.14, 0.2);
    builder.cuboid([-0.6 * foot, -foot, 0.0], [1.2 * foot, foot, 0.015]);
    builder.lathe(&[[0.0, 0.014], [post, 0.014], [post, height + 0.03], [0.0, height + 0.03]]);
    let tilt = random.range(0.0, 12.0);
    let [cos, sin] = turn(tilt);
    let at = |s: f64| -> V { [s * cos, 0.0, height + s * sin] };
    builder.tube(&[at(0.0), at(reach)], radius);
    let mut bar = bar(at(post + radius), at(reach), radius);
    bar.wall = Some((single(X), (radius * cos) as f32));
    bar.drop = bar.position[2] - 0.015;
    Support { solid: builder.finish(), bars: vec![bar] }
}

/// Flat rails below a shelf, in pairs that hold the foot of a glass.
pub(super) fn glass_rack(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let lanes = 1 + random.pick(2);
    let (gap, width) = (random.range(0.022, 0.034), random.range(0.012, 0.02));
    let (length, below) = (random.range(0.15, 0.28), random.range(0.03, 0.045));
    let spacing = 0.11_f64.max(gap + 2.0 * width);
    let mut bars = Vec::new();
    let span = spacing * lanes as f64;
    builder.cuboid([-0.01, -span / 2.0, 0.0], [length, span / 2.0, 0.015]);
    builder.cuboid([-0.02, -span / 2.0, -0.12], [0.0, span / 2.0, 0.0149]);
    for lane in 0..lanes {
        let y = spacing * (lane as f64 - 0.5 * (lanes as f64 - 1.0));
        for side in [-1.0, 1.0] {
            let inner = y + side * gap / 2.0;
            let outer = inner + side * width;
            // A rail, hung from the shelf by a web along its outer edge.
            builder.cuboid([-0.001, inner.min(outer), -below - 0.005], [length, inner.max(outer), -below]);
            let web = outer - side * 0.004;
            builder.cuboid(
                [-0.0005, outer.min(web) + 2e-4, -below - 0.002],
                [length - 0.002, outer.max(web) - 2e-4, 0.002],
            );
            let middle = [0.0, (inner + outer) / 2.0, -below - 0.0025];
            let mut bar = bar(middle, add(middle, [length, 0.0, 0.0]), width / 2.0);
            bar.gap = gap as f32;
            // The web keeps every opening from enclosing the rail.
            bar.pass_radius = f32::INFINITY;
            bars.push(bar);
        }
    }
    Support { solid: builder.finish(), bars }
}

/// Parallel prongs on an arm that curve upwards.
pub(super) fn fork(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let prongs = 2 + random.pick(3);
    let (radius, apart) = (random.range(0.004, 0.007), random.range(0.028, 0.04));
    let (reach, rise) = (random.range(0.06, 0.1), random.range(0.02, 0.05));
    let arm = random.range(0.04, 0.09);
    let half = 0.5 * apart * (prongs - 1) as f64;
    builder.tube(&[[arm, -half - 0.002, 0.0], [arm, half + 0.002, 0.0]], 1.3 * radius);
    builder.tube(&[[-0.001, 0.0, 0.0], [arm, 0.0, 0.0]], 1.6 * radius);
    plate(&mut builder, [0.0, 0.0], [random.range(0.05, 0.09), random.range(0.05, 0.09)], 0.012);
    let mut bars = Vec::new();
    for i in 0..prongs {
        let root = [arm, apart * i as f64 - half, 0.0];
        let along_x = scale(X, reach);
        let end = add(add(root, along_x), scale(Z, rise));
        let path =
            bezier([root, add(root, scale(X, 0.5 * reach)), add(root, scale(X, 0.85 * reach)), end], 14);
        builder.tube(&path, radius);
        let mut lower = bar(path[3], path[9], radius);
        lower.gap = (apart - 2.0 * radius) as f32;
        lower.wall = Some((single(X), (path[3][0] - arm - 1.3 * radius) as f32));
        let mut tip = bar(path[11], path[14], radius);
        tip.gap = lower.gap;
        bars.extend([lower, tip]);
    }
    Support { solid: builder.finish(), bars }
}
