//! Small objects with a hole.

use super::super::builder::Builder;
use super::super::vector::{V, X, Y, Z, arc, rounded, scale};
use super::{HangObject, Random};

/// A closed carabiner: a D, or an oval.
pub(super) fn carabiner(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let radius = random.range(0.003, 0.0055);
    let (wide, tall) = (random.range(0.018, 0.028), random.range(0.035, 0.05));
    let narrow = wide * random.range(0.6, 1.0);
    let corners = [[-wide, -tall, 0.0], [narrow, -tall, 0.0], [wide, tall, 0.0], [-wide, tall, 0.0]];
    builder.tube(&rounded(&corners, 0.9 * narrow, true), radius);
    // The gate's sleeve.
    builder.tube(&[[-wide, -0.3 * tall, 0.0], [-wide, 0.3 * tall, 0.0]], 1.35 * radius);
    HangObject::new(&builder).hole([0.0, 0.5 * tall, 0.0], Z)
}

pub(super) fn padlock(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let (w, h) = (random.range(0.018, 0.032), random.range(0.028, 0.05));
    let d = random.range(0.007, 0.012);
    let cut = 0.3 * d;
    let outline = [
        [-w, cut - d],
        [cut - w, -d],
        [w - cut, -d],
        [w, cut - d],
        [w, d - cut],
        [w - cut, d],
        [cut - w, d],
        [-w, d - cut],
    ];
    builder.prism(&outline, [-h, 0.0]);
    let shackle = random.range(0.0025, 0.005).min(0.4 * d);
    let (half, legs) = (w - cut - shackle, random.range(0.006, 0.02));
    let mut path: Vec<V> = vec![[half, 0.0, -0.006]];
    path.extend(arc([0.0, 0.0, legs], scale(X, half), scale(Z, half), [0.0, 180.0], 20));
    path.push([-half, 0.0, -0.006]);
    builder.tube(&path, shackle);
    HangObject::new(&builder).hole([0.0, 0.0, legs], Y)
}

pub(super) fn key(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let hole = random.range(0.0025, 0.008);
    let rim = hole + random.range(0.003, 0.006);
    let thick = random.range(0.001, 0.002);
    builder.eye([0.0, 0.0], [hole, hole], [rim, rim * random.range(1.0, 1.3)], [-thick, thick]);
    let blade = random.range(0.03, 0.05);
    let start = 0.5 * (hole + rim);
    let end = rim + blade;
    let z = [0.0002 - thick, thick - 0.0002];
    builder.prism(&[[start, -0.003], [end, -0.003], [end + 0.002, 0.0], [end, 0.003], [start, 0.003]], z);
    for i in 0..4 {
        let x = end - 0.006 * f64::from(i) - 0.004;
        let deep = 0.003 + random.range(0.001, 0.0035);
        builder.prism(
            &[[x - 0.0022, -0.0028], [x - 0.001, -deep], [x + 0.001, -deep], [x + 0.0022, -0.0028]],
            [-0.5 * thick, 0.5 * thick],
        );
    }
    HangObject::new(&builder).hole([0.0; 3], Z)
}

pub(super) fn tape_roll(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let inner = if random.chance(0.5) { random.range(0.0125, 0.014) } else { random.range(0.036, 0.039) };
    let outer = inner + random.range(0.005, 0.025);
    let half = random.range(0.006, 0.025);
    builder.eye([0.0, 0.0], [inner, inner], [outer, outer], [-half, half]);
    HangObject::new(&builder).hole([0.0; 3], Z)
}

pub(super) fn ring(random: &mut Random) -> HangObject {
    let mut builder = Builder::default();
    let bend = random.range(0.012, 0.07);
    let radius = (bend * random.range(0.08, 0.25)).clamp(0.002, 0.009);
    builder.tube(&arc([0.0; 3], scale(X, bend), scale(Y, bend), [0.0, 360.0], 32), radius);
    HangObject::new(&builder).hole([0.0; 3], Z)
}
