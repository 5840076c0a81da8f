//! Simple hand-made solids.

use host_tests::solid::{Part, Solid};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

type Point = [f32; 3];

fn point(at: Vector3<f32>) -> Point {
    at.into()
}

/// Adds one body between rings of points, each counter-clockwise seen from the next one. The ends of open tubes are
/// closed by fans around the centres of the first and last ring. In closed tubes the first ring follows the last.
fn tube(solid: &mut Solid, rings: &[Vec<Vector3<f32>>], closed: bool) {
    let sides = rings[0].len() as u32;
    let first = solid.vertices.len() as u32;
    solid.vertices.extend(rings.iter().flatten().map(|&at| point(at)));
    let count = rings.len() as u32;
    let at = |ring: u32, side: u32| first + ring % count * sides + side % sides;
    for ring in 0..if closed { count } else { count - 1 } {
        for side in 0..sides {
            let [a, b, c, d] =
                [at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)];
            solid.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    if !closed {
        for (ring, outward) in [(0, false), (count - 1, true)] {
            let middle = rings[ring as usize].iter().sum::<Vector3<f32>>() / sides as f32;
            let tip = solid.vertices.len() as u32;
            solid.vertices.push(point(middle));
            for side in 0..sides {
                let (a, b) = (at(ring, side), at(ring, side + 1));
                solid.triangles.push(if outward { [a, b, tip] } else { [b, a, tip] });
            }
        }
    }
}

fn across(axis: &Vector3<f32>) -> [Vector3<f32>; 2] {
    let side = if axis.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
    let x = axis.cross(&side).normalize();
    [x, axis.cross(&x)]
}

pub(crate) fn add_capsule(solid: &mut Solid, from: Point, to: Point, radius: f32) {
    let (a, b) = (Vector3::from(from), Vector3::from(to));
    let axis = (b - a).try_normalize(1e-9).unwrap_or(Vector3::z());
    let [x, y] = across(&axis);
    let ring = |middle: Vector3<f32>, latitude: f32| {
        (0..24)
            .map(|i| {
                let (sin, cos) = (i as f32 / 24.0 * TAU).sin_cos();
                middle + ((x * cos + y * sin) * latitude.cos() + axis * latitude.sin()) * radius
            })
            .collect::<Vec<_>>()
    };
    let latitude = |i: usize| i as f32 / 6.0 * FRAC_PI_2 * 0.999;
    let mut rings: Vec<_> = (0..=6).map(|i| ring(a, latitude(i) - FRAC_PI_2 * 0.999)).collect();
    rings.extend((0..=6).map(|i| ring(b, latitude(i))));
    tube(solid, &rings, false);
    solid.parts.push(Part::Capsule { from, to, radius });
}

pub(crate) fn add_box(solid: &mut Solid, pose: Isometry3<f32>, half_extents: Point) {
    let [x, y, z] = half_extents;
    let ring = |z: f32| {
        [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| (pose * Point3::new(x, y, z)).coords).to_vec()
    };
    tube(solid, &[ring(-z), ring(z)], false);
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (pose * axis).into());
    solid.parts.push(Part::Cuboid { centre: pose.translation.vector.into(), axes, half_extents });
}

/// Adds a round bar along a circle or an arc in the xz plane. Its parts are hulls.
pub(crate) fn add_arc(
    solid: &mut Solid,
    middle: Point,
    radius: f32,
    thickness: f32,
    from: f32,
    to: f32,
    count: usize,
) {
    let closed = (to - from - TAU).abs() < 1e-3;
    let ring = |i: usize| {
        let angle = from + (to - from) * i as f32 / count as f32;
        let outwards = Vector3::new(angle.cos(), 0.0, angle.sin());
        (0..12)
            .map(|j| {
                let (sin, cos) = (-(j as f32) / 12.0 * TAU).sin_cos();
                Vector3::from(middle) + outwards * (radius + thickness * cos)
                    - Vector3::y() * (thickness * sin)
            })
            .collect::<Vec<_>>()
    };
    let rings: Vec<_> = (0..if closed { count } else { count + 1 }).map(ring).collect();
    tube(solid, &rings, closed);
    let hulls =
        (0..count).map(|i| Part::Hull([ring(i), ring(i + 1)].concat().into_iter().map(point).collect()));
    solid.parts.extend(hulls);
}

/// A ring in the xz plane about the origin.
pub(crate) fn ring(radius: f32, thickness: f32) -> Solid {
    let mut solid = Solid::default();
    add_arc(&mut solid, [0.0; 3], radius, thickness, 0.0, TAU, 32);
    solid
}

pub(crate) fn capsule(from: Point, to: Point, radius: f32) -> Solid {
    let mut solid = Solid::default();
    add_capsule(&mut solid, from, to, radius);
    solid
}

