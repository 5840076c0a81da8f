//! The point cloud of the ball.

use crate::scene::{IMAGES, RADIUS, Scene};
use hangpose::files::depth::{ScanFrame, read_scan};
use hangpose::geometry::{Aabb, Vector};
use hangpose::perception::depth_points::DepthPointsSettings;
use hangpose::{FuseError, scan_cloud, suggested_voxel};
use std::collections::HashSet;

fn frames() -> Vec<ScanFrame> {
    read_scan(&Scene::new().sources()).unwrap().frames
}

#[test]
fn has_one_point_a_voxel_on_the_ball_with_normals_outwards() {
    let found = scan_cloud(&frames(), 0.005, &DepthPointsSettings::default()).unwrap();
    let cloud = found.cloud;
    assert!(cloud.points.len() > 2000 && found.counts.points > 3 * cloud.points.len());
    let voxels: HashSet<_> = cloud.points.iter().map(|p| p.map(|x| (x / 0.005).floor() as i32)).collect();
    assert_eq!(voxels.len(), cloud.points.len());
    for (point, normal) in cloud.points.iter().zip(cloud.normals.as_ref().unwrap()) {
        let [point, normal] = [point, normal].map(|v| Vector::from(*v));
        assert!((point.norm() - RADIUS).abs() < 0.002, "{point}");
        assert!((normal.norm() - 1.0).abs() < 1e-5 && normal.dot(&point) > 0.9 * RADIUS, "{point} {normal}");
    }
    assert_eq!(cloud.viewpoints.len(), IMAGES);
    assert!(found.agreement.is_some_and(|agreement| agreement > 0.0));
}

#[test]
fn the_voxel_follows_the_size_of_what_is_shown() {
    let frames = frames();
    assert!((suggested_voxel(&frames, 5.0, None) - 0.002).abs() < 1e-4);
    let small = Aabb { min: [-0.05; 3].map(|x| x - 0.05).into(), max: [0.0; 3].into() };
    assert_eq!(suggested_voxel(&frames, 5.0, Some(small)), 0.0015);
    assert_eq!(suggested_voxel(&frames, 0.1, None), 0.0015);
}

#[test]
fn names_what_is_wrong() {
    let (frames, fine) = (frames(), DepthPointsSettings::default());
    let of = |voxel, settings| scan_cloud(&frames, voxel, &settings).unwrap_err();
    assert!(matches!(of(0.0, fine), FuseError::Settings(_)));
    assert!(matches!(
        of(0.002, DepthPointsSettings { stride: 0, ..fine }),
        FuseError::Points { index: 0, .. }
    ));
    let crop = Some(Aabb { min: [1.0; 3].into(), max: [2.0; 3].into() });
    assert!(matches!(of(0.002, DepthPointsSettings { crop, ..fine }), FuseError::Outside { .. }));
    assert_eq!(scan_cloud(&[], 0.002, &fine).unwrap_err(), FuseError::Empty);
}
