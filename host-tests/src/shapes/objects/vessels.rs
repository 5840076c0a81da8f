//! Vessels with handles.

use super::super::builder::Builder;
use super::super::sections::{ellipse, rectangle};
use super::super::vector::{V, X, Y, Z, arc, bezier, scale};
use super::{HangObject, OpeningKind, Random};

/// Adds a cup with a floor and walls from radius `foot` to radius `rim`.
fn cup(builder: &mut Builder, [foot, rim]: [f64; 2], height: f64, wall: f64) {
    builder.revolve(&[
        [[0.0, 0.0], [0.0, wall]],
        [[foot, 0.0], [foot - wall, wall]],
        [[rim, height], [rim - wall, height]],
    ]);
}

pub(super) fn mug(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (rim, height) = (random.range(0.035, 0.048), random.range(0.075, 0.12));
    let foot = rim * random.range(0.8, 1.0);
    let wall = random.range(0.003, 0.005);
    cup(&mut builder, [foot, rim], height, wall);
    // The handle's ends sit within the wall.
    let ear = random.range(0.025, 0.038);
    let (low, high) = (random.range(0.12, 0.22) * height, random.range(0.78, 0.9) * height);
    let at = |z: f64| foot + (rim - foot) * z / height - 0.8 * wall;
    let far = rim + 1.3 * ear;
    let path =
        bezier([[at(high), 0.0, high], [far, 0.0, high + 0.005], [far, 0.0, low], [at(low), 0.0, low]], 18);
    builder.sweep(&path, Y, &ellipse(random.range(0.004, 0.0075), random.range(0.003, 0.0045)));
    let mug = HangObject::new(&builder).hole([rim + 0.45 * ear, 0.0, (low + high) / 2.0], Y);
    mug.also(OpeningKind::Rim, [0.0, 0.0, 0.5 * height], Z, foot - wall)
}

/// A glass whose foot hangs in a rack.
pub(super) fn goblet(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (foot, stem) = (random.range(0.03, 0.04), random.range(0.0035, 0.0055));
    let (tall, wide) = (random.range(0.06, 0.09), random.range(0.03, 0.042));
    let deep = random.range(0.06, 0.1);
    builder.lathe(&[
        [0.0, 0.0],
        [foot, 0.0],
        [foot, 0.003],
        [2.0 * stem, 0.007],
        [stem, 0.02],
        [stem, tall],
        [0.0, tall],
    ]);
    let wall = 0.002;
    let z = tall - 0.003;
    builder.revolve(&[
        [[0.0, z], [0.0, z + wall]],
        [[0.6 * wide, z + 0.12 * deep], [0.6 * wide - wall, z + 0.12 * deep + wall]],
        [[wide, z + 0.45 * deep], [wide - wall, z + 0.45 * deep + 0.2 * wall]],
        [[0.8 * wide, z + deep], [0.8 * wide - wall, z + deep]],
    ]);
    let mut goblet = HangObject::new(&builder);
    let neck = OpeningKind::Neck { head_radius: foot as f32 };
    goblet.push(neck, [0.0, 0.0, 0.02], scale(Z, -1.0), stem);
    goblet.also(OpeningKind::Rim, [0.0, 0.0, z + 0.5 * deep], Z, 0.5 * wide)
}

/// Adds a handle over the top of a vessel, half an ellipse from ear to ear along y. Returns a point inside its hole.
fn bail(builder: &mut Builder, half: f64, from: f64, rise: f64, radius: f64) -> V {
    builder.tube(&arc([0.0, 0.0, from], scale(Y, half), scale(Z, rise), [0.0, 180.0], 24), radius);
    [0.0, 0.0, from + 0.6 * rise]
}

pub(super) fn bucket(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (rim, height) = (random.range(0.07, 0.14), random.range(0.12, 0.26));
    let foot = rim * random.range(0.7, 0.85);
    cup(&mut builder, [foot, rim], height, 0.003);
    let radius = random.range(0.002, 0.004);
    let ear = height - 0.015;
    for side in [-1.0, 1.0] {
        builder.tube(&[[0.0, side * (rim + 0.004), ear], [0.0, side * (rim - 0.002), ear]], 1.8 * radius);
    }
    let inside = bail(&mut builder, rim + 0.004, ear, rim * random.range(0.95, 1.2), radius);
    let bucket = HangObject::new(&builder).hole_through(inside, X, rim);
    bucket.also(OpeningKind::Rim, [0.0, 0.0, 0.5 * height], Z, foot - 0.003)
}

