//! What a method's search knows of the object and the supporter, beside the places on them.

use super::request::Request;
use crate::geometry::{Point, Surface, Symmetry};
use crate::mechanics::{Body, Support};
use crate::params::Params;

/// An object and a supporter in their frames, and the constants of the search.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    /// Surface of the object.
    pub(super) surface: &'a Surface<'a>,
    /// Of the object, metres.
    pub(super) centre_of_mass: Point,
    /// The object as mechanics sees it; `None` if it was analysed without voxels.
    pub(super) body: Option<&'a Body<'a>>,
    /// The supporter as mechanics sees it, with its points.
    pub(super) support: &'a Support<'a>,
    /// Turns of the object that make no other pose, about axes in the caller's object coordinates.
    pub(super) symmetries: &'a [Symmetry],
    /// In the caller's coordinates.
    pub(super) request: &'a Request<'a>,
    pub(super) params: &'a Params,
}
