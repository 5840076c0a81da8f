//! Straight pegs and nails on a wall.

use super::super::builder::Builder;
use super::super::vector::{V, X, Y, Z, along, turn};
use super::super::{Bar, Random, Support};
use super::{bar, plate};

/// Adds a straight peg with its root at (0, y, z).
fn straight(builder: &mut Builder, [y, z]: [f64; 2], tilt: f64, length: f64, radius: f64) -> Bar {
    let [cos, sin] = turn(tilt);
    let at = |s: f64| -> V { [s * cos, y, z + s * sin] };
    builder.tube(&[at(-0.001), at(length)], radius);
    let clear = radius * sin / cos;
    bar(at(clear), at(length), radius)
}

fn at_tilt(random: &mut Random, low: f64, high: f64) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.003, 0.011);
    let (length, tilt) = (random.range(0.06, 0.16), random.range(low, high));
    let width = random.range(0.03, 0.12);
    let height = width * random.range(1.0, 2.0);
    plate(&mut builder, [0.0, 0.0], [width, height], random.range(0.012, 0.02));
    let bars = vec![straight(&mut builder, [0.0, 0.0], tilt, length, radius)];
    Support { solid: builder.finish(), bars }
}

pub(super) fn peg(random: &mut Random) -> Support {
    at_tilt(random, 0.0, 15.0)
}

pub(super) fn tilted_peg(random: &mut Random) -> Support {
    at_tilt(random, 15.0, 37.0)
}

pub(super) fn steep_peg(random: &mut Random) -> Support {
    at_tilt(random, 37.0, 60.0)
}

pub(super) fn nail(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.0012, 0.003);
    let (length, tilt) = (random.range(0.025, 0.06), random.range(0.0, 30.0));
    plate(&mut builder, [0.0, 0.0], [random.range(0.06, 0.15), random.range(0.06, 0.15)], 0.012);
    let mut bar = straight(&mut builder, [0.0, 0.0], tilt, length, radius);
    let head = radius * random.range(1.6, 2.4);
    let mut nail = Builder::default();
    nail.lathe(&[
        [0.0, length - 0.001],
        [head, length - 0.001],
        [head, length + 0.0015],
        [0.0, length + 0.0015],
    ]);
    let [cos, sin] = turn(tilt);
    let forth = along([cos, 0.0, 0.0], sin, Z);
    builder.place(&nail, [[sin, 0.0, -cos], Y, forth], [0.0; 3]);
    bar.pass_radius = (head as f32).max(bar.radius);
    bar.length -= 0.001;
    Support { solid: builder.finish(), bars: vec![bar] }
}

pub(super) fn ball_hook(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.003, 0.006);
    let (length, tilt) = (random.range(0.04, 0.09), random.range(10.0, 45.0));
    let mut disc = Builder::default();
    let rosette = random.range(0.015, 0.03);
    disc.lathe(&[[0.0, -0.01], [rosette, -0.01], [rosette, -0.003], [0.8 * rosette, 0.0], [0.0, 0.0]]);
    builder.place(&disc, [Y, Z, X], [0.0; 3]);
    let mut bar = straight(&mut builder, [0.0, 0.0], tilt, length, radius);
    let ball = radius * random.range(1.5, 2.2);
    let [cos, sin] = turn(tilt);
    builder.ball([length * cos, 0.0, length * sin], ball);
    bar.pass_radius = ball as f32;
    bar.length -= ball as f32;
    Support { solid: builder.finish(), bars: vec![bar] }
}

pub(super) fn pegboard(random: &mut Random) -> Support {
    let mut builder = Builder::default();
    let radius = random.range(0.0025, 0.005);
    let apart = 0.0254 * (1 + random.pick(3)) as f64;
    let (length, tilt) = (random.range(0.05, 0.12), random.range(0.0, 12.0));
    plate(&mut builder, [0.0, 0.0], [random.range(0.18, 0.3), random.range(0.12, 0.25)], 0.006);
    let bars = [-0.5, 0.5].map(|side| {
        let mut bar = straight(&mut builder, [side * apart, 0.0], tilt, length, radius);
        bar.gap = (apart - 2.0 * radius) as f32;
        bar
    });
    Support { solid: builder.finish(), bars: bars.to_vec() }
}
