//! Random points and directions.

#[path = "../random/mod.rs"]
mod generator;

pub(crate) use generator::Random;
use nalgebra::{Point3, Vector3};

impl Random {
    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [0, count).
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Uniform in the cube [-1, 1)³.
    pub(crate) fn in_cube(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| 2.0 * self.unit() - 1.0)
    }

    /// Uniform on the unit sphere.
    pub(crate) fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = self.in_cube();
            if (0.01..1.0).contains(&v.norm()) {
                return v.normalize();
            }
        }
    }

    /// Uniform on a triangle.
    pub(crate) fn on_triangle(&mut self, [a, b, c]: [Point3<f64>; 3]) -> Point3<f64> {
        let (s, t) = (self.unit().sqrt(), self.unit());
        a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t)
    }
}
