//! What a query for distances collects.

use crate::geometry::{Point, Vector};
use crate::motion::failure::{Collision, Mover, Obstacle};
use heapless::Vec;

/// A place where something that moves is near something that stands still.
#[derive(Clone, Copy, Debug)]
pub(in crate::motion) struct Touch {
    /// Distance, metres, negative inside; or a lower bound of it.
    pub(in crate::motion) distance: f32,
    /// Where, in supporter coordinates, metres.
    pub(in crate::motion) at: Point,
    /// Unit vector that leads away from the obstacle, in supporter coordinates; zero where it is not known.
    pub(in crate::motion) normal: Vector,
    pub(in crate::motion) mover: Mover,
    pub(in crate::motion) obstacle: Obstacle,
}

impl Touch {
    pub(in crate::motion) fn collision(&self) -> Collision {
        let Self { distance, at, mover, obstacle, .. } = *self;
        Collision { mover, obstacle, at: at.into(), distance }
    }
}

/// Collects touches.
pub(in crate::motion) trait Collector {
    /// Distance below which touches are of interest, metres.
    fn limit(&self) -> f32;
    /// Takes a touch with a distance below the limit.
    fn offer(&mut self, touch: Touch);
    /// Whether it takes more than the nearest touch.
    fn takes_all(&self) -> bool;
    /// Distance of a touch, metres, below which no other is of interest.
    fn enough(&self) -> f32;
}

/// The nearest touch within a distance.
pub(in crate::motion) struct Nearest {
    /// Of the touch, or the limit of the search.
    pub(in crate::motion) distance: f32,
    pub(in crate::motion) touch: Option<Touch>,
    /// Distance below which nothing nearer is looked for, metres.
    pub(in crate::motion) enough: f32,
}

impl Nearest {
    pub(in crate::motion) fn within(limit: f32) -> Self {
        Self { distance: limit, touch: None, enough: f32::NEG_INFINITY }
    }
}

impl Collector for Nearest {
    fn enough(&self) -> f32 {
        self.enough
    }

    fn takes_all(&self) -> bool {
        false
    }

    fn limit(&self) -> f32 {
        if self.distance < self.enough { f32::NEG_INFINITY } else { self.distance }
    }

    fn offer(&mut self, touch: Touch) {
        if touch.distance < self.limit() {
            (self.distance, self.touch) = (touch.distance, Some(touch));
        }
    }
}

/// Distance below which touches with similar normals are one, metres.
const SAME_PLACE: f32 = 0.004;
/// Least cosine between the normals of touches that are one.
const SAME_NORMAL: f32 = 0.9;

/// Touches within a distance; of those that are alike, and of more than fit, the nearest remain.
pub(in crate::motion) struct Touches {
    range: f32,
    pub(in crate::motion) list: Vec<Touch, { Touches::CAPACITY }>,
}

impl Touches {
    /// Touches that are kept.
    pub(in crate::motion) const CAPACITY: usize = 16;

    pub(in crate::motion) fn within(range: f32) -> Self {
        Self { range, list: Vec::new() }
    }
}

impl Collector for Touches {
    fn enough(&self) -> f32 {
        f32::NEG_INFINITY
    }

    fn takes_all(&self) -> bool {
        true
    }

    fn limit(&self) -> f32 {
        self.range
    }

    fn offer(&mut self, touch: Touch) {
        if touch.normal == Vector::zeros() {
            return;
        }
        let is_same = |other: &&mut Touch| {
            (other.at - touch.at).norm_squared() < SAME_PLACE * SAME_PLACE
                && other.normal.dot(&touch.normal) > SAME_NORMAL
        };
        if let Some(other) = self.list.iter_mut().find(is_same) {
            if touch.distance < other.distance {
                *other = touch;
            }
        } else if let Err(touch) = self.list.push(touch) {
            let farthest = self.list.iter_mut().max_by(|a, b| a.distance.total_cmp(&b.distance));
            if let Some(farthest) = farthest.filter(|farthest| touch.distance < farthest.distance) {
                *farthest = touch;
            }
        }
    }
}
