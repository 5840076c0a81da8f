//! Axis-aligned bounding boxes.

use crate::geometry::{Point, Vector};

/// An axis-aligned box, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the least coordinates.
    pub min: Point,
    /// The corner with the greatest coordinates.
    pub max: Point,
}

impl Aabb {
    /// The empty box: its union with a point is that point.
    pub(crate) const EMPTY: Self = Self {
        min: Point::new(f32::INFINITY, f32::INFINITY, f32::INFINITY),
        max: Point::new(f32::NEG_INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY),
    };

    /// The smallest box around `points`.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point>) -> Self {
        points.into_iter().fold(Self::EMPTY, |aabb, point| aabb.grow(point))
    }

    pub(crate) fn grow(&self, point: &Point) -> Self {
        Self { min: self.min.inf(point), max: self.max.sup(point) }
    }

    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Edge lengths, in metres.
    pub fn extents(&self) -> Vector {
        self.max - self.min
    }

    /// The length of the diagonal, in metres.
    pub fn diagonal(&self) -> f32 {
        self.extents().norm()
    }

    /// The centre of the box.
    pub fn centre(&self) -> Point {
        nalgebra::center(&self.min, &self.max)
    }

    /// The eight corners.
    pub(crate) fn corners(&self) -> [Point; 8] {
        let ends = [self.min, self.max];
        core::array::from_fn(|k| Point::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2 & 1].z))
    }

    /// Half the surface area; zero for an empty box.
    pub(crate) fn half_area(&self) -> f32 {
        let e = self.extents().sup(&Vector::zeros());
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    /// Whether a point is in the box or on its border.
    pub fn contains(&self, point: &Point) -> bool {
        (0..3).all(|i| self.min[i] <= point[i] && point[i] <= self.max[i])
    }

    /// Square of the distance from `point` to the box; zero inside.
    pub(crate) fn distance_squared(&self, point: &Point) -> f32 {
        let mut sum = 0.0;
        for i in 0..3 {
            // By comparisons, which take one instruction each: nothing here is not a number.
            let (below, above) = (self.min[i] - point[i], point[i] - self.max[i]);
            let outside = if below > above { below } else { above };
            let outside = if outside > 0.0 { outside } else { 0.0 };
            sum += outside * outside;
        }
        sum
    }

    /// Square of the distance from `point` to the farthest corner.
    pub(crate) fn farthest_squared(&self, point: &Point) -> f32 {
        let mut sum = 0.0;
        for i in 0..3 {
            let reach = (point[i] - self.min[i]).abs().max((self.max[i] - point[i]).abs());
            sum += reach * reach;
        }
        sum
    }
}
