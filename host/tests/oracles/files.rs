//! Meshes from files, which may have several bodies, openings, duplicate faces and needle triangles.
//!
//! The environment variable `HANGPOSE_MESHES` names a directory; every mesh below it is checked. The default is the
//! samples of the repository.

use crate::random::Random;
use crate::shapes::Shape;
use crate::truth::Truth;
use crate::{rays, surface};
use hangpose::files::{read_cloud, read_mesh};
use std::path::{Path, PathBuf};

/// Largest extent of each mesh after scaling, m; files have no unit.
const EXTENT: f32 = 0.2;

/// Paths of the meshes below a directory, sorted.
fn meshes_below(directory: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            found.extend(meshes_below(&path));
        } else if path
            .extension()
            .is_some_and(|e| ["obj", "stl", "ply", "glb"].iter().any(|known| e == *known))
        {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Reads a mesh; `None` if the file holds a point cloud.
fn read(path: &Path) -> Option<Shape> {
    if read_cloud(path).is_ok() {
        return None;
    }
    let mesh = read_mesh(path).unwrap();
    let extent = |axis: usize| {
        let values = || mesh.vertices.iter().map(|v| v[axis]);
        values().fold(f32::MIN, f32::max) - values().fold(f32::MAX, f32::min)
    };
    let scale = EXTENT / extent(0).max(extent(1)).max(extent(2));
    let vertices = mesh.vertices.iter().map(|v| v.map(|x| x * scale)).collect();
    Some(Shape::from_file(path.file_name().unwrap().to_string_lossy().into(), vertices, mesh.triangles))
}

#[test]
fn meshes_from_files_agree_with_parry() {
    let directory = std::env::var_os("HANGPOSE_MESHES").map(PathBuf::from).unwrap_or_else(|| {
        eprintln!("HANGPOSE_MESHES is not set: checking the samples only");
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples")
    });
    if !directory.is_dir() {
        eprintln!("{} is not a directory: nothing was checked", directory.display());
        return;
    }
    let mut random = Random(4);
    for shape in meshes_below(&directory).iter().filter_map(|path| read(path)) {
        shape.with_surface(|ours, shape| {
            let truth = Truth::of(shape);
            let rays = rays::check(shape, ours, &truth, &mut random, 50);
            let points = surface::check(&shape.name, ours, &truth, &mut random, 100);
            eprintln!("{} ({} triangles): {rays:?} {points:?}", shape.name, shape.triangles.len());
        });
    }
}
