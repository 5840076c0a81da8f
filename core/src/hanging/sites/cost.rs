//! How good a match is: eqs. (8) to (11).

use super::{HangingSite, SupportSite};
use crate::params::Params;

/// The costs of a pose; less is better.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Cost {
    /// `S_c`: points of the supporter inside the object, eq. (8).
    pub collision: u32,
    /// `S_b`: how far the hanging position is from the middle of the supporter along the hanging direction, from
    /// 0.5 (in the middle) to 1 (at the boundary), eq. (9).
    pub boundary: f32,
    /// `S_a`: how small the contact area is against the object's largest, from 0 to 1, eq. (10).
    pub contact_area: f32,
    /// `S_total`: the weighted sum, eq. (11).
    pub total: f32,
}

impl Cost {
    /// The cost of a match before its collisions are counted. `most_contact_points` is the largest number of
    /// contact points among the object's sites.
    pub(super) fn without_collision(
        object: &HangingSite,
        most_contact_points: u32,
        support: &SupportSite,
        params: &Params,
    ) -> Self {
        let [d1, d2] = support.boundary_distances;
        // A position outside the hull, or on its boundary on both sides, is as close to it as can be.
        let boundary = if d1 + d2 > 0.0 { d1.max(d2) / (d1 + d2) } else { 1.0 };
        let contact_area = 1.0 - object.contact_points as f32 / most_contact_points.max(1) as f32;
        let total = params.boundary_weight * boundary + params.contact_area_weight * contact_area;
        Self { collision: 0, boundary, contact_area, total }
    }

    /// The same with `collision` points inside.
    pub(super) fn with_collision(self, collision: u32, params: &Params) -> Self {
        Self { collision, total: self.total + params.collision_weight * collision as f32, ..self }
    }

    /// How many points may be inside before the total is worse than `total`.
    pub(super) fn collisions_up_to(&self, total: f32, params: &Params) -> u32 {
        if params.collision_weight > 0.0 {
            // One more than the quotient, so that rounding never drops a match that is as good.
            (((total - self.total) / params.collision_weight) as u32).saturating_add(1)
        } else {
            u32::MAX
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;

    fn cost(contact_points: u32, boundary_distances: [f32; 2]) -> Cost {
        let object = HangingSite { contact_points, ..HangingSite::zeroed() };
        let support = SupportSite { boundary_distances, ..SupportSite::zeroed() };
        Cost::without_collision(&object, 80, &support, &Params::paper())
    }

    #[test]
    fn equations_9_to_11() {
        let cost = cost(20, [0.03, 0.01]);
        assert_eq!((cost.boundary, cost.contact_area, cost.total), (0.75, 0.75, 1.5));
        let hit = cost.with_collision(3, &Params { collision_weight: 0.5, ..Params::paper() });
        assert_eq!((hit.collision, hit.total), (3, 3.0));
        assert_eq!(self::cost(80, [0.0, 0.0]).total, 1.0);
    }

    #[test]
    fn the_collision_bound_keeps_every_match_that_is_as_good() {
        let params = Params { collision_weight: 0.3, ..Params::paper() };
        let cost = cost(33, [0.02, 0.017]);
        for collision in 0..5000 {
            let total = cost.with_collision(collision, &params).total;
            let bound = cost.collisions_up_to(total, &params);
            assert!((collision..=collision + 2).contains(&bound), "{collision}: {bound}");
        }
        assert!(cost.collisions_up_to(0.0, &params) <= 1);
    }
}
