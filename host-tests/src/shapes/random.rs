//! A seeded random number generator with the same numbers on every machine.

use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::TAU;

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
pub struct Random(u64);

impl Random {
    /// A generator with this seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A generator with this seed and name, so that different things of one seed differ.
    pub fn named(name: &str, seed: u64) -> Self {
        // FNV-1a.
        let hash = (name.bytes()).fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        Self(Self(hash ^ seed).next_u64())
    }

    /// 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in 0..count.
    pub fn pick(&mut self, count: usize) -> usize {
        (self.next_u64() % count as u64) as usize
    }

    /// Normally distributed with mean 0 and standard deviation 1 (Box and Muller 1958).
    pub fn gaussian(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.range(0.0, 1.0))).sqrt();
        radius * libm::cos(self.range(0.0, TAU))
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.range(0.0, 1.0) < probability
    }

    /// Uniform over all rotations (Shoemake, "Uniform random rotations", 1992).
    pub fn rotation(&mut self) -> UnitQuaternion<f32> {
        let [share, a, b] = [1.0, TAU, TAU].map(|high| self.range(0.0, high));
        let (low, high) = ((1.0 - share).sqrt(), share.sqrt());
        let parts = [low * libm::sin(a), low * libm::cos(a), high * libm::sin(b), high * libm::cos(b)];
        UnitQuaternion::from_quaternion(Quaternion::from(parts.map(|x| x as f32)))
    }
}
