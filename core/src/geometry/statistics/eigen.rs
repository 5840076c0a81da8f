//! Eigenvectors of a symmetric 3x3 matrix.

use crate::geometry::Vector;
use nalgebra::Matrix3;

/// Sweeps of cyclic Jacobi. It converges quadratically: six exceed `f32`'s precision for any 3x3 matrix.
const SWEEPS: usize = 6;

/// The unit eigenvector of the least eigenvalue of a symmetric matrix, of either sign.
pub(crate) fn least_eigenvector(m: Matrix3<f32>) -> Vector {
    let (values, vectors) = eigenvectors(m);
    vectors[values.imin()]
}

/// The eigenvalues of a symmetric matrix, and their unit eigenvectors, of either sign and at right angles: cyclic Jacobi
/// rotations (Golub and Van Loan, "Matrix Computations", 8.5), which are as accurate as the matrix and never fail.
pub(crate) fn eigenvectors(mut m: Matrix3<f32>) -> (Vector, [Vector; 3]) {
    let mut vectors = Matrix3::<f32>::identity();
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[(p, q)] == 0.0 {
                continue;
            }
            // The rotation that makes m[(p, q)] zero.
            let theta = (m[(q, q)] - m[(p, p)]) / (2.0 * m[(p, q)]);
            let t = theta.signum() / (theta.abs() + libm::sqrtf(theta * theta + 1.0));
            let c = 1.0 / libm::sqrtf(t * t + 1.0);
            let s = t * c;
            let mut rotation = Matrix3::identity();
            (rotation[(p, p)], rotation[(q, q)]) = (c, c);
            (rotation[(p, q)], rotation[(q, p)]) = (s, -s);
            m = rotation.transpose() * m * rotation;
            (m[(p, q)], m[(q, p)]) = (0.0, 0.0);
            vectors *= rotation;
        }
    }
    (m.diagonal(), [0, 1, 2].map(|i| vectors.column(i).normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn solves_its_equation() {
        let mut random = Random::new(1);
        for case in 0..300 {
            let scale = [1.0, 1e-9, 1e6][case % 3];
            let turn = nalgebra::Rotation3::from_euler_angles(
                random.next_f32() * 6.0,
                random.next_f32() * 6.0,
                random.next_f32() * 6.0,
            );
            let least = Vector::z();
            let values =
                Vector::new(1.0 + random.next_f32(), 1.0 + random.next_f32(), random.next_f32() * 0.9);
            let m = turn.matrix() * Matrix3::from_diagonal(&(values * scale)) * turn.matrix().transpose();
            let found = least_eigenvector((m + m.transpose()) * 0.5);
            assert!(found.dot(&(turn * least)).abs() > 0.9999, "{case}: {found}");
        }
    }

    #[test]
    fn degenerate_matrices_give_unit_vectors() {
        for m in [Matrix3::zeros(), Matrix3::identity(), Matrix3::from_element(1.0)] {
            assert!((least_eigenvector(m).norm() - 1.0).abs() < 1e-5);
        }
        let flat = Matrix3::from_diagonal(&Vector::new(2.0, 0.0, 3.0));
        assert_eq!(least_eigenvector(flat).y.abs(), 1.0);
    }
}
