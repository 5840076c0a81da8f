//! Pairs of real meshes, from a folder with a `manifest.json`.

use super::case::Case;
use crate::solid::Solid;
use anyhow::{Context, Result};
use hangpose::files::read_mesh;
use serde::Deserialize;
use std::path::Path;
use std::sync::Arc;

/// What the tables need of an entry of the manifest.
#[derive(Deserialize)]
struct Entry {
    file: String,
    name: String,
    category: String,
    hangable: String,
    scale_to_m: f32,
    up_axis: String,
}

/// Every object on every supporter, at most `pairs` that may hang, evenly over the list, and those that cannot.
pub fn real(folder: &Path, pairs: usize) -> Result<Vec<Case>> {
    let path = folder.join("manifest.json");
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let entries: Vec<Entry> = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    let of = |start: &str| entries.iter().filter(|e| e.file.starts_with(start)).collect::<Vec<_>>();
    let load = |entries: Vec<&Entry>| -> Result<Vec<(String, String, Arc<Solid>)>> {
        let mut solids = Vec::new();
        for entry in entries {
            solids.push((entry.name.clone(), entry.category.clone(), Arc::new(solid(folder, entry)?)));
        }
        Ok(solids)
    };
    let supporters = load(of("supporters/"))?;
    let mut cases = Vec::new();
    for (group, fits) in [("objects/", true), ("unhangable/", false)] {
        let chosen =
            of(group).into_iter().filter(|e| if fits { e.hangable == "yes" } else { e.hangable == "no" });
        let objects = load(chosen.collect())?;
        let all: Vec<_> =
            objects.iter().flat_map(|object| supporters.iter().map(move |s| (object, s))).collect();
        let count = if fits { pairs } else { pairs / 2 }.min(all.len());
        cases.extend((0..count).map(|k| {
            let (object, supporter) = all[k * all.len() / count];
            Case {
                name: format!("{}-{}", object.0, supporter.0),
                seed: k as u64,
                object_kind: object.1.clone(),
                supporter_kind: supporter.0.clone(),
                fits,
                object: object.2.clone(),
                supporter: supporter.2.clone(),
            }
        }));
    }
    Ok(cases)
}

/// The mesh in metres with z up, taken apart into convex parts.
fn solid(folder: &Path, entry: &Entry) -> Result<Solid> {
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
    Ok(Solid::take_apart(vertices, mesh.triangles))
}
