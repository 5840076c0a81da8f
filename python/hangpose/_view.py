"""The page of a prediction."""

from __future__ import annotations

import html
import os
from typing import Any

from . import _hangpose
from ._poses import Prediction
from .errors import InvalidInput

_HEIGHT = 640
"""Height of the page in a notebook, pixels."""


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


def frame(prediction: Prediction) -> str:
    """The page in a frame of a notebook, or the text of a prediction without shapes."""
    if prediction._native is None:
        return f"<pre>{html.escape(repr(prediction))}</pre>"
    page = html.escape(view(prediction), quote=True)
    return f'<iframe srcdoc="{page}" style="width: 100%; height: {_HEIGHT}px; border: 0" title="hangpose"></iframe>'
