"""The constants of the method."""

from __future__ import annotations

import os
from typing import Any, Iterator, Mapping, Union

import numpy as np

from . import _hangpose


class Params(Mapping[str, Any]):
    """All constants. ``Params()`` is the default profile and ``Params("paper")`` the published method; keyword
    arguments change single constants, and ``file`` is a TOML file of changes.

    >>> Params(clearance=0.002)["clearance"]
    0.002
    """

    def __init__(self, profile: str = "default", *, file: str | os.PathLike[str] | None = None, **changes: Any) -> None:
        read = {} if file is None else _hangpose.read_params(file)
        self._profile, self._given = profile, {**read, **{name: _plain(value) for name, value in changes.items()}}
        self._values = _hangpose.params(profile, self._given)

    def __getitem__(self, name: str) -> Any:
        value = self._values[name]
        # Single precision, in the shortest form that is the same number.
        return float(str(np.float32(value))) if isinstance(value, float) else value

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        parts = [repr(self._profile)] if self._profile != "default" else []
        return f"Params({', '.join(parts + [f'{name}={value!r}' for name, value in self._given.items()])})"


def _plain(value: Any) -> Any:
    """Numbers and arrays of NumPy as those of Python."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value


ParamsLike = Union[Params, Mapping[str, Any], str, None]


def resolve(params: ParamsLike) -> dict[str, Any]:
    """All constants as the native part takes them."""
    if params is None:
        params = Params()
    elif isinstance(params, str):
        params = Params(params)
    elif not isinstance(params, Params):
        params = Params(**params)
    return params._values
