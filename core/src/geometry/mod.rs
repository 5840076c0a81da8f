//! Shapes and queries on them. Nothing here knows about hanging.
//!
//! Each folder uses only the ones above it:
//!
//! - `vector.rs`: points, vectors and poses;
//! - `shapes/`: what a caller hands in, meshes and clouds, and what follows from it alone: bounding box, area, mass properties;
//! - `queries/`: trees over triangles and points, for rays, closest points, winding numbers and neighbours; the exit from a convex hull;
//! - `distance_field/`: the signed distance of a surface, tabulated on a sparse grid;
//! - `statistics/`: clusters, principal directions and frames of points;
//! - `symmetry/`: turns after which an object looks as before.

mod distance_field;
mod queries;
mod shapes;
mod statistics;
mod symmetry;
mod vector;

pub use distance_field::DistanceField;
pub(crate) use queries::{Nearest, Node, PointTreeSlots};
pub use queries::{Neighbour, PointTree, Surface, hull};
pub use shapes::{Aabb, Cloud, CloudError, MAX_COUNT, MassProperties, Mesh, MeshError};
pub(crate) use shapes::{
    Viewpoints, ball_on, closest_point_on_triangle, halves, longest_side_first, scaled_normal,
};
pub(crate) use statistics::{
    eigenvectors, least_eigenvector, linked_cluster, mean_shift, principal_direction, principal_frame,
    upright_frame,
};
pub use symmetry::{MAX_FOLD, Symmetry};
pub(crate) use symmetry::{Symmetries, least_angle};
pub use vector::{MAX_COORDINATE, Point, Pose, Vector};
pub(crate) use vector::{
    any_perpendicular, fibonacci_direction, is_rigid, rotate_about, rotation_by, unit_or,
};
