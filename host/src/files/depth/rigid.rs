//! Checks that a matrix is a rigid motion.

use hangpose_core::geometry::Pose;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Greatest deviation of a rotation's product with its transpose from the identity. Matrices written with three decimals
/// pass.
const TOLERANCE: f64 = 5e-3;

/// The pose with this rotation matrix and translation, metres; `Err` is the reason why it is none.
pub(super) fn pose(rotation: &Matrix3<f64>, translation: Vector3<f64>) -> Result<Pose, String> {
    if !rotation.iter().chain(translation.iter()).all(|x| x.is_finite()) {
        return Err("the pose has numbers that are not finite: the tracker had lost the camera".into());
    }
    let deviation = (rotation.transpose() * rotation - Matrix3::identity()).amax();
    let determinant = rotation.determinant();
    if deviation > TOLERANCE {
        let lengths = [0, 1, 2].map(|i| format!("{:.3}", rotation.column(i).norm())).join(", ");
        return Err(format!(
            "the pose is not rigid: the columns of its rotation have lengths {lengths} and should be perpendicular unit vectors"
        ));
    }
    if determinant < 0.0 {
        return Err("the pose mirrors: its rotation has the determinant -1".into());
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(rotation));
    Ok(Pose::from_parts(translation.cast().into(), rotation.cast()))
}

/// The pose of the sixteen numbers of a row-major 4 x 4 matrix; `Err` is the reason why it is none.
pub fn of_rows(m: &[f64]) -> Result<Pose, String> {
    if m.len() != 16 {
        return Err(format!("a 4 x 4 pose has 16 numbers, not {}", m.len()));
    }
    if (0..4).any(|i| (m[12 + i] - if i == 3 { 1.0 } else { 0.0 }).abs() > 1e-6) {
        return Err("the last row of a 4 x 4 pose must be 0 0 0 1".into());
    }
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    pose(&rotation, Vector3::new(m[3], m[7], m[11]))
}
