//! Where things are free: outside of the supporter's bounds.

use super::placement::{Leg, Placement};
use crate::geometry::{Aabb, Point, Vector, fibonacci_direction};

/// Directions in which ways out are tried.
const DIRECTIONS: usize = 24;

/// Places outside of a box, one in each of some directions from a place, with its rotation. They are not tested.
pub(super) fn outside<'o>(
    aabb: &'o Aabb,
    from: &'o Placement,
    reach: f32,
    up: Vector,
) -> impl Iterator<Item = Placement> + 'o {
    // Straight up comes first: that is how most things are taken off. Then along the axes, as most things are made.
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    let directions = core::iter::once(up)
        .chain(axes)
        .chain(axes.map(|axis| -axis))
        .chain((0..DIRECTIONS).map(|index| fibonacci_direction(index, DIRECTIONS)));
    directions.map(move |direction| {
        let centre = from.centre();
        // Least way until the ball around what moves is off the box.
        let is_off = |distance: f32| aabb.distance_squared(&(centre + direction * distance)) > reach * reach;
        let far = aabb.diagonal() + reach + libm::sqrtf(aabb.distance_squared(&centre));
        let (mut near, mut far) = (0.0, far * 1.01);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if is_off(middle) { far = middle } else { near = middle }
        }
        let leg = Leg { shift: direction * far, turn: Vector::zeros() };
        from.after(&leg, 1.0)
    })
}

/// Halvings of the distance to the outside: to a thousandth.
const HALVINGS: usize = 10;

/// The smallest box around points and a margin.
pub(super) fn box_around(aabb: &Aabb, points: impl IntoIterator<Item = Point>, margin: f32) -> Aabb {
    let all = points.into_iter().fold(*aabb, |all, point| all.grow(&point));
    let margin = Vector::repeat(margin);
    Aabb { min: all.min - margin, max: all.max + margin }
}
