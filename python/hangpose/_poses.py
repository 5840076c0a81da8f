"""Poses and paths."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InvalidInput

Matrix = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Placement:
    """Where the object is: maps object coordinates to supporter coordinates, metres."""

    position: Matrix
    """Position of the object's origin."""
    quaternion: Matrix
    """Unit quaternion x, y, z, w."""
    matrix: Matrix
    """Homogeneous matrix, 4 x 4."""

    @staticmethod
    def of(value: Any, name: str = "pose") -> Placement:
        """A placement from a 4 x 4 matrix, from a position and a quaternion x, y, z, w, from a placement, or of an object
        that hangs at a pose."""
        if isinstance(value, Placement):
            return value
        if isinstance(value, Pose):
            return value.rest_placement or value.release_placement
        if isinstance(value, tuple) and len(value) == 2:
            position, quaternion = (np.asarray(part, dtype=np.float64) for part in value)
            if position.shape != (3,) or quaternion.shape != (4,) or abs(np.linalg.norm(quaternion) - 1) > 1e-3:
                raise InvalidInput(f"{name} needs a position and a unit quaternion x, y, z, w", field=name)
            quaternion = quaternion / np.linalg.norm(quaternion)
            return Placement(position, quaternion, _matrix(position, quaternion))
        matrix = np.asarray(value, dtype=np.float64)
        is_pose = matrix.shape == (4, 4) and np.array_equal(matrix[3], (0, 0, 0, 1)) and np.isfinite(matrix).all()
        if not is_pose or not _is_rotation(matrix[:3, :3]):
            raise InvalidInput(f"{name} needs a 4 x 4 matrix of a rotation and a position", field=name)
        return Placement(matrix[:3, 3].copy(), _quaternion(matrix[:3, :3]), matrix.copy())


def _is_rotation(matrix: Matrix) -> bool:
    return bool(np.abs(matrix @ matrix.T - np.eye(3)).max() < 1e-3 and np.linalg.det(matrix) > 0)


def _matrix(position: Matrix, quaternion: Matrix) -> Matrix:
    x, y, z, w = quaternion
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = position
    return matrix


def _quaternion(rotation: Matrix) -> Matrix:
    """x, y, z, w: the eigenvector of the largest eigenvalue of Bar-Itzhack's matrix, which needs no cases."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    matrix = np.array(
        [
            [a - e - i, d + b, g + c, h - f],
            [d + b, e - a - i, h + f, c - g],
            [g + c, h + f, i - a - e, d - b],
            [h - f, c - g, d - b, a + e + i],
        ]
    )
    quaternion: Matrix = np.linalg.eigh(matrix)[1][:, -1]
    return -quaternion if quaternion[3] < 0 else quaternion


@dataclass(frozen=True)
class Contact:
    """A contact at rest."""

    position: tuple[float, float, float]
    """Supporter coordinates, metres."""
    normal: tuple[float, float, float]
    """Unit vector into the object, supporter coordinates."""
    force: float
    """Multiples of the weight of the object."""


@dataclass(frozen=True)
class Margin:
    """How firmly the object stays."""

    tilts: tuple[float, ...]
    """Tilt of gravity that the pose survives towards eight directions, radians, from x of the supporter and
    counter-clockwise seen from above."""
    jolt_time: float
    """Seconds for which it stays when gravity suddenly tilts by 21.8 degrees."""
    tilted_sinking: float
    """Metres by which the centre of mass sinks in the tilt test."""
    escape_rise: float
    """Metres by which the centre of mass rises before the object comes off."""
    centre_of_mass_radius: float
    """Metres by which the centre of mass may be off."""
    escape_ratio: float
    """Escape rise over the lever of the centre of mass."""
    knock_speed: float
    """Speed of a knock that it survives, m/s."""


@dataclass(frozen=True)
class Tolerance:
    """How far the release may be off."""

    position: float
    """Metres."""
    rotation: float
    """Radians."""


@dataclass(frozen=True)
class Unseen:
    """How much of what matters no camera has seen, shares from 0 to 1."""

    object: float
    shadow: float
    supporter: float
    object_view: tuple[float, float, float]
    """Direction in which a camera would see most of what is unseen of the object, object frame."""
    supporter_view: tuple[float, float, float]
    """The same of the supporter, supporter frame."""


@dataclass(frozen=True, eq=False)
class Pose:
    """A pose in which the object hangs. What is known only by simulation is ``None`` for the profile ``paper``."""

    rank: int
    """1 for the best."""
    release: Matrix
    """Where the gripper lets go: 4 x 4 matrix, object to supporter coordinates, metres."""
    rest: Matrix | None
    """Where the object comes to rest."""
    kind: str | None
    """``"threaded"``, ``"hooked"``, ``"capped"`` or ``"balanced"``."""
    probability: float | None
    """Probability that the object hangs and stays."""
    robustness: float | None
    """Probability that it also stays when gravity tilts by 21.8 degrees."""
    sinking: float | None
    """Metres by which the centre of mass sinks from the release to rest."""
    clearance: float | None
    """Distance from the supporter at the release, metres."""
    tolerance: Tolerance | None
    unseen: Unseen | None
    margin: Margin | None
    contacts: tuple[Contact, ...]
    cost: float | None
    """Cost of the published method."""
    release_placement: Placement = field(repr=False)
    """The release pose as position and quaternion."""
    rest_placement: Placement | None = field(repr=False)

    def __repr__(self) -> str:
        x, y, z = self.release[:3, 3]
        sure = "" if self.probability is None else f" {self.kind}, hangs with probability {self.probability:.1%}"
        return f"<Pose {self.rank}:{sure}, release at ({x:.4f}, {y:.4f}, {z:.4f}) m>"


@dataclass(frozen=True)
class Rejection:
    """Why there is no pose."""

    stage: str
    """The first step that left nothing."""
    reason: str
    """The same in words."""


@dataclass(frozen=True, eq=False)
class Path:
    """A path without collisions. Between two waypoints the centre of mass moves straight and the object turns about a
    fixed axis."""

    seconds: Matrix
    """Times of the waypoints, shape (n,)."""
    poses: Matrix
    """Poses of the object, shape (n, 4, 4): from the start over the release pose to rest, or to where the
    object is in contact before that; or the other way."""
    release: int
    """Index of the release pose."""
    gripper_seconds: Matrix
    gripper_poses: Matrix
    """Poses of the opened gripper; empty without a gripper."""
    clearance: float
    """Least distance from obstacles between start and release, metres."""
    _waypoints: dict[str, Any] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        count, seconds = len(self.seconds), self.seconds[-1]
        return f"<Path of {count} waypoints, {seconds:.1f} s, clearance {self.clearance * 1e3:.1f} mm>"
