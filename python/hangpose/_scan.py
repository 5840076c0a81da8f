"""Meshes and clouds from depth images."""

from __future__ import annotations

import warnings
from typing import Any, Sequence

import numpy as np
import numpy.typing as npt

from . import _hangpose
from ._arrays import box, vector
from ._shapes import Progress
from .errors import InvalidInput


def scan(
    depths: Sequence[Any],
    intrinsics: Any,
    poses: Sequence[Any] | None = None,
    *,
    masks: Sequence[Any] | None = None,
    label: int = 1,
    distortion: Any = (0.0, 0.0, 0.0, 0.0, 0.0),
    depth_scale: float = 0.001,
    voxel: float | None = None,
    crop: Any = None,
    max_depth: float = 5.0,
    complete: bool = False,
    cloud: bool = False,
    progress: Progress | None = None,
) -> dict[str, npt.NDArray[Any]]:
    """Fuses depth images into the mesh of an object, or into the cloud of a supporter.

    Args:
        depths: Images of ``uint16`` in units of ``depth_scale`` metres, or of floating-point metres, which are rounded to
            a 60000th of ``max_depth``; 0 or NaN is no depth.
        intrinsics: 3 x 3 matrix of the camera.
        poses: 4 x 4 matrices from camera to world coordinates; not needed for a single image.
        masks: Images of ``uint8`` in which the object has ``label``.
        distortion: k1, k2, p1, p2, k3.
        voxel: Resolution, metres; from 1.5 to 3 mm by default.
        crop: Box in world coordinates: two corners.
        max_depth: Depth beyond which surfaces are ignored, metres.
        complete: Close the mesh of an object that is held alone by a guess.
        cloud: Give points with normals instead of a mesh.

    Returns:
        ``vertices``, ``triangles``, ``seen`` (0 where it was guessed) and ``viewpoints``; or ``points``, ``normals``
        and ``viewpoints``.
    """
    if poses is None and len(depths) == 1:
        poses = [np.eye(4)]
    if poses is None or len(poses) != len(depths):
        raise InvalidInput(f"there are {len(depths)} images: give one pose for each", field="poses")
    if masks is not None and len(masks) != len(depths):
        raise InvalidInput(f"there are {len(depths)} images: give one mask for each", field="masks")
    if complete and cloud:
        raise InvalidInput("complete closes a mesh: leave out cloud", field="complete")
    images = [_depth(image, index, depth_scale, max_depth) for index, image in enumerate(depths)]
    labels = [None if masks is None else np.ascontiguousarray(masks[i], dtype=np.uint8) for i in range(len(depths))]
    matrices = [np.asarray(pose, dtype=np.float64) for pose in poses]
    for index, matrix in enumerate(matrices):
        if matrix.shape != (4, 4):
            raise InvalidInput(f"poses[{index}] has the shape {matrix.shape}: give 4 x 4", field="poses", index=index)
    intrinsics = np.asarray(intrinsics, dtype=np.float64)
    if intrinsics.shape != (3, 3):
        raise InvalidInput(f"intrinsics has the shape {intrinsics.shape}: give 3 x 3", field="intrinsics")
    common = {
        "intrinsics": intrinsics.tolist(),
        "distortion": vector(distortion, "distortion", 5),
        "label": label,
        "voxel": voxel,
        "crop": None if crop is None else box(crop, "crop"),
        "max_depth": max_depth,
    }
    frames = [(*image, mask, matrix.tolist()) for image, mask, matrix in zip(images, labels, matrices)]
    if cloud:
        found = _hangpose.scan_cloud(frames, common, progress)
    else:
        found = _hangpose.scan(frames, common, complete, progress)
    agreement = found.pop("agreement")
    if agreement is not None and agreement < _FAIR_AGREEMENT:
        warnings.warn(
            f"only {agreement:.0%} of the points of an image reappear in the next: check that poses and images are in "
            "the same order, or that the images overlap",
            stacklevel=2,
        )
    return found


_FAIR_AGREEMENT = 0.3
"""Part of the points of an image that should reappear in the next."""
_UNITS = 60_000
"""Units of the greatest depth in images of floating-point numbers. What is farther away is free space up to there."""
_MOST_UNITS = 65_534


def _depth(image: Any, index: int, scale: float, max_depth: float) -> tuple[npt.NDArray[np.uint16], float]:
    """The image in units, and metres a unit."""
    array = np.asarray(image)
    if array.ndim != 2:
        raise InvalidInput(
            f"depths[{index}] has the shape {array.shape}: give (height, width)", field="depths", index=index
        )
    if array.dtype == np.uint16:
        return np.ascontiguousarray(array), scale
    if array.dtype.kind != "f":
        raise InvalidInput(
            f"depths[{index}] is of type {array.dtype}: give uint16 or metres as floating-point numbers",
            field="depths",
            index=index,
        )
    if not max_depth > 0:
        raise InvalidInput(
            f"max_depth is {max_depth}: give a positive number of metres", field="max_depth", value=max_depth
        )
    metres = np.where(np.isfinite(array) & (array > 0), array, 0)
    return np.minimum(np.round(metres * (_UNITS / max_depth)), _MOST_UNITS).astype(np.uint16), max_depth / _UNITS
