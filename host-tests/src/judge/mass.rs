//! Mass properties of a solid.

use crate::solid::Solid;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};

/// Mass properties of a rigid body.
#[derive(Clone, Copy, Debug)]
pub struct Mass {
    /// Mass, kg.
    pub mass: f64,
    /// Principal moments of inertia about the centre of mass, kg m².
    pub inertia: [f64; 3],
    /// Frame of the centre of mass and the principal axes: maps its coordinates to the solid's.
    pub frame: Isometry3<f64>,
}

impl Mass {
    /// Mass properties of a solid of uniform density and `mass` kilograms. Where bodies overlap, the volume counts
    /// twice. A surface that is not closed, or has no volume, is a sheet of uniform thickness.
    pub fn of(solid: &Solid, mass: f64) -> Self {
        let at = |index: u32| Vector3::from(solid.vertices[index as usize]).cast::<f64>();
        // An origin near the surface avoids cancellation.
        let origin = solid.triangles.first().map_or_else(Vector3::zeros, |triangle| at(triangle[0]));
        let (mut volume, mut area) = (Integrals::default(), Integrals::default());
        for &triangle in &solid.triangles {
            let [a, b, c] = triangle.map(|index| at(index) - origin);
            // The fourth corner of the tetrahedron is the origin.
            volume.add(a.dot(&b.cross(&c)), [a, b, c], [6.0, 24.0, 120.0]);
            area.add((b - a).cross(&(c - a)).norm(), [a, b, c], [2.0, 6.0, 24.0]);
        }
        let fills_some = volume.size.abs() > LEAST_THICKNESS * area.size;
        let Integrals { size, first, second } = if fills_some && solid.is_closed() { volume } else { area };
        let centre = first / size;
        let covariance = second / size - centre * centre.transpose();
        let inertia = (Matrix3::identity() * covariance.trace() - covariance) * mass;
        let principal = inertia.symmetric_eigen();
        let mut axes = principal.eigenvectors;
        if axes.determinant() < 0.0 {
            axes.column_mut(2).neg_mut();
        }
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        Self {
            mass,
            inertia: principal.eigenvalues.into(),
            frame: Isometry3::from_parts(Point3::from(origin + centre).into(), rotation),
        }
    }
}

/// Smallest ratio of volume to area of a solid, m. A closed surface below it is a folded sheet.
const LEAST_THICKNESS: f64 = 1e-6;

/// Integrals of 1, x and x xᵀ.
#[derive(Default)]
struct Integrals {
    size: f64,
    first: Vector3<f64>,
    second: Matrix3<f64>,
}

impl Integrals {
    /// Adds the integrals over a simplex of n dimensions: `determinant` of its edges, three `corners` (a tetrahedron's
    /// fourth is the origin), and `factorials` of n, n + 1 and n + 2.
    fn add(&mut self, determinant: f64, corners: [Vector3<f64>; 3], factorials: [f64; 3]) {
        let [a, b, c] = corners;
        let sum = a + b + c;
        let squares = a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose();
        self.size += determinant / factorials[0];
        self.first += sum * (determinant / factorials[1]);
        self.second += squares * (determinant / factorials[2]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_box_far_from_the_origin() {
        let half = [0.05_f32, 0.02, 0.01];
        let pose = Isometry3::new(Vector3::new(0.3, -0.2, 0.5), Vector3::new(0.4, 0.8, -0.3));
        let corner = |i: u32| {
            let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            (pose * Point3::new(sign(1) * half[0], sign(2) * half[1], sign(4) * half[2])).coords.into()
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let solid = Solid {
            vertices: (0..8).map(corner).collect(),
            triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            ..Solid::default()
        };
        let mass = Mass::of(&solid, 0.3);
        assert!((mass.frame.translation.vector - pose.translation.vector.cast()).norm() < 1e-7);
        let mut moments = mass.inertia;
        moments.sort_by(f64::total_cmp);
        let expected = |a: f64, b: f64| 0.3 / 3.0 * (a * a + b * b);
        let expected = [expected(0.02, 0.01), expected(0.05, 0.01), expected(0.05, 0.02)];
        for (moment, expected) in moments.iter().zip(expected) {
            assert!((moment / expected - 1.0).abs() < 1e-4, "{moments:?}");
        }
        // The principal axes are those of the box.
        for axis in mass.frame.rotation.to_rotation_matrix().matrix().column_iter() {
            let along = pose.rotation.cast::<f64>().inverse() * axis.into_owned();
            assert!((along.amax() - 1.0).abs() < 1e-4, "{along}");
        }
    }
}
