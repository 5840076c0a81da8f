//! Objects that cannot hang.

use super::super::builder::Builder;
use super::super::sections::circle;
use super::super::vector::{X, Z, arc, scale, turn};
use super::{HangObject, Random};

pub(super) fn ball(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    builder.ball([0.0; 3], random.range(0.02, 0.11));
    HangObject::new(&builder)
}

pub(super) fn cuboid(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let half = [0; 3].map(|_| random.range(0.015, 0.12));
    builder.cuboid(scale(half, -1.0), half);
    HangObject::new(&builder)
}

pub(super) fn can(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, height) = (random.range(0.026, 0.05), random.range(0.05, 0.15));
    let rim = radius - 0.004;
    builder.lathe(&[
        [0.0, 0.0],
        [rim, 0.0],
        [radius, 0.005],
        [radius, height - 0.008],
        [rim, height],
        [0.0, height],
    ]);
    HangObject::new(&builder)
}

pub(super) fn bottle(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, height) = (random.range(0.03, 0.045), random.range(0.18, 0.3));
    let neck = random.range(0.012, 0.015);
    builder.lathe(&[
        [0.0, 0.0],
        [0.95 * radius, 0.0],
        [radius, 0.006],
        [radius, 0.6 * height],
        [0.8 * radius, 0.7 * height],
        [neck, 0.8 * height],
        [neck, height],
        [0.0, height],
    ]);
    HangObject::new(&builder)
}

/// A banana, bent too little to hook over anything.
pub(super) fn banana(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (bend, thick) = (random.range(0.11, 0.16), random.range(0.015, 0.02));
    let path = arc([0.0; 3], scale(X, bend), scale(Z, bend), [235.0, 305.0], 16);
    builder.tapered(&path, [0.0, 1.0, 0.0], &circle(thick), |t| 0.25 + 0.75 * turn(180.0 * t)[1].sqrt());
    HangObject::new(&builder)
}

pub(super) fn wedge(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (long, high) = (random.range(0.06, 0.15), random.range(0.02, 0.06));
    let half = random.range(0.015, 0.05);
    builder.prism(&[[0.0, 0.0], [long, 0.0], [long, high]], [-half, half]);
    HangObject::new(&builder)
}

pub(super) fn book(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (w, h) = (random.range(0.1, 0.2), random.range(0.15, 0.28));
    let (thick, cover) = (random.range(0.01, 0.04), 0.002);
    builder.cuboid([0.001, 0.004, cover - 0.0003], [w - 0.004, h - 0.004, thick - cover + 0.0003]);
    builder.cuboid([0.0, 0.0, 0.0], [w, h, cover]);
    builder.cuboid([0.0, 0.0, thick - cover], [w, h, thick]);
    builder.cuboid([-cover, 0.0, 0.0001], [0.0002, h, thick - 0.0001]);
    HangObject::new(&builder)
}

/// A solid half ball: a bowl turned over, with no hollow.
pub(super) fn dome(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (radius, height) = (random.range(0.05, 0.11), random.range(0.03, 0.08));
    let mut outline = vec![[0.0, 0.0]];
    outline.extend((0..9).map(|i| turn(10.0 * f64::from(i))).map(|[cos, sin]| [radius * cos, height * sin]));
    outline.push([0.0, height]);
    builder.lathe(&outline);
    HangObject::new(&builder)
}
