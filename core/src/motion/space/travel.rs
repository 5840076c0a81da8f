//! How far a motion may go before it must be tested again.

use crate::geometry::{Aabb, Point};
use crate::motion::placement::{Leg, Placement};

/// Distances of what moves, metres: lower bounds.
#[derive(Clone, Copy)]
pub(in crate::motion) struct Distances {
    /// From the supporter.
    pub(super) supporter: f32,
    /// From the scene and what hangs already; infinite if there is nothing of that.
    pub(super) others: f32,
}

/// How much nearer a motion brings what moves, metres: upper bounds.
///
/// What turns about a hook comes hardly nearer to it, however far its other end travels.
#[derive(Clone, Copy)]
pub(in crate::motion) struct Travels {
    /// To the supporter.
    pub(super) supporter: f32,
    /// To the scene and what hangs already.
    pub(super) others: f32,
}

impl Distances {
    /// The lesser one.
    pub(in crate::motion) fn least(&self) -> f32 {
        self.supporter.min(self.others)
    }
}

impl Travels {
    /// Those of a motion from a place: of something of this reach, past a supporter in a box.
    pub(super) fn of(reach: f32, supporter: &Aabb, from: &Placement, leg: &Leg) -> Self {
        let others = leg.travel(reach);
        Self { supporter: travel_of_box(supporter, from, leg).min(others), others }
    }

    /// The share of the motion after which what `left` tells of the distances before it may be used up, but no less than that after which
    /// `least` metres are.
    pub(in crate::motion) fn share(
        &self,
        distances: &Distances,
        left: impl Fn(f32) -> f32,
        least: f32,
    ) -> f32 {
        let share = |distance: f32, travel: f32| left(distance).max(least) / travel.max(1e-9);
        share(distances.supporter, self.supporter).min(share(distances.others, self.others))
    }
}

/// How far any point of a box travels, metres, seen from what moves from a place: an upper bound.
///
/// It moves with the speed, per share of the motion, that the moving thing has where the point is. That is affine in the point and in the
/// centre of the moving thing: greatest at a corner of the box, and at the beginning or the end.
fn travel_of_box(aabb: &Aabb, from: &Placement, leg: &Leg) -> f32 {
    let (begin, end) = (from.centre(), from.centre() + leg.shift);
    let speed = |corner: &Point| {
        let with = |centre: &Point| (leg.shift + leg.turn.cross(&(corner - centre))).norm_squared();
        with(&begin).max(with(&end))
    };
    libm::sqrtf(aabb.corners().iter().map(speed).fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use crate::random::Random;
    use nalgebra::{Quaternion, UnitQuaternion};

    #[test]
    fn seen_from_what_moves_no_point_of_a_box_travels_farther_than_is_told() {
        let mut random = Random::new(7);
        let mut next = |size: f32| size * (2.0 * random.next_f32() - 1.0);
        let aabb = Aabb { min: Point::new(-0.1, 0.0, 0.2), max: Point::new(0.3, 0.1, 0.5) };
        let mut tightest = f32::INFINITY;
        for _ in 0..300 {
            let mut vector = |size: f32| Vector::new(next(size), next(size), next(size));
            let (centre, shift, turn, part) = (vector(0.5), vector(0.3), vector(1.5), vector(0.5));
            let rotation =
                UnitQuaternion::new_normalize(Quaternion::new(next(1.0), next(1.0), next(1.0), 1.0));
            let (from, leg) = (Placement::new(centre.into(), rotation), Leg { shift, turn });
            let point = aabb.centre() + aabb.extents().component_mul(&part);
            let seen = |share: f32| from.after(&leg, share).pose(&Point::origin()).inverse() * point;
            let way: f32 =
                (0..100).map(|k| (seen(k as f32 / 100.0) - seen((k + 1) as f32 / 100.0)).norm()).sum();
            let told = travel_of_box(&aabb, &from, &leg);
            assert!(way <= told + 1e-4, "{way} {told}");
            tightest = tightest.min(told / way);
        }
        assert!(tightest < 1.2, "the bound is near to what some point travels: {tightest}");
        // A ring turns about a bar: the bar stays where it is, whatever the reach of the ring.
        let bar = Aabb { min: Point::new(-0.05, -0.001, -0.001), max: Point::new(0.05, 0.001, 0.001) };
        let from = Placement::new(Point::new(0.0, 0.0, -0.3), UnitQuaternion::identity());
        let turn = Vector::x() * 0.1;
        let leg = Leg { shift: turn.cross(&Vector::new(0.0, 0.0, -0.3)), turn };
        assert!(leg.travel(0.3) > 0.05 && travel_of_box(&bar, &from, &leg) < 0.005);
    }
}
