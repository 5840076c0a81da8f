//! ODE: the object's triangles against the supporter's capsules, boxes and triangles, in double precision.

use super::world::{ODE, World};
use super::{Judge, Scene};
use crate::solid::Part;

/// Judges with ODE.
#[derive(Clone, Copy, Debug)]
pub struct Ode {
    /// Time step, s.
    pub time_step: f64,
}

impl Default for Ode {
    fn default() -> Self {
        Self { time_step: 1.0 / 960.0 }
    }
}

impl Judge for Ode {
    fn name(&self) -> &'static str {
        "ODE"
    }

    fn world(&self, scene: &Scene) -> World {
        let mut world = World::new(ODE, scene, self.time_step);
        world.add_mesh(scene.object, Some(&scene.mass.frame.inverse()));
        // The shim takes no hulls. If any part is one, the triangles of the surface replace all parts.
        if scene.supporter.parts.iter().any(|part| matches!(part, Part::Hull(_))) {
            world.add_mesh(scene.supporter, None);
        } else {
            for part in &scene.supporter.parts {
                world.add_part(part, None);
            }
        }
        world.look_inside(scene);
        world
    }
}
