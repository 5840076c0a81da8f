"""Predictions and paths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterable, Sequence

import numpy as np

from . import _hangpose
from ._arrays import box, numbers, rows, vector
from ._poses import Contact, Margin, Matrix, Path, Placement, Pose, Rejection, Tolerance, Unseen
from ._prediction import Prediction
from ._shapes import Object, Progress, Supporter
from .errors import InvalidInput, NoPath

Hung = Iterable[tuple[Object, Any]]


@dataclass(frozen=True)
class Capsule:
    """A part of a gripper that is closed on the object, in object coordinates, metres."""

    start: Sequence[float]
    end: Sequence[float]
    radius: float
    opening: Sequence[float] = (0.0, 0.0, 0.0)
    """How it moves when the gripper opens."""


@dataclass(frozen=True)
class Gripper:
    """The hand that holds the object, opens and leaves."""

    parts: Sequence[Capsule]
    retreat: Sequence[float] = (0.0, 0.0, 0.0)
    """The opened gripper leaves this way if it is free, object coordinates, metres."""


_MOST_POSES = 10_000
"""Largest number of poses of a prediction."""


def predict(
    object: Object,
    supporter: Supporter,
    *,
    top: int = 10,
    allow: Iterable[str] | str | None = None,
    prefer: Iterable[str] | str | None = None,
    here: Any = None,
    here_radius: float = 0.02,
    by: Any = None,
    by_radius: float = 0.02,
    by_box: Any = None,
    approach: Any = None,
    approach_angle: float = np.pi / 6,
    approach_length: float = 0.1,
    scene: Any = None,
    hung: Hung = (),
    distinct: tuple[float, float] | None = None,
    work_limit: int | None = None,
    progress: Progress | None = None,
) -> Prediction:
    """Predicts poses in which the object hangs, best first.

    Args:
        top: Largest number of poses, 1 to 10000.
        allow: Kinds that are given at all: ``"threaded"``, ``"hooked"``, ``"capped"``, ``"balanced"``.
        prefer: Kinds that come first; threaded and hooked by default.
        here: Point or points of the supporter at which the object hangs, within ``here_radius`` metres.
        by: Point or points of the object by which it hangs, within ``by_radius`` metres; or ``by_box``, two corners.
        approach: Direction of a free straight way to the release pose, at most ``approach_angle`` radians off it, of
            ``approach_length`` metres.
        scene: Points of things near the supporter that the object does not touch, shape (n, 3).
        hung: Objects that hang already, each with its :class:`Pose` or a 4 x 4 matrix.
        distinct: How much two poses of a kind differ at least, metres and radians.
        work_limit: Largest number of rays and distance queries.
        progress: Called with the share that is done, 0 to 1, while the call runs.

    Other threads run during the call, and Ctrl-C ends it.
    """
    _check(object, supporter)
    wishes, others, points = _wishes(
        supporter, allow, prefer, here, here_radius, by, by_radius, by_box, approach, approach_angle, approach_length,
        scene, hung, distinct,
    )  # fmt: skip
    if not 1 <= top <= _MOST_POSES:
        raise InvalidInput(
            f"top is {top}: give 1 to {_MOST_POSES}", field="top", value=top, minimum=1, maximum=_MOST_POSES
        )
    summary, native = _hangpose.predict(
        object._native, supporter._native, wishes, others, points, int(top), work_limit, progress
    )
    rejection = summary["rejection"]
    return Prediction(
        poses=[_pose(rank, pose, supporter.origin) for rank, pose in enumerate(summary["poses"], 1)],
        rejection=None if rejection is None else Rejection(*rejection),
        stopped=summary["stopped"],
        counts=summary["counts"],
        object=object,
        supporter=supporter,
        _native=native,
    )


def plan(
    object: Object,
    supporter: Supporter,
    pose: Any,
    *,
    start: Any = None,
    take_off: bool = False,
    gripper: Gripper | None = None,
    workspace: Any = None,
    clearance: float | None = None,
    samples: int | None = None,
    seed: int | None = None,
    scene: Any = None,
    hung: Hung = (),
    accepts: Callable[[Matrix], bool] | None = None,
    progress: Progress | None = None,
) -> Path:
    """Plans a path without collisions to a pose, or away from it.

    Args:
        pose: A :class:`Pose`, or a release pose as a 4 x 4 matrix or a position and a quaternion x, y, z, w.
        start: Where the object is grasped; by default anywhere outside of the supporter's bounds.
        take_off: Plan from rest to the start.
        gripper: The hand that holds the object.
        workspace: Box that the object stays in: two corners, supporter frame.
        clearance: Distance from obstacles where there is room for it, metres; 0.005 by default.
        samples: Budget of the search; 400 by default.
        scene, hung: Obstacles, as for :func:`predict`.
        accepts: Asked whether the object may be at a pose, a 4 x 4 matrix: the place of your inverse kinematics.

    Raises:
        NoPath: There is none, or none was found.
    """
    _check(object, supporter)
    origin = supporter.origin
    wishes, others, points = _wishes(supporter, scene=scene, hung=hung)
    if isinstance(pose, Pose):
        release, rest = pose.release_placement, pose.rest_placement
    else:
        release, rest = Placement.of(pose), None
    way = {
        "start": None if start is None else _placed(Placement.of(start, "start"), origin),
        "take_off": take_off,
        "gripper": None if gripper is None else _hand(gripper),
        "workspace": None if workspace is None else _local_box(workspace, origin),
        "clearance": clearance,
        "samples": samples,
        "seed": seed,
    }
    ask = None
    if accepts is not None:
        chosen = accepts

        def ask(rows: list[float]) -> bool:
            return bool(chosen(_moved(rows, origin)))

    answer = _hangpose.plan(
        object._native,
        supporter._native,
        _placed(release, origin),
        None if rest is None else _placed(rest, origin),
        way,
        wishes,
        others,
        points,
        ask,
        progress,
    )
    failure = answer.get("failure")
    if failure is not None:
        message, collision = failure["message"], failure["collision"]
        if collision is not None and origin.any():
            at = np.array(collision["at"]) + origin
            message = message.replace(_written(collision["at"]), _written(at))
            collision = {**collision, "at": at.tolist()}
        raise NoPath(message, reason=failure["reason"], collision=collision)
    found = answer["path"]
    (seconds, poses), (later, away) = (_waypoints(found[name], origin) for name in ("object", "gripper"))
    return Path(seconds, poses, found["release"], later, away, found["clearance"], found)


def _written(at: Iterable[float]) -> str:
    return f"({', '.join(f'{x:.3f}' for x in at)})"


def _check(object: Object, supporter: Supporter) -> None:
    for value, expected, name in ((object, Object, "object"), (supporter, Supporter, "supporter")):
        if not isinstance(value, expected):
            raise InvalidInput(f"{name} is a {type(value).__name__}: give a hangpose.{expected.__name__}", field=name)
    if object._shared != supporter._shared:
        raise InvalidInput("the object and the supporter have different params: give both the same", field="params")


def _wishes(
    supporter: Supporter,
    allow: Iterable[str] | str | None = None,
    prefer: Iterable[str] | str | None = None,
    here: Any = None,
    here_radius: float = 0.02,
    by: Any = None,
    by_radius: float = 0.02,
    by_box: Any = None,
    approach: Any = None,
    approach_angle: float = 0.0,
    approach_length: float = 0.0,
    scene: Any = None,
    hung: Hung = (),
    distinct: tuple[float, float] | None = None,
) -> tuple[dict[str, Any], list[Any], Any]:
    origin = supporter.origin
    hung = list(hung)
    for index, (other, _) in enumerate(hung):
        if not isinstance(other, Object):
            raise InvalidInput(f"hung[{index}] needs an Object and a pose", field="hung", index=index)
    wishes = {
        "allow": _kinds(allow, "allow"),
        "prefer": _kinds(prefer, "prefer"),
        "here": None if here is None else rows(np.atleast_2d(numbers(here, "here")) - origin, "here").tolist(),
        "here_radius": here_radius,
        "by": None if by is None else rows(np.atleast_2d(by), "by").tolist(),
        "by_radius": by_radius,
        "by_box": None if by_box is None else box(by_box, "by_box"),
        "approach": None if approach is None else vector(approach, "approach"),
        "approach_angle": approach_angle,
        "approach_length": approach_length,
        "hung": [_placed(Placement.of(pose, "hung"), origin) for _, pose in hung],
        "distinct": distinct,
    }
    points = rows([], "scene") if scene is None else rows(numbers(scene, "scene") - origin, "scene")
    return wishes, [other._native for other, _ in hung], points


_KINDS = ("threaded", "hooked", "capped", "balanced")


def _kinds(kinds: Iterable[str] | str | None, name: str) -> list[str] | None:
    if kinds is None:
        return None
    chosen = [kinds] if isinstance(kinds, str) else list(kinds)
    for kind in chosen:
        if kind not in _KINDS:
            raise InvalidInput(f"{name} has {kind!r}: give {', '.join(_KINDS)}", field=name)
    return chosen


def _placed(placement: Placement, origin: Matrix) -> dict[str, Any]:
    return {"position": (placement.position - origin).tolist(), "quaternion": placement.quaternion.tolist()}


def _local_box(values: Any, origin: Matrix) -> list[list[float]]:
    return [[x - o for x, o in zip(corner, origin)] for corner in box(values, "workspace")]


def _hand(gripper: Gripper) -> dict[str, Any]:
    parts = [
        {
            "start": vector(capsule.start, "gripper.parts"),
            "end": vector(capsule.end, "gripper.parts"),
            "radius": float(capsule.radius),
            "opening": vector(capsule.opening, "gripper.parts"),
        }
        for capsule in gripper.parts
    ]
    return {"parts": parts, "retreat": vector(gripper.retreat, "gripper.retreat")}


def _moved(rows: list[float], origin: Matrix) -> Matrix:
    matrix = np.array(rows, dtype=np.float64).reshape(4, 4)
    matrix[:3, 3] += origin
    return matrix


def _placement(value: dict[str, Any], origin: Matrix) -> Placement:
    return Placement(
        np.array(value["position"]) + origin, np.array(value["quaternion"]), _moved(value["matrix"], origin)
    )


def _waypoints(found: list[dict[str, Any]], origin: Matrix) -> tuple[Matrix, Matrix]:
    poses = np.array([_moved(waypoint["matrix"], origin) for waypoint in found]).reshape(-1, 4, 4)
    return np.array([waypoint["seconds"] for waypoint in found]), poses


def _pose(rank: int, value: dict[str, Any], origin: Matrix) -> Pose:
    release = _placement(value["release"], origin)
    rest = None if value["rest"] is None else _placement(value["rest"], origin)
    tolerance, unseen, margin = value["tolerance"], value["unseen"], value["margin"]
    if margin is not None:
        margin = Margin(**{**margin, "tilts": tuple(margin["tilts"])})
        views = {name: tuple(unseen[name]) for name in ("object_view", "supporter_view")}
        unseen = Unseen(**{**unseen, **views})
        tolerance = Tolerance(**tolerance)
    contacts = tuple(
        Contact(tuple(np.array(c["position"]) + origin), tuple(c["normal"]), c["force"])
        for c in value["contacts"] or ()
    )
    return Pose(
        rank=rank,
        release=release.matrix,
        rest=None if rest is None else rest.matrix,
        kind=value["kind"],
        probability=value["probability"],
        robustness=value["robustness"],
        sinking=value["sinking"],
        clearance=value["clearance"],
        tolerance=tolerance,
        unseen=unseen,
        margin=margin,
        contacts=contacts,
        cost=value["cost"],
        release_placement=release,
        rest_placement=rest,
    )
