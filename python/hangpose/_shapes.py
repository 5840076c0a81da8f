"""Objects and supporters."""

from __future__ import annotations

import os
import warnings
from typing import Any, Callable, TypeVar

import numpy as np
import numpy.typing as npt

from . import _hangpose
from ._arrays import box, numbers, origin, rows, triangles as indices, vector
from ._params import ParamsLike, resolve
from .errors import InvalidInput

Progress = Callable[[float], object]
_Float = TypeVar("_Float", np.float32, np.float64)

_AXES = ("x", "y", "z")
_PLAUSIBLE = (0.005, 5.0)
"""Least and greatest plausible extent of an object or a supporter, metres."""


def _warn_of_size(points: npt.NDArray[np.float32], what: str) -> None:
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    least, greatest = _PLAUSIBLE
    if np.isfinite(size) and not least <= size <= greatest:
        unit = "millimetres, pass scale=0.001" if size > greatest else "kilometres, pass scale=1000"
        text = f"the {what} is {size:.3g} m large, but {least} to {greatest:g} m is plausible; if its unit is {unit}"
        warnings.warn(text, stacklevel=3)


def _turn(array: npt.NDArray[_Float], up: str) -> npt.NDArray[_Float]:
    """Turns coordinates by the smallest angle that maps an axis to z."""
    sign = -1 if up.startswith("-") else 1
    axis = up.lower().removeprefix("+").removeprefix("-")
    if axis not in _AXES:
        raise InvalidInput(f"up is {up!r}: give x, y, z, -x, -y or -z", field="up")
    x, y, z = array.T
    turned = {"x": (-sign * z, y, sign * x), "y": (x, -sign * z, sign * y), "z": (x, sign * y, sign * z)}[axis]
    return np.ascontiguousarray(np.stack(turned, axis=1))


def _placed(array: npt.NDArray[np.float32], scale: float, up: str) -> npt.NDArray[np.float32]:
    if not (np.isfinite(scale) and scale > 0):
        raise InvalidInput(
            f"scale is {scale}: give a positive number, as 0.001 for millimetres", field="scale", value=scale
        )
    if scale != 1.0:
        array = (array * np.float32(scale)).astype(np.float32, copy=False)
    return array if up == "z" else _turn(array, up)


def _is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def _mesh_arrays(mesh: Any) -> tuple[Any, Any] | None:
    """Vertices and triangles of a mesh of trimesh or Open3D, told by its attributes."""
    for faces in ("faces", "triangles"):
        if hasattr(mesh, "vertices") and hasattr(mesh, faces):
            found = getattr(mesh, faces)
            if not callable(found):
                return np.asarray(mesh.vertices), np.asarray(found)
    return None


def _cloud_arrays(cloud: Any) -> tuple[Any, Any] | None:
    """Points and normals of a cloud of Open3D or trimesh, told by its attributes."""
    if hasattr(cloud, "points") and not callable(cloud.points):
        normals = np.asarray(cloud.normals) if hasattr(cloud, "normals") else np.empty((0, 3))
        return np.asarray(cloud.points), normals if len(normals) else None
    if hasattr(cloud, "vertices"):
        return np.asarray(cloud.vertices), None
    return None


class Object:
    """An object, analysed: shape, centre of mass, and the places by which it may hang.

    Args:
        mesh: A path (obj, stl, ply, glb, gltf), a mesh of trimesh or Open3D, or an array of vertices.
        triangles: Vertex indices of the triangles, if ``mesh`` is an array of vertices.
        params: A :class:`Params`, the name of a profile, or a mapping of changes. The supporter needs the same.
        viewpoints: Positions of the cameras that saw the object, object frame, metres, after ``scale`` and ``up``; by
            default what the file says.
        centre_of_mass: In the object frame, metres, after ``scale`` and ``up``; by default the centroid of the volume.
        scale: Factor to metres.
        up: Axis that becomes z: x, y, z, -x, -y or -z.
        progress: Called with the share that is done, 0 to 1.
        name: What the page calls it; by default the name of the file.

    Arrays may be of any numeric type and layout. One copy is made, so that other threads may write to them meanwhile.
    Vertices are not merged: a mesh whose triangles share none is open, and its centre of mass that of its surface.
    """

    def __init__(
        self,
        mesh: Any,
        triangles: Any = None,
        *,
        params: ParamsLike = None,
        viewpoints: Any = None,
        centre_of_mass: Any = None,
        scale: float = 1.0,
        up: str = "z",
        progress: Progress | None = None,
        name: str | None = None,
    ) -> None:
        self.notes: list[str] = []
        if triangles is not None:
            vertices = mesh
        elif _is_path(mesh):
            read = _hangpose.read_mesh(mesh)
            vertices, triangles = read["vertices"], read["triangles"]
            if viewpoints is None:
                viewpoints = _placed(read["viewpoints"], scale, up)
            self.notes = read["notes"]
            name = name or os.path.basename(os.fspath(mesh))
        else:
            found = _mesh_arrays(mesh)
            if found is None:
                raise InvalidInput(
                    f"mesh is a {type(mesh).__name__}: give a path, a mesh of trimesh or Open3D, or vertices and "
                    "triangles",
                    field="mesh",
                )
            vertices, triangles = found
        constants = resolve(params)
        if centre_of_mass is not None:
            constants = {**constants, "centre_of_mass": {"given": vector(centre_of_mass, "centre_of_mass")}}
        self.name = name or "object"
        self._shared = {**constants, "centre_of_mass": None}
        placed = _placed(rows(vertices, "vertices"), scale, up)
        self._native = _hangpose.NativeObject(
            placed,
            indices(triangles, "triangles"),
            rows([] if viewpoints is None else viewpoints, "viewpoints"),
            constants,
            progress,
        )
        _warn_of_size(placed, "object")

    @property
    def centre_of_mass(self) -> npt.NDArray[np.float64]:
        """Object frame, metres."""
        return np.array(self._native.centre_of_mass)

    @property
    def mass(self) -> dict[str, Any]:
        """Area, volume, inertia and closedness of the mesh."""
        return self._native.mass

    @property
    def symmetries(self) -> list[tuple[list[float], int]]:
        """Axes of symmetry through the centre of mass with their folds, 0 for any angle."""
        return self._native.symmetries

    @property
    def places(self) -> npt.NDArray[np.float32]:
        """Positions of the contact candidates, or of the hanging sites of the profile ``paper``; object frame."""
        return self._native.places

    def __repr__(self) -> str:
        return f"<Object {self.name!r}: {self._native.triangle_count} triangles, {len(self.places)} places to hang by>"


