"""The native part: arrays, dictionaries and strings. Use the classes and functions of `hangpose`."""

from os import PathLike
from typing import Any, Callable, Sequence, final

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float32]
_Indices = npt.NDArray[np.uint32]
_Progress = Callable[[float], object] | None

__all__ = [
    "NativeObject",
    "NativePrediction",
    "NativeSupporter",
    "__version__",
    "page",
    "params",
    "plan",
    "predict",
    "read_mesh",
    "read_params",
    "read_supporter",
    "sample",
    "scan",
    "scan_cloud",
]

__version__: str

@final
class NativeObject:
    def __new__(
        cls, vertices: _Floats, triangles: _Indices, viewpoints: _Floats, params: dict[str, Any], progress: _Progress
    ) -> NativeObject: ...
    @property
    def centre_of_mass(self) -> list[float]: ...
    @property
    def mass(self) -> dict[str, Any]: ...
    @property
    def symmetries(self) -> list[tuple[list[float], int]]: ...
    @property
    def places(self) -> _Floats: ...
    @property
    def triangle_count(self) -> int: ...

@final
class NativeSupporter:
    def __new__(
        cls,
        points: _Floats,
        normals: _Floats | None,
        viewpoints: _Floats,
        region: Sequence[Sequence[float]] | None,
        params: dict[str, Any],
        progress: _Progress,
    ) -> NativeSupporter: ...
    @property
    def places(self) -> _Floats: ...
    @property
    def point_count(self) -> int: ...
    @property
    def guessed(self) -> int: ...

@final
class NativePrediction: ...

def params(profile: str, changes: dict[str, Any]) -> dict[str, Any]: ...
def read_params(path: str | PathLike[str]) -> dict[str, Any]: ...
def read_mesh(path: str | PathLike[str]) -> dict[str, Any]: ...
def read_supporter(path: str | PathLike[str]) -> dict[str, Any]: ...
def sample(vertices: _Floats, triangles: _Indices, count: int, seed: int) -> tuple[_Floats, _Floats]: ...
def predict(
    object: NativeObject,
    supporter: NativeSupporter,
    wishes: dict[str, Any],
    hung: list[NativeObject],
    scene: _Floats,
    top: int,
    work_limit: int | None,
    progress: _Progress,
) -> tuple[dict[str, Any], NativePrediction]: ...
def plan(
    object: NativeObject,
    supporter: NativeSupporter,
    release: dict[str, Any],
    rest: dict[str, Any] | None,
    way: dict[str, Any],
    wishes: dict[str, Any],
    hung: list[NativeObject],
    scene: _Floats,
    accepts: Callable[[list[float]], bool] | None,
    progress: _Progress,
) -> dict[str, Any]: ...
def scan(
    images: Sequence[tuple[Any, float, Any, Any]], common: dict[str, Any], complete: bool, progress: _Progress
) -> dict[str, Any]: ...
def scan_cloud(
    images: Sequence[tuple[Any, float, Any, Any]], common: dict[str, Any], progress: _Progress
) -> dict[str, Any]: ...
def page(
    object: NativeObject,
    supporter: NativeSupporter,
    prediction: NativePrediction,
    names: tuple[str, str],
    paths: list[dict[str, Any]],
) -> str: ...
