//! What is known at one point of the grid.

use bytemuck::{Pod, Zeroable};

/// Weight of one observation from a metre away.
const WEIGHT_AT_METRE: f32 = 256.0;
/// Greatest weight of one observation, reached at a quarter of a metre. Nearer, the noise of a depth camera does not fall
/// any more.
const MAX_WEIGHT: f32 = 4096.0;

/// A truncated signed distance and how much it weighs.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Voxel {
    /// Positive in free space, in units of the truncation over [`FREE`](Self::FREE).
    pub(crate) distance: i16,
    /// Sum of the weights of the observations; zero where nothing was seen.
    pub(crate) weight: u16,
}

impl Voxel {
    /// Distance of a voxel at least the truncation away from the surface.
    pub(crate) const FREE: i16 = i16::MAX;

    #[inline]
    pub(crate) fn is_seen(self) -> bool {
        self.weight > 0
    }

    /// Takes an observation into the weighted mean: `distance` in truncations, of the given weight. The sum of weights is
    /// bounded; then old observations fade.
    #[inline]
    pub(super) fn observe(&mut self, distance: f32, weight: f32) {
        let weight = (weight + 0.5) as u16;
        if distance == 1.0 && self.distance == Self::FREE {
            self.weight = self.weight.saturating_add(weight);
            return;
        }
        let old = self.weight.min(u16::MAX - weight);
        let sum = old + weight;
        let mean = f32::from(self.distance);
        let distance = distance * f32::from(Self::FREE);
        let mean = mean + (distance - mean) * (f32::from(weight) / f32::from(sum));
        self.distance = (mean + f32::copysign(0.5, mean)) as i16;
        self.weight = sum;
    }
}

/// Weight of an observation at a depth of one over `inverse_depth`, metres. The noise of structured light and of stereo
/// grows with the square of the depth, so the weight falls with it.
#[inline]
pub(super) fn weight(inverse_depth: f32) -> f32 {
    (WEIGHT_AT_METRE * inverse_depth * inverse_depth).clamp(1.0, MAX_WEIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn holds_the_weighted_mean() {
        let mut random = Random::new(5);
        for _ in 0..100 {
            let mut voxel = Voxel::default();
            let (mut sum, mut weights) = (0.0, 0.0);
            for _ in 0..20 {
                let distance = 2.0 * random.next_f32() - 1.0;
                let weight = (1.0 + 2000.0 * random.next_f32()).trunc();
                voxel.observe(distance, weight);
                sum += f64::from(distance) * f64::from(weight);
                weights += f64::from(weight);
            }
            let mean = f64::from(voxel.distance) / f64::from(Voxel::FREE);
            assert!((mean - sum / weights).abs() < 5e-4 && f64::from(voxel.weight) == weights);
        }
    }

    #[test]
    fn the_sum_of_weights_saturates_and_stays_in_range() {
        let mut voxel = Voxel::default();
        for _ in 0..100 {
            voxel.observe(1.0, MAX_WEIGHT);
        }
        assert_eq!((voxel.distance, voxel.weight), (Voxel::FREE, u16::MAX));
        for _ in 0..100 {
            voxel.observe(-1.0, MAX_WEIGHT);
        }
        assert!(voxel.distance < -32000 && voxel.weight == u16::MAX);
    }

    #[test]
    fn weight_falls_with_the_square_of_the_depth() {
        assert_eq!(
            [0.1_f32, 0.5, 1.0, 2.0, 100.0].map(|z| weight(1.0 / z)),
            [4096.0, 1024.0, 256.0, 64.0, 1.0]
        );
    }
}