/// A round or square basket with a handle overhead.
pub(super) fn basket(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (half, height) = (random.range(0.09, 0.15), random.range(0.08, 0.15));
    let wall = 0.005;
    if random.chance(0.5) {
        cup(&mut builder, [0.85 * half, half], height, wall);
    } else {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let long = half * random.range(1.0, 1.5);
        let pairs = corners.map(|[x, y]| [[x * long, y * half], [x * (long - wall), y * (half - wall)]]);
        builder.strip(&pairs, [0.0, height], true);
        let [x, y] = [long - wall / 2.0, half - wall / 2.0];
        builder.cuboid([-x, -y, 0.0005], [x, y, wall]);
    }
    let rise = random.range(0.1, 0.2);
    let (broad, thick) = (random.range(0.012, 0.022), random.range(0.005, 0.009));
    let mut path = vec![[0.0, half, 0.6 * height]];
    path.extend(arc([0.0, 0.0, height], scale(Y, half), scale(Z, rise), [0.0, 180.0], 24));
    path.push([0.0, -half, 0.6 * height]);
    builder.sweep(&path, X, &rectangle(broad, thick));
    let basket = HangObject::new(&builder).hole_through([0.0, 0.0, height + 0.6 * rise], X, half);
    basket.also(OpeningKind::Rim, [0.0, 0.0, 0.5 * height], Z, 0.85 * half - wall)
}

pub(super) fn watering_can(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, height) = (random.range(0.06, 0.1), random.range(0.11, 0.18));
    cup(&mut builder, [radius, 0.92 * radius], height, 0.003);
    // Half a lid, a spout in front and a handle from the lid down the back.
    let spout = random.range(0.1, 0.16);
    let end = [radius + spout, 0.0, height + 0.02];
    let start = [radius - 0.006, 0.0, 0.25 * height];
    let path = bezier(
        [start, [radius + 0.5 * spout, 0.0, 0.3 * height], [radius + 0.6 * spout, 0.0, 0.8 * height], end],
        10,
    );
    builder.tapered(&path, Y, &ellipse(0.012, 0.012), |t| 1.0 - 0.4 * t);
    let mut rose = Builder::default();
    rose.lathe(&[[0.0, 0.0], [0.006, 0.0], [0.02, 0.02], [0.02, 0.025], [0.0, 0.027]]);
    builder.place(&rose, [[0.8, 0.0, -0.6], Y, [0.6, 0.0, 0.8]], [end[0] - 0.004, 0.0, end[2] - 0.004]);
    let grip = random.range(0.004, 0.007);
    let back = 0.92 * radius;
    let above = height + random.range(0.03, 0.06);
    let far = back + random.range(0.06, 0.1);
    let front = [0.5 * radius, 0.0, height - 0.003];
    let handle = bezier(
        [front, [0.0, 0.0, above + 0.05], [-far - 0.05, 0.0, above + 0.02], [-back, 0.0, 0.3 * height]],
        20,
    );
    builder.sweep(&handle, Y, &ellipse(1.3 * grip, grip));
    let outermost = handle.iter().min_by(|a, b| a[0].total_cmp(&b[0])).copied().unwrap_or(front);
    // A bar across the opening that carries the front end of the handle.
    builder.cuboid([0.4 * radius, -0.8 * back, height - 0.007], [0.6 * radius, 0.8 * back, height - 0.001]);
    HangObject::new(&builder)
        .hole([(outermost[0] - back) / 2.0, 0.0, outermost[2]], Y)
        .hole_through([-0.3 * radius, 0.0, height + 0.025], Y, radius)
        .also(OpeningKind::Rim, [0.0, 0.0, 0.5 * height], Z, back - 0.003)
}
