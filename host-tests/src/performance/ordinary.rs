//! The pair beside which calls are measured: a mug, and the supporter that it was made for.

use crate::performance::refine::{Triangles, refine, weld};
use crate::performance::room::scatter;
use crate::tables::case::{Case, made};

/// Kind of the object, and the generated pairs that it is the first of.
const OBJECT: &str = "mug";
const PAIRS: usize = 22;
const SEED: u64 = 61;

/// The pair.
///
/// # Panics
///
/// If no mug is among the pairs any more.
pub fn ordinary() -> Case {
    made(PAIRS, SEED).into_iter().find(|case| case.object_kind == OBJECT).expect("a mug is generated")
}

/// Its object in at least so many triangles.
pub fn object(case: &Case, triangles: usize) -> Triangles {
    refine(weld(&case.object.vertices, &case.object.triangles), triangles)
}

/// Points of its supporter, and their normals.
pub fn supporter(case: &Case, points: usize) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    scatter(&case.supporter.vertices, &case.supporter.triangles, points)
}
