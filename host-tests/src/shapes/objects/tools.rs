//! Tools and household objects.

use super::super::builder::Builder;
use super::super::sections::ellipse;
use super::super::vector::{V, X, Y, Z, along, arc, scale, turn};
use super::{HangObject, OpeningKind, Random};

/// Two crossed blades, each with a finger ring.
pub(super) fn scissors(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (blade, shank) = (random.range(0.07, 0.13), random.range(0.05, 0.08));
    let open = random.range(8.0, 16.0);
    let ring = [random.range(0.016, 0.026), random.range(0.011, 0.015)];
    let (rim, thick) = (random.range(0.0025, 0.004), random.range(0.0015, 0.0025));
    let mut middles = Vec::new();
    for (side, z) in [(-1.0, 0.0), (1.0, thick + 0.0001)] {
        let mut half = Builder::default();
        half.prism(
            &[[-0.006, -0.007], [0.012, -0.008], [blade, -0.001], [blade, 0.001], [0.0, 0.007]],
            [0.0, thick],
        );
        half.prism(
            &[[0.0, -0.0065], [0.0, 0.0065], [-shank, 0.004], [-shank, -0.004]],
            [0.0002, thick - 0.0002],
        );
        // The ring lies outside the shank and is thicker.
        let centre: V = [-shank - 0.8 * ring[0], -0.45 * ring[1], thick / 2.0];
        let path = arc(centre, scale(X, ring[0] + rim), scale(Y, ring[1] + rim), [0.0, 360.0], 28);
        half.sweep(&path, Z, &ellipse(1.3 * rim, rim));
        let [cos, sin] = turn(open);
        let axes = [[cos, side * sin, 0.0], [-side * sin, cos, 0.0], Z];
        // The second is the first's mirror image, turned over about x.
        let axes = if side > 0.0 { axes } else { [axes[0], scale(axes[1], -1.0), scale(Z, -1.0)] };
        let origin = [0.0, 0.0, if side > 0.0 { z } else { z + thick }];
        builder.place(&half, axes, origin);
        middles.push((0..3).fold(origin, |p, i| along(p, centre[i], axes[i])));
    }
    builder.tube(&[[0.0, 0.0, 0.0], [0.0, 0.0, 2.0 * thick]], 0.003);
    middles.iter().fold(HangObject::new(&builder), |scissors, &middle| scissors.hole(middle, Z))
}

/// A ring spanner, or a combination with an open jaw at the other end.
pub(super) fn wrench(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let size = random.range(0.004, 0.013);
    let length = 0.05 + 12.0 * size * random.range(0.8, 1.1);
    let thick = 0.003 + 0.35 * size;
    let z = [-thick, thick];
    // Twelve inner corners and a round outer rim.
    let eye = |builder: &mut Builder, x: f64, size: f64| {
        let pairs: Vec<_> = (0..24)
            .map(|i| (turn(15.0 * f64::from(i)), if i % 2 == 0 { 1.06 } else { 1.0 }))
            .map(|([cos, sin], notch)| [notch * size, 1.55 * size + 0.001].map(|r| [x + r * cos, r * sin]))
            .collect();
        builder.strip(&pairs, z, true);
    };
    eye(&mut builder, 0.0, size);
    let half = 0.6 * size + 0.002;
    let inner = [1.06 * size + 0.0004, length - 1.2 * size];
    builder.prism(
        &[[inner[0], -half], [inner[1], -half], [inner[1], half], [inner[0], half]],
        [-0.6 * thick, 0.6 * thick],
    );
    if random.chance(0.4) {
        eye(&mut builder, length, 1.1 * size);
        return HangObject::new(&builder).hole([0.0; 3], Z).hole([length, 0.0, 0.0], Z);
    }
    let jaw: Vec<_> = (0..=20)
        .map(|i| 45.0 + 15.0 + 240.0 * f64::from(i) / 20.0)
        .map(turn)
        .map(|[cos, sin]| [size, 1.8 * size].map(|r| [length + r * cos, r * sin]))
        .collect();
    builder.strip(&jaw, z, false);
    let wrench = HangObject::new(&builder).hole([0.0; 3], Z);
    wrench.also(OpeningKind::Hook, [length, 0.0, 0.0], Z, size)
}

/// A lantern with a wire bail.
pub(super) fn lantern(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, glass) = (random.range(0.04, 0.065), random.range(0.08, 0.14));
    builder.lathe(&[[0.0, 0.0], [radius, 0.0], [radius, 0.015], [0.8 * radius, 0.03], [0.0, 0.03]]);
    builder.lathe(&[
        [0.0, 0.029],
        [0.65 * radius, 0.029],
        [0.85 * radius, 0.029 + 0.4 * glass],
        [0.6 * radius, 0.031 + glass],
        [0.0, 0.031 + glass],
    ]);
    let top = 0.03 + glass;
    builder.lathe(&[
        [0.0, top],
        [radius, top],
        [0.4 * radius, top + 0.03],
        [0.4 * radius, top + 0.045],
        [0.0, top + 0.05],
    ]);
    // Posts around the glass.
    for i in 0..4 {
        let [cos, sin] = turn(45.0 + 90.0 * f64::from(i));
        let at = |z: f64| [0.9 * radius * cos, 0.9 * radius * sin, z];
        builder.tube(&[at(0.008), at(top + 0.001)], 0.002);
    }
    let wire = random.range(0.0015, 0.003);
    let rise = 0.05 + random.range(0.04, 0.09);
    let half = 0.93 * radius;
    let mut path = vec![[0.0, half, top - 0.002]];
    path.extend(arc([0.0, 0.0, top + 0.02], scale(Y, half), scale(Z, rise), [0.0, 180.0], 22));
    path.push([0.0, -half, top - 0.002]);
    builder.tube(&path, wire);
    HangObject::new(&builder).hole_through([0.0, 0.0, top + 0.02 + 0.6 * rise], X, radius)
}

/// A picture in a frame, with a wire loop above it.
pub(super) fn picture_frame(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (w, h) = (random.range(0.05, 0.15), random.range(0.06, 0.15));
    let (border, thick) = (random.range(0.01, 0.025), random.range(0.01, 0.018));
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let pairs = corners.map(|[x, y]| [[x * w, y * h], [x * (w - border), y * (h - border)]]);
    builder.strip(&pairs, [0.0, thick], true);
    let [x, y] = [w - 0.5 * border, h - 0.5 * border];
    builder.cuboid([-x, -y, 0.0005], [x, y, 0.004]);
    let (wire, bend) = (random.range(0.0012, 0.002), random.range(0.007, 0.013));
    let middle: V = [0.0, h + 0.6 * bend, 0.3 * thick];
    builder.tube(&arc(middle, scale(X, bend), scale(Y, bend), [-60.0, 240.0], 20), wire);
    HangObject::new(&builder).hole(middle, Z)
}
