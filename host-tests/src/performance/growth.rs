//! How time and memory grow with the sizes of the inputs.

use super::refine::{Triangles, refine, weld};
use super::room::{room, scatter};
use super::stages::{Figures, measure};
use crate::tables::case::made;
use anyhow::{Context, Result};
use hangpose::Params;
use hangpose::files::{read_cloud, read_mesh};
use hangpose::geometry::{Cloud, Mesh};
use serde::Serialize;
use std::collections::HashMap;
use std::path::Path;

/// Sizes that are measured, from one thousand to one million.
pub const SIZES: [usize; 8] = [1_000, 3_000, 10_000, 30_000, 100_000, 200_000, 300_000, 1_000_000];
/// Points of the sample hook in the room, and points of a supporter beside meshes of growing size.
const POINTS: usize = 10_000;

/// Kind of the generated object, which is the first of that kind among pairs of this number and seed.
const OBJECT: &str = "mug";
const PAIRS: usize = 22;
const SEED: u64 = 61;

/// Time of a prediction, ms, after which no larger sizes are measured. After a tenth of it each is measured once.
const TOO_LONG: f64 = 6_000.0;

/// Figures at one size.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What grows: triangles, points or room.
    pub axis: &'static str,
    /// Parameters.
    pub profile: &'static str,
    /// Size asked for; a mesh may be a little larger.
    pub size: usize,
    /// Time, memory and work.
    #[serde(flatten)]
    pub figures: Figures,
}

/// Measures all sizes up to `largest`: a generated pair with the object as a mesh of that many triangles, and with the supporter
/// as a cloud of that many points; and the sample mug on the sample hook with a room of that many points around. Calls `keep`
/// with each row.
pub fn measure_growth(
    samples: &Path,
    largest: usize,
    runs: usize,
    mut keep: impl FnMut(Row) -> Result<()>,
) -> Result<()> {
    let case = made(PAIRS, SEED).into_iter().find(|case| case.object_kind == OBJECT);
    let case = case.context("no such pair is generated")?;
    let (object, supporter) = (&case.object, &case.supporter);
    let sizes = || SIZES.into_iter().filter(|size| *size <= largest);
    // The time of the last size, by what grows and profile.
    let mut last: HashMap<(&str, &str), f64> = HashMap::new();
    let mut each = |axis, size, mesh: &Mesh, cloud: &Cloud| -> Result<()> {
        for (profile, params) in [("paper", Params::paper()), ("default", Params::default())] {
            let before = last.entry((axis, profile)).or_default();
            if *before > TOO_LONG {
                continue;
            }
            let runs = if *before > TOO_LONG / 10.0 { 1 } else { runs };
            let figures = measure(mesh, cloud, &params, runs)?;
            *before = figures.total();
            keep(Row { axis, profile, size, figures })?;
        }
        Ok(())
    };
    let (points, normals) = scatter(&supporter.vertices, &supporter.triangles, POINTS);
    let cloud = Cloud::new(&points, Some(&normals))?;
    let mut finer: Triangles = weld(&object.vertices, &object.triangles);
    for size in sizes().filter(|size| *size >= object.triangles.len()) {
        finer = refine(finer, size);
        each("triangles", size, &Mesh::new(&finer.0, &finer.1)?, &cloud)?;
    }
    let (vertices, triangles) = refine(weld(&object.vertices, &object.triangles), POINTS);
    let mesh = Mesh::new(&vertices, &triangles)?;
    for size in sizes() {
        let (points, normals) = scatter(&supporter.vertices, &supporter.triangles, size);
        each("points", size, &mesh, &Cloud::new(&points, Some(&normals))?)?;
    }
    let (mug, hook) = (read_mesh(&samples.join("mug.obj"))?, read_cloud(&samples.join("hook.ply"))?);
    for size in sizes() {
        let points = [hook.points.as_slice(), &room(size)].concat();
        each("room", size, &mug.mesh()?, &Cloud::new(&points, None)?)?;
    }
    Ok(())
}
