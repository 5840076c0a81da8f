//! Verdicts on predicted poses by either of two physics engines, which simulate the release of the object.
//!
//! [`Bullet`] collides convex parts with convex parts. [`Ode`] collides the object's triangles with the supporter. The
//! two share neither an engine nor an approximation of the shapes, so that their agreement has no common cause of
//! error. Arbitrary meshes are represented by shells; their penetration at release is measured on the meshes
//! themselves.

mod bullet;
mod buried;
mod freedom;
mod mass;
mod ode;
mod overlap;
pub mod replay;
mod verdict;
mod world;

pub use bullet::Bullet;
pub use freedom::freedom;
pub use mass::Mass;
pub use ode::Ode;
pub(crate) use overlap::Overlap;
pub use verdict::{Figures, Limits, Verdict};
pub use world::{State, World};

use crate::solid::Solid;
use nalgebra::Isometry3;

/// Coefficient of friction between object and supporter.
pub const FRICTION: f64 = 0.4;
/// Damping rate of rotation, 1/s. Rigid bodies that roll on each other swing forever; real objects lose energy to
/// friction, deformation and air. Translation is not damped.
pub const DAMPING: f64 = 1.0;
/// Gravitational acceleration along -z of the supporter, m/s².
pub const GRAVITY: f64 = 9.81;

/// An object, its mass properties, and a fixed supporter.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// The object to hang.
    pub object: &'a Solid,
    /// The supporter.
    pub supporter: &'a Solid,
    /// Mass properties of the object.
    pub mass: Mass,
    /// Coefficient of friction; the default is [`FRICTION`].
    pub friction: f64,
    /// Damping rate of rotation, 1/s; the default is [`DAMPING`].
    pub damping: f64,
    /// Whether to test under tilted gravity, which takes most of the time. Without it no verdict is robust.
    pub tilt: bool,
}

impl<'a> Scene<'a> {
    /// An object of 200 g and uniform density.
    pub fn new(object: &'a Solid, supporter: &'a Solid) -> Self {
        Self {
            object,
            supporter,
            mass: Mass::of(object, 0.2),
            friction: FRICTION,
            damping: DAMPING,
            tilt: true,
        }
    }

    /// The object's centre of mass, in its own coordinates.
    pub fn centre_of_mass(&self) -> [f32; 3] {
        self.mass.frame.translation.vector.cast().into()
    }
}

/// A physics engine that judges poses.
pub trait Judge: Sync {
    /// Name of the engine, for tables.
    fn name(&self) -> &'static str;

    /// The scene in the engine, for more detail than a verdict gives.
    fn world(&self, scene: &Scene) -> World;

    /// Verdict on the release of the object at `release`, which maps object to supporter coordinates.
    fn judge(&self, scene: &Scene, release: &Isometry3<f32>) -> Verdict {
        self.world(scene).judge(scene, release)
    }
}
