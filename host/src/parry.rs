//! Conversions to and from the types of parry3d 0.31, which rapier3d uses too.
//!
//! Triangles need no conversion: `TriMesh::indices` is what [`Mesh::new`](hangpose_core::geometry::Mesh::new) takes.
//!
//! ```
//! use hangpose::geometry::{Cloud, Mesh};
//! use hangpose::{Monitor, Params, analyze_object, analyze_supporter, parry, predict_poses};
//! use hangpose::{hanging::{HangingPose, Request}, perception::sampling};
//! use parry3d::{math, query, shape::{Capsule, TriMesh}};
//!
//! # // A ring of 3 cm radius, 6 mm thick.
//! # let turn = |step: u32, steps: u32| (std::f32::consts::TAU * step as f32 / steps as f32).sin_cos();
//! # let (rows, columns) = (48, 16);
//! # let vertices: Vec<math::Vector> = (0..rows * columns).map(|i| {
//! #     let ((s, c), (u, v)) = (turn(i / columns, rows), turn(i % columns, columns));
//! #     let radius = 0.03 + 0.003 * v;
//! #     math::Vector::new(radius * c, radius * s, 0.003 * u)
//! # }).collect();
//! # let triangles: Vec<[u32; 3]> = (0..rows * columns).flat_map(|i| {
//! #     let at = |row: u32, column: u32| row % rows * columns + column % columns;
//! #     let (r, k) = (i / columns, i % columns);
//! #     let [a, b, c, d] = [at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1)];
//! #     [[a, b, c], [a, c, d]]
//! # }).collect();
//! let ring = TriMesh::new(vertices, triangles)?;
//! let peg = Capsule::new_y(0.04, 0.004);
//!
//! // A point cloud of the peg, as from a camera.
//! let (vertices, triangles) = peg.to_trimesh(32, 8);
//! let vertices = parry::coordinates(&vertices);
//! let (mut points, mut normals) = (vec![[0.0; 3]; 2000], vec![[0.0; 3]; 2000]);
//! let mut memory = vec![0; sampling::sample_bytes(points.len())];
//! sampling::sample(&Mesh::new(&vertices, &triangles)?, 0, &mut points, &mut normals, &mut memory)?;
//!
//! // Predict where the ring hangs.
//! let (params, monitor) = (Params::default(), Monitor::new());
//! let vertices = parry::coordinates(ring.vertices());
//! let (mut object_memory, mut supporter_memory) = (vec![], vec![]);
//! let object = analyze_object(&Mesh::new(&vertices, ring.indices())?, &params, &mut object_memory, &monitor)?;
//! let cloud = Cloud::new(&points, Some(&normals))?;
//! let supporter = analyze_supporter(&cloud, &params, &mut supporter_memory, &monitor)?;
//! let mut poses = [HangingPose::default(); 10];
//! let prediction = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor)?;
//!
//! // Check the best pose with parry: the peg is in the ring's hole, which has a radius of 27 mm.
//! let pose = parry::pose_to_parry(&prediction.poses[0].pose);
//! let gap = query::distance(&pose, &ring, &math::Pose::IDENTITY, &peg)?.distance;
//! assert!(gap < 0.027 && pose.translation.y.abs() < 0.04);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use hangpose_core::geometry::Pose;
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use parry3d::math;

/// Converts vertices, points or normals for the core. The frame is unchanged; lengths are in metres.
pub fn coordinates(vectors: &[math::Vector]) -> Vec<[f32; 3]> {
    vectors.iter().map(math::Vector::to_array).collect()
}

/// Converts a pose for parry and rapier. A hanging pose maps object to supporter coordinates, so the object's pose in
/// the world is the supporter's pose in the world times this pose.
pub fn pose_to_parry(pose: &Pose) -> math::Pose {
    let rotation = math::Rotation::from_array(pose.rotation.coords.into());
    math::Pose::from_parts(math::Vector::from_array(pose.translation.vector.into()), rotation)
}

/// Converts a pose for the core. The rotation is renormalised, since many products may have changed its length.
pub fn pose_from_parry(pose: &math::Pose) -> Pose {
    let rotation = Quaternion::from(nalgebra::Vector4::from(pose.rotation.to_array()));
    Pose::from_parts(
        Translation3::from(pose.translation.to_array()),
        UnitQuaternion::from_quaternion(rotation),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use hangpose_core::geometry::{Point, Vector};

    /// Both libraries transform a point alike, before and after conversion in both directions.
    #[test]
    fn a_pose_moves_points_to_the_same_place() {
        let ours = Pose::new(Vector::new(0.1, -0.2, 0.3), Vector::new(1.0, 2.0, -0.5));
        let parrys = pose_to_parry(&ours);
        for point in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.3, -0.7, 0.2]] {
            let expected = ours * Point::from(point);
            let moved = Point::from(parrys.transform_point(point.into()).to_array());
            // A few rounding errors of numbers around 1.
            assert!((moved - expected).norm() < 1e-6, "{moved} {expected}");
        }
        assert!((pose_from_parry(&parrys).to_homogeneous() - ours.to_homogeneous()).norm() < 1e-6);
    }

    #[test]
    fn a_rotation_that_lost_its_length_is_mended() {
        let mut pose = pose_to_parry(&Pose::rotation(Vector::new(0.0, 0.0, 1.0)));
        pose.rotation = math::Rotation::from_array(pose.rotation.to_array().map(|x| 1.01 * x));
        let x = pose_from_parry(&pose) * Vector::x();
        assert!((x - Vector::new(1_f32.cos(), 1_f32.sin(), 0.0)).norm() < 1e-6, "{x}");
    }
}
