//! Elimination of the candidates that are closest to others.

use super::cells::{Cells, LANES};
use super::falling::{self, FallingQueue};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Unfinished};
use crate::sort::sort;

/// Yuksel's `beta`, which with `gamma` limits the weight of candidates that are very close (eq. 5).
const BETA: f32 = 0.65;
/// Yuksel's `gamma` (eq. 5).
const GAMMA: f32 = 1.5;

/// Bytes of working memory.
pub(super) const fn scratch_bytes(candidates: usize) -> usize {
    array_bytes::<f32>(candidates.saturating_add(LANES))
        .saturating_add(falling::scratch_bytes(candidates))
        .saturating_add(array_bytes::<u32>(candidates).saturating_mul(2))
}

/// Removes the candidate with the heaviest neighbours until `count` are left, and returns the indices of those in the order
/// in which they were drawn. `cells` are as wide as twice `r_max`.
pub(super) fn eliminate<'s>(
    cells: &Cells,
    count: usize,
    r_max: f32,
    mut scratch: Arena<'s>,
    meter: &Meter,
) -> Result<&'s [u32], Unfinished> {
    let total = cells.order.len();
    let kernel = Kernel::new(count as f32 / total.max(1) as f32, r_max);
    let weights = scratch.slice::<f32>(total + LANES)?;
    for place in 0..total {
        meter.check_at(place)?;
        let mut own = [0.0; LANES];
        cells.visit_behind(place, |others, squares| {
            if let Some(heavier) = kernel.weights(squares) {
                add(&mut weights[others..][..LANES], heavier);
                add(&mut own, heavier);
            }
        });
        weights[place] += own.iter().sum::<f32>();
    }
    let mut queue = FallingQueue::new(weights, total, &mut scratch)?;
    for step in count..total {
        meter.check_at(step)?;
        let Some(heaviest) = queue.pop() else { break };
        let weights = queue.weights();
        cells.visit_all(heaviest, |others, squares| {
            if let Some(lighter) = kernel.weights(squares) {
                add(&mut weights[others..][..LANES], lighter.map(|weight| -weight));
            }
        });
    }
    let kept = scratch.unset::<u32>(count)?;
    for (slot, place) in kept.iter_mut().zip(queue.into_items()) {
        *slot = cells.order[place];
    }
    // Unlike the order of the cells, this one does not change when the mesh is rotated.
    sort(kept, scratch.unset(count)?, meter, |a, b| a < b)?;
    Ok(kept)
}

fn add(weights: &mut [f32], changes: [f32; LANES]) {
    for (weight, change) in weights.iter_mut().zip(changes) {
        *weight += change;
    }
}

/// How much a candidate weighs on another.
struct Kernel {
    r_min: f32,
    r_max: f32,
}

impl Kernel {
    /// For keeping this fraction of the candidates.
    fn new(fraction: f32, r_max: f32) -> Self {
        Self { r_min: r_max * BETA * (1.0 - libm::powf(fraction, GAMMA)), r_max }
    }

    /// Weights at distances of these squares: eq. 4 and 6, with the exponent alpha = 8. Zero from twice `r_max` on; `None` if
    /// all are.
    fn weights(&self, squares: [f32; LANES]) -> Option<[f32; LANES]> {
        let (nearest, farthest) = (2.0 * self.r_min, 2.0 * self.r_max);
        let is_near = |square: &f32| *square < farthest * farthest;
        squares.iter().any(is_near).then(|| {
            squares.map(|square| {
                let distance = libm::sqrtf(square).max(nearest).min(farthest);
                let base = 1.0 - distance / farthest;
                let square = base * base;
                let fourth = square * square;
                fourth * fourth
            })
        })
    }
}
