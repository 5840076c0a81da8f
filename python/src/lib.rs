//! The native part of the Python module `hangpose`. The classes that users see are in `python/hangpose`; they pass arrays,
//! dictionaries and strings to the functions here.

// The macros of PyO3 make items that cannot be documented.
#![allow(missing_docs)]

mod arrays;
mod errors;
mod files;
mod models;
mod plan;
mod predict;
mod request;
mod scan;
mod view;
mod work;

use hangpose::Params;
use pyo3::prelude::*;
use pythonize::{depythonize, pythonize};
use std::path::PathBuf;

/// All constants of a profile, with `changes` to them.
#[pyfunction]
fn params<'py>(py: Python<'py>, profile: &str, changes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let base = match profile {
        "paper" => Params::paper(),
        "default" => Params::default(),
        _ => return Err(errors::value(py, "profile", "the profile is \"default\" or \"paper\"")),
    };
    let changes: serde_json::Map<String, serde_json::Value> = depythonize(changes)?;
    let mut all = serde_json::to_value(base).expect("params are a map");
    all.as_object_mut().expect("params are a map").extend(changes);
    let params: Params =
        serde_json::from_value(all).map_err(|error| errors::value(py, "params", &error.to_string()))?;
    params.validate().map_err(|error| errors::params(py, &error))?;
    Ok(pythonize(py, &params)?)
}

/// The constants that a TOML file changes.
#[pyfunction]
fn read_params(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let at = path.display();
    let unreadable = |reason: &str| errors::unreadable(py, &format!("{at}: {reason}"));
    let text = std::fs::read_to_string(&path)
        .map_err(|_| unreadable("cannot be read; give a readable TOML file of constants"))?;
    let wrong = |error: toml::de::Error| unreadable(error.to_string().trim_end());
    // Parsed as `Params` first: these errors name the line and the valid keys.
    let checked: Params = toml::from_str(&text).map_err(wrong)?;
    checked.validate().map_err(|error| errors::params(py, &error))?;
    let table: toml::Table = text.parse().map_err(wrong)?;
    Ok(pythonize(py, &table)?)
}

#[pymodule]
fn _hangpose(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<models::NativeObject>()?;
    module.add_class::<models::NativeSupporter>()?;
    module.add_class::<predict::NativePrediction>()?;
    module.add_function(wrap_pyfunction!(params, module)?)?;
    module.add_function(wrap_pyfunction!(read_params, module)?)?;
    module.add_function(wrap_pyfunction!(files::read_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(files::read_supporter, module)?)?;
    module.add_function(wrap_pyfunction!(files::sample, module)?)?;
    module.add_function(wrap_pyfunction!(predict::predict, module)?)?;
    module.add_function(wrap_pyfunction!(plan::plan, module)?)?;
    module.add_function(wrap_pyfunction!(scan::scan, module)?)?;
    module.add_function(wrap_pyfunction!(scan::scan_cloud, module)?)?;
    module.add_function(wrap_pyfunction!(view::page, module)?)?;
    Ok(())
}
