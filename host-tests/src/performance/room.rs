//! Points of a room around a supporter.

use crate::shapes::Random;
use nalgebra::Vector3;

/// Points at random, with noise of a millimetre, on a wall of 2 m by 2 m 10 cm behind the sample hook, on a floor of that size
/// 1 m below it, and on a table.
pub fn room(count: usize) -> Vec<[f32; 3]> {
    let mut random = Random::named("room", 1);
    let point = |index: usize| {
        let [a, b] = [0; 2].map(|_| random.range(-1.0, 1.0));
        let noise = random.range(-0.001, 0.001);
        let place = match index % 29 {
            0..13 => [-0.107 + noise, a, b],
            13..26 => [0.9 + a, b, -0.993 + noise],
            _ => [0.6 + 0.3 * a, 0.6 * b, -0.313 + noise],
        };
        place.map(|x| x as f32)
    };
    (0..count).map(point).collect()
}

/// Points with normals at random on a surface, uniform by area.
pub fn scatter(
    vertices: &[[f32; 3]],
    triangles: &[[u32; 3]],
    count: usize,
) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut random = Random::named("scatter", 1);
    let corners = |triangle: &[u32; 3]| triangle.map(|index| Vector3::from(vertices[index as usize]));
    let mut sums = vec![0.0];
    for triangle in triangles {
        let [a, b, c] = corners(triangle);
        sums.push(sums[sums.len() - 1] + f64::from((b - a).cross(&(c - a)).norm()));
    }
    let all = sums[triangles.len()];
    let point = |_| -> ([f32; 3], [f32; 3]) {
        let at = random.range(0.0, all);
        let index = sums.partition_point(|sum| *sum <= at).clamp(1, triangles.len()) - 1;
        let [a, b, c] = corners(&triangles[index]);
        let [mut u, mut v] = [0; 2].map(|_| random.range(0.0, 1.0) as f32);
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let normal = (b - a).cross(&(c - a)).normalize();
        ((a + (b - a) * u + (c - a) * v).into(), normal.into())
    };
    (0..count).map(point).unzip()
}
