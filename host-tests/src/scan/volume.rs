//! Fusion of several depth images: the mean signed distance to the surface on a dense grid (Curless and Levoy 1996).

use super::{Surface, tetrahedra};
use hangpose::geometry::{Point, Vector};
use hangpose::perception::depth::DepthImage;

/// Smallest distance between nodes, m.
const SPACING: f32 = 0.0015;
/// Largest number of nodes, 32 MB. The spacing of large objects grows to keep it.
const MAX_NODES: f32 = 8e6;
/// Distance from the surface up to which an image is used, in spacings.
const TRUNCATION: f32 = 4.0;
/// Sum of weights from which a node is known: that of one image which sees it in front of the surface.
const KNOWN: f32 = 1.0;

/// A grid of nodes with signed distances.
pub(super) struct Grid {
    pub(super) origin: Point,
    pub(super) spacing: f32,
    pub(super) size: [usize; 3],
    /// Signed distance at each node, m, positive outside; not a number where it is not known. The x index is the
    /// fastest.
    pub(super) distances: Vec<f32>,
}

/// The surface that the images agree on, open where it is not known.
pub(super) fn fused(images: &[DepthImage]) -> Surface {
    let Some(mut grid) = Grid::around(images) else { return Surface::default() };
    let [columns, rows, _] = grid.size;
    let truncation = TRUNCATION * grid.spacing;
    for (index, distance) in grid.distances.iter_mut().enumerate() {
        let at = [index % columns, index / columns % rows, index / columns / rows];
        let node = grid.origin + Vector::from(at.map(|k| k as f32)) * grid.spacing;
        let (mut sum, mut weights) = (0.0, 0.0);
        for image in images {
            let Some(measured) = distance_in(image, &node) else { continue };
            // Behind the surface the other side of a thin wall may be near, which this image does not see.
            let weight = (1.0 + measured.min(0.0) / truncation).max(0.0);
            sum += weight * measured.min(truncation);
            weights += weight;
        }
        *distance = if weights >= KNOWN { sum / weights } else { f32::NAN };
    }
    tetrahedra::surface(&grid)
}

/// How far a point is in front of the surface that an image shows, along the camera's axis, m; `None` if the image has
/// no depth there.
fn distance_in(image: &DepthImage, point: &Point) -> Option<f32> {
    let seen = image.pose().inverse_transform_point(point);
    let [u, v] = image.camera().project(seen.into())?.map(f32::round);
    if u < 0.0 || v < 0.0 {
        return None;
    }
    Some(image.depth(u as u32, v as u32)? - seen.z)
}

impl Grid {
    /// The grid over all points of the images; `None` without points.
    fn around(images: &[DepthImage]) -> Option<Self> {
        let points = images.iter().flat_map(|image| {
            let [width, height] = image.camera().size();
            let pixels = (0..height).flat_map(move |v| (0..width).map(move |u| (u, v)));
            pixels.filter_map(|(u, v)| Some(image.pose() * image.point(u, v)?))
        });
        let (low, high) = points.map(|point| (point, point)).reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))?;
        let extent = high - low;
        let volume = extent.map(|x| x.max(SPACING)).product();
        let spacing = SPACING.max((volume / MAX_NODES).cbrt());
        let origin = low - Vector::repeat(TRUNCATION * spacing);
        let size: [f32; 3] = (extent / spacing + Vector::repeat(2.0 * TRUNCATION)).map(f32::ceil).into();
        let size = size.map(|n| n as usize + 1);
        Some(Self { origin, spacing, size, distances: vec![f32::NAN; size.iter().product()] })
    }
}