pub(crate) fn cuboid(half_extents: Point) -> Solid {
    let mut solid = Solid::default();
    add_box(&mut solid, Isometry3::identity(), half_extents);
    solid
}

pub(crate) fn ball(radius: f32) -> Solid {
    capsule([0.0; 3], [0.0; 3], radius)
}

/// A peg of radius 4 mm from a wall at y = 0 towards +y, tilted slightly upwards.
pub(crate) fn peg() -> Solid {
    let mut solid = wall();
    add_capsule(&mut solid, [0.0; 3], [0.0, 0.1, 0.015], PEG);
    solid
}

fn wall() -> Solid {
    let mut solid = Solid::default();
    add_box(&mut solid, at(0.0, -0.01, 0.0), [0.2, 0.01, 0.15]);
    solid
}

/// Radius of the peg and of the hook's bar, m.
pub(crate) const PEG: f32 = 0.004;

/// A hook of capsules that leaves a wall at y = 0 and bends down and up again. Its lowest point is at y = 0.07, z = 0.
pub(crate) fn hook() -> Solid {
    let mut solid = wall();
    let at = |degrees: f32| {
        let (sin, cos) = (degrees / 180.0 * PI).sin_cos();
        [0.0, 0.07 - 0.03 * cos, 0.03 - 0.03 * sin]
    };
    let path = [[0.0, 0.0, 0.05], at(0.0), at(45.0), at(90.0), at(135.0), at(180.0), [0.0, 0.1, 0.04]];
    for pair in path.windows(2) {
        add_capsule(&mut solid, pair[0], pair[1], PEG);
    }
    solid
}

/// An arc of hulls in the yz plane, similar to the hook.
pub(crate) fn hulls() -> Solid {
    let mut solid = Solid::default();
    add_arc(&mut solid, [0.0, 0.0, 0.0], 0.03, PEG, PI, TAU, 12);
    let turn = pose([0.0, 0.07, 0.03], Vector3::z(), 90.0);
    let place = |at: &mut Point| *at = (turn * Point3::from(*at)).coords.into();
    solid.vertices.iter_mut().for_each(place);
    for part in &mut solid.parts {
        if let Part::Hull(points) = part {
            points.iter_mut().for_each(place);
        }
    }
    solid
}

/// A mug on z = 0 about the z axis with its handle towards +x: 8 cm wide, 9 cm high, 41 hulls.
pub(crate) fn mug() -> Solid {
    let mut solid = Solid::default();
    let circle = |radius: f32, z: f32| {
        (0..24)
            .map(|i| {
                let (sin, cos) = (i as f32 / 24.0 * TAU).sin_cos();
                Vector3::new(radius * cos, radius * sin, z)
            })
            .collect::<Vec<_>>()
    };
    let (outer, inner, height, floor) = (0.04, 0.036, 0.09, 0.004);
    let outline = [(outer, 0.0), (outer, height), (inner, height), (inner, floor)];
    let rings: Vec<_> = outline.iter().map(|&(radius, z)| circle(radius, z)).collect();
    tube(&mut solid, &rings, false);
    for i in 0..24 {
        let corners = rings.iter().flat_map(|ring| [ring[i], ring[(i + 1) % 24]]);
        let mut corners: Vec<_> = corners.collect();
        for corner in &mut corners[6..] {
            corner.z = 0.0;
        }
        solid.parts.push(Part::Hull(corners.into_iter().map(point).collect()));
    }
    let plate = [circle(outer, 0.0), circle(inner, floor)].concat();
    solid.parts.push(Part::Hull(plate.into_iter().map(point).collect()));
    add_arc(&mut solid, [0.038, 0.0, 0.045], 0.025, 0.004, -FRAC_PI_2, FRAC_PI_2, 16);
    solid
}

/// A clothes hanger in the xz plane: a triangle of bars below a hook around the origin.
pub(crate) fn hanger() -> Solid {
    let mut solid = Solid::default();
    let (left, right, top) = ([-0.15, 0.0, -0.15], [0.15, 0.0, -0.15], [0.0, 0.0, -0.07]);
    for (from, to) in [(left, right), (right, top), (top, left), (top, [0.0, 0.0, -0.02])] {
        add_capsule(&mut solid, from, to, 0.003);
    }
    add_arc(&mut solid, [0.0; 3], 0.02, 0.003, -FRAC_PI_2, PI, 14);
    solid
}

/// A pose from a position in metres and a rotation in degrees about an axis.
pub(crate) fn pose(position: Point, axis: Vector3<f32>, degrees: f32) -> Isometry3<f32> {
    let turn = axis.try_normalize(1e-9).map_or(Vector3::zeros(), |axis| axis * (degrees / 180.0 * PI));
    Isometry3::from_parts(Translation3::from(position), UnitQuaternion::new(turn))
}

pub(crate) fn at(x: f32, y: f32, z: f32) -> Isometry3<f32> {
    Isometry3::translation(x, y, z)
}
