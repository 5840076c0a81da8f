//! The direction along which points spread most.

use crate::geometry::{Point, PointTree, Vector};

/// Variance of positions below which they are one place, m²: a nanometre squared. The square of less has few digits or none.
const ONE_PLACE: f32 = 1e-18;

/// Unit vector along which the points within `radius` metres of a position spread most; any where they are at one place.
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
        if norm <= ONE_PLACE {
            break;
        }
        direction = next / norm;
    }
    direction
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::PointTreeSlots;
    use crate::memory::{Arena, model_bytes};
    use crate::monitor::Meter;

    /// The direction of points along a line with steps of so many metres.
    fn of_steps(step: f32) -> Vector {
        let line = Vector::new(0.6, 0.0, -0.8);
        let points: std::vec::Vec<Point> = (0..9).map(|k| Point::from(line * (step * k as f32))).collect();
        let mut memory = std::vec![0; model_bytes(PointTree::bytes(points.len()))];
        let mut arena = Arena::new(&mut memory, 0).unwrap();
        let mut slots = PointTreeSlots::new(points.len(), &mut arena).unwrap();
        slots.fill(&points, &Meter::unwatched()).unwrap();
        principal_direction(&slots.tree(), &points[4], 0.02)
    }

    #[test]
    fn the_direction_is_that_of_a_line_and_a_unit_vector_where_there_is_none() {
        for step in [1e-3, 1e-6] {
            assert!(of_steps(step).cross(&Vector::new(0.6, 0.0, -0.8)).norm() < 1e-3, "{step}");
        }
        // The variance of such steps is a number of a few bits, or zero.
        for step in [1e-10, 1e-11, 3e-12, 0.0] {
            assert!((of_steps(step).norm() - 1.0).abs() < 1e-5, "{step}");
        }
    }
}
