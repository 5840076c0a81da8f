//! The point cloud of a supporter from depth images.

use hangpose::geometry::{Point, Vector};
use hangpose::perception::depth::DepthImage;
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Side of the voxels that keep one point each, m.
const VOXEL: f32 = 0.002;
/// Half the side of the square of pixels to which a plane is fitted: with 3 pixels, 5 mm at 0.5 m, so that wires of
/// that width keep their normals and noise of 0.5 mm turns a normal by about 2°.
const HALF_WINDOW: u32 = 3;
/// Distance up to which a pixel of the window belongs to the same surface, m.
const SAME_SURFACE: f32 = 0.006;
/// Smallest number of pixels that make a surface. A flying pixel has fewer near it and is dropped.
const MIN_SUPPORT: f32 = 6.0;

/// A cloud as a robot has it.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenCloud {
    /// Points in world coordinates, m.
    pub points: Vec<[f32; 3]>,
    /// Normals that face the cameras which saw the points; none with a single image, whose camera all normals face.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Positions of the cameras, m.
    pub viewpoints: Vec<[f32; 3]>,
}

/// The points of all images, one for each voxel of 2 mm: the mean of its pixels.
pub fn cloud(images: &[DepthImage]) -> SeenCloud {
    let mut voxels: BTreeMap<[i32; 3], (Vector, Vector, f32)> = BTreeMap::new();
    for image in images {
        let [width, height] = image.camera().size();
        for (u, v) in (0..height).flat_map(|v| (0..width).map(move |u| (u, v))) {
            let Some((point, normal)) = point_and_normal(image, u, v) else { continue };
            let (point, normal) = (image.pose() * point, image.pose() * normal);
            let voxel = (point / VOXEL).map(|x| x.floor() as i32);
            let (points, normals, count) = voxels.entry(voxel.coords.into()).or_default();
            *points += point.coords;
            *normals += normal;
            *count += 1.0;
        }
    }
    let (points, normals) = voxels
        .into_values()
        .map(|(point, normal, count)| (to_array(point / count), to_array(normal)))
        .unzip();
    let viewpoints = images.iter().map(|image| to_array(image.viewpoint().coords)).collect();
    SeenCloud { points, normals: (images.len() > 1).then_some(normals), viewpoints }
}

fn to_array(vector: Vector) -> [f32; 3] {
    vector.into()
}

/// The point of a pixel and the normal towards the camera of the plane through the pixels about it, in camera
/// coordinates; `None` if too few pixels are near it.
fn point_and_normal(image: &DepthImage, u: u32, v: u32) -> Option<(Point, Vector)> {
    let middle = image.point(u, v)?;
    let (mut sum, mut products, mut count) = (Vector::zeros(), Matrix3::zeros(), 0.0);
    for v in v.saturating_sub(HALF_WINDOW)..=v + HALF_WINDOW {
        for u in u.saturating_sub(HALF_WINDOW)..=u + HALF_WINDOW {
            let Some(offset) = image.point(u, v).map(|point| point - middle) else { continue };
            if offset.norm_squared() < SAME_SURFACE * SAME_SURFACE {
                sum += offset;
                products += offset * offset.transpose();
                count += 1.0;
            }
        }
    }
    if count < MIN_SUPPORT {
        return None;
    }
    let eigen = (products - sum * sum.transpose() / count).symmetric_eigen();
    let normal: Vector = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    Some((middle, if normal.dot(&middle.coords) > 0.0 { -normal } else { normal }))
}
