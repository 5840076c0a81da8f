//! Arrays of NumPy as the core takes them.

use crate::errors;
use numpy::{Element, IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// The rows of an array of three columns, without a copy. The Python part makes the array contiguous and of this type.
pub(crate) fn rows<'a, T: Element>(
    py: Python<'_>,
    name: &str,
    array: &'a PyReadonlyArray2<'_, T>,
) -> PyResult<&'a [[T; 3]]> {
    let flat = array.as_slice().ok().filter(|_| array.shape()[1] == 3);
    let (rows, _) = flat
        .ok_or_else(|| errors::value(py, name, &format!("{name} needs the shape (n, 3)")))?
        .as_chunks::<3>();
    Ok(rows)
}

/// An array of three columns that takes over the memory of `rows`.
pub(crate) fn array<T: Element>(py: Python<'_>, rows: Vec<[T; 3]>) -> Bound<'_, PyArray2<T>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, 3]).expect("three numbers a row")
}
