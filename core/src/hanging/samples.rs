//! What a method sees of an object and of a supporter when it looks for places.

use crate::geometry::{Point, PointTree, Surface, Vector};
use crate::params::Params;

/// Samples of an object's surface, from which a method finds places.
pub(super) struct ObjectSamples<'a> {
    pub(super) surface: &'a Surface<'a>,
    /// On the surface, metres.
    pub(super) points: &'a [Point],
    /// Unit vectors out of the solid, one a point.
    pub(super) normals: &'a [Vector],
    pub(super) centre_of_mass: Point,
    pub(super) params: &'a Params,
}

/// The points of a supporter, on which a method finds places.
pub(super) struct SupporterCloud<'a> {
    pub(super) tree: &'a PointTree<'a>,
    /// Unit vectors out of the solid, in tree order.
    pub(super) normals: &'a [Vector],
    /// 1 for points on which nothing shall hang: those on walls and tables, and those that the caller excludes. In tree
    /// order.
    pub(super) is_excluded: &'a [u8],
    pub(super) params: &'a Params,
}
