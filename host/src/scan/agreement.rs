//! Whether images agree with each other under their poses.

use hangpose_core::geometry::Pose;
use hangpose_core::perception::depth::DepthImage;

/// Pairs of consecutive images that are compared at most, spread over the scan.
const PAIRS: usize = 16;
/// Every so many pixels in both directions are compared.
const STRIDE: usize = 8;
/// Difference of depths that still agree: a constant part, metres, and a part of the depth. More than the noise of cameras.
const TOLERANCE: [f32; 2] = [0.01, 0.02];
/// Part of the points of an image that reappear in the next at the same depth, with poses changed by `change`; `None` for a
/// single image.
pub(super) fn of(images: &[DepthImage], change: impl Fn(&Pose) -> Pose) -> Option<f32> {
    let pairs = images.len().checked_sub(1).filter(|pairs| *pairs > 0)?;
    let (mut seen, mut agreeing) = (0, 0);
    for first in (0..pairs).step_by(pairs.div_ceil(PAIRS)) {
        let (from, to) = (&images[first], &images[first + 1]);
        let between = change(to.pose()).inverse() * change(from.pose());
        let [width, height] = from.camera().size();
        for v in (0..height).step_by(STRIDE) {
            for u in (0..width).step_by(STRIDE) {
                let Some(point) = from.point(u, v) else { continue };
                seen += 1;
                let point = between * point;
                let depth = to.camera().project(point.into()).and_then(|[x, y]| {
                    let is_inside = x >= -0.5 && y >= -0.5;
                    is_inside.then(|| to.depth((x + 0.5) as u32, (y + 0.5) as u32)).flatten()
                });
                let is_near = |depth: f32| (depth - point.z).abs() <= TOLERANCE[0] + TOLERANCE[1] * point.z;
                agreeing += usize::from(depth.is_some_and(is_near));
            }
        }
    }
    Some(agreeing as f32 / (seen as f32).max(1.0))
}
