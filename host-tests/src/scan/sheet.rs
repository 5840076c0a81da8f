//! The surface in a single depth image: neighbouring pixels joined by triangles.

use super::Surface;
use hangpose::geometry::Point;
use hangpose::perception::depth::DepthImage;

/// Side of the triangles, m.
const SIDE: f32 = 0.002;
/// Largest difference in depth between joined pixels, m. On a surface at 75° neighbours of 2 mm differ by 7.5 mm.
const JUMP: f32 = 0.008;

/// The surface seen in one image. The pixels are averaged in square blocks, one for each vertex.
pub(super) fn sheet(image: &DepthImage) -> Surface {
    let [width, height] = image.camera().size();
    let depths = (0..height).flat_map(|v| (0..width).filter_map(move |u| image.depth(u, v)));
    let (sum, count) = depths.fold((0.0, 0.0_f32), |(sum, count), depth| (sum + depth, count + 1.0));
    let block = (SIDE * image.camera().focal()[0] * count / sum).round().max(1.0) as u32;
    let [columns, rows] = [width / block, height / block];
    let nodes: Vec<Option<Point>> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| node(image, block, column * block, row * block)))
        .collect();
    let mut surface = Surface::default();
    let mut numbers = vec![u32::MAX; nodes.len()];
    for row in 1..rows {
        for column in 1..columns {
            let at = |c: u32, r: u32| (r * columns + c) as usize;
            let [a, b] = [at(column - 1, row - 1), at(column, row - 1)];
            let [c, d] = [at(column - 1, row), at(column, row)];
            // Seen from the camera, a is above c and to the left of b.
            for corners in [[a, c, b], [b, c, d]] {
                let Some(depths) = depths_of(corners, &nodes) else { continue };
                let nearest = depths.into_iter().fold(f32::INFINITY, f32::min);
                if depths.into_iter().any(|depth| depth - nearest > JUMP) {
                    continue;
                }
                surface.triangles.push(corners.map(|corner| {
                    if numbers[corner] == u32::MAX {
                        numbers[corner] = surface.vertices.len() as u32;
                        let point = nodes[corner].unwrap_or_default();
                        surface.vertices.push((image.pose() * point).into());
                    }
                    numbers[corner]
                }));
            }
        }
    }
    surface
}

fn depths_of(corners: [usize; 3], nodes: &[Option<Point>]) -> Option<[f32; 3]> {
    let [a, b, c] = corners.map(|corner| nodes[corner].map(|point| point.z));
    Some([a?, b?, c?])
}

/// The mean point, in camera coordinates, of the pixels of a block that are on the surface of its median.
fn node(image: &DepthImage, block: u32, u: u32, v: u32) -> Option<Point> {
    let pixels = (v..v + block).flat_map(|v| (u..u + block).map(move |u| (u, v)));
    let mut points: Vec<Point> = pixels.filter_map(|(u, v)| image.point(u, v)).collect();
    points.sort_by(|a, b| a.z.total_cmp(&b.z));
    let median = points.get(points.len() / 2)?.z;
    points.retain(|point| (point.z - median).abs() < JUMP / 2.0);
    let sum = points.iter().fold(nalgebra::Vector3::zeros(), |sum, point| sum + point.coords);
    Some((sum / points.len() as f32).into())
}
