//! Which blocks a triangle, thickened, passes through.

use super::brick::BLOCK;
use crate::geometry::Vector;

/// Half the edge of a block, in voxels.
const HALF: f32 = BLOCK as f32 / 2.0;

/// One of the axes that may part a block from a triangle: normal to an edge in one of the planes of two coordinates.
#[derive(Clone, Copy, Default)]
struct Side {
    u: f32,
    v: f32,
    /// Blocks whose centre is further along (u, v) are apart.
    limit: f32,
}

impl Side {
    fn admits(&self, u: f32, v: f32) -> bool {
        self.u * u + self.v * v <= self.limit
    }
}

/// Visits the blocks, of `blocks` along each axis, that come closer to the triangle than `reach`, and a few more at its
/// corners; all in voxels.
///
/// By the separating axes of a box and a triangle, each moved out by `reach`, a column of blocks at a time: so a large
/// triangle costs its area and not its box.
pub(super) fn visit_blocks(
    corners: &[Vector; 3],
    reach: f32,
    blocks: &[u32; 3],
    mut visit: impl FnMut([u32; 3]),
) {
    let [a, b, c] = corners;
    let (min, max) = (a.inf(b).inf(c), a.sup(b).sup(c));
    let last = blocks.map(|count| count - 1);
    let below = |x: f32, axis: usize| (x.max(0.0) as u32 / BLOCK).min(last[axis]);
    let low = [0, 1, 2].map(|axis| below(min[axis] - reach, axis));
    let high = [0, 1, 2].map(|axis| below(max[axis] + reach, axis));
    if low == high {
        return visit(low);
    }
    let edges = [b - a, c - b, a - c];
    let normal = edges[0].cross(&edges[1]);
    let k = normal.iamax();
    let axes = [k, (k + 1) % 3, (k + 2) % 3];
    // In the plane across each axis, the sides of the triangle seen from where it turns anticlockwise.
    let sides = axes.map(|axis| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let turn = if normal[axis] < 0.0 { -1.0 } else { 1.0 };
        let edge_on = normal[axis] == 0.0;
        [0, 1, 2].map(|i| {
            let (edge, from) = (edges[i], corners[i]);
            let (x, y) = (edge[v] * turn, -edge[u] * turn);
            let radius = HALF * (x.abs() + y.abs()) + reach * libm::sqrtf(x * x + y * y);
            let limit = if edge_on { f32::INFINITY } else { x * from[u] + y * from[v] + radius };
            Side { u: x, v: y, limit }
        })
    });
    let [_, u, v] = axes;
    let radius = HALF * (normal.x.abs() + normal.y.abs() + normal.z.abs()) + reach * normal.norm();
    let (offset, inverse) = (normal.dot(a), 1.0 / normal[k]);
    let half_range = radius * inverse.abs();
    let centre = |i: u32| i as f32 * BLOCK as f32 + HALF;
    for iv in low[v]..=high[v] {
        for iu in low[u]..=high[u] {
            let (cu, cv) = (centre(iu), centre(iv));
            if !sides[0].iter().all(|side| side.admits(cu, cv)) {
                continue;
            }
            // Where the plane runs through the column.
            let middle = (offset - normal[u] * cu - normal[v] * cv) * inverse;
            let first = (middle - half_range - HALF) / BLOCK as f32;
            let end = (middle + half_range - HALF) / BLOCK as f32;
            if end < 0.0 {
                continue;
            }
            let first = (libm::ceilf(first).max(0.0) as u32).max(low[k]);
            for ik in first..=(end as u32).min(high[k]) {
                let ck = centre(ik);
                // Across u the plane is that of v and k, across v that of k and u.
                if sides[1].iter().all(|side| side.admits(cv, ck))
                    && sides[2].iter().all(|side| side.admits(ck, cu))
                {
                    let mut block = [0; 3];
                    (block[k], block[u], block[v]) = (ik, iu, iv);
                    visit(block);
                }
            }
        }
    }
}
