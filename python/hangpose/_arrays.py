"""Arrays as the native part takes them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InvalidInput


def rows(values: Any, name: str) -> npt.NDArray[np.float32]:
    """An array of shape (n, 3) in single precision; not copied if it is one already."""
    array: npt.NDArray[np.float32] = _rows(numbers(values, name), name, np.float32)
    return array


def numbers(values: Any, name: str) -> npt.NDArray[Any]:
    """An array of real numbers, of the type in which they were given."""
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise InvalidInput(f"{name} is no array of numbers: {error}", field=name) from error
    if array.dtype.kind not in "fiu":
        raise InvalidInput(f"{name} is of type {array.dtype}: give numbers", field=name)
    return array


def origin(points: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """What to subtract from points in double precision so that single precision holds their details: zero unless they are
    as far from the origin as on a map. The same as for files."""
    if points.dtype != np.float64 or points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        return np.zeros(3)
    if not len(points):
        return np.zeros(3)
    low, high = points.min(axis=0), points.max(axis=0)
    extent, distance = (high - low).max(), max(np.abs(low).max(), np.abs(high).max())
    return np.floor(low) if extent > 0 and distance > _FAR * extent else np.zeros(3)


_FAR = 1000.0
"""Distance from the origin, in extents of the cloud, up to which the rounding of single precision does not matter."""


def triangles(values: Any, name: str) -> npt.NDArray[np.uint32]:
    """An array of shape (n, 3) of indices; not copied if it is one already."""
    array = numbers(values, name)
    if array.dtype.kind == "f" and array.size:
        raise InvalidInput(f"{name} are of type {array.dtype}: give integers", field=name)
    if array.size and (array.min() < 0 or array.max() > np.iinfo(np.uint32).max):
        index = int(np.argwhere((array < 0) | (array > np.iinfo(np.uint32).max))[0][0])
        raise InvalidInput(f"{name}[{index}] is no index of a vertex: {array[index]}", field=name, index=index)
    indices: npt.NDArray[np.uint32] = _rows(array, name, np.uint32)
    return indices


def _rows(values: Any, name: str, dtype: Any) -> Any:
    with np.errstate(over="ignore"):
        # What is too large for single precision becomes infinite, which the core refuses by its index.
        array = np.ascontiguousarray(values, dtype=dtype)
    if array.size == 0:
        return np.empty((0, 3), dtype=dtype)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"{name} has the shape {array.shape}: give (n, 3)", field=name)
    return array


def vector(values: Any, name: str, length: int = 3) -> list[float]:
    """So many numbers."""
    array = numbers(values, name).astype(np.float64).reshape(-1)
    if array.shape != (length,) or not np.isfinite(array).all():
        raise InvalidInput(f"{name} is {values!r}: give {length} numbers", field=name)
    return [float(x) for x in array]


def box(values: Any, name: str) -> list[list[float]]:
    """Two corners: (2, 3), or six numbers."""
    corners = vector(values, name, 6)
    return [corners[:3], corners[3:]]
