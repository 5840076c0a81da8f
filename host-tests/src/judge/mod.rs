//! What becomes of an object that is let go at a predicted pose: a verdict, from either of two physics engines.
//!
//! [`Bullet`] drops convex parts onto convex parts. [`Ode`] drops the object's triangles onto the supporter. So the two
//! share neither an engine nor an approximation of the shapes, and where they agree it is not for a common fault. Meshes of
//! unknown make are shells, whose overlap at the release is measured on the meshes themselves.

mod bullet;
mod buried;
mod mass;
mod ode;
mod overlap;
mod verdict;
mod world;

pub use bullet::Bullet;
pub use mass::Mass;
pub use ode::Ode;
pub(crate) use overlap::Overlap;
pub use verdict::{Figures, Limits, Verdict};
pub use world::{State, World};

use crate::solid::Solid;
use nalgebra::Isometry3;

/// Of the object against the supporter.
pub const FRICTION: f64 = 0.4;
/// Per second. Rigid bodies that roll on each other swing for ever; things swing out, because they rub, give and stir
/// the air. Falling is not slowed.
pub const DAMPING: f64 = 1.0;
/// Metres per second squared, along -z of the supporter.
pub const GRAVITY: f64 = 9.81;

/// An object, a supporter that does not move, and what the object weighs.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// What is to hang.
    pub object: &'a Solid,
    /// What it hangs on.
    pub supporter: &'a Solid,
    /// How the object's mass is spread.
    pub mass: Mass,
    /// The coefficient of friction: [`FRICTION`] unless changed.
    pub friction: f64,
    /// The rate at which rotation dies down, per second: [`DAMPING`] unless changed.
    pub damping: f64,
    /// Whether to tilt gravity too, which takes most of the time. Nothing is robust if not.
    pub tilt: bool,
}

impl<'a> Scene<'a> {
    /// An object of 200 g, of one density throughout.
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

/// Whoever drops an object and watches.
pub trait Judge: Sync {
    /// For tables.
    fn name(&self) -> &'static str;

    /// The scene as the engine sees it, for a closer look than a verdict gives.
    fn world(&self, scene: &Scene) -> World;

    /// What becomes of the object when it is let go at `release`, which maps object to supporter coordinates.
    fn judge(&self, scene: &Scene, release: &Isometry3<f32>) -> Verdict {
        self.world(scene).judge(scene, release)
    }
}
