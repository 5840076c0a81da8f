"""Arrays as the native part takes them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InvalidInput


def rows(values: Any, name: str) -> npt.NDArray[np.float32]:
    """An array of shape (n, 3) in single precision; not copied if it is one already."""
    return _rows(values, name, np.float32)


def triangles(values: Any, name: str) -> npt.NDArray[np.uint32]:
    """An array of shape (n, 3) of indices; not copied if it is one already."""
    array = np.asarray(values)
    if array.dtype.kind not in "iu":
        raise InvalidInput(f"{name} are of type {array.dtype}: give integers", field=name)
    if array.size and (array.min() < 0 or array.max() > np.iinfo(np.uint32).max):
        index = int(np.argwhere((array < 0) | (array > np.iinfo(np.uint32).max))[0][0])
        raise InvalidInput(f"{name}[{index}] is no index of a vertex: {array[index]}", field=name, index=index)
    return _rows(array, name, np.uint32)


def _rows(values: Any, name: str, dtype: Any) -> Any:
    try:
        array = np.ascontiguousarray(values, dtype=dtype)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"{name} is no array of numbers: {error}", field=name) from error
    if array.size == 0:
        return np.empty((0, 3), dtype=dtype)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"{name} has the shape {array.shape}: give (n, 3)", field=name)
    return array


def vector(values: Any, name: str, length: int = 3) -> list[float]:
    """So many numbers."""
    array = np.asarray(values, dtype=np.float64).reshape(-1)
    if array.shape != (length,) or not np.isfinite(array).all():
        raise InvalidInput(f"{name} is {values!r}: give {length} numbers", field=name)
    return [float(x) for x in array]


def box(values: Any, name: str) -> list[list[float]]:
    """Two corners: (2, 3), or six numbers."""
    corners = vector(values, name, 6)
    return [corners[:3], corners[3:]]
