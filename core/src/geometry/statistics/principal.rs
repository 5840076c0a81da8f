//! The direction along which points spread most.

use crate::geometry::{Point, PointTree, Vector};

/// Unit vector along which the points within `radius` metres of a position spread most.
pub(crate) fn principal_direction(tree: &PointTree, position: &Point, radius: f32) -> Vector {
    let (mut count, mut sum, mut squares) = (0.0, Vector::zeros(), nalgebra::Matrix3::<f32>::zeros());
    tree.for_each_within(position, radius, |n| {
        let offset = tree.points()[n.index as usize] - position;
        count += 1.0;
        sum += offset;
        squares += offset * offset.transpose();
    });
    let count = f32::max(count, 1.0);
    let spread = squares / count - (sum / count) * (sum / count).transpose();
    // Power iteration. Twenty rounds suffice for a direction that only orders candidates.
    let mut direction = Vector::new(1.0, 0.83, 0.61).normalize();
    for _ in 0..20 {
        let next = spread * direction;
        let norm = next.norm();
        if norm <= 0.0 {
            break;
        }
        direction = next / norm;
    }
    direction
}
