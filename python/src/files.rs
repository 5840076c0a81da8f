//! Meshes and clouds from files.

use crate::arrays::{array, rows};
use crate::errors;
use hangpose::files::{self, SupporterFile};
use hangpose::geometry::Mesh;
use hangpose::sample_supporter;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The mesh of a file: `vertices`, `triangles`, `viewpoints` and `notes`.
#[pyfunction]
pub(crate) fn read_mesh(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let mesh = py.detach(|| files::read_mesh(&path)).map_err(|error| errors::file(py, &error))?;
    let result = PyDict::new(py);
    result.set_item("vertices", array(py, mesh.vertices))?;
    result.set_item("triangles", array(py, mesh.triangles))?;
    result.set_item("viewpoints", array(py, mesh.viewpoints))?;
    result.set_item("notes", mesh.notes)?;
    Ok(result)
}

/// The supporter of a file: a mesh, as [`read_mesh`] gives it, or a cloud: `points`, `normals`, `viewpoints`, `origin` and `notes`.
#[pyfunction]
pub(crate) fn read_supporter(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let file = py.detach(|| files::read_supporter(&path)).map_err(|error| errors::file(py, &error))?;
    let result = PyDict::new(py);
    match file {
        SupporterFile::Mesh(mesh) => {
            result.set_item("vertices", array(py, mesh.vertices))?;
            result.set_item("triangles", array(py, mesh.triangles))?;
            result.set_item("notes", mesh.notes)?;
        }
        SupporterFile::Cloud(cloud) => {
            result.set_item("points", array(py, cloud.points))?;
            result.set_item("normals", cloud.normals.map(|normals| array(py, normals)))?;
            result.set_item("viewpoints", array(py, cloud.viewpoints))?;
            result.set_item("origin", cloud.origin)?;
            result.set_item("notes", cloud.notes)?;
        }
    }
    Ok(result)
}

/// Points and normals on a mesh.
#[pyfunction]
pub(crate) fn sample<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f32>,
    triangles: PyReadonlyArray2<'py, u32>,
    count: usize,
    seed: u64,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    // Copies, since other threads may write to the arrays while the mesh is sampled.
    let vertices = rows(py, "vertices", &vertices)?.to_vec();
    let triangles = rows(py, "triangles", &triangles)?.to_vec();
    let mesh = Mesh::new(&vertices, &triangles).map_err(|error| errors::mesh(py, &error))?;
    let cloud = py.detach(|| sample_supporter(&mesh, count, seed));
    let normals = cloud.normals.unwrap_or_default();
    Ok((array(py, cloud.points).into_any(), array(py, normals).into_any()))
}
