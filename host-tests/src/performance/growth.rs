//! How time and memory grow with the sizes of the inputs.

use super::refine::{Triangles, refine, weld};
use super::room::{room, scatter};
use super::stages::{Figures, measure};
use crate::shapes::{OBJECTS, SUPPORTERS};
use crate::solid::Solid;
use anyhow::{Context, Result};
use hangpose::Params;
use hangpose::files::{read_cloud, read_mesh};
use hangpose::geometry::{Cloud, Mesh};
use serde::Serialize;
use std::path::Path;

/// Sizes that are measured, from one thousand to one million.
pub const SIZES: [usize; 8] = [1_000, 3_000, 10_000, 30_000, 100_000, 200_000, 300_000, 1_000_000];
/// Points of the sample hook in the room, and points of a supporter beside meshes of growing size.
const POINTS: usize = 10_000;

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

/// Measures all sizes up to `largest`: a ring as a mesh of that many triangles, a peg as a cloud of that many points,
/// and the sample mug on the sample hook with a room of that many points around. Calls `keep` with each row.
pub fn measure_growth(
    samples: &Path,
    largest: usize,
    runs: usize,
    mut keep: impl FnMut(Row) -> Result<()>,
) -> Result<()> {
    let ring = solid(OBJECTS.iter().find(|kind| kind.name == "ring").map(|kind| kind.make(1).solid))?;
    let peg = solid(SUPPORTERS.iter().find(|kind| kind.name == "peg").map(|kind| kind.make(1).solid))?;
    let sizes = || SIZES.into_iter().filter(|size| *size <= largest);
    let mut each = |axis, size, mesh: &Mesh, cloud: &Cloud| -> Result<()> {
        for (profile, params) in [("paper", Params::paper()), ("default", Params::default())] {
            let figures = measure(mesh, cloud, &params, runs)?;
            keep(Row { axis, profile, size, figures })?;
        }
        Ok(())
    };
    let (points, normals) = scatter(&peg.vertices, &peg.triangles, POINTS);
    let cloud = Cloud::new(&points, Some(&normals))?;
    let mut finer: Triangles = weld(&ring.vertices, &ring.triangles);
    for size in sizes().filter(|size| *size >= ring.triangles.len()) {
        finer = refine(finer, size);
        each("triangles", size, &Mesh::new(&finer.0, &finer.1)?, &cloud)?;
    }
    let (vertices, triangles) = refine(weld(&ring.vertices, &ring.triangles), POINTS);
    let mesh = Mesh::new(&vertices, &triangles)?;
    for size in sizes() {
        let (points, normals) = scatter(&peg.vertices, &peg.triangles, size);
        each("points", size, &mesh, &Cloud::new(&points, Some(&normals))?)?;
    }
    let (mug, hook) = (read_mesh(&samples.join("mug.obj"))?, read_cloud(&samples.join("hook.ply"))?);
    for size in sizes() {
        let points = [hook.points.as_slice(), &room(size)].concat();
        each("room", size, &mug.mesh()?, &Cloud::new(&points, None)?)?;
    }
    Ok(())
}

fn solid(found: Option<Solid>) -> Result<Solid> {
    found.context("this kind of shape is no longer generated")
}
