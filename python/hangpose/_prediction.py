"""Predictions, and the page that shows one."""

from __future__ import annotations

import html
import os
from dataclasses import dataclass, field
from typing import Any

from . import _hangpose
from ._poses import Path, Pose, Rejection
from ._shapes import Object, Supporter
from .errors import InvalidInput

_HEIGHT = 640
"""Height of the page in a notebook, pixels."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """What :func:`hangpose.predict` found. In a notebook it shows itself."""

    poses: list[Pose]
    """Best first."""
    rejection: Rejection | None
    """Why there are none."""
    stopped: str | None
    """``"work_limit"`` if the work limit ended the search; the poses are the best found until then."""
    counts: dict[str, int]
    """Candidates that were released, and what became of them: ``settling`` in the JSON of the command."""
    object: Object | None = field(repr=False)
    """``None`` in a prediction that was pickled."""
    supporter: Supporter | None = field(repr=False)
    paths: dict[int, Path] = field(default_factory=dict, repr=False)
    """Paths of :func:`hangpose.plan`, by rank, for the page."""
    _native: Any = field(default=None, repr=False)

    @property
    def best(self) -> Pose | None:
        """The best pose, or ``None`` if nothing hangs."""
        return self.poses[0] if self.poses else None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "object": None, "supporter": None, "_native": None}

    def _repr_html_(self) -> str:
        """The page in a frame of a notebook, or the text of a prediction without shapes."""
        if self._native is None:
            return f"<pre>{html.escape(repr(self))}</pre>"
        page = html.escape(view(self), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: {_HEIGHT}px; border: 0" title="hangpose"></iframe>'


def view(prediction: Prediction, path: str | os.PathLike[str] | None = None) -> str:
    """The page that shows a prediction: HTML that needs no network. With ``path`` it is also written there.

    Paths of ``prediction.paths`` are shown: ``prediction.paths[pose.rank] = hangpose.plan(...)``.
    """
    if prediction.object is None or prediction.supporter is None or prediction._native is None:
        raise InvalidInput("the prediction was pickled and has no shapes: predict again to view it", field="prediction")
    page = _hangpose.page(
        prediction.object._native,
        prediction.supporter._native,
        prediction._native,
        (prediction.object.name, prediction.supporter.name),
        [_path(rank, found._waypoints) for rank, found in prediction.paths.items()],
    )
    if path is not None:
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)
    return page


def _path(rank: int, found: dict[str, Any]) -> dict[str, Any]:
    return {**found, "rank": rank}
