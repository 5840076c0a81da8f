//! Pairs of real meshes, from a folder with a `manifest.json`.

use super::case::{Case, Fit, POINTS};
use crate::solid::Solid;
use anyhow::{Context, Result};
use hangpose::files::read_mesh;
use serde::Deserialize;
use std::path::Path;
use std::sync::Arc;

/// The fields of an entry of the manifest that the tables need.
#[derive(Deserialize)]
struct Entry {
    file: String,
    name: String,
    category: String,
    hangable: String,
    scale_to_m: f32,
    up_axis: String,
}

/// A mesh converted to a shell.
struct Loaded {
    name: String,
    category: String,
    solid: Arc<Solid>,
}

/// Pairs of every object with every supporter: at most `pairs` that may hang, spread evenly over the list, and at most
/// half as many that cannot.
pub fn real(folder: &Path, pairs: usize) -> Result<Vec<Case>> {
    let path = folder.join("manifest.json");
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let entries: Vec<Entry> = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    let of = |start: &str| entries.iter().filter(|e| e.file.starts_with(start)).collect::<Vec<_>>();
    let load = |entries: Vec<&Entry>| -> Result<Vec<Loaded>> {
        let mut solids = Vec::new();
        for entry in entries {
            solids.push(solid(folder, entry)?);
        }
        Ok(solids)
    };
    let supporters = load(of("supporters/"))?;
    let mut cases = Vec::new();
    for (group, hangable, fit) in [("objects/", "yes", Fit::Unknown), ("unhangable/", "no", Fit::No)] {
        let objects = load(of(group).into_iter().filter(|e| e.hangable == hangable).collect())?;
        let all: Vec<_> =
            objects.iter().flat_map(|object| supporters.iter().map(move |s| (object, s))).collect();
        let count = if fit == Fit::No { pairs / 2 } else { pairs }.min(all.len());
        cases.extend((0..count).map(|k| {
            let (object, supporter) = all[k * all.len() / count];
            Case {
                name: format!("{}-{}", object.name, supporter.name),
                seed: k as u64,
                object_kind: object.category.clone(),
                supporter_kind: supporter.name.clone(),
                fit,
                meant: None,
                object: object.solid.clone(),
                supporter: supporter.solid.clone(),
                points: POINTS,
                openings: Vec::new(),
                bars: Vec::new(),
            }
        }));
    }
    Ok(cases)
}

/// Reads a mesh, converts it to metres with z up, and makes its shell.
fn solid(folder: &Path, entry: &Entry) -> Result<Loaded> {
    let mesh = read_mesh(&folder.join(&entry.file))?;
    let turn = |[x, y, z]: [f32; 3]| match entry.up_axis.as_str() {
        "+y" => [x, -z, y],
        "-y" => [x, z, -y],
        "+x" => [-z, y, x],
        "-x" => [z, y, -x],
        "-z" => [x, -y, -z],
        _ => [x, y, z],
    };
    let vertices = mesh.vertices.iter().map(|v| turn(v.map(|x| x * entry.scale_to_m))).collect();
    let solid = Solid::shell(vertices, mesh.triangles).into();
    Ok(Loaded { name: entry.name.clone(), category: entry.category.clone(), solid })
}