_SAMPLES = (100, 500_000)
"""Least and greatest number of points to which a mesh is sampled."""


class Supporter:
    """A supporter, analysed: points and the places on which something may hang.

    Args:
        cloud: A path (ply, pcd, xyz, or a mesh), a cloud or mesh of Open3D or trimesh, or an array of points. Meshes
            are sampled.
        normals: Normals of the points, if ``cloud`` is an array of points.
        triangles: Vertex indices, if ``cloud`` is an array of the vertices of a mesh.
        params: As for the object.
        viewpoints: Positions of the cameras that saw it, supporter frame, metres, after ``scale`` and ``up``; by
            default what the file says.
        region: Box that limits the places to hang on: two corners, supporter frame.
        samples: Number of points to which a mesh is sampled, 100 to 500000.
        scale, up, progress, name: As for :class:`Object`.

    Points in double precision may have the coordinates of a map: ``origin`` is subtracted before the analysis, and what
    is found is given in the map's frame.
    """

    def __init__(
        self,
        cloud: Any,
        normals: Any = None,
        *,
        triangles: Any = None,
        params: ParamsLike = None,
        viewpoints: Any = None,
        region: Any = None,
        samples: int = 10_000,
        scale: float = 1.0,
        up: str = "z",
        progress: Progress | None = None,
        name: str | None = None,
    ) -> None:
        self.notes: list[str] = []
        self.origin = np.zeros(3)
        constants = resolve(params)
        mesh: tuple[Any, Any] | None = None
        local_views = np.empty((0, 3), dtype=np.float32)
        if triangles is not None:
            mesh = (cloud, triangles)
        elif _is_path(cloud):
            read = _hangpose.read_supporter(cloud)
            self.notes = read["notes"]
            name = name or os.path.basename(os.fspath(cloud))
            if "triangles" in read:
                mesh = (read["vertices"], read["triangles"])
            else:
                points, normals = read["points"], read["normals"]
                self.origin = _turn_point(np.array(read["origin"]) * scale, up)
                local_views = _placed(read["viewpoints"], scale, up)
        elif isinstance(cloud, (np.ndarray, list, tuple)):
            points = cloud
        else:
            mesh = _mesh_arrays(cloud)
            if mesh is None or not len(mesh[1]):
                found = _cloud_arrays(cloud)
                if found is None:
                    raise InvalidInput(
                        f"cloud is a {type(cloud).__name__}: give a path, a cloud or mesh of Open3D or trimesh, or "
                        "points",
                        field="cloud",
                    )
                mesh, (points, normals) = None, found
        if mesh is not None:
            vertices = _placed(rows(mesh[0], "vertices"), scale, up)
            least, most = _SAMPLES
            if not least <= samples <= most:
                text = f"samples is {samples}: give {least} to {most}"
                raise InvalidInput(text, field="samples", value=samples, minimum=least, maximum=most)
            points, normals = _hangpose.sample(vertices, indices(mesh[1], "triangles"), samples, constants["seed"])
        else:
            points = numbers(points, "points")
            far = origin(points)
            if far.any():
                points = points - far
                self.origin = _turn_point(far * scale, up)
            points = _placed(rows(points, "points"), scale, up)
            normals = None if normals is None else _placed(rows(normals, "normals"), 1.0, up)
        local = (
            None
            if region is None
            else [[x - o for x, o in zip(corner, self.origin)] for corner in box(region, "region")]
        )
        if viewpoints is not None:
            local_views = rows(np.atleast_2d(numbers(viewpoints, "viewpoints")) - self.origin, "viewpoints")
        self.name = name or "supporter"
        self._shared = {**constants, "centre_of_mass": None}
        self._constants = constants
        self._native = _hangpose.NativeSupporter(
            points,
            normals,
            local_views,
            local,
            constants,
            progress,
        )
        _warn_of_size(points, "supporter")

    @property
    def places(self) -> npt.NDArray[np.float64]:
        """Positions of the contact candidates, or of the support sites of the profile ``paper``; supporter frame."""
        return self._native.places + self.origin

    @property
    def guessed(self) -> int:
        """Number of points of the far side that no camera saw and that were guessed."""
        return self._native.guessed

    def __repr__(self) -> str:
        return f"<Supporter {self.name!r}: {self._native.point_count} points, {len(self.places)} places to hang on>"


def _turn_point(point: npt.NDArray[np.float64], up: str) -> npt.NDArray[np.float64]:
    return point if up == "z" else _turn(point[None, :], up)[0]
