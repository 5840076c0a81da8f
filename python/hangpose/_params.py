"""The constants of the method."""

from __future__ import annotations

import os
import sys
from typing import Any, Iterator, Mapping, Union

import numpy as np

from . import _hangpose
from .errors import InvalidInput, UnreadableFile


class Params(Mapping[str, Any]):
    """All constants. ``Params()`` is the default profile and ``Params("paper")`` the published method; keyword arguments
    change single constants, and ``file`` is a TOML file of changes.

    >>> Params(clearance=0.002)["clearance"]
    0.002
    """

    def __init__(self, profile: str = "default", *, file: str | os.PathLike[str] | None = None, **changes: Any) -> None:
        read = {} if file is None else _read(file)
        self._values = _hangpose.params(profile, {**read, **changes})
        self._profile, self._given = profile, {**read, **changes}

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


def _read(file: str | os.PathLike[str]) -> dict[str, Any]:
    if sys.version_info < (3, 11):
        raise InvalidInput("file needs Python 3.11 or later: give the constants as keyword arguments", field="file")
    import tomllib

    try:
        with open(file, "rb") as stream:
            return tomllib.load(stream)
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise UnreadableFile(f"{os.fspath(file)}: {error}", field="file") from error
