//! What is asked for, from keyword arguments.

use crate::errors;
use crate::models::NativeObject;
use hangpose::geometry::Pose;
use hangpose::hanging::{Approach, Distance, Hung, Region, Request};
use hangpose::mechanics::{Kind, Kinds};
use nalgebra::{Quaternion, UnitQuaternion};
use pyo3::prelude::*;
use serde::Deserialize;

/// A pose as position and unit quaternion, x, y, z, w.
#[derive(Clone, Copy, Deserialize)]
pub(crate) struct Placed {
    position: [f32; 3],
    quaternion: [f32; 4],
}

impl From<&Placed> for Pose {
    fn from(placed: &Placed) -> Self {
        // As it is: a quaternion that was read from a pose is of unit length to its last bit.
        let rotation = UnitQuaternion::new_unchecked(Quaternion::from(placed.quaternion));
        Self::from_parts(placed.position.into(), rotation)
    }
}

/// The keyword arguments, in the order of the documentation of `hangpose.predict`.
#[derive(Deserialize)]
pub(crate) struct Wishes {
    allow: Option<Vec<Kind>>,
    prefer: Option<Vec<Kind>>,
    here: Option<Vec<[f32; 3]>>,
    here_radius: f32,
    by: Option<Vec<[f32; 3]>>,
    by_radius: f32,
    by_box: Option<[[f32; 3]; 2]>,
    approach: Option<[f32; 3]>,
    approach_angle: f32,
    approach_length: f32,
    hung: Vec<Placed>,
    distinct: Option<(f32, f32)>,
}

impl Wishes {
    /// Calls `work` with the request. `hung` are the objects that hang already, `scene` the points of what stands around.
    pub(crate) fn with<T>(
        &self,
        py: Python<'_>,
        hung: &[PyRef<'_, NativeObject>],
        scene: &[[f32; 3]],
        work: impl FnOnce(&Request) -> PyResult<T>,
    ) -> PyResult<T> {
        let hung: Vec<Hung> = hung
            .iter()
            .zip(&self.hung)
            .map(|(object, pose)| Hung { object: object.object(), pose: pose.into() })
            .collect();
        let any = Request::ANY;
        let kinds = |kinds: &Option<Vec<Kind>>, default| kinds.as_deref().map_or(default, Kinds::of);
        let request = Request {
            allow: kinds(&self.allow, any.allow),
            prefer: kinds(&self.prefer, any.prefer),
            on: near(&self.here, self.here_radius),
            by: match self.by_box {
                Some([low, high]) => Region::Box { low, high },
                None => near(&self.by, self.by_radius),
            },
            approach: self.approach.map(|direction| Approach {
                direction,
                angle: self.approach_angle,
                length: self.approach_length,
            }),
            scene,
            hung: &hung,
            distinct: self
                .distinct
                .map_or(any.distinct, |(position, rotation)| Distance { position, rotation }),
            ..any
        };
        request.validate().map_err(|error| errors::request(py, &error))?;
        work(&request)
    }
}

/// The region around points.
fn near(points: &Option<Vec<[f32; 3]>>, radius: f32) -> Region<'_> {
    match points {
        Some(points) => Region::Points { points, indices: None, radius },
        None => Region::Everywhere,
    }
}
