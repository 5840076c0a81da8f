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
    /// Sum of the weights of the observations; zero where nothing was seen, [`GUESS`](Self::GUESS) where the distance is a
    /// guess.
    pub(crate) weight: u16,
}

impl Voxel {
    /// Distance of a voxel at least the truncation away from the surface.
    pub(crate) const FREE: i16 = i16::MAX;

    /// Weight that marks a guess.
    const GUESS: u16 = u16::MAX;
    /// Greatest sum of weights.
    const MAX: u16 = Self::GUESS - 1;

    /// A guessed distance, truncations.
    pub(crate) fn guess(distance: f32) -> Self {
        let distance = distance.clamp(-1.0, 1.0) * f32::from(Self::FREE);
        // A guess inside stays inside, however close to the surface.
        Self { distance: libm::floorf(distance) as i16, weight: Self::GUESS }
    }

    /// Whether there is a distance, seen or guessed.
    #[inline]
    pub(crate) fn is_known(self) -> bool {
        self.weight > 0
    }

    #[inline]
    pub(crate) fn is_seen(self) -> bool {
        self.weight > 0 && self.weight != Self::GUESS
    }

    /// The distance in truncations.
    #[inline]
    pub(crate) fn part(self) -> f32 {
        f32::from(self.distance) / f32::from(Self::FREE)
    }

    /// Takes an observation into the weighted mean: `distance` in truncations, of the given weight. The sum of weights is
    /// bounded; then old observations fade.
    #[inline]
    pub(super) fn observe(&mut self, distance: f32, weight: f32) {
        let weight = (weight + 0.5) as u16;
        if self.weight == Self::GUESS {
            *self = Self::default();
        }
        if distance == 1.0 && self.distance == Self::FREE {
            self.weight = self.weight.saturating_add(weight).min(Self::MAX);
            return;
        }
        let old = self.weight.min(Self::MAX - weight);
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
        assert_eq!((voxel.distance, voxel.weight), (Voxel::FREE, Voxel::MAX));
        for _ in 0..100 {
            voxel.observe(-1.0, MAX_WEIGHT);
        }
        assert!(voxel.distance < -32000 && voxel.weight == Voxel::MAX);
    }

    #[test]
    fn an_observation_replaces_a_guess() {
        let mut voxel = Voxel::guess(-1e-9);
        assert!(voxel.is_known() && !voxel.is_seen() && voxel.distance < 0);
        voxel.observe(0.5, 100.0);
        assert!(voxel.is_seen() && (voxel.part() - 0.5).abs() < 1e-4 && voxel.weight == 100);
    }

    #[test]
    fn weight_falls_with_the_square_of_the_depth() {
        assert_eq!(
            [0.1_f32, 0.5, 1.0, 2.0, 100.0].map(|z| weight(1.0 / z)),
            [4096.0, 1024.0, 256.0, 64.0, 1.0]
        );
    }
}
