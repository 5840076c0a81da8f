//! The neighbourhood of a pixel: its normal, and whether it lies on a surface at all.

use super::DepthPointsSettings;
use crate::geometry::Vector;
use crate::perception::depth::DepthImage;

/// Pixels to each side of the middle. Five by five even out the noise of a camera and still fit on a bar that is a few
/// pixels wide.
const RADIUS: i32 = 2;
/// Least number of pixels that a normal is fitted to: the corner of a box shows nine of them.
const LEAST: usize = 8;
/// Depth difference that the noise of two pixels can make, standard deviations of that of one.
const JUMP: f32 = 4.0;

pub(super) struct Window<'a> {
    image: &'a DepthImage<'a>,
    centre: [u32; 2],
    /// Depth of the centre, metres.
    depth: f32,
    /// Depth difference that the noise can make, metres.
    noise: f32,
    /// Depth difference from one pixel to the next on the flattest surface that is kept, metres.
    slope: f32,
}

impl<'a> Window<'a> {
    /// The neighbourhood of a pixel of this depth, metres.
    pub(super) fn new(
        image: &'a DepthImage<'a>,
        settings: &DepthPointsSettings,
        centre: [u32; 2],
        depth: f32,
    ) -> Self {
        let cosine = settings.least_cosine;
        let tangent = libm::sqrtf(1.0 - cosine * cosine) / cosine;
        let [x, y] = image.camera().focal();
        let noise = JUMP * (settings.noise * depth * depth + image.scale());
        Self { image, centre, depth, noise, slope: tangent * depth / x.min(y) }
    }

    /// The unit normal in camera coordinates that faces the camera, of a plane through the pixels on the same surface;
    /// `None` if they are too few or in a line.
    ///
    /// On a plane, one over the depth is a linear function of the directions x and y at a depth of one, and its
    /// coefficients are the normal, up to scale. So the fit needs no eigenvectors.
    pub(super) fn normal(&self) -> Option<Vector> {
        let at = |[u, v]: [u32; 2]| self.image.camera().direction([u as f32, v as f32]);
        let middle = at(self.centre);
        let (mut count, mut sums, mut squares, mut products) = (0, [0.0; 3], [0.0; 3], [0.0; 2]);
        for down in -RADIUS..=RADIUS {
            for across in -RADIUS..=RADIUS {
                let Some((pixel, depth)) = self.neighbour(across, down) else { continue };
                if (depth - self.depth).abs() > self.jump(across.abs().max(down.abs())) {
                    continue;
                }
                let direction = at(pixel);
                let (x, y) = (direction[0] - middle[0], direction[1] - middle[1]);
                // Relative to the centre, so that the differences keep their precision.
                let inverse = (self.depth - depth) / depth;
                count += 1;
                sums = [sums[0] + x, sums[1] + y, sums[2] + inverse];
                squares = [squares[0] + x * x, squares[1] + x * y, squares[2] + y * y];
                products = [products[0] + x * inverse, products[1] + y * inverse];
            }
        }
        if count < LEAST {
            return None;
        }
        let scale = 1.0 / count as f32;
        let [xx, xy, yy] =
            [(0, 0, 0), (0, 1, 1), (1, 1, 2)].map(|(i, j, k)| squares[k] - sums[i] * sums[j] * scale);
        let [xz, yz] = [0, 1].map(|i| products[i] - sums[i] * sums[2] * scale);
        let determinant = xx * yy - xy * xy;
        // In a line, the sine of the angle between the two spreads vanishes.
        if determinant <= 1e-3 * xx * yy {
            return None;
        }
        let (a, b) = ((xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant);
        // One over the depth at the centre, in units of one over its own, as the fit sees it.
        let c = 1.0 + (sums[2] - a * sums[0] - b * sums[1]) * scale - a * middle[0] - b * middle[1];
        let normal = -Vector::new(a, b, c);
        let length = normal.norm();
        (length > 0.0 && length.is_finite()).then(|| normal / length)
    }

    /// Whether the depth jumps on both sides of the pixel, in any direction.
    pub(super) fn is_flying(&self) -> bool {
        [(1, 0), (0, 1), (1, 1), (1, -1)].into_iter().any(|(across, down)| {
            [1, -1].into_iter().all(|side| {
                self.neighbour(side * across, side * down)
                    .is_some_and(|(_, depth)| (depth - self.depth).abs() > self.jump(1))
            })
        })
    }

    /// A pixel of the window and its depth, metres.
    fn neighbour(&self, across: i32, down: i32) -> Option<([u32; 2], f32)> {
        let pixel = [self.centre[0].checked_add_signed(across)?, self.centre[1].checked_add_signed(down)?];
        Some((pixel, self.image.depth(pixel[0], pixel[1])?))
    }

    /// The difference in depth, metres, above which a pixel so many steps away is on another surface.
    fn jump(&self, steps: i32) -> f32 {
        self.noise + self.slope * steps as f32
    }
}
