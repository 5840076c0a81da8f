//! Bullet: convex parts against convex parts, in single precision.

use super::world::{BULLET, World};
use super::{Judge, Scene};

/// Judges with Bullet.
#[derive(Clone, Copy, Debug)]
pub struct Bullet {
    /// Time step, s.
    pub time_step: f64,
}

impl Default for Bullet {
    fn default() -> Self {
        Self { time_step: 1.0 / 1920.0 }
    }
}

impl Judge for Bullet {
    fn name(&self) -> &'static str {
        "Bullet"
    }

    fn world(&self, scene: &Scene) -> World {
        let mut world = World::new(BULLET, scene, self.time_step);
        for part in &scene.supporter.parts {
            world.add_part(part, None);
        }
        let into_body = scene.mass.frame.inverse();
        for part in &scene.object.parts {
            world.add_part(part, Some(&into_body));
        }
        world
    }
}
